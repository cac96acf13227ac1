"""How well the hand follows over physics: servos, payload and delay, one at a time.

`python -m wrist_control.studies.following [seconds]` prints two tables; docs/results/physics.md
says what they mean.
"""

from __future__ import annotations

import math
import sys
from collections.abc import Mapping
from typing import NamedTuple

import numpy as np
from rich.box import SIMPLE_HEAD
from rich.console import Console
from rich.progress import track
from rich.table import Table

from wrist_control.errors import UnstableError
from wrist_control.flight import Flight, fly
from wrist_control.operating.maneuvers import BARKER_SPEED, stick
from wrist_control.physics.driven import DrivenMechanism, Drives
from wrist_control.physics.mechanism import Settings
from wrist_control.physics.models import MODELS, build
from wrist_control.rotations import quaternion_of, rates_between
from wrist_control.wrists import Wrist, make_wrist

# What is flown: the stick with its first seed, steps/s.
RATE, SECONDS = 100.0, 20.0
# As a resolver has them where nobody says otherwise: rad/s and m/s; s to there, and to a stop.
LIMITS = {'revolute': BARKER_SPEED, 'prismatic': 0.05}
SPEEDING_UP, SLOWING_DOWN = 0.25, 0.1
# How long the mechanism sags before the flight, s.
SETTLING = 1.0


class Case(NamedTuple):
    """One way in which a wrist is driven, all else being as in the first case.

    Attributes:
        bandwidth: Of the servos, rad/s.
        payload: At the end of the probe, kg.
        delay: Until a command reaches the servos, s.
        by_rates: Told joint rates rather than positions.
    """

    bandwidth: float = 100.0
    payload: float = 0.5
    delay: float = 0.0
    by_rates: bool = False


CASES = {
    'as is': Case(),
    '30 rad/s': Case(bandwidth=30.0),
    '300 rad/s': Case(bandwidth=300.0),
    'no load': Case(payload=0.0),
    '2 kg': Case(payload=2.0),
    '10 ms': Case(delay=0.01),
    '50 ms': Case(delay=0.05),
    'rates': Case(by_rates=True),
}


class Errors(NamedTuple):
    """How far the hand is at most from where the joints were told to hold it.

    Attributes:
        turn: rad.
        place: m.
    """

    turn: float
    place: float


def flown(wrist: Wrist, seconds: float = SECONDS) -> Flight:
    """Return the flight of the stick that the joints are told, s long."""
    limit = LIMITS[wrist.joints[0].kind]
    return fly(
        wrist,
        stick(BARKER_SPEED, duration=seconds),
        RATE,
        joint_rate_limits=limit,
        joint_acceleration_limits=limit / SPEEDING_UP,
        joint_deceleration_limits=limit / SLOWING_DOWN,
        patience=math.inf,
    )


def follow(flight: Flight, case: Case) -> Errors:
    """Let a wrist's mechanism follow a flight.

    What a period is told is compared with the end of that period, when a servo without any lag
    would be there.

    Raises:
        UnstableError: The physics has no answer.
    """
    wrist, count = flight.wrist, len(flight.wrist.joints)
    settings = Settings(
        bandwidth=case.bandwidth, payload=case.payload, gravity=(0.0, 0.0, -9.80665)
    )
    drives = Drives(1.0 / RATE, case.delay, [math.inf] * count, [0.0] * count, case.by_rates)
    positions = flight.joint_positions
    mechanism = DrivenMechanism(build(wrist, settings), wrist.joints, drives, positions[0])
    told = flight.joint_rates if case.by_rates else positions[1:]
    for _ in range(round(SETTLING * RATE)):
        mechanism.advance(np.zeros(count) if case.by_rates else positions[0])
    errors = []
    for row, command in enumerate(told[: len(positions) - 1], start=1):
        pose = mechanism.advance(command).hand_pose
        told_to = quaternion_of(flight.hand_rotation[row])
        turn = math.hypot(*rates_between(told_to, pose.quaternion, 1.0))
        errors.append((turn, math.dist(pose.position, flight.hand_position[row])))
    return Errors(*np.max(errors, axis=0).tolist())


def study(seconds: float = SECONDS) -> dict[str, dict[str, Errors | None]]:
    """Return the errors of every wrist by case; None where the physics diverges."""
    found: dict[str, dict[str, Errors | None]] = {}
    for name in track(MODELS, 'flying', transient=True):
        flight = flown(make_wrist(name), seconds)
        found[name] = {}
        for case, given in CASES.items():
            try:
                found[name][case] = follow(flight, given)
            except UnstableError:
                found[name][case] = None
    return found


def table(found: Mapping[str, Mapping[str, Errors | None]], what: str) -> Table:
    """Return one of the two errors as a table that a terminal of 80 columns has room for.

    Args:
        found: What `study` returns.
        what: `turn`, shown in mrad, or `place`, in mm.
    """
    unit, digits = {'turn': ('mrad', 1), 'place': ('mm', 2)}[what]
    shown = Table(
        title=f'Largest error of the hand, {unit}',
        box=SIMPLE_HEAD,
        show_edge=False,
        pad_edge=False,
    )
    shown.add_column('wrist', no_wrap=True)
    for case in CASES:
        shown.add_column(case, justify='right')
    for name, errors in found.items():
        values = [None if one is None else getattr(one, what) for one in errors.values()]
        if what == 'turn' or max(value or 0.0 for value in values) > 1e-9:
            shown.add_row(name, *(_cell(value, digits) for value in values))
    return shown


def _cell(value: float | None, digits: int) -> str:
    return '—' if value is None else f'{1e3 * value:.{digits}f}'


def main(seconds: float = SECONDS) -> None:
    """Print both tables."""
    found, console = study(seconds), Console()
    for what in ('turn', 'place'):
        console.print(table(found, what))


if __name__ == '__main__':
    main(*(float(given) for given in sys.argv[1:]))
