"""Everything between two steps: who is in charge, what is stale, what is wrong. No ROS, no clock.

The supervisor is told what arrives and when, and is asked once per period what to do. It knows
two clocks, as `commands` does: stamp time and receipt time.
"""

from __future__ import annotations

import math
from collections.abc import Sequence
from enum import Enum
from typing import NamedTuple

from wrist_control.errors import InvalidValueError, RefusedError, WristError
from wrist_control.resolving.commands import Command, freshness, hand_twist
from wrist_control.resolving.homing import has_reached, step_towards
from wrist_control.resolving.joint_order import in_joint_order
from wrist_control.resolving.latest_message import LatestMessage
from wrist_control.resolving.permission import Permission
from wrist_control.resolving.report import WristState, sentence, state_of
from wrist_control.resolving.step import ZERO_TWIST, State, Step, Twist, resting, start, step
from wrist_control.wrists.wrist import Positions, Wrist

# A joint may lag this far behind its command, rad and m, for this long, s.
LAG = {'revolute': 0.35, 'prismatic': 0.02}
LAG_TIME = 0.5
DISABLED = 'Disabled: call ~/enable to go on from where the joints are.'
STOPPING = 'Stopping: somebody sent a message on stop.'
STOPPED = (
    'Disabled: somebody sent a message on stop; call ~/enable to go on from where the joints are.'
)


class SupervisorSettings(NamedTuple):
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


