"""The resolver node, for every wrist: operator rates in, joint commands out."""

from __future__ import annotations

import sys
import time
from collections.abc import Callable, Iterator
from functools import partial
from typing import Any

from rclpy.service import Service
from rclpy.subscription import Subscription
from rclpy.time import Time
from sensor_msgs.msg import JointState
from std_srvs.srv import SetBool, Trigger

from wrist_control.errors import RefusedError, WristError
from wrist_control.nodes.resolver_clock import StepClock
from wrist_control.nodes.resolver_inputs import Inputs
from wrist_control.nodes.resolver_journal import Journal
from wrist_control.nodes.resolver_outputs import Outputs
from wrist_control.nodes.resolver_settings import (
    check_ceilings,
    check_own,
    completed,
    example,
    limited,
    mechanism,
    mechanism_specs,
    settings,
    specs,
    wrist_spec,
)
from wrist_control.resolving.announcer import Announcer
from wrist_control.resolving.period import Mode, PeriodResult
from wrist_control.resolving.report import WristState
from wrist_control.resolving.witness import WitnessedSupervisor
from wrist_control.ros import convert
from wrist_control.ros.diagnostics import ERROR, OK, WARN, Diagnostics
from wrist_control.ros.guarded import GuardedNode
from wrist_control.ros.polled_services import PolledServices
from wrist_control.ros.qos import NEWEST
from wrist_control.ros.running import run
from wrist_control.ros.usage import is_wanted
from wrist_control.ros.wrong_types import WrongTypes

LEVELS = {
    WristState.LIMITED: WARN,
    WristState.SINGULAR: WARN,
    WristState.STALE: WARN,
    WristState.FAULT: ERROR,
    WristState.WAITING: WARN,
}
# What the resolver whose wrist is a parameter is called after.
ANY = 'wrist'
TYPES = {
    'cmd_vel': 'geometry_msgs/msg/TwistStamped',
    'cmd_vel_unstamped': 'geometry_msgs/msg/Twist',
    'joint_states': 'sensor_msgs/msg/JointState',
    'deadman': 'std_msgs/msg/Bool',
    'stop': 'std_msgs/msg/Empty',
}


