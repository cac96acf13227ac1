"""What is drawn wrongly breaks a law of what a person sees."""

import dataclasses
import math

import numpy as np
import pytest

from wrist_control import WRISTS
from wrist_control.rotations import about_x, product
from wrist_control.testing.broken import LawBrokenError
from wrist_control.testing.seen import SEEN
from wrist_control.wrists import Wrist, wrist_class
from wrist_control.wrists.body import Arc, Ball, Plate, Rod


def changed(body, **changes):
    return body._replace(**changes)


def hand_drawn_elsewhere(drawn, positions):
    *rest, hand = drawn
    x, y, z = hand.pose.position
    return (*rest, changed(hand, pose=hand.pose._replace(position=(x, y + 1e-9, z))))


def hand_drawn_turned(drawn, positions):
    *rest, hand = drawn
    turned = product(hand.pose.quaternion, about_x(1e-9))
    return (*rest, changed(hand, pose=hand.pose._replace(quaternion=turned)))


def moving_forearm(drawn, positions):
    forearm, *rest = drawn
    return (changed(forearm, pose=rest[0].pose), *rest)


def no_forearm(drawn, positions):
    return drawn[1:]


def two_of_one_name(drawn, positions):
    forearm, second, third, *rest = drawn
    return (forearm, second, changed(third, name=second.name), *rest)


def body_that_grows(drawn, positions):
    forearm, second, *rest = drawn
    ball = Ball((0.0, 0.0, 0.0), 0.01 + 1e-3 * abs(positions[0]))
    return (forearm, changed(second, shapes=(*second.shapes, ball)), *rest)


def endless_shape(drawn, positions):
    forearm, second, *rest = drawn
    ball = Ball((0.0, 0.0, math.inf), 0.01)
    return (forearm, changed(second, shapes=(*second.shapes, ball)), *rest)


def nothing_to_see(drawn, positions):
    forearm, second, *rest = drawn
    return (forearm, changed(second, shapes=()), *rest)


def body_left_behind(drawn, positions):
    forearm, second, *rest = drawn
    return (forearm, changed(second, pose=forearm.pose), *rest)


def pin_beside(drawn, positions):
    forearm, *rest = drawn
    first, *others = forearm.pins
    x, y, z = first.point
    return (changed(forearm, pins=(first._replace(point=(x + 1e-9, y, z)), *others)), *rest)


def pin_askew(drawn, positions):
    *rest, hand = drawn
    pins = tuple(
        pin._replace(axis=(pin.axis[1], pin.axis[2], pin.axis[0])) if pin.axis else pin
        for pin in hand.pins
    )
    return (*rest, changed(hand, pins=pins))


def pin_without_another(drawn, positions):
    forearm, *rest = drawn
    return (changed(forearm, pins=()), *rest)


def floating_pin(drawn, positions):
    forearm, *rest = drawn
    return (changed(forearm, shapes=(Ball((0.0, 0.0, -9.0), 0.1),)), *rest)


def far_too_long(drawn, positions):
    forearm, second, *rest = drawn
    rod = Rod((0.0, 0.0, 0.0), (0.0, 0.0, 2.0))
    return (forearm, changed(second, shapes=(*second.shapes, rod)), *rest)


def far_too_thick(drawn, positions):
    forearm, second, *rest = drawn
    plate = Plate(((0.0, 0.0, 0.0), (0.01, 0.0, 0.0), (0.0, 0.01, 0.0)), 2.0)
    return (forearm, changed(second, shapes=(*second.shapes, plate)), *rest)


def far_too_wide(drawn, positions):
    forearm, second, *rest = drawn
    arc = Arc((0.0, 0.0, 0.0), (2.0, 0.0, 0.0), (0.0, 0.0, 1.0), 3.0)
    return (forearm, changed(second, shapes=(*second.shapes, arc)), *rest)


def joints_that_turn_backwards(drawn, positions):
    return tuple(
        changed(
            body,
            pins=tuple(
                pin._replace(axis=tuple(-x for x in pin.axis)) if pin.axis else pin
                for pin in body.pins
            ),
        )
        for body in drawn
    )


FAULTS = (
    hand_drawn_elsewhere,
    hand_drawn_turned,
    moving_forearm,
    no_forearm,
    two_of_one_name,
    body_that_grows,
    endless_shape,
    nothing_to_see,
    body_left_behind,
    pin_beside,
    pin_askew,
    pin_without_another,
    floating_pin,
    far_too_long,
    far_too_thick,
    far_too_wide,
    joints_that_turn_backwards,
)
# A wrist that says nothing of itself is a forearm and a hand: there is little to get wrong.
DRAWN = tuple(name for name in WRISTS if wrist_class(name).bodies is not Wrist.bodies)
# The hands of platforms have balls alone, which have no axes.
PLATFORMS = ('stewart', 'rotary_stewart')
CASES = [(f, n) for f in FAULTS for n in DRAWN if f is not pin_askew or n not in PLATFORMS]


def seeded(fault, name):
    """Return a registered wrist that is drawn wrongly."""
    kind = wrist_class(name)

    def bodies(self, positions):
        return fault(kind.bodies(self, positions), positions)

    faulty = type(f'{kind.__name__}With_{fault.__name__}', (kind,), {'bodies': bodies})
    return dataclasses.dataclass(frozen=True)(faulty)()


def look_at(wrist):
    for law in SEEN:
        law(wrist, np.random.default_rng(1))


@pytest.mark.parametrize(('fault', 'name'), CASES, ids=[f'{f.__name__}-{n}' for f, n in CASES])
def test_every_fault_of_a_drawing_breaks_a_law(fault, name):
    wrist = seeded(fault, name)
    with pytest.raises(LawBrokenError):
        look_at(wrist)


@pytest.mark.parametrize('name', DRAWN)
def test_every_driven_joint_can_be_seen(name):
    wrist = wrist_class(name)()
    pins = {pin.name for body in wrist.bodies(wrist.home) for pin in body.pins}
    assert pins >= {joint.name for joint in wrist.joints}
