"""What every wrist makes of the same maneuvers under the same joint-rate limit. No ROS."""

from __future__ import annotations

import math
from collections.abc import Callable, Iterable, Sequence
from typing import NamedTuple

import numpy as np

from wrist_control.errors import WristError
from wrist_control.flight import Flight, fly
from wrist_control.operating.maneuvers import BARKER_SPEED, Maneuver, Segment, make_maneuver
from wrist_control.resolving import SINGULAR_MARGIN
from wrist_control.rotations import Vector, quaternion_of, rates_between, turned
from wrist_control.wrists import WRISTS, Wrist, make_wrist
from wrist_control.wrists.plugins import plugged_in

MANEUVERS = tuple(
    make_maneuver(name)
    for name in ('basic_test', 'extended_test', 'pitch_then_roll', 'roll_at_full_bend', 'stick')
)
# Steps per second: Barker's, and that of a resolver for the stick.
STEPS = {'stick': 100.0}
BARKER_STEPS = 32.0
# The same for every wrist, rad/s. A leg may move as fast, m/s, as it would 0.27 m from the centre
# of a turn at that rate: the radius of the only platform with legs, [Nguyen1991].
JOINT_SPEEDS = {'revolute': BARKER_SPEED, 'prismatic': 0.27 * BARKER_SPEED}
# A hand held up for longer than this does not finish, s; a stick ends by itself.
PATIENCE = 20.0


class Performance(NamedTuple):
    """What one wrist made of one maneuver.

    Attributes:
        wrist: Its name.
        maneuver: Its name.
        follows_roll: False for a wrist that points only: its hand rolls as the mechanism forces.
        time_lost: s.
        peak_rate: Fastest joint increment, as a share of the joint's limit.
        free_peak_rate: The same for a flight without the limit.
        path_error: Largest angle between the hand and its commanded path, rad: `path_error`.
        margin: The closest to lock.
        stopped_by: The first limit of the mechanism itself that was at work, or 'lock', or ''.
        stopped_at: When that was, s.
        completed: False when the wrist could not finish.
    """

    wrist: str
    maneuver: str
    follows_roll: bool
    time_lost: float
    peak_rate: float
    free_peak_rate: float
    path_error: float
    margin: float
    stopped_by: str
    stopped_at: float
    completed: bool


Pair = tuple[str, Maneuver]


def compare(
    wrists: Sequence[str] = tuple(WRISTS),
    maneuvers: Sequence[Maneuver] = MANEUVERS,
    tracked: Callable[[Sequence[Pair]], Iterable[Pair]] = iter,
) -> list[Performance]:
    """Return what every wrist makes of every maneuver.

    Args:
        wrists: Names of wrists, flown with their default dimensions.
        maneuvers: What they are asked to do; x is the hand's approach axis.
        tracked: Passes the flights on one by one, and may show how many are done.
    """
    pairs = [(wrist, maneuver) for maneuver in maneuvers for wrist in wrists]
    return [_performance(make_wrist(name), name, maneuver) for name, maneuver in tracked(pairs)]


def wrists_here(tell: Callable[[str], object]) -> list[str]:
    """Return the names of all wrists that can be made here, those of other packages too.

    Args:
        tell: Called with a sentence for each wrist of another package that cannot be made.
    """
    found = []
    for name in (*WRISTS, *plugged_in()):
        try:
            make_wrist(name)
        except WristError as error:
            tell(str(error))
        else:
            found.append(name)
    return found


def approach_axis(wrist: Wrist) -> int:
    """Return the hand axis (0, 1, 2 for x, y, z) that points away from the wrist.

    The probe lies along it.
    """
    return int(np.argmax(np.abs(wrist.probe)))


def about_approach(maneuver: Maneuver, axis: int) -> Maneuver:
    """Return a maneuver for a hand whose approach axis is not x: x, y, z in cyclic order."""
    segments = []
    for rates, duration in maneuver.segments:
        x, y, z = np.roll(rates, axis)
        segments.append(Segment((float(x), float(y), float(z)), duration))
    return Maneuver(maneuver.name, tuple(segments), maneuver.waits)


def path_error(flight: Flight) -> float:
    """Return the largest angle between the hand and its commanded path, rad.

    The path is the start carried on by F times the command, so time lost is no error. Where a
    rotation cannot be followed the one that was made is taken, and the angle is that between the
    pointing axes.
    """
    follows = tuple(axis in flight.wrist.followed_axes for axis in range(3))
    dt = flight.time[1] - flight.time[0]
    wanted = flight.scale_factor[:, None] * flight.command
    wanted = np.where(follows, wanted, flight.achieved[:, -3:])
    path = quaternion_of(flight.hand_rotation[0])
    largest = 0.0
    for rates, rotation in zip(wanted[:-1], flight.hand_rotation[1:], strict=True):
        path = turned(path, (float(rates[0]), float(rates[1]), float(rates[2])), dt)
        away = rates_between(path, quaternion_of(rotation), 1.0)
        largest = max(largest, _seen(away, follows))
    return largest


def _seen(away: Vector, follows: tuple[bool, ...]) -> float:
    """Return the part of a small turn that moves what the wrist is there to point."""
    return math.hypot(*(x for x, follow in zip(away, follows, strict=True) if follow))


def _performance(wrist: Wrist, name: str, maneuver: Maneuver) -> Performance:
    limits = [JOINT_SPEEDS[joint.kind] for joint in wrist.joints]
    maneuver = about_approach(maneuver, approach_axis(wrist))
    steps = STEPS.get(maneuver.name, BARKER_STEPS)
    patience = PATIENCE if maneuver.waits else math.inf
    flight = fly(wrist, maneuver, steps, limits, patience=patience)
    free = fly(wrist, maneuver, steps, patience=patience)
    stopped_by, stopped_at = first_stop(flight)
    return Performance(
        wrist=name,
        maneuver=maneuver.name,
        follows_roll=len(wrist.followed_axes) == 3,
        time_lost=float(flight.time_lost[-1]),
        peak_rate=float((np.abs(flight.joint_rates) / limits).max()),
        free_peak_rate=float((np.abs(free.joint_rates) / limits).max()),
        path_error=path_error(flight),
        margin=float(flight.margin.min()),
        stopped_by=stopped_by,
        stopped_at=stopped_at,
        completed=flight.completed,
    )


def first_stop(flight: Flight) -> tuple[str, float]:
    """Return the first limit that is not a joint's rate, or 'lock', and when it was, s."""
    joints = {joint.name for joint in flight.wrist.joints}
    for time, margin, names in zip(flight.time, flight.margin, flight.limited, strict=True):
        own = [name for name in names if name not in joints]
        if own or margin < SINGULAR_MARGIN:
            return own[0] if own else 'lock', float(time)
    return '', math.nan
