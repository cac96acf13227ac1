"""Laws of what a person sees: bodies that are rigid, joined, and move as the joints do."""

from __future__ import annotations

import math

import numpy as np

from wrist_control.rotations import Vector
from wrist_control.testing.broken import require, require_close
from wrist_control.testing.places import Random, regular_places
from wrist_control.wrists.body import Arc, Ball, Body, Pin, Plate, Rod, Shape
from wrist_control.wrists.wrist import Positions, Wrist

PLACES = 20
# Of a mechanism a metre across, m: round-off alone.
TOLERANCE = 1e-12


def the_forearm_rests_and_the_hand_is_where_forward_says(wrist: Wrist, random: Random) -> None:
    """`bodies` begins with the forearm, which does not move, and ends with the hand."""
    for positions in regular_places(wrist, random, PLACES):
        forearm, *_, hand = wrist.bodies(positions)
        at = f'at {tuple(positions)}'
        names = [forearm.name, hand.name]
        require(names == ['forearm', 'hand'], f'the first and the last body are {names} {at}')
        for body, rotation, position in (
            (forearm, np.eye(3), (0.0, 0.0, 0.0)),
            (hand, wrist.forward(positions).rotation, wrist.forward(positions).position),
        ):
            require_close(body.pose.rotation, rotation, TOLERANCE, f'the {body.name} drawn {at}')
            require_close(body.pose.position, position, TOLERANCE, f'the {body.name} drawn {at}')


def bodies_are_rigid(wrist: Wrist, random: Random) -> None:
    """Names, shapes and pins are the same wherever the joints are; all of them are finite."""
    home = wrist.bodies(wrist.home)
    names = [body.name for body in home]
    require(len(set(names)) == len(names), f'two bodies have the same name: {names}')
    for body in home:
        require(body.shapes, f'{body.name} looks like nothing')
        numbers = _numbers((body.shapes, body.pins))
        require(all(map(math.isfinite, numbers)), f'{body.name} is not finite: {body}')
    for positions in regular_places(wrist, random, PLACES):
        for before, now in zip(home, wrist.bodies(positions), strict=True):
            same = before._replace(pose=now.pose) == now
            require(same, f'{before.name} is another body at {tuple(positions)}: {before}, {now}')


def _numbers(value: object) -> list[float]:
    if isinstance(value, tuple):
        return [number for part in value for number in _numbers(part)]
    return [value] if isinstance(value, float) else []


def pins_that_belong_together_coincide(wrist: Wrist, random: Random) -> None:
    """Two bodies that share a pin have it at the same place, along the same axis."""
    for positions in regular_places(wrist, random, PLACES):
        for name, ends in _pairs(wrist, positions).items():
            what = f'pin {name} at {tuple(positions)}'
            require(len(ends) == 2, f'{what} belongs to {len(ends)} bodies, not to two')
            (one, first), (other, second) = ends
            apart = np.subtract(other.pose.point(second.point), one.pose.point(first.point))
            axis, same = _axis(one, first), _axis(other, second)
            require_close(same, axis, TOLERANCE, f'the axis of {what}')
            if first.slides:
                apart -= axis * (apart @ axis)
            require_close(apart, np.zeros(3), TOLERANCE, f'the distance of {what}')


def pins_named_like_joints_move_by_their_positions(wrist: Wrist, random: Random) -> None:
    """Between a driven pin's bodies lies the joint's position: an angle, or a distance."""
    names = [joint.name for joint in wrist.joints]
    home = _pairs(wrist, wrist.home)
    for positions in regular_places(wrist, random, PLACES):
        pairs = _pairs(wrist, positions)
        for name, position, start in zip(names, positions, wrist.home, strict=True):
            if name in pairs:
                moved = _moved(pairs[name], home[name])
                apart = math.remainder(moved - (position - start), math.tau)
                what = f'what joint {name} moved since home, at {tuple(positions)}'
                require_close(apart, 0.0, 1e-9, what)


def pins_lie_on_what_is_drawn(wrist: Wrist, random: Random) -> None:
    """No body is held by a pin that floats beside it."""
    for body in wrist.bodies(wrist.home):
        for pin in body.pins:
            gap = min(_gap(shape, pin.point) for shape in body.shapes)
            require(gap <= 1e-9, f'pin {pin.name} floats {gap:.2g} m beside {body.name}')


