"""Everything between two steps: who is in charge, what is stale, what is wrong. No ROS, no clock.

The supervisor is told what arrives and when, and is asked once per period what to do. It knows
two clocks, as `commands` does: stamp time and receipt time.
"""

from __future__ import annotations

from collections.abc import Sequence
from contextlib import suppress

from wrist_control.errors import InvalidValueError, WristError
from wrist_control.resolving.commands import Command, freshness, hand_twist
from wrist_control.resolving.feedback import Feedback, checked_start, state_at
from wrist_control.resolving.homing import has_reached, step_towards
from wrist_control.resolving.latest_message import LatestMessage
from wrist_control.resolving.period import Ending, Mode, PeriodResult, SupervisorSettings
from wrist_control.resolving.report import WristState, sentence, state_of
from wrist_control.resolving.step import ZERO_TWIST, State, resting, start, step
from wrist_control.wrists.wrist import Wrist

# What clears a fault.
GO_ON = 'Call ~/enable to go on from where the joints are.'

__all__ = ['Mode', 'PeriodResult', 'Supervisor', 'SupervisorSettings']


class Supervisor:
    """Keeps one wrist's state between steps, and decides whose turn it is.

    Attributes:
        wrist: The mechanism, with the limits to keep; replaced when limits change.
        settings: What it was told once; replaced when a timeout changes.
        state: Where everything is.
        mode: Who is in charge.
    """

    def __init__(self, wrist: Wrist, settings: SupervisorSettings) -> None:
        """Wait for the joints, or start at the initial positions; at rest.

        Raises:
            InvalidValueError: The initial positions cannot be used.
        """
        self.wrist = wrist
        self.settings = settings
        self.state: State = start(wrist, settings.initial_positions)
        self.mode = Mode.WAITING if settings.require_joint_states else Mode.FOLLOWING
        self._commands: LatestMessage[Command] = LatestMessage()
        self._feedback = Feedback(wrist.joints)
        self._adopted = self._moving = False
        self._ending: Ending | None = None
        self._commanded = ZERO_TWIST
        self._reason = ''

    def take_command(self, command: Command) -> None:
        """Follow a command from the first step after its stamp; the newest counts."""
        self._commands.put(command.stamp, command)

    def take_measured(
        self, names: Sequence[str], positions: Sequence[float], receipt_time: float
    ) -> None:
        """Hear where the joints really are.

        Before the first motion the wrist starts from there, once, when they rest; after that they
        are watched. Where nobody may move them, the state follows them.

        Args:
            names: Joint names, in any order; other joints may be among them.
            positions: Their positions, rad or m.
            receipt_time: Now, s.

        Raises:
            RefusedError: Wrong names, lengths or numbers; nothing has changed.
            WristError: No start from there; nothing has changed.
        """
        measured = self._feedback.hear(names, positions, receipt_time)
        if self.mode in (Mode.FOLLOWING, Mode.HOMING):
            self._watch(receipt_time)
        else:
            self._show(measured)
        if self.mode in (Mode.WAITING, Mode.FOLLOWING) and not self._adopted:
            self._adopt_when_resting(measured, receipt_time)

    def enable(self, wanted: bool, *, receipt_time: float) -> str:
        """Allow or forbid motion; after a pause go on from where the joints really are.

        Args:
            wanted: True to allow it; False for a ramp to a stop.
            receipt_time: Now, s.

        Raises:
            WristError: The wrist cannot go on from there; nothing has changed.
        """
        if not wanted:
            self._end(
                Mode.DISABLED, f'Disabled: the hand stays where it is. {GO_ON}', receipt_time
            )
            return 'Disabled: the hand stays where it is.'
        if self.mode in (Mode.DISABLED, Mode.FAULT):
            self._take_over(receipt_time)
        elif self._ending:
            raise InvalidValueError('Cannot enable before the hand has stopped; call it again.')
        if self.mode is Mode.WAITING:
            return 'Enabled: commands are followed once the joints were heard.'
        return 'Enabled: following commands.'

    def _take_over(self, receipt_time: float) -> None:
        feedback = self._feedback
        if feedback.positions is None:
            self.mode = Mode.WAITING if self.settings.require_joint_states else Mode.FOLLOWING
        else:
            if feedback.age(receipt_time) > self.settings.feedback_timeout:
                raise InvalidValueError(
                    f'Cannot enable: {feedback.what_is_missing(receipt_time)}; start the joints '
                    'first.'
                )
            if not feedback.resting:
                raise InvalidValueError(
                    'Cannot enable: the joints do not rest; hold them still, and call it again.'
                )
            self.state = checked_start(self.wrist, feedback.positions, self.state)
            self._adopted, self.mode = True, Mode.FOLLOWING
        self._commands.clear()
        feedback.forget_lag()
        self._reason = ''

    def reset(self) -> str:
        """Go back to the initial positions at the rate limits.

        Raises:
            InvalidValueError: Nobody may move the joints now, or the limits have changed and the
                initial positions cannot be used any more.
        """
        if self._ending or self.mode not in (Mode.FOLLOWING, Mode.HOMING):
            mode = self._ending.mode if self._ending else self.mode
            raise InvalidValueError(f'Cannot reset: {mode.value} is in charge; enable first.')
        start(self.wrist, self.settings.initial_positions)
        self.mode = Mode.HOMING
        return 'On the way back to initial_positions; time lost starts again from zero there.'

    def tick(self, *, stamp_time: float, receipt_time: float) -> PeriodResult:
        """Return what this period brings.

        Args:
            stamp_time: Now, s.
            receipt_time: Now, s.
        """
        try:
            if self.mode in (Mode.FOLLOWING, Mode.HOMING):
                if self._moving and self._deaf(receipt_time):
                    self._end(Mode.FAULT, self._blind(receipt_time), receipt_time)
                result = self._moved(stamp_time, receipt_time)
                self._moving = any(result.step.joint_rates)
                return self._ended(result) if self._ending else result
        except WristError as error:
            return self._fail(str(error))
        except ArithmeticError as error:
            return self._fail(f'The step could not be computed ({error}); nothing moves.')
        return self._stand_still(receipt_time)

    def _moved(self, stamp_time: float, receipt_time: float) -> PeriodResult:
        if self.mode is Mode.FOLLOWING and not self._ending:
            return self._follow(self._commands.at(stamp_time), receipt_time)
        if self._deaf(receipt_time) and not self._moving:
            return self._hold(receipt_time)
        if self.mode is Mode.HOMING:
            return self._home(self._ramp(receipt_time))
        assert self._ending is not None
        share = self._ramp(receipt_time)
        return self._step([share * x for x in self._ending.twist])

    def _hold(self, receipt_time: float) -> PeriodResult:
        return self._step(ZERO_TWIST)._replace(
            wrist_state=WristState.WAITING, message=self._waiting(receipt_time)
        )

    def _follow(self, command: Command | None, receipt_time: float) -> PeriodResult:
        if command is None:
            return self._step(ZERO_TWIST)
        settings = self.settings
        age = receipt_time - command.receipt
        fresh = freshness(age, settings.command_timeout, settings.stop_time)
        if fresh and any(command.twist) and self._deaf(receipt_time) and not self._moving:
            return self._hold(receipt_time)
        result = self._step([fresh * x for x in hand_twist(command, self.state.pose.quaternion)])
        if fresh < 1.0 and any(command.twist):
            return result._replace(
                wrist_state=WristState.STALE,
                message='No fresh command: ramped to a stop; send commands again to go on.',
            )
        return result

    def _step(self, commanded: Sequence[float]) -> PeriodResult:
        vx, vy, vz, p, q, r = commanded
        self._commanded = twist = (vx, vy, vz, p, q, r)
        taken = step(self.wrist, self.state, twist, self.settings.dt)
        self._adopted = self._adopted or any(taken.joint_rates)
        self.state = taken.state
        message = sentence(self.wrist, taken, twist)
        return PeriodResult(state_of(taken, twist), taken, twist, message, True)

    def _home(self, share: float) -> PeriodResult:
        before, goal, dt = self.state, self.settings.initial_positions, self.settings.dt
        if share > 0.0:
            self.state = step_towards(self.wrist, before, goal, share * dt)
        self._adopted, self._commanded = True, ZERO_TWIST
        rates = tuple(
            (new - old) / dt
            for old, new in zip(before.positions, self.state.positions, strict=True)
        )
        taken = resting(self.wrist, self.state)._replace(joint_rates=rates)
        if has_reached(self.state, goal):
            self.state = state_at(self.wrist, tuple(goal), self.state)._replace(time_lost=0.0)
            self.mode = Mode.FOLLOWING
            self._commands.clear()
        message = 'Resetting: on the way back to initial_positions; commands do not count now.'
        return PeriodResult(WristState.TRACKING, taken, ZERO_TWIST, message, True)

    def _end(self, mode: Mode, message: str, receipt_time: float) -> None:
        """Ramp to a stop, if anything moves, and go to another mode then; a fault stays one."""
        if self.mode is Mode.FAULT or (self._ending and self._ending.mode is Mode.FAULT):
            return
        if self.mode in (Mode.FOLLOWING, Mode.HOMING) and self._moving:
            self._ending = Ending(mode, message, receipt_time, self._commanded)
        else:
            self._settle(mode, message)

    def _ramp(self, receipt_time: float) -> float:
        if not self._ending:
            return 1.0
        return freshness(receipt_time - self._ending.since, 0.0, self.settings.stop_time)

    def _ended(self, result: PeriodResult) -> PeriodResult:
        assert self._ending is not None
        mode, message, _, _ = self._ending
        if not self._moving:
            self._settle(mode, message)
        return result._replace(wrist_state=WristState[mode.name], message=message)

    def _settle(self, mode: Mode, message: str) -> None:
        self.mode, self._reason, self._ending, self._moving = mode, message, None, False

    def _fail(self, reason: str) -> PeriodResult:
        self._settle(Mode.FAULT, f'{reason} {GO_ON}')
        return self._stand_still(0.0)

    def _stand_still(self, receipt_time: float) -> PeriodResult:
        message = self._waiting(receipt_time) if self.mode is Mode.WAITING else self._reason
        still = resting(self.wrist, self.state)
        return PeriodResult(WristState[self.mode.name], still, ZERO_TWIST, message, False)

    def _waiting(self, receipt_time: float) -> str:
        """Return what is waited for, and how to go on."""
        missing = self._feedback.what_is_missing(receipt_time)
        if self._feedback.positions is None:
            return (
                f'Waiting: {missing}; start the joints, or set require_joint_states to false to '
                'go on without.'
            )
        if self._deaf(receipt_time):
            return f'Waiting: {missing}, and nothing moves without them; start the joints.'
        return self._reason or 'Waiting for the joints to rest.'

    def _blind(self, receipt_time: float) -> str:
        missing = self._feedback.what_is_missing(receipt_time)
        return f'Stopped, since {missing}: the hand would move unseen. {GO_ON}'

    def _deaf(self, receipt_time: float) -> bool:
        """Return whether the joints were heard too long ago to move by."""
        if not self.settings.require_joint_states:
            return False
        return self._feedback.age(receipt_time) > self.settings.feedback_timeout

    def _watch(self, receipt_time: float) -> None:
        found = self._feedback.joint_that_does_not_follow(
            self.state.positions, self.settings.tracking_tolerance, self.settings.tracking_time
        )
        if found:
            self._end(Mode.FAULT, f'{found} {GO_ON}', receipt_time)

    def _show(self, measured: Sequence[float]) -> None:
        with suppress(WristError):
            self.state = state_at(self.wrist, measured, self.state)

    def _adopt_when_resting(self, measured: Sequence[float], receipt_time: float) -> None:
        if not self._feedback.resting:
            self._reason = ''
            return
        try:
            self.state = checked_start(self.wrist, measured, self.state)
        except WristError as error:
            self._reason = f'Waiting: {error}'
            if self.mode is Mode.FOLLOWING:
                self._end(Mode.FAULT, f'{error} {GO_ON}', receipt_time)
            raise
        self._adopted, self.mode = True, Mode.FOLLOWING
        self._commands.clear()
