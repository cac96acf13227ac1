"""Hostile periods of a supervisor: everything that a node may be told, at random, any time."""

from __future__ import annotations

import math
from collections.abc import Sequence
from contextlib import suppress

import numpy as np

from hostile.joints import HostileJoints
from hostile.numbers import extreme, hostile_number, not_finite, ordinary
from hostile.places import places, with_hostile_limits
from hostile.rules import are_finite, broken_clearances, broken_limits, stopping_steps
from hostile.verdict import Verdict
from wrist_control.errors import InvalidValueError, WristError
from wrist_control.resolving.commands import CommandPolicy, ReceivedTwist
from wrist_control.resolving.feedback import EDGE_SAG, SAG
from wrist_control.resolving.period import Mode, PeriodResult, SupervisorSettings
from wrist_control.resolving.ramp import PAUSE
from wrist_control.resolving.supervisor import Supervisor
from wrist_control.testing.places import Random
from wrist_control.wrists import Joint, Wrist, make_wrist
from wrist_control.wrists.wrist import Positions

ATTACK = 'supervisor'
PERIODS = 300
FRAMES = ('', '', '', 'hand', 'forearm', 'base_link', 'x' * 10_000)
MODES = (Mode.FOLLOWING, Mode.DISABLED, Mode.FAULT)
# Rounding of times, in periods: a stop that takes 10.2 of them may take 13.
MORE_STEPS = 3.0


