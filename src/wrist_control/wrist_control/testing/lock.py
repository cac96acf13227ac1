"""Laws of lock: where it is, how `margin` tells its distance, and which rotation is lost there."""

from __future__ import annotations

import math
from collections.abc import Callable, Iterator
from contextlib import suppress
from itertools import pairwise
from typing import NamedTuple

import numpy as np

from wrist_control.errors import UnreachableError
from wrist_control.rotations import Pose
from wrist_control.testing.broken import require
from wrist_control.testing.places import (
    Conditioning,
    Line,
    Random,
    is_outside,
    random_positions,
    random_twist,
    rate_map,
    regular_places,
)
from wrist_control.wrists.wrist import Positions, Wrist

LINES = 12
SAMPLES = 100
# Half the length of a line: rad along joints; s along a twist of 1 rad/s and 0.1 m/s.
REACH = 2.0
# A least conditioning below this, found by golden section, is a lock.
LOCKED = 1e-6
GOLDEN = 0.5 * (math.sqrt(5.0) - 1.0)
# Distances from a lock, in lengths of the line: `margin` shrinks from each to the next.
DISTANCES = (2e-3, 1e-3, 3e-4, 1e-4, 3e-5)
# `margin` grows like this power of the way that the joints are from lock: by its square a wrist
# would count as locked thirty times further away than it is.
LEAST_POWER, LARGEST_POWER = 0.8, 1.25


class Lock(NamedTuple):
    """A place where a wrist locks.

    Attributes:
        line: Joint positions along a way through it.
        at: Where on the line it is.
    """

    line: Line
    at: float


def locks(wrist: Wrist, random: Random) -> list[Lock]:
    """Return locks that lines through the joints' ranges, or through the poses, run into."""
    return _minima(wrist, random, Conditioning(wrist))


def _minima(wrist: Wrist, random: Random, measure: Callable[[Positions], float]) -> list[Lock]:
    """Return where a measure of the joint positions comes to 0 along random lines."""
    found = []
    for number in range(LINES):
        line = _line(wrist, random, number)

        def along(t: float, line: Line = line) -> float:
            try:
                return measure(line(t))
            except UnreachableError:
                return math.inf

        times = np.linspace(-REACH, REACH, SAMPLES)
        values = [along(t) for t in times.tolist()]
        for i in range(1, SAMPLES - 1):
            if values[i] <= min(values[i - 1], values[i + 1]) and math.isfinite(values[i]):
                at = _golden(along, float(times[i - 1]), float(times[i + 1]))
                if along(at) < LOCKED:
                    found.append(Lock(line, at))
    return found


def _line(wrist: Wrist, random: Random, number: int) -> Line:
    if wrist.twist_size == 6:
        return _along_twist(wrist, random_twist(wrist, random))
    # Every other line starts at home: not all mechanisms can be assembled everywhere.
    begin = wrist.home if number % 2 else random_positions(wrist, random)
    toward = random.normal(size=len(begin))
    toward /= np.linalg.norm(toward)
    return lambda t: tuple((np.array(list(begin)) + t * toward).tolist())


def _along_twist(wrist: Wrist, twist: tuple[float, ...]) -> Line:
    home: Pose = wrist.forward(wrist.home)
    return lambda t: wrist.inverse(wrist.target_pose(home, twist, t), wrist.home)


def _golden(value: Callable[[float], float], low: float, high: float) -> float:
    """Return where a function is least between two places, by golden section."""
    one, other = high - GOLDEN * (high - low), low + GOLDEN * (high - low)
    at_one, at_other = value(one), value(other)
    for _ in range(70):
        if at_one < at_other:
            high, other, at_other = other, one, at_one
            one = high - GOLDEN * (high - low)
            at_one = value(one)
        else:
            low, one, at_one = one, other, at_other
            other = low + GOLDEN * (high - low)
            at_other = value(other)
    return one if at_one < at_other else other


def margin_is_zero_at_lock(wrist: Wrist, random: Random) -> None:
    """Where the wrist locks, `margin` is 0."""
    for lock in locks(wrist, random):
        margin = wrist.margin(lock.line(lock.at))
        where = tuple(lock.line(lock.at))
        require(margin < 1e-4, f'it locks at {where}, where margin is {margin:.2g}')


