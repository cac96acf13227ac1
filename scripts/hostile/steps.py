"""Hostile steps of every wrist: what `step` makes of any command, anywhere, in any limits."""

from __future__ import annotations

import math
from collections.abc import Sequence
from typing import NamedTuple

import numpy as np

from hostile.numbers import along, extreme, not_finite, ordinary
from hostile.places import places, with_hostile_limits
from hostile.rules import are_finite, broken_clearances, broken_limits, speeds_up, stopping_steps
from hostile.verdict import Verdict
from wrist_control.errors import InvalidValueError
from wrist_control.resolving.state import State, Step
from wrist_control.resolving.step import start, step
from wrist_control.testing.places import Random
from wrist_control.wrists import Wrist, make_wrist
from wrist_control.wrists.wrist import Positions

FLIGHT = 60  # steps
LONGEST_COMMAND = 20  # steps
MOST_STOPPING = 100  # steps
REFUSED = 'steps: not finite'


class Kind(NamedTuple):
    """One kind of flight.

    Attributes:
        attack: Its name in the table.
        locks: Whether flights start beside locks, and run along what is lost there.
        limits: Whether joints start on their position limits.
        extreme: Whether commands are of any size.
        eased: Whether joints take time to change their rates; None for half of the flights.
    """

    attack: str
    locks: bool = False
    limits: bool = False
    extreme: bool = False
    eased: bool | None = None


KINDS = (
    Kind('steps: free joints', eased=False),
    Kind('steps: eased joints', eased=True),
    Kind('steps: locks', locks=True),
    Kind('steps: position limits', limits=True),
    Kind('steps: any size', extreme=True),
    Kind('steps: all at once', locks=True, limits=True, extreme=True),
)


class Flight:
    """One start, one set of limits, many commands; every step is judged."""

    def __init__(self, wrist: Wrist, positions: Positions, dt: float, verdict: Verdict) -> None:
        """Start at rest.

        Args:
            wrist: The mechanism with its limits.
            positions: Where it starts, rad or m.
            dt: Duration of the steps, s.
            verdict: Told of every finding.

        Raises:
            InvalidValueError: There is no start from there.
        """
        self.wrist, self._dt, self._verdict = wrist, dt, verdict
        self.state: State = start(wrist, positions)
        self._start = self.state.positions
        self._clearances = wrist.clearances(self._start)

    def fly(self, twist: Sequence[float]) -> Step:
        """Make a step and judge it."""
        before = self.state
        taken = step(self.wrist, before, twist, self._dt)
        self.judge(before, taken, twist)
        self._verdict.count += 1
        self.state = taken.state
        return taken

    def judge(self, before: State, taken: Step, twist: Sequence[float]) -> None:
        """Count everything that is wrong with a step."""
        after, rates, old = taken.state, taken.joint_rates, self._rates(before)
        numbers = (*after.positions, *after.pose.position, *after.pose.quaternion, *rates)
        if not are_finite((*numbers, *taken.achieved, taken.margin, after.time_lost)):
            self._find('nonfinite', f'{taken}', before, twist)
            return
        limits = [
            *broken_limits(self.wrist.joints, self._start, after.positions, old, rates, self._dt),
            *broken_clearances(self._clearances, self.wrist.clearances(after.positions)),
        ]
        for sentence in limits:
            self._find('limits', sentence, before, twist)
        if not 0.0 <= taken.scale_factor <= 1.0:
            self._find('limits', f'F is {taken.scale_factor!r}', before, twist)
        if not any(twist) and speeds_up(old, rates, self._dt):
            self._find('uncommanded', f'it goes from {old} to {rates}', before, twist)

    def refuse(self, twist: Sequence[float]) -> None:
        """See that a command that is not finite is refused."""
        self._verdict.count += 1
        try:
            step(self.wrist, self.state, twist, self._dt)
        except InvalidValueError:
            return
        self._find('nonfinite', 'it is not refused', self.state, twist)

    def stop(self) -> None:
        """See that the hand comes to rest and stays there."""
        zero = [0.0] * self.wrist.twist_size
        steps = stopping_steps(self.wrist.joints, self._rates(self.state), self._dt)
        for _ in range(min(MOST_STOPPING, math.ceil(steps) + 1)):
            taken = self.fly(zero)
        if steps < MOST_STOPPING - 1 and any(taken.joint_rates):
            self._find('uncommanded', f'not at rest after {steps} steps', self.state, zero)

    def _rates(self, state: State) -> Sequence[float]:
        return state.joint_rates or (0.0,) * len(self.wrist.joints)

    def _find(self, kind: str, sentence: str, before: State, twist: Sequence[float]) -> None:
        """Tell of a finding with all that makes it again."""
        self._verdict.find(
            kind,
            f'{type(self.wrist).__name__}, dt {self._dt!r}, command {list(twist)}, from '
            f'{tuple(before.positions)} at {tuple(before.joint_rates)}: {sentence}; '
            f'{self.wrist.joints}',
        )


def attack(name: str, kind: Kind, steps: int, seed: Sequence[int]) -> list[Verdict]:
    """Fly one wrist in one way, and return what was found.

    Args:
        name: One of the registered wrists.
        kind: The kind of flights.
        steps: How many.
        seed: The campaign's first, then the part's own.
    """
    wrist, random = make_wrist(name), np.random.default_rng(seed)
    verdict, refused = Verdict(kind.attack), Verdict(REFUSED)
    regular, locked = places(name, seed[0])
    pool = [*(locked if kind.locks else regular)]
    while verdict.count < steps:
        positions = pool[random.integers(len(pool))]
        eased = bool(random.random() < 0.5) if kind.eased is None else kind.eased
        limited = with_hostile_limits(wrist, positions, random, at_limits=kind.limits, eased=eased)
        dt = float(10.0 ** random.uniform(-4.0, 0.0))
        try:
            flight = Flight(limited, positions, dt, verdict)
        except InvalidValueError:
            verdict.count += 1  # a refused start is an answer, too
            continue
        try:
            _fly(flight, kind, random, refused)
            pool.append(flight.state.positions)
        except Exception as error:
            verdict.count += 1
            verdict.find(
                'dead',
                f'{name}, dt {dt!r}, at {tuple(flight.state.positions)}, rates '
                f'{flight.state.joint_rates}: {type(error).__name__}: {error}; {limited.joints}',
            )
    return [verdict, refused]


def _fly(flight: Flight, kind: Kind, random: Random, refused: Verdict) -> None:
    wrist = flight.wrist
    left = FLIGHT
    while left > 0:
        twist = extreme(wrist, random) if kind.extreme else ordinary(wrist, random)
        if kind.locks and random.random() < 0.4:
            twist = along(wrist.lost_axis(flight.state.positions), wrist, random)
        length = int(random.integers(1, LONGEST_COMMAND))
        left -= length
        for _ in range(length):
            flight.fly(twist)
            if random.random() < 0.03:
                _refuse(flight, random, refused)
    flight.stop()


def _refuse(flight: Flight, random: Random, refused: Verdict) -> None:
    before, verdict = flight.state, flight._verdict
    flight._verdict = refused
    flight.refuse(not_finite(flight.wrist, random))
    if flight.state != before:
        refused.find('uncommanded', f'a refused command moves {before}')
    flight._verdict = verdict