def nothing_is_drawn_out_of_proportion(wrist: Wrist, random: Random) -> None:
    """Nothing reaches more than twice as far from the forearm's origin as pins and probe do."""
    bodies = wrist.bodies(wrist.home)
    pins = [body.pose.point(pin.point) for body in bodies for pin in body.pins]
    size = max(math.hypot(*point) for point in (*pins, bodies[-1].pose.point(wrist.probe)))
    for body in bodies:
        for shape in body.shapes:
            points, thickness = _ends(shape)
            reach = thickness + max(math.hypot(*body.pose.point(point)) for point in points)
            require(reach <= 2.0 * size, f'{shape} of {body.name} reaches {reach:.2g} m far')


def _ends(shape: Shape) -> tuple[list[Vector], float]:
    """Return points that tell how far a shape reaches, body axes, and how thick it is there, m."""
    if isinstance(shape, Ball):
        return [shape.centre], shape.radius
    if isinstance(shape, Plate):
        return list(shape.corners), shape.thickness
    if isinstance(shape, Rod):
        return [shape.begin, shape.end], shape.radius
    return [shape.centre], math.hypot(*shape.begin) + shape.radius


def _pairs(wrist: Wrist, positions: Positions) -> dict[str, list[tuple[Body, Pin]]]:
    found: dict[str, list[tuple[Body, Pin]]] = {}
    for body in wrist.bodies(positions):
        for pin in body.pins:
            found.setdefault(pin.name, []).append((body, pin))
    return found


def _axis(body: Body, pin: Pin) -> np.ndarray:
    """Return a pin's axis in forearm axes, 0 for a ball joint."""
    axis: np.ndarray = body.pose.rotation.T @ np.array(pin.axis or (0.0, 0.0, 0.0))
    return axis


def _moved(ends: list[tuple[Body, Pin]], before: list[tuple[Body, Pin]]) -> float:
    """Return how far the second body of a pair turned or slid from the first, rad or m."""
    (one, first), (other, second) = ends
    (one_before, _), (other_before, _) = before
    if first.slides:
        now, then = (
            np.subtract(b.pose.point(second.point), a.pose.point(first.point)) @ _axis(a, first)
            for a, b in ((one, other), (one_before, other_before))
        )
        return float(now - then)
    now, then = (
        a.pose.rotation @ b.pose.rotation.T for a, b in ((one, other), (one_before, other_before))
    )
    turn = now @ then.T  # in axes of the first body
    sine = 0.5 * np.array(
        [turn[2, 1] - turn[1, 2], turn[0, 2] - turn[2, 0], turn[1, 0] - turn[0, 1]]
    )
    return math.atan2(float(sine @ np.array(first.axis)), 0.5 * (float(np.trace(turn)) - 1.0))


def _gap(shape: Shape, point: Vector) -> float:
    """Return how far a point lies outside a shape, m."""
    if isinstance(shape, Ball):
        return math.dist(shape.centre, point) - shape.radius
    if isinstance(shape, Plate):
        return min(math.dist(corner, point) for corner in shape.corners) - shape.thickness
    if isinstance(shape, Rod):
        begin, along = np.array(shape.begin), np.subtract(shape.end, shape.begin)
        share = float((np.array(point) - begin) @ along / (along @ along))
        return math.dist(begin + min(max(share, 0.0), 1.0) * along, point) - shape.radius
    return _gap_to_arc(shape, np.subtract(point, shape.centre)) - shape.radius


def _gap_to_arc(arc: Arc, point: np.ndarray) -> float:
    begin, axis = np.array(arc.begin), np.array(arc.axis)
    radius, side = float(np.linalg.norm(begin)), np.cross(axis, begin)
    angle = math.atan2(float(point @ side), float(point @ begin)) % math.tau
    if angle > arc.angle:  # nearer to an end
        angle = arc.angle if angle - arc.angle < math.tau - angle else 0.0
    nearest = math.cos(angle) * begin + math.sin(angle) * side
    require(abs(float(axis @ begin)) <= TOLERANCE * radius, f'{arc} does not begin square to it')
    return float(np.linalg.norm(point - nearest))


SEEN = (
    the_forearm_rests_and_the_hand_is_where_forward_says,
    bodies_are_rigid,
    pins_that_belong_together_coincide,
    pins_named_like_joints_move_by_their_positions,
    pins_lie_on_what_is_drawn,
    nothing_is_drawn_out_of_proportion,
)