def margin_is_zero_at_lock_only(wrist: Wrist, random: Random) -> None:
    """Where `margin` is 0, the wrist locks."""
    conditioning = Conditioning(wrist)
    for zero in _minima(wrist, random, wrist.margin):
        found = conditioning(zero.line(zero.at))
        where = tuple(zero.line(zero.at))
        require(
            found < 1e-3, f'margin is 0 at {where}, where the wrist does not lock ({found:.2g})'
        )


def margin_tells_the_distance_to_lock(wrist: Wrist, random: Random) -> None:
    """Near lock `margin` grows with the least singular value, in proportion to the distance."""
    conditioning = Conditioning(wrist)
    for line, at in locks(wrist, random):
        for side in (1.0, -1.0):
            try:
                places = [line(at + side * distance) for distance in DISTANCES]
                margins = [wrist.margin(place) for place in places]
                values = [conditioning(place) for place in places]
            except UnreachableError:
                continue
            if any(less >= more for more, less in pairwise(values)):
                continue  # the line runs along the lock, or past two of them
            where = tuple(line(at))
            falls = all(less < more for more, less in pairwise(margins))
            require(falls, f'towards the lock at {where} margin does not fall: {margins}')
            # Of the two nearest only: further out, another lock may be the nearer one.
            far, near = (math.dist(places[i], line(at)) for i in (2, -1))
            power = math.log(margins[2] / margins[-1]) / math.log(far / near)
            require(
                LEAST_POWER < power < LARGEST_POWER,
                f'near the lock at {where} margin goes like the power {power:.2g} of the way',
            )


def margin_is_at_most_about_one(wrist: Wrist, random: Random) -> None:
    """`margin` is above 0 away from lock, and never above 1."""
    for positions in regular_places(wrist, random, 40):
        margin = wrist.margin(positions)
        require(0.0 < margin <= 1.0 + 1e-9, f'margin at {tuple(positions)} is {margin}')


def _places_beside_locks(wrist: Wrist, random: Random) -> Iterator[Positions]:
    """Yield joint positions so near to locks that what is lost there is plain."""
    for line, at in locks(wrist, random):
        with suppress(UnreachableError):
            yield line(at + 1e-4)


def lost_axis_is_the_rotation_that_is_lost(wrist: Wrist, random: Random) -> None:
    """`lost_axis` is a unit vector; near lock it is the rotation that needs the fastest joints.

    Or, where a lock lets the hand go, the rotation that moves no joint.
    """
    components = list(wrist.followed_components)
    for positions in _places_beside_locks(wrist, random):
        _, gains, directions = np.linalg.svd(rate_map(wrist, positions)[:, components])
        hardest = np.zeros(wrist.twist_size)
        hardest[components] = directions[-1 if _lets_go(gains) else 0]
        rotation = hardest[-3:] / np.linalg.norm(hardest[-3:])
        lost = np.array(wrist.lost_axis(positions))
        where = tuple(positions)
        require(abs(np.linalg.norm(lost) - 1.0) < 1e-9, f'lost_axis at {where} is {lost.tolist()}')
        away = float(np.linalg.norm(np.cross(lost, rotation)))
        require(
            away < 0.05,
            f'near lock at {where} lost_axis is {lost.tolist()}, but {rotation.tolist()} is lost',
        )


def _lets_go(gains: np.ndarray) -> bool:
    """Return whether the least joint rates per twist come to 0 sooner than the largest grow."""
    return bool(gains[-1] * gains[0] < 1.0)


def a_lock_that_lets_the_hand_go_is_outside_the_workspace(wrist: Wrist, random: Random) -> None:
    """Where the hand can move though no joint does, a clearance is used up."""
    conditioning = Conditioning(wrist)
    for positions in _places_beside_locks(wrist, random):
        if _lets_go(conditioning.gains(positions)):
            sentence = f'the hand is loose at {tuple(positions)}, inside every clearance'
            require(is_outside(wrist, positions), sentence)


LOCK = (
    margin_is_zero_at_lock,
    margin_is_zero_at_lock_only,
    margin_tells_the_distance_to_lock,
    margin_is_at_most_about_one,
    lost_axis_is_the_rotation_that_is_lost,
    a_lock_that_lets_the_hand_go_is_outside_the_workspace,
)
