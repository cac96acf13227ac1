"""The resolver node, for every wrist: operator rates in, joint commands out."""

from __future__ import annotations

import sys
from collections.abc import Callable, Iterator
from functools import partial
from types import SimpleNamespace
from typing import Any

from rclpy.clock import Clock, ClockType
from rclpy.node import Node
from rclpy.service import Service
from rclpy.subscription import Subscription
from sensor_msgs.msg import JointState
from std_srvs.srv import SetBool, Trigger

from wrist_control.errors import RefusedError, WristError
from wrist_control.nodes.resolver_inputs import Inputs
from wrist_control.nodes.resolver_outputs import Outputs
from wrist_control.nodes.resolver_settings import (
    check_ceilings,
    limited,
    mechanism,
    settings,
    specs,
)
from wrist_control.resolving.announcer import Announcer
from wrist_control.resolving.report import WristState
from wrist_control.resolving.supervisor import PeriodResult, Supervisor
from wrist_control.ros import convert
from wrist_control.ros.diagnostics import ERROR, OK, WARN, Diagnostics
from wrist_control.ros.parameters import declare, watch
from wrist_control.ros.polled_services import PolledServices
from wrist_control.ros.qos import NEWEST
from wrist_control.ros.running import run
from wrist_control.ros.wrong_types import WrongTypes
from wrist_control.wrists import WRISTS

LEVELS = {
    WristState.LIMITED: WARN,
    WristState.SINGULAR: WARN,
    WristState.STALE: WARN,
    WristState.FAULT: ERROR,
}
TYPES = {
    'cmd_vel': 'geometry_msgs/msg/TwistStamped',
    'cmd_vel_unstamped': 'geometry_msgs/msg/Twist',
    'joint_states': 'sensor_msgs/msg/JointState',
    'deadman': 'std_msgs/msg/Bool',
    'stop': 'std_msgs/msg/Empty',
}


class Resolver(Node):
    """Turns operator rates into joint commands for one wrist."""

    def __init__(self, wrist_name: str, **node_options: Any) -> None:
        """Declare the parameters and start stepping.

        Args:
            wrist_name: One of the registered wrists.
            node_options: Passed on to rclpy.

        Raises:
            WristError: A parameter cannot be used; the sentence says why.
        """
        self._hidden: list[Subscription] = []
        super().__init__(f'{wrist_name}_resolver', **node_options)
        wanted = specs(wrist_name)
        self._values = declare(self, wanted)
        self._started = dict(self._values)
        wrist = limited(mechanism(wrist_name, self._values), self._values)
        self._supervisor = Supervisor(wrist, settings(wrist, self._values))
        self._outputs = Outputs(self, wrist, self._values)
        self._result = self._supervisor.tick(
            stamp_time=0.0, receipt_time=0.0, withheld='Starting: no step was made yet.'
        )
        self._announcer = Announcer()
        self._receipt_clock = Clock(clock_type=ClockType.STEADY_TIME)
        if self.get_parameter('use_sim_time').value:
            self._receipt_clock = self.get_clock()
        watch(self, wanted, self._check, self._apply)
        self._diagnostics = Diagnostics(self, self._health)
        self._wrong_types = WrongTypes(self, TYPES)
        self._inputs = Inputs(
            self,
            self._values,
            self._supervisor,
            self._diagnostics,
            self._receipt_clock,
            self._hidden,
        )
        self._listen()
        PolledServices(self, list(super().services))
        self.create_timer(1.0 / self._values['rate'], self._tick)

    @property
    def services(self) -> Iterator[Service]:
        """Return what an executor shall serve of them: none, for they are polled."""
        return iter(())

    @property
    def subscriptions(self) -> Iterator[Subscription]:
        """Return what an executor shall serve of them: not those that are waited for otherwise."""
        return (each for each in super().subscriptions if each not in self._hidden)

    def _listen(self) -> None:
        self.create_subscription(JointState, 'joint_states', self._on_joint_states, NEWEST)
        self.create_service(SetBool, '~/enable', self._on_enable)
        self.create_service(Trigger, '~/reset', self._on_reset)

    def _on_joint_states(self, message: JointState) -> None:
        prefix = self._values['joint_prefix']
        names = [name.removeprefix(prefix) for name in message.name]
        try:
            self._supervisor.take_measured(
                names, message.position, self._seconds(self._receipt_clock)
            )
        except (RefusedError, WristError) as error:
            refused = error if isinstance(error, RefusedError) else RefusedError('bad', str(error))
            self._diagnostics.refuse('joint_states', refused)

    def _on_enable(self, request: SetBool.Request, answer: SetBool.Response) -> Any:
        return self._answer(answer, partial(self._supervisor.enable, request.data))

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

    def _tick(self) -> None:
        now = self.get_clock().now()
        receipt_time = self._seconds(self._receipt_clock)
        result = self._supervisor.tick(
            stamp_time=convert.seconds_of(now.nanoseconds),
            receipt_time=receipt_time,
            withheld=self._inputs.withheld(),
        )
        message = self._inputs.with_refused(result.message)
        message = self._announcer.say(result.wrist_state, message, receipt_time)
        self._result = result._replace(message=message)
        self._outputs.publish(self._result, now.to_msg())

    def _check(self, changed: dict[str, Any]) -> None:
        check_ceilings(self._supervisor.wrist, self._started, changed)
        limited(self._supervisor.wrist, {**self._values, **changed})

    def _apply(self, changed: dict[str, Any]) -> None:
        self._values.update(changed)
        self._supervisor.wrist = limited(self._supervisor.wrist, self._values)
        self._supervisor.settings = settings(self._supervisor.wrist, self._values)

    def _health(self) -> tuple[bytes, str, dict[str, str]]:
        result: PeriodResult = self._result
        values = {
            'state': result.wrist_state.name,
            'scale factor': f'{result.step.scale_factor:.4f}',
            'time lost': f'{result.step.state.time_lost:.4f} s',
            'margin': f'{result.step.margin:.4f}',
        }
        level = LEVELS.get(result.wrist_state, OK)
        for (publisher, topic), sentence in self._wrong_types.found.items():
            values[f'{publisher} on {topic}'] = sentence
            level = max(level, WARN)
        return level, result.message, values

    @staticmethod
    def _seconds(clock: Clock) -> float:
        return convert.seconds_of(clock.now().nanoseconds)


def main(wrist_name: str) -> None:
    """Run the resolver of one wrist."""
    sys.exit(run(partial(Resolver, wrist_name)))


# One entry point for each registered wrist: setup.py names them.
mains = SimpleNamespace(**{name: partial(main, name) for name in WRISTS})
