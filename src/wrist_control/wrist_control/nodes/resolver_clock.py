"""When a resolver steps, and by which clock it judges ages.

On a steady clock, that nobody can set. Where `use_sim_time` is set the simulated clock says when
to step, and is watched: where it stands still, a steady clock makes the steps of the ramp.
"""

from __future__ import annotations

from collections.abc import Callable

from wrist_control.resolving.clock_watch import ClockWatch
from wrist_control.resolving.period import Mode
from wrist_control.resolving.supervisor import Supervisor
from wrist_control.ros import convert
from wrist_control.ros.guarded import GuardedNode
from wrist_control.ros.timing import Timing


class StepClock:
    """Calls for the steps of one resolver.

    Attributes:
        stamp: When the last step was made, ns of the node's clock.
        pause: How long before it the one before was made, s; of the node's clock and a steady one,
            what says less: a clock that jumps makes no pause, and neither does one that waits.
        timing: How punctual the steps are, and what they follow.
    """

    def __init__(
        self,
        node: GuardedNode,
        supervisor: Supervisor,
        step: Callable[[int], None],
    ) -> None:
        """Start stepping.

        Args:
            node: The resolver.
            supervisor: Is told to stop when the clock cannot be trusted.
            step: Makes a step; called with its stamp, ns.
        """
        self.stamp = 0
        self.pause = 0.0
        self._steady_stamp = 0
        self._node = node
        self._supervisor = supervisor
        self._make_step = step
        self._period = supervisor.settings.dt
        self._watch = ClockWatch(supervisor.settings.command_timeout)
        self._told = 0
        self.timing = Timing(self._period)
        self._timer = node.create_timer(self._period, self._tick)
        if node.simulated:
            node.create_timer(self._period, self._look, clock=node.steady)

    def stamp_time(self) -> float:
        """Return now, s, on the clock that messages are stamped by."""
        return convert.seconds_of(self._now())

    def receipt_time(self) -> float:
        """Return now, s, on the clock that ages are judged by, which never goes back."""
        if self._node.simulated:
            return convert.seconds_of(self._watch.age_time(self._now()))
        return convert.seconds_of(self._node.steady.now().nanoseconds)

    def step_by_steady_clock(self) -> None:
        """Make a step a period after the last, even if the node's clock does not say so."""
        self._step(max(self._now(), self.stamp + round(1e9 * self._period)))

    def health(self) -> tuple[bool, dict[str, str]]:
        """Return whether the clock is, or since the last time was, not to be trusted, and why."""
        new, self._told = self._watch.troubles > self._told, self._watch.troubles
        values = self.timing.values(self.receipt_time())
        if self._watch.troubles:
            values['clock'] = self._watch.last
            values['clock troubles'] = str(self._watch.troubles)
        return new or self._watch.stands, values

    def _tick(self) -> None:
        now = self._now()
        if self._node.simulated:
            self._mind(now)
        if self.timing.is_late(now):
            self._timer.reset()  # the next a whole period after this one, not when it was planned
        if self.timing.is_due(now):
            self._step(now)

    def _look(self) -> None:
        self._mind(self._now())
        if self._watch.stands and self._supervisor.stopping:
            self.step_by_steady_clock()

    def _mind(self, now: int) -> None:
        self._watch.timeout = max(self._supervisor.settings.command_timeout, 3.0 * self._period)
        steady = convert.seconds_of(self._node.steady.now().nanoseconds)
        if self._watch.look(now, steady):
            self._supervisor.stop(self._watch.last, Mode.FOLLOWING)

    def _step(self, stamp: int) -> None:
        steady = self._node.steady.now().nanoseconds
        self.pause = convert.seconds_of(min(stamp - self.stamp, steady - self._steady_stamp))
        self.stamp, self._steady_stamp = stamp, steady
        self.timing.step(stamp)
        self._make_step(stamp)

    def _now(self) -> int:
        return int(self._node.get_clock().now().nanoseconds)