class Supervised:
    """A supervisor among hostile people, clocks and joints; every period is judged."""

    def __init__(
        self, wrist: Wrist, positions: Positions, random: Random, verdict: Verdict
    ) -> None:
        """Start somewhere.

        Args:
            wrist: The mechanism with its limits.
            positions: Where it starts, rad or m.
            random: Chooses what happens.
            verdict: Told of every finding.

        Raises:
            InvalidValueError: There is no start from there.
        """
        self.wrist, self._random, self._verdict = wrist, random, verdict
        self._dt = float(10.0 ** random.uniform(-3.0, -1.0))
        settings = SupervisorSettings(
            dt=self._dt,
            command_timeout=float(random.uniform(2.0, 30.0)) * self._dt,
            stop_time=float(random.uniform(0.01, 20.0)) * self._dt,
            initial_positions=positions,
            tracking_tolerance=(float(10.0 ** random.uniform(-3.0, 0.0)),) * len(wrist.joints),
            tracking_time=float(random.uniform(0.0, 20.0)) * self._dt,
            require_joint_states=bool(random.random() < 0.7),
            feedback_timeout=float(random.uniform(2.0, 30.0)) * self._dt,
        )
        self.supervisor = Supervisor(wrist, settings)
        self._policy = CommandPolicy(settings.command_timeout)
        self._joints = HostileJoints(wrist.joints, positions, random)
        self._start = [*positions]
        self._stop_time = settings.stop_time
        # A ramp is counted in periods, whatever the clocks do.
        full = [joint.rate_limit for joint in wrist.joints]
        ramp = settings.stop_time / self._dt
        self._stopping = ramp + stopping_steps(wrist.joints, full, self._dt) + MORE_STEPS
        self._now, self._skew, self._withheld = 0.0, 1e3, ''
        self._rates: Sequence[float] = (0.0,) * len(wrist.joints)
        # Until when a command counts, and until when motion is allowed, s; whether a stop must be
        # undone first; and how many periods of stopping are left.
        self._commanded_until, self._allowed_until = -math.inf, math.inf
        self._stopped, self._periods_left = False, -1.0

    def period(self) -> None:
        """Let a few things happen, and judge what comes of them."""
        pause = 1.0
        if self._random.random() < 0.03:
            pause = float(self._random.uniform(1.0, 40.0))
        self._now += pause * self._dt
        self._hear()
        for _ in range(int(self._random.integers(0, 3))):
            self._happen()
        stamp = self._now + self._skew
        homing = self.supervisor.mode is Mode.HOMING
        result = self.supervisor.tick(
            stamp_time=stamp,
            receipt_time=self._now,
            withheld=self._withheld,
            pause=pause * self._dt,
        )
        self._verdict.count += 1
        self._judge(result, pause, homing)
        if result.moving_allowed:
            self._joints.told(tuple(result.step.state.positions))

    def _hear(self) -> None:
        for names, positions in self._joints.messages():
            with suppress(WristError):
                self.supervisor.take_measured(names, positions, self._now)

    def _happen(self) -> None:
        kind = self._random.random()
        if kind < 0.6:
            self._command()
        elif kind < 0.66:
            self._stop(str(self._random.choice(['enable', 'stop', 'fault'])))
        elif kind < 0.8:
            with suppress(WristError):
                self.supervisor.enable(True, receipt_time=self._now)
                self._stopped = False
        elif kind < 0.83:
            with suppress(WristError):
                self.supervisor.reset()
                self._stopped = False
        elif kind < 0.86:
            self._withheld = '' if self._withheld else 'Held: nobody presses the switch.'
            self._allowed_until = self._now + self._stop_time if self._withheld else math.inf
        elif kind < 0.88:
            self._skew += float(self._random.choice([-500.0, -0.1, 0.1, 500.0]))
        elif kind < 0.9:
            self._joints.pushed(float(10.0 ** self._random.uniform(-5.0, 0.0)))

    def _command(self) -> None:
        random, wrist = self._random, self.wrist
        make = (ordinary, ordinary, ordinary, extreme, not_finite)[int(random.integers(5))]
        twist = [0.0] * 6
        twist[-wrist.twist_size :] = make(wrist, random)
        if random.random() < 0.05:
            twist[int(random.integers(6))] = hostile_number(random)
        stamp = self._now + self._skew
        age = float(random.choice([0.0, 0.0, 0.0, -0.04, -1e3, 1.0, 1e9])) * self._dt
        received = ReceivedTwist(
            tuple(twist),
            str(random.choice(FRAMES)),
            None if random.random() < 0.2 else stamp - age,
        )
        with suppress(WristError):
            command = self._policy.accept(received, stamp_time=stamp, receipt_time=self._now)
            self.supervisor.take_command(command)
            if any(twist) and not self._stopped:
                wanted = self.supervisor.settings.command_timeout + self._stop_time
                self._commanded_until = self._now + wanted

    def _stop(self, way: str) -> None:
        if way == 'enable':
            self.supervisor.enable(False, receipt_time=self._now)
        else:
            then = MODES[1] if way == 'stop' else MODES[int(self._random.integers(3))]
            self.supervisor.stop('Stopped by the campaign.', then)
            if then is Mode.FOLLOWING:
                return
        self._stopped, self._commanded_until = True, -math.inf

    def _judge(self, result: PeriodResult, pause: float, homing: bool) -> None:
        taken, mode = result.step, self.supervisor.mode
        after, rates = taken.state, taken.joint_rates
        numbers = (*after.positions, *after.pose.position, *after.pose.quaternion, *rates)
        if not are_finite((*numbers, *taken.achieved, *result.commanded, after.time_lost)):
            self._find('nonfinite', f'{result}')
            return
        old = self._rates
        if pause * self._dt > self._dt + PAUSE:  # the joints were where they were told long before
            old = [rate / pause for rate in old]
        commanded = self._now <= min(self._commanded_until, self._allowed_until)
        if homing or commanded:
            self._periods_left = self._stopping
        else:
            self._periods_left -= 1.0
        if result.moving_allowed:
            for sentence in self._broken(after.positions, old, rates):
                self._find('limits', f'{sentence}, {mode}, {result.message}')
        elif any(rates):
            self._find('uncommanded', f'nothing may move in {mode}, but {rates}')
        elif stopping_steps(self.wrist.joints, old, self._dt) > 1.0 + 1e-6:
            self._find('limits', f'silence from {tuple(old)}, {mode}: {result.message}')
        if any(rates) and self._periods_left < 0.0:
            self._find('uncommanded', f'{rates} in {mode}: {result.message}')
        self._rates = rates

    def _broken(
        self, positions: Positions, old: Sequence[float], rates: Sequence[float]
    ) -> list[str]:
        joints = [_sagging(joint) for joint in self.wrist.joints]
        found = [*broken_limits(joints, self._start, positions, old, rates, self._dt)]
        clearances = self.wrist.clearances(positions)
        sagging = [one._replace(remaining=-EDGE_SAG) for one in clearances]
        return [*found, *broken_clearances(sagging, clearances)]

    def _find(self, kind: str, sentence: str) -> None:
        self._verdict.find(
            kind, f'{type(self.wrist).__name__}, dt {self._dt!r}, at {self._now!r} s: {sentence}'
        )


def _sagging(joint: Joint) -> Joint:
    """Return a joint with the limits of a servo that rests outside its own."""
    sag = SAG[joint.kind]
    return joint._replace(lower=joint.lower - sag, upper=joint.upper + sag)


def attack(name: str, periods: int, seed: Sequence[int]) -> list[Verdict]:
    """Attack the supervisor of one wrist.

    Args:
        name: One of the registered wrists.
        periods: How many periods.
        seed: The campaign's first, then the part's own.
    """
    wrist, random = make_wrist(name), np.random.default_rng(seed)
    verdict = Verdict(ATTACK)
    regular, locked = places(name, seed[0])
    pool = [*regular, *locked]
    while verdict.count < periods:
        positions = pool[random.integers(len(pool))]
        limited = with_hostile_limits(
            wrist,
            positions,
            random,
            at_limits=bool(random.random() < 0.5),
            eased=bool(random.random() < 0.7),
        )
        try:
            supervised = Supervised(limited, positions, random, verdict)
        except InvalidValueError:
            verdict.count += 1  # a refused start is an answer, too
            continue
        try:
            for _ in range(PERIODS):
                supervised.period()
        except Exception as error:
            verdict.count += 1
            state = supervised.supervisor.state
            verdict.find('dead', f'{name} at {state}: {type(error).__name__}: {error}')
    return [verdict]
