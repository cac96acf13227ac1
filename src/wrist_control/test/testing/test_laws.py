"""Every registered wrist keeps every law, and every fault breaks one."""

import dataclasses
import math

import numpy as np
import pytest

from wrist_control import WRISTS, make_wrist
from wrist_control.testing import LAWS, LawBrokenError, check_wrist
from wrist_control.wrists import wrist_class
from wrist_control.wrists.wrist import Configuration


@pytest.mark.parametrize('law', LAWS)
@pytest.mark.parametrize('name', WRISTS)
def test_every_wrist_keeps_every_law(name, law):
    LAWS[law](make_wrist(name), np.random.default_rng(1))


# Faults that a new wrist may have, each seeded into every registered wrist that can have it.


def no_clearance(kind):
    return {'clearances': lambda self, positions: ()}


def constant_margin(kind):
    return {'margin': lambda self, positions: 0.7}


def margin_cubed(kind):
    return {'margin': lambda self, positions: kind.margin(self, positions) ** 3}


def margin_that_jumps_to_zero(kind):
    def margin(self, positions):
        true = kind.margin(self, positions)
        return true if true > 0.1 else 0.0

    return {'margin': margin}


def margin_of_another_place(kind):
    def margin(self, positions):
        beside = tuple(position + 0.02 for position in positions)
        return kind.margin(self, self.resolve_assembly(beside, self.forward(positions)))

    return {'margin': margin}


def one_branch_only(kind):
    home = tuple(kind().home)
    return {'inverse': lambda self, pose, near: kind.inverse(self, pose, home)}


def turns_not_nearest(kind):
    def inverse(self, pose, near):
        found = kind.inverse(self, pose, near)
        unwound = tuple(math.remainder(x, math.tau) for x in found)
        if isinstance(found, Configuration):
            return dataclasses.replace(found, positions=unwound)
        return unwound

    return {'inverse': inverse}


def wrong_lost_axis(kind):
    def lost_axis(self, positions):
        x, y, z = kind.lost_axis(self, positions)
        return (z, x, y)

    return {'lost_axis': lost_axis}


def half_the_rates(kind):
    def rates(self, positions, twist):
        return tuple(0.5 * rate for rate in kind.rates(self, positions, twist))

    return {'rates': rates}


def one_sign_in_the_jacobian(kind):
    def jacobian(self, positions):
        found = kind.jacobian(self, positions)
        found[:, 1] *= -1.0
        return found

    return {'jacobian': jacobian}


def hand_that_creeps(kind):
    def target_pose(self, pose, twist, dt):
        return kind.target_pose(self, pose, [x + 0.01 for x in twist], dt)

    return {'target_pose': target_pose}


def fourth_gimbal_by_sin_phi_alone(kind):
    """[Barker1986], eq. (1), as printed: beyond |θ| = 90° it drives φ to where it jumps."""

    def _alpha_rate(self, positions):
        law, share = kind._alpha_rate(self, positions)
        return (law if math.cos(positions[1]) > 0.0 else -law), share

    return {'_alpha_rate': _alpha_rate}


EVERYONE = tuple(WRISTS)
# Beyond these edges the mechanism itself ends; a cone is drawn where it need not be.
WITH_AN_EDGE = ('carpal', 'five_bar', 'stewart', 'rotary_stewart')
# A leg has no turns, and lengths with a little more to each may fit several poses.
WITH_TURNS = tuple(name for name in WRISTS if name != 'stewart')
FAULTS = {
    no_clearance: WITH_AN_EDGE,
    constant_margin: EVERYONE,
    margin_cubed: EVERYONE,
    margin_that_jumps_to_zero: EVERYONE,
    margin_of_another_place: WITH_TURNS,
    one_branch_only: WITH_TURNS,
    turns_not_nearest: WITH_TURNS,
    wrong_lost_axis: EVERYONE,
    half_the_rates: EVERYONE,
    one_sign_in_the_jacobian: EVERYONE,
    hand_that_creeps: EVERYONE,
    fourth_gimbal_by_sin_phi_alone: ('four_gimbal',),
}
CASES = [(fault, name) for fault, names in FAULTS.items() for name in names]


def seeded(fault, name):
    """Return a registered wrist with one answer wrong."""
    kind = wrist_class(name)
    faulty = type(f'{kind.__name__}With_{fault.__name__}', (kind,), fault(kind))
    return dataclasses.dataclass(frozen=True)(faulty)()


@pytest.mark.parametrize(('fault', 'name'), CASES, ids=[f'{f.__name__}-{n}' for f, n in CASES])
def test_every_fault_breaks_a_law(fault, name):
    with pytest.raises(LawBrokenError, match=f'{fault.__name__} breaks '):
        check_wrist(seeded(fault, name))


@pytest.mark.parametrize(
    ('name', 'told'),
    [
        ('three_gimbal', (0, 1)),
        ('pitch_yaw', (0, 1, 2)),
        ('pitch_yaw', (0, 2)),
        ('carpal', (0, 2)),
        ('pitch_yaw', (0,)),
    ],
)
def test_followed_axes_that_are_too_few_too_many_or_others_break_their_law(name, told):
    law = LAWS['the_joints_can_turn_the_hand_about_its_followed_axes_and_no_other']
    wrist = make_wrist(name)
    law(wrist, np.random.default_rng(1))
    object.__setattr__(wrist, 'followed_axes', told)
    with pytest.raises(LawBrokenError, match='followed_axes are '):
        law(wrist, np.random.default_rng(1))