class PeriodResult(NamedTuple):
    """What one period brought.

    Attributes:
        wrist_state: For the operator's status.
        step: The step that was made.
        commanded: The twist that was followed, hand axes, (vx, vy, vz, p, q, r).
        message: What is happening and what to do, one sentence.
        moving_allowed: False while nothing may be sent to the joints.
    """

    wrist_state: WristState
    step: Step
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

    def __init__(self, wrist: Wrist, settings: SupervisorSettings) -> None:
        """Start at the initial positions, at rest.

        Raises:
            InvalidValueError: The initial positions cannot be used.
        """
        self.wrist = wrist
        self.settings = settings
        self.state: State = start(wrist, settings.initial_positions)
        self.mode = Mode.FOLLOWING
        self._commands: LatestMessage[Command] = LatestMessage()
        self._measured: tuple[float, ...] | None = None
        self._moved = False
        self._lagging_since: float | None = None
        self._fault = ''
        self._permission = Permission()
        self._stopping = False
        self._disabled = DISABLED

    def take_command(self, command: Command) -> None:
        """Follow a command from the first step after its stamp; the newest counts."""
        self._commands.put(command.stamp, command)

    def take_measured(
        self, names: Sequence[str], positions: Sequence[float], receipt_time: float
    ) -> None:
        """Hear where the joints really are; before the first motion, start from there.

        Args:
            names: Joint names, in any order; other joints may be among them.
            positions: Their positions, rad or m.
            receipt_time: Now, s.

        Raises:
            RefusedError: Wrong names, lengths or numbers; nothing has changed.
            UnreachableError: A start that the mechanism cannot take; nothing has changed, but
                where the joints are was never known it is a fault: to go on would be a jump.
        """
        measured = in_joint_order([joint.name for joint in self.wrist.joints], names, positions)
        if not all(math.isfinite(x) for x in measured):
            raise RefusedError(
                'not finite', f'Refused joint states that are not finite: {measured}.'
            )
        if not self._moved and self.mode is Mode.FOLLOWING:
            try:
                self._adopt(measured)
            except WristError as error:
                if self._measured is None:
                    self._fail(str(error))
                raise
        self._measured = measured
        self._watch_lag(measured, receipt_time)

    def enable(self, wanted: bool) -> str:
        """Allow or forbid motion; after a pause go on from where the joints really are.

        Raises:
            WristError: The wrist cannot go on from there; it is in FAULT. Or it is still stopping.
        """
        if not wanted:
            self.mode, self._disabled = Mode.DISABLED, DISABLED
            return 'Disabled: the joints stay where they are.'
        if self._stopping:
            raise InvalidValueError(f'{STOPPING} Call ~/enable again when it stands still.')
        if self.mode in (Mode.DISABLED, Mode.FAULT):
            self._commands.clear()
            self._lagging_since = None
            self._moved = False
            try:
                if self._measured is not None:
                    self._adopt(self._measured)
            except WristError as error:
                self._fail(str(error))
                raise
        self.mode = Mode.FOLLOWING
        return 'Enabled: following commands.'

    def stop(self) -> None:
        """Ramp to a stop and disable: whoever is in charge, and until somebody enables again."""
        self._stopping = True

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

    def tick(self, *, stamp_time: float, receipt_time: float, withheld: str = '') -> PeriodResult:
        """Return what this period brings.

        Args:
            stamp_time: Now, s.
            receipt_time: Now, s.
            withheld: Why the hand may not move now, one sentence; empty when it may.
        """
        withheld = STOPPING if self._stopping else withheld
        allowed = self._permission.share(bool(withheld), receipt_time, self.settings.stop_time)
        self._finish_stop(allowed)
        try:
            if self.mode is Mode.HOMING:
                result = self._home(allowed)
            elif self.mode is Mode.FOLLOWING:
                result = self._follow(self._commands.at(stamp_time), receipt_time, allowed)
            else:
                return self._stand_still()
            if withheld:
                result = result._replace(wrist_state=WristState.STALE, message=withheld)
            return result
        except WristError as error:
            return self._fail(str(error))
        except ArithmeticError as error:
            return self._fail(f'The step could not be computed ({error}); nothing moves.')

    def _finish_stop(self, allowed: float) -> None:
        moving = self.mode in (Mode.FOLLOWING, Mode.HOMING)
        if self._stopping and moving and allowed == 0.0:
            self.mode, self._disabled = Mode.DISABLED, STOPPED
        self._stopping = self._stopping and self.mode in (Mode.FOLLOWING, Mode.HOMING)

    def _follow(
        self, command: Command | None, receipt_time: float, allowed: float
    ) -> PeriodResult:
        commanded, fresh = self._commanded(command, receipt_time, allowed)
        taken = step(self.wrist, self.state, commanded, self.settings.dt)
        self._moved = self._moved or any(taken.joint_rates)
        self.state = taken.state
        if command is not None and fresh < 1.0 and any(command.twist):
            message = 'No fresh command: ramped to a stop; send commands again to go on.'
            return PeriodResult(WristState.STALE, taken, commanded, message, True)
        message = sentence(self.wrist, taken, commanded)
        return PeriodResult(state_of(taken, commanded), taken, commanded, message, True)

    def _commanded(
        self, command: Command | None, receipt_time: float, allowed: float
    ) -> tuple[Twist, float]:
        if command is None:
            return ZERO_TWIST, 0.0
        age = receipt_time - command.receipt
        fresh = freshness(age, self.settings.command_timeout, self.settings.stop_time)
        vx, vy, vz, p, q, r = hand_twist(command, self.state.pose.quaternion)
        share = min(fresh, allowed)
        return (share * vx, share * vy, share * vz, share * p, share * q, share * r), fresh

    def _home(self, allowed: float) -> PeriodResult:
        before, goal, dt = self.state, self.settings.initial_positions, self.settings.dt
        if allowed > 0.0:
            self.state = step_towards(self.wrist, before, goal, allowed * dt)
        self._moved = True
        rates = tuple(
            (new - old) / dt
            for old, new in zip(before.positions, self.state.positions, strict=True)
        )
        taken = resting(self.wrist, self.state)._replace(joint_rates=rates)
        if has_reached(self.state, goal):
            self._adopt(goal)
            self.state = self.state._replace(time_lost=0.0)
            self.mode = Mode.FOLLOWING
            self._commands.clear()
        message = 'Resetting: on the way back to initial_positions; commands do not count now.'
        return PeriodResult(WristState.TRACKING, taken, ZERO_TWIST, message, True)

    def _stand_still(self) -> PeriodResult:
        resting_step = resting(self.wrist, self.state)
        if self.mode is Mode.FAULT:
            return PeriodResult(WristState.FAULT, resting_step, ZERO_TWIST, self._fault, False)
        return PeriodResult(WristState.DISABLED, resting_step, ZERO_TWIST, self._disabled, False)

    def _fail(self, reason: str) -> PeriodResult:
        self.mode = Mode.FAULT
        self._fault = f'{reason} Call ~/enable to go on from where the joints are.'
        return self._stand_still()

    def _adopt(self, measured: Sequence[float]) -> None:
        positions = self.wrist.resolve_assembly(measured, self.state.pose)
        pose = self.wrist.forward(positions)
        self.state = State(positions, pose, time_lost=self.state.time_lost)

    def _watch_lag(self, measured: Sequence[float], receipt_time: float) -> None:
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
            self._lagging_since = receipt_time
        elif receipt_time - self._lagging_since > LAG_TIME:
            self._fail(f'{name} is at {seen:.3f} but was told {told:.3f}: it does not follow.')
