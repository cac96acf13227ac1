"""The resolver node, for every wrist: operator rates in, joint commands out."""

from __future__ import annotations

import sys
import time
from collections.abc import Callable
from functools import partial
from types import SimpleNamespace
from typing import Any

from geometry_msgs.msg import Twist, TwistStamped
from rclpy.time import Time
from sensor_msgs.msg import JointState
from std_srvs.srv import SetBool, Trigger

from wrist_control.errors import RefusedError, WristError
from wrist_control.nodes.resolver_clock import StepClock
from wrist_control.nodes.resolver_outputs import Outputs
from wrist_control.nodes.resolver_settings import limited, mechanism, settings, specs
from wrist_control.resolving.commands import CommandPolicy, ReceivedTwist
from wrist_control.resolving.report import WristState
from wrist_control.resolving.supervisor import Mode, PeriodResult, Supervisor
from wrist_control.ros import convert
from wrist_control.ros.diagnostics import ERROR, OK, WARN, Diagnostics
from wrist_control.ros.guarded import GuardedNode
from wrist_control.ros.parameters import declare, watch
from wrist_control.ros.qos import NEWEST
from wrist_control.ros.running import run
from wrist_control.ros.shown import shown
from wrist_control.ros.wrong_types import WrongTypes
from wrist_control.wrists import WRISTS

LEVELS = {
    WristState.LIMITED: WARN,
    WristState.SINGULAR: WARN,
    WristState.STALE: WARN,
    WristState.FAULT: ERROR,
    WristState.WAITING: WARN,
}
TYPES = {
    'cmd_vel': 'geometry_msgs/msg/TwistStamped',
    'cmd_vel_unstamped': 'geometry_msgs/msg/Twist',
    'joint_states': 'sensor_msgs/msg/JointState',
}


class Resolver(GuardedNode):
    """Turns operator rates into joint commands for one wrist."""

    def __init__(self, wrist_name: str, **node_options: Any) -> None:
        """Declare the parameters and start stepping.

        Args:
            wrist_name: One of the registered wrists.
            node_options: Passed on to rclpy.

        Raises:
            WristError: A parameter cannot be used; the sentence says why.
        """
        super().__init__(f'{wrist_name}_resolver', **node_options)
        wanted = specs(wrist_name)
        self._values = declare(self, wanted)
        wrist = limited(mechanism(wrist_name, self._values), self._values)
        self._supervisor = Supervisor(wrist, settings(wrist, self._values))
        self._outputs = Outputs(self, wrist, self._values)
        self._result = self._supervisor.tick(stamp_time=0.0, receipt_time=0.0)
        self._broken = False
        self._warned_unstamped = False
        watch(self, wanted, self._check, self._apply)
        self._diagnostics = Diagnostics(self, self._health)
        self._wrong_types = WrongTypes(self, TYPES)
        self._step_clock = StepClock(self, self._supervisor, self._step)
        self._listen()

    def _listen(self) -> None:
        self.create_subscription(TwistStamped, 'cmd_vel', self._on_stamped, NEWEST)
        self.create_subscription(Twist, 'cmd_vel_unstamped', self._on_unstamped, NEWEST)
        self.create_subscription(JointState, 'joint_states', self._on_joint_states, NEWEST)
        self.create_service(SetBool, '~/enable', self._on_enable)
        self.create_service(Trigger, '~/reset', self._on_reset)

    def _on_stamped(self, message: TwistStamped) -> None:
        stamp = convert.seconds(message.header.stamp)
        if stamp is None and not self._warned_unstamped:
            self._warned_unstamped = True
            self.get_logger().warning('Commands on cmd_vel have no stamp; each counts as new.')
        self._take('cmd_vel', message.twist, shown(message.header.frame_id), stamp)

    def _on_unstamped(self, message: Twist) -> None:
        self._take('cmd_vel_unstamped', message, '', None)

    def _take(self, topic: str, twist: Twist, frame: str, stamp: float | None) -> None:
        policy = CommandPolicy(
            self._values['command_timeout'],
            self._values['hand_frame'],
            self._values['forearm_frame'],
        )
        try:
            command = policy.accept(
                ReceivedTwist(convert.twist_values(twist), frame, stamp),
                stamp_time=self._step_clock.stamp_time(),
                receipt_time=self._step_clock.receipt_time(),
            )
        except RefusedError as error:
            self._diagnostics.refuse(topic, error)
        else:
            self._supervisor.take_command(command)
            self._step_clock.timing.hear('command', command.receipt, stamp)

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
            self._result = self._supervisor.tick(
                stamp_time=convert.seconds_of(stamp), receipt_time=self._step_clock.receipt_time()
            )
            self._outputs.publish(self._result, Time(nanoseconds=stamp).to_msg())
        except Exception as error:
            if self._broken:  # the ramp cannot be computed either: a zero without one
                self._outputs.zero()
                self._supervisor.give_up(str(error))
            self._broken = True
            raise
        self._broken = False

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
        values = {**self._values, **changed}
        settings(limited(self._supervisor.wrist, values), values)

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
    """Run the resolver of one wrist."""
    sys.exit(run(partial(Resolver, wrist_name)))


# One entry point for each registered wrist: setup.py names them.
mains = SimpleNamespace(**{name: partial(main, name) for name in WRISTS})