class Resolver(GuardedNode):
    """Turns operator rates into joint commands for one wrist."""

    def __init__(self, wrist_name: str = '', **node_options: Any) -> None:
        """Declare the parameters and start stepping.

        Args:
            wrist_name: One of the wrists; without it the parameter `wrist` names one.
            node_options: Passed on to rclpy.

        Raises:
            WristError: A parameter cannot be used; the sentence says why.
        """
        self._hidden: list[Subscription] = []
        super().__init__(f'{wrist_name or ANY}_resolver', **node_options)
        chosen = wrist_spec(wrist_name)
        wrist_name = str(self.given(chosen))
        geometry = mechanism_specs(wrist_name)
        own = mechanism(wrist_name, {spec.name: self.given(spec) for spec in geometry})
        self._values = completed(self.declare([chosen, *geometry, *specs(own)]))
        self._started = dict(self._values)
        check_own(own, self._values)
        wrist = limited(own, self._values)
        self._supervisor = WitnessedSupervisor(wrist, settings(wrist, self._values))
        self._outputs = Outputs(self, wrist, self._values)
        self._journal = Journal(self, self._values, self._supervisor)
        self._result = self._supervisor.tick(
            stamp_time=0.0, receipt_time=0.0, withheld='Starting: no step was made yet.'
        )
        self._supervisor.turn_over()
        self._announcer = Announcer()
        self._broken = False
        self.watch(self._check, self._apply)
        self._diagnostics = Diagnostics(self, self._health)
        self._wrong_types = WrongTypes(self, TYPES)
        self._step_clock = StepClock(self, self._supervisor, self._step)
        self._inputs = Inputs(
            self,
            self._values,
            self._supervisor,
            self._diagnostics,
            self._step_clock,
            self._hidden,
        )
        self.create_subscription(JointState, 'joint_states', self._on_joint_states, NEWEST)
        self.create_service(SetBool, '~/enable', self._on_enable)
        self.create_service(Trigger, '~/reset', self._on_reset)
        PolledServices(self, list(super().services))

    @property
    def services(self) -> Iterator[Service]:
        """Return what an executor shall serve of them: none, for they are polled."""
        return iter(())

    @property
    def subscriptions(self) -> Iterator[Subscription]:
        """Return what an executor shall serve of them: not those that are waited for otherwise."""
        return (each for each in super().subscriptions if each not in self._hidden)

    def _on_joint_states(self, message: JointState) -> None:
        prefix = self._values['joint_prefix']
        names = [name.removeprefix(prefix) for name in message.name]
        now = self._step_clock.receipt_time()
        try:
            self._supervisor.take_measured(names, message.position, now)
        except (RefusedError, WristError) as error:
            refused = error if isinstance(error, RefusedError) else RefusedError('bad', str(error))
            self._diagnostics.refuse('joint_states', refused)
        else:
            self._step_clock.timing.hear('joint states', now)

    def _on_enable(self, request: SetBool.Request, answer: SetBool.Response) -> Any:
        enable = partial(self._supervisor.enable, receipt_time=self._step_clock.receipt_time())
        self._answer(answer, partial(enable, request.data))
        if answer.success:
            self.unexpected.clear()
        return answer

    def _on_reset(self, _: Trigger.Request, answer: Trigger.Response) -> Any:
        return self._answer(answer, self._supervisor.reset)

    @staticmethod
    def _answer(answer: Any, ask: Callable[[], str]) -> Any:
        """Fill in the answer of a service: what was done, or why it was not."""
        try:
            answer.message = ask()
            answer.success = True
        except WristError as error:
            answer.message, answer.success = str(error), False
        return answer

    def _step(self, stamp: int) -> None:
        try:
            now, pause = self._step_clock.receipt_time(), self._step_clock.pause
            withheld, time_stamp = self._inputs.withheld(), Time(nanoseconds=stamp).to_msg()
            result = self._supervisor.tick(
                stamp_time=convert.seconds_of(stamp),
                receipt_time=now,
                withheld=withheld,
                pause=pause,
            )
            self._result = self._announced(result)
            self._outputs.publish(self._result, time_stamp)
            self._journal.publish(time_stamp, now, withheld, pause)
        except Exception as error:
            self._supervisor.turn_over()  # untold: this step cannot be made again
            if self._broken:  # the ramp cannot be computed either: a zero without one
                self._outputs.zero()
                self._supervisor.give_up(str(error))
            self._broken = True
            raise
        self._broken = False

    def _announced(self, result: PeriodResult) -> PeriodResult:
        message = self._inputs.with_refused(result.message)
        now = self._step_clock.receipt_time()
        return result._replace(message=self._announcer.say(result.wrist_state, message, now))

    def on_unexpected(self, sentence: str) -> None:
        """Ramp to a stop and be in FAULT."""
        self._supervisor.stop(sentence, Mode.FAULT)

    def wind_down(self) -> None:
        """Ramp to a stop, whatever the clock does, and let only a zero stand at the end."""
        self._supervisor.stop('Ending: the hand is ramped to a stop.', Mode.DISABLED)
        period = 1.0 / self._values['rate']
        try:
            while self._result.moving_allowed:
                time.sleep(period)
                self._step_clock.step_by_steady_clock()
        finally:
            self._outputs.settle()

    def _check(self, changed: dict[str, Any]) -> None:
        values = completed({**self._values, **changed})
        check_ceilings(self._supervisor.wrist, self._started, {n: values[n] for n in changed})
        settings(limited(self._supervisor.wrist, values), values)

    def _apply(self, changed: dict[str, Any]) -> None:
        self._values.update(completed({**self._values, **changed}))
        self._supervisor.wrist = limited(self._supervisor.wrist, self._values)
        self._supervisor.settings = settings(self._supervisor.wrist, self._values)
        self._journal.note_parameters()

    def _health(self) -> tuple[bytes, str, dict[str, str]]:
        result: PeriodResult = self._result
        values = {
            'state': result.wrist_state.name,
            'scale factor': f'{result.step.scale_factor:.4f}',
            'time lost': f'{result.step.state.time_lost:.4f} s',
            'margin': f'{result.step.margin:.4f}',
        }
        level = LEVELS.get(result.wrist_state, OK)
        if result.wrist_state == WristState.WAITING:
            self.get_logger().warning(result.message, throttle_duration_sec=10.0)
        distrusted, timing = self._step_clock.health()
        values.update(timing)
        level = max(level, WARN if distrusted else OK)
        for (publisher, topic), sentence in self._wrong_types.found.items():
            values[f'{publisher} on {topic}'] = sentence
            level = max(level, WARN)
        return level, result.message, values


def main(wrist_name: str) -> None:
    """Run the resolver of one wrist, or of the one that its parameter `wrist` names."""
    name = '' if wrist_name == ANY else wrist_name
    shown = {'parameter_overrides': example(name)} if name and is_wanted(sys.argv) else {}
    sys.exit(run(partial(Resolver, name, **shown)))
