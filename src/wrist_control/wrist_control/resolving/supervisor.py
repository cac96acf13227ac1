"""Everything between two steps: who is in charge, what is stale, what is wrong. No ROS, no clock.

The supervisor is told what arrives and when, and is asked once per period what to do.
"""

from __future__ import annotations

import math
from collections.abc import Sequence
from enum import Enum
from typing import NamedTuple

from wrist_control.errors import InvalidValueError, RefusedError, WristError
from wrist_control.resolving.commands import Command, freshness, hand_twist
from wrist_control.resolving.homing import arrived, step_towards
from wrist_control.resolving.newest import Newest
from wrist_control.resolving.report import WristState, sentence, state_of
from wrist_control.resolving.step import STILL, State, Step, Twist, resting, start, step
from wrist_control.wrists.wrist import Positions, Wrist

# A joint may lag this far behind its command, rad and m, for this long, s.
LAG = {'revolute': 0.35, 'prismatic': 0.02}
LAG_TIME = 0.5


class Settings(NamedTuple):
    """What a supervisor is told once.

    Attributes:
        dt: Duration of a step, s.
        command_timeout: Age up to which a command is followed in full, s.
        stop_time: How long the ramp to a stop takes after that, s.
        initial_positions: Where to start, and where `reset` goes, rad or m.
    """

    dt: float
    command_timeout: float
    stop_time: float
    initial_positions: Positions


class Outcome(NamedTuple):
    """What one period brought.

    Attributes:
        wrist_state: For the operator's status.
        made: The step that was made.
        commanded: The twist that was followed, hand axes, (vx, vy, vz, p, q, r).
        message: What is happening and what to do, one sentence.
        moving_allowed: False while nothing may be sent to the joints.
    """

    wrist_state: WristState
    made: Step
    commanded: Twist
    message: str
    moving_allowed: bool


class Mode(Enum):
    """Who is in charge of the joints."""

    FOLLOWING = 'the operator'
    HOMING = 'the reset'
    DISABLED = 'nobody: disabled'
    FAULT = 'nobody: a fault'


