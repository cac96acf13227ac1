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
from wrist_control.resolving.homing import check_way_home, has_reached, speed_of, step_home
from wrist_control.resolving.latest_message import LatestMessage
from wrist_control.resolving.period import Mode, PeriodResult, SupervisorSettings
from wrist_control.resolving.permission import Permission
from wrist_control.resolving.ramp import Ramp, after_a_pause, scaled
from wrist_control.resolving.report import RESETTING, SILENT, WristState, sentence, state_of
from wrist_control.resolving.state import ZERO_TWIST, State, Twist, resting
from wrist_control.resolving.step import start, step
from wrist_control.wrists.wrist import Wrist

DISABLED = 'Disabled: the hand stays where it is.'
GO_ON = 'Call ~/enable to go on from where the joints are.'


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
        self._ramp: Ramp | None = None
        # What was followed when the hand was last free to move, and the share of it since then.
        self._followed: Twist = ZERO_TWIST
        self._home_speed, self._share = 0.0, 1.0
        self._reason = ''
        self._permission = Permission()

    def take_command(self, command: Command) -> None:
        """Follow a command from the first step after its stamp; the newest counts."""
        self._commands.put(command.stamp, command)

    @property
    def stopping(self) -> bool:
        """Whether a stop is on its way."""
        return bool(self._ramp)

    def stop(self, message: str, then: Mode) -> None:
        """Take the command away: ramp to a stop over `stop_time`, counted in steps.

        Args:
            message: What happens, one sentence; of a fault, its reason.
            then: Who is in charge once the joints are at rest: FOLLOWING waits for new commands,
                and a fault stays one.
        """
        if self.mode not in (Mode.FOLLOWING, Mode.HOMING):
            if then is Mode.FAULT or (then is Mode.DISABLED and self.mode is Mode.WAITING):
                self._settle(then, message)
        elif self._ramp is None:
            self._commands.clear()
            if self._moving or self.mode is Mode.HOMING:
                self._ramp = Ramp(self._share, then, message)
            else:
                self._settle(then, message)
        elif self._ramp.then is not Mode.FAULT and then is not Mode.FOLLOWING:
            self._ramp = self._ramp._replace(then=then, message=message)

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
            tolerance, longest = self.settings.tracking_tolerance, self.settings.tracking_time
            told = self.state.positions
            if found := self._feedback.joint_that_does_not_follow(told, tolerance, longest):
                self.stop(found, Mode.FAULT)
        else:
            with suppress(WristError):
                self.state = state_at(self.wrist, measured, self.state)
        if self.mode in (Mode.WAITING, Mode.FOLLOWING) and not self._adopted:
            self._adopt_when_resting(measured)

    def enable(self, wanted: bool, *, receipt_time: float) -> str:
        """Allow or forbid motion; after a pause go on from where the joints really are.

        Args:
            wanted: True to allow it; False for a ramp to a stop.
            receipt_time: Now, s.

        Raises:
            WristError: The wrist cannot go on from there; nothing has changed.
        """
        if not wanted:
            self.stop(DISABLED, Mode.DISABLED)
            return DISABLED
        if self.mode in (Mode.DISABLED, Mode.FAULT):
            self._take_over(receipt_time)
        elif self._ramp:
            raise InvalidValueError('Cannot enable: coming to a stop; call ~/enable again then.')
        if self.mode is Mode.WAITING:
            return 'Enabled: commands are followed once the joints were heard.'
        return 'Enabled: following commands.'

    def _take_over(self, receipt_time: float) -> None:
        feedback = self._feedback
        if feedback.positions is None:
            self.mode = Mode.WAITING if self.settings.require_joint_states else Mode.FOLLOWING
        else:
            feedback.check_ready(receipt_time, self.settings.feedback_timeout)
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
        if self._ramp:
            raise InvalidValueError('Cannot reset: coming to a stop; call ~/reset again then.')
        if self.mode not in (Mode.FOLLOWING, Mode.HOMING):
            raise InvalidValueError(
                f'Cannot reset: {self.mode.value} is in charge; call ~/enable first.'
            )
        goal = start(self.wrist, self.settings.initial_positions).positions
        check_way_home(self.wrist, self.state, goal)
        self.mode, self._home_speed = Mode.HOMING, 0.0
        return 'On the way back to initial_positions; time lost starts again from zero there.'

    def tick(
        self, *, stamp_time: float, receipt_time: float, withheld: str = '', pause: float = 0.0
    ) -> PeriodResult:
        """Return what this period brings.

        Args:
            stamp_time: Now, s.
            receipt_time: Now, s.
            withheld: Why the hand may not move now, one sentence; empty when it may.
            pause: Time since the period before, s, where it is more than a step's.
        """
        self.state, self._ramp = after_a_pause(self.state, self._ramp, self.settings, pause)
        allowed = self._permission.share(bool(withheld), receipt_time, self.settings.stop_time)
        try:
            if self.mode in (Mode.FOLLOWING, Mode.HOMING):
                if self._moving and self._deaf(receipt_time):
                    self.stop(self._feedback.blind_sentence(receipt_time), Mode.FAULT)
                result = self._moved(stamp_time, receipt_time, allowed)
                self._moving = any(result.step.joint_rates)
                return self._ramped(result) if self._ramp else result.withheld(withheld)
        except WristError as error:
            return self.give_up(str(error))
        except ArithmeticError as error:
            return self.give_up(f'The step could not be computed ({error}); nothing moves.')
        return self._stand_still(receipt_time)

    def _moved(self, stamp_time: float, receipt_time: float, allowed: float) -> PeriodResult:
        if self._ramp:
            self._ramp = self._ramp.after(self.settings.dt, self.settings.stop_time)
            if self.mode is Mode.HOMING:
                return self._home(self._ramp.share)
            return self._step(scaled(self._ramp.share, self._followed))
        if self.mode is Mode.FOLLOWING:
            return self._follow(self._commands.at(stamp_time), receipt_time, allowed)
        if self._deaf(receipt_time) and not self._moving:
            return self._hold(receipt_time)
        return self._home(allowed)

    def _hold(self, receipt_time: float) -> PeriodResult:
        message = self._feedback.waiting_sentence(receipt_time, self.settings.feedback_timeout)
        self._followed = ZERO_TWIST
        return self._step(ZERO_TWIST)._replace(wrist_state=WristState.WAITING, message=message)

    def _follow(
        self, command: Command | None, receipt_time: float, allowed: float
    ) -> PeriodResult:
        if command is None:
            return self._step(ZERO_TWIST)
        settings = self.settings
        age = receipt_time - command.receipt
        fresh = freshness(age, settings.command_timeout, settings.stop_time)
        if fresh and any(command.twist) and self._deaf(receipt_time) and not self._moving:
            return self._hold(receipt_time)
        self._share = min(fresh, allowed)
        if self._share < 1.0:
            result = self._step(scaled(self._share, self._followed))
        else:
            result = self._step(hand_twist(command, self.state.pose.quaternion))
            self._followed = scaled(result.step.scale_factor, result.commanded)
        if fresh < 1.0 and any(command.twist):
            return result.withheld(SILENT)
        return result

    def _step(self, commanded: Sequence[float]) -> PeriodResult:
        vx, vy, vz, p, q, r = commanded
        twist = (vx, vy, vz, p, q, r)
        taken = step(self.wrist, self.state, twist, self.settings.dt)
        self._adopted = self._adopted or any(taken.joint_rates)
        self.state = taken.state
        message = sentence(self.wrist, taken, twist)
        return PeriodResult(state_of(taken, twist), taken, twist, message, True)

    def _home(self, share: float) -> PeriodResult:
        goal = self.settings.initial_positions
        speed = share * self._home_speed if share < 1.0 else 1.0
        before = self.state
        taken = step_home(self.wrist, before, goal, self.settings.dt, speed)
        self.state = taken.state
        self._adopted, self._share = True, share
        if share == 1.0:
            self._home_speed, self._followed = speed_of(self.wrist, taken), ZERO_TWIST
        if has_reached(self.state, goal):
            there = state_at(self.wrist, tuple(goal), self.state)
            self.state = there._replace(time_lost=0.0, joint_rates=taken.state.joint_rates)
            self.mode = Mode.FOLLOWING
            self._commands.clear()
        elif self.state == before and share == 1.0:
            self.stop('The reset cannot go on: there is an edge in the way.', Mode.FAULT)
        return PeriodResult(WristState.TRACKING, taken, ZERO_TWIST, RESETTING, True)

    def _ramped(self, result: PeriodResult) -> PeriodResult:
        assert self._ramp is not None
        share, then, message = self._ramp
        if share == 0.0 and not any(result.step.joint_rates):  # a zero is sent with this step
            self._settle(then, message)
        state = WristState.STALE if then is Mode.FOLLOWING else WristState[then.name]
        return result._replace(wrist_state=state, message=message)

    def _settle(self, mode: Mode, message: str) -> None:
        self.mode, self._ramp, self._moving = mode, None, False
        self.state, self._followed = self.state._replace(joint_rates=()), ZERO_TWIST
        self._reason = f'{message} {GO_ON}'
        self._commands.clear()

    def give_up(self, reason: str) -> PeriodResult:
        """Be in FAULT at once, where not even a ramp can be computed."""
        self._settle(Mode.FAULT, reason)
        return self._stand_still(0.0)

    def _stand_still(self, receipt_time: float) -> PeriodResult:
        message, longest = self._reason, self.settings.feedback_timeout
        if self.mode is Mode.WAITING:
            message = self._feedback.waiting_sentence(receipt_time, longest)
        still = resting(self.wrist, self.state)
        return PeriodResult(WristState[self.mode.name], still, ZERO_TWIST, message, False)

    def _deaf(self, receipt_time: float) -> bool:
        """Return whether the joints were heard too long ago to move by."""
        age, settings = self._feedback.age(receipt_time), self.settings
        return settings.require_joint_states and age > settings.feedback_timeout

    def _adopt_when_resting(self, measured: Sequence[float]) -> None:
        if not self._feedback.resting:
            return
        try:
            self.state = checked_start(self.wrist, measured, self.state)
        except WristError as error:
            self._feedback.refused = str(error)
            if self.mode is Mode.FOLLOWING:
                self.stop(str(error), Mode.FAULT)
            raise
        self._adopted, self.mode = True, Mode.FOLLOWING
        self._commands.clear()