class Supervisor:
    """Keeps one wrist's state between steps, and decides whose turn it is.

    Attributes:
        wrist: The mechanism, with the limits to keep; replaced when limits change.
        settings: What it was told once; replaced when a timeout changes.
        state: Where everything is.
        mode: Who is in charge.
    """

    def __init__(self, wrist: Wrist, settings: Settings) -> None:
        """Start at the initial positions, at rest.

        Raises:
            InvalidValueError: The initial positions cannot be used.
        """
        self.wrist = wrist
        self.settings = settings
        self.state: State = start(wrist, settings.initial_positions)
        self.mode = Mode.FOLLOWING
        self._commands: Newest[Command] = Newest()
        self._measured: Positions | None = None
        self._moved = False
        self._lagging_since: float | None = None
        self._fault = ''

    def take_command(self, command: Command) -> None:
        """Follow a command from the first step after its stamp; the newest counts."""
        self._commands.put(command.stamp, command)

    def take_measured(self, names: Sequence[str], positions: Sequence[float], now: float) -> None:
        """Hear where the joints really are; before the first motion, start from there.

        Raises:
            RefusedError: Wrong names, lengths or numbers; nothing has changed.
            UnreachableError: A start that the mechanism cannot take; nothing has changed, but
                where the joints are was never known it is a fault: to go on would be a jump.
        """
        measured = self._sorted(names, positions)
        if not self._moved and self.mode is Mode.FOLLOWING:
            try:
                self._adopt(measured)
            except WristError as error:
                if self._measured is None:
                    self._fail(str(error))
                raise
        self._measured = measured
        self._watch_lag(measured, now)

    def enable(self, wanted: bool) -> str:
        """Allow or forbid motion; after a pause go on from where the joints really are."""
        if not wanted:
            self.mode = Mode.DISABLED
            return 'Disabled: the joints stay where they are.'
        if self.mode in (Mode.DISABLED, Mode.FAULT):
            self._commands.forget()
            self._lagging_since = None
            self._moved = False
            try:
                if self._measured is not None:
                    self._adopt(self._measured)
            except WristError as error:
                return self._fail(str(error)).message
        self.mode = Mode.FOLLOWING
        return 'Enabled: following commands.'

    def reset(self) -> str:
        """Go back to the initial positions at the rate limits.

        Raises:
            InvalidValueError: Nobody may move the joints now, or the limits have changed and the
                initial positions cannot be used any more.
        """
        if self.mode in (Mode.DISABLED, Mode.FAULT):
            raise InvalidValueError(
                f'Cannot reset: {self.mode.value} is in charge; call ~/enable first.'
            )
        start(self.wrist, self.settings.initial_positions)
        self.mode = Mode.HOMING
        return 'On the way back to initial_positions; time lost starts again from zero there.'

    def tick(self, now: float, received: float) -> Outcome:
        """Return what this period brings.

        Args:
            now: The time on the clock of the stamps, s.
            received: The time on the clock that ages are judged by, s.
        """
        try:
            if self.mode is Mode.HOMING:
                return self._home()
            if self.mode is Mode.FOLLOWING:
                return self._follow(self._commands.at(now), received)
        except WristError as error:
            return self._fail(str(error))
        return self._stand_still()

    def _follow(self, command: Command | None, received: float) -> Outcome:
        commanded, fresh = self._commanded(command, received)
        asked = commanded[-self.wrist.twist_size :]
        made = step(self.wrist, self.state, asked, self.settings.dt)
        self._moved = self._moved or any(made.joint_rates)
        self.state = made.state
        if command is not None and fresh < 1.0 and any(command.twist):
            message = 'No fresh command: ramped to a stop; send commands again to go on.'
            return Outcome(WristState.STALE, made, commanded, message, True)
        message = sentence(self.wrist, made, asked)
        return Outcome(state_of(made, asked), made, commanded, message, True)

    def _commanded(self, command: Command | None, received: float) -> tuple[Twist, float]:
        if command is None:
            return STILL, 0.0
        age = received - command.received
        fresh = freshness(age, self.settings.command_timeout, self.settings.stop_time)
        vx, vy, vz, p, q, r = hand_twist(command, self.state.pose.quaternion)
        return (fresh * vx, fresh * vy, fresh * vz, fresh * p, fresh * q, fresh * r), fresh

    def _home(self) -> Outcome:
        before, aim, dt = self.state, self.settings.initial_positions, self.settings.dt
        self.state = step_towards(self.wrist, before, aim, dt)
        self._moved = True
        rates = tuple(
            (new - old) / dt
            for old, new in zip(before.positions, self.state.positions, strict=True)
        )
        made = resting(self.wrist, self.state)._replace(joint_rates=rates)
        if arrived(self.state, aim):
            self._adopt(aim)
            self.state = self.state._replace(time_lost=0.0)
            self.mode = Mode.FOLLOWING
            self._commands.forget()
        message = 'Resetting: on the way back to initial_positions; commands do not count now.'
        return Outcome(WristState.TRACKING, made, STILL, message, True)

    def _stand_still(self) -> Outcome:
        made = resting(self.wrist, self.state)
        if self.mode is Mode.FAULT:
            return Outcome(WristState.FAULT, made, STILL, self._fault, False)
        message = 'Disabled: call ~/enable to go on from where the joints are.'
        return Outcome(WristState.DISABLED, made, STILL, message, False)

    def _fail(self, reason: str) -> Outcome:
        self.mode = Mode.FAULT
        self._fault = f'{reason} Call ~/enable to go on from where the joints are.'
        return self._stand_still()

    def _adopt(self, measured: Positions) -> None:
        positions = self.wrist.assembled(measured, self.state.pose)
        pose = self.wrist.forward(positions)
        self.state = State(positions, pose, time_lost=self.state.time_lost)

    def _sorted(self, names: Sequence[str], positions: Sequence[float]) -> Positions:
        expected = [joint.name for joint in self.wrist.joints]
        if len(names) != len(positions):
            raise RefusedError(
                'wrong length',
                f'Refused joint states with {len(names)} names and {len(positions)} positions; '
                'send one position for each name.',
            )
        found = dict(zip(names, positions, strict=True))
        missing = [name for name in expected if name not in found]
        if missing or len(found) != len(names):
            raise RefusedError(
                'wrong joint names',
                f'Refused joint states of {", ".join(names) or "no joint"}; this wrist needs '
                f'{", ".join(expected)}, each once.',
            )
        measured = tuple(found[name] for name in expected)
        if not all(math.isfinite(x) for x in measured):
            raise RefusedError(
                'not finite', f'Refused joint states that are not finite: {measured}.'
            )
        return measured

    def _watch_lag(self, measured: Positions, now: float) -> None:
        lags = [
            (abs(told - seen) - LAG[joint.kind], joint.name, told, seen)
            for joint, told, seen in zip(
                self.wrist.joints, self.state.positions, measured, strict=True
            )
        ]
        excess, name, told, seen = max(lags)
        if excess <= 0.0 or self.mode not in (Mode.FOLLOWING, Mode.HOMING):
            self._lagging_since = None
        elif self._lagging_since is None:
            self._lagging_since = now
        elif now - self._lagging_since > LAG_TIME:
            self._fail(f'{name} is at {seen:.3f} but was told {told:.3f}: it does not follow.')
