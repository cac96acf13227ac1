"""A mechanism in place of the hardware: servos, links and loads that move by physics."""

from __future__ import annotations

import sys
import time
from collections.abc import Callable
from typing import Any

from geometry_msgs.msg import PoseStamped
from sensor_msgs.msg import JointState
from std_msgs.msg import Float64MultiArray, Header

from wrist_control.errors import RefusedError, UnstableError
from wrist_control.nodes.physics_settings import POSITIONS, SPECS, WRIST, check_stuck, driven
from wrist_control.nodes.resolver_settings import mechanism, mechanism_specs
from wrist_control.resolving.joint_order import finite_in_joint_order
from wrist_control.resolving.latest_message import LatestMessage
from wrist_control.ros import convert
from wrist_control.ros.diagnostics import ERROR, OK, WARN, Diagnostics, Health
from wrist_control.ros.guarded import GuardedNode
from wrist_control.ros.qos import EVERY, NEWEST, OUTPUT
from wrist_control.ros.running import run

# How much the newest period counts in the mean of what periods cost.
NEWEST_SHARE = 0.02


class PhysicsSimulator(GuardedNode):
    """Moves a wrist's mechanism by `joint_command` or `joint_velocity_command`.

    Publishes `joint_states` with efforts, and where the hand really is as `true_hand_pose`.
    Until a command is heard the servos hold the mechanism where it started.
    """

    def __init__(self, **node_options: Any) -> None:
        """Declare the parameters and let the mechanism go.

        Args:
            node_options: Passed on to rclpy.

        Raises:
            WristError: A parameter cannot be used, or the physics is not installed; the sentence
                says why.
        """
        super().__init__('physics_simulator', **node_options)
        name = str(self.given(WRIST))
        self._values = values = self.declare([*SPECS, *mechanism_specs(name)])
        self._wrist = mechanism(name, values)
        self._mechanism = driven(self._wrist, values)
        self._start = self._mechanism.reading.positions
        self._names = [values['joint_prefix'] + joint.name for joint in self._wrist.joints]
        self._period = 1.0 / values['rate']
        self._cost, self._torn = 0.0, ''
        self._commands: LatestMessage[tuple[float, ...]] = LatestMessage()
        self._heard = -float('inf')
        self.watch(self._check, self._apply)
        self._diagnostics = Diagnostics(self, self._health)
        self._states = self.create_publisher(JointState, 'joint_states', OUTPUT)
        self._poses = self.create_publisher(PoseStamped, 'true_hand_pose', OUTPUT)
        if values['command'] == POSITIONS:
            self.create_subscription(JointState, 'joint_command', self._on_positions, EVERY)
            self._told: Callable[[float], tuple[float, ...]] = self._positions
        else:
            topic = 'joint_velocity_command'
            self.create_subscription(Float64MultiArray, topic, self._on_rates, NEWEST)
            self._told = self._rates
        self.create_timer(self._period, self._tick)

    def _on_positions(self, message: JointState) -> None:
        try:
            wanted = finite_in_joint_order(self._names, message.name, message.position)
        except RefusedError as error:
            self._diagnostics.refuse('joint_command', error)
        else:
            self._commands.put(convert.seconds(message.header.stamp), wanted)

    def _on_rates(self, message: Float64MultiArray) -> None:
        topic = 'joint_velocity_command'
        if len(message.data) != len(self._names):
            sentence = f'{topic} has {len(message.data)} rates; give {len(self._names)}, for '
            sentence += f'{", ".join(self._names)}.'
            self._diagnostics.refuse(topic, RefusedError('wrong length', sentence))
            return
        try:
            wanted = finite_in_joint_order(self._names, self._names, message.data)
        except RefusedError as error:
            self._diagnostics.refuse(topic, error)
        else:
            self._commands.put(None, wanted)
            self._heard = self._receipt_time()

    def _receipt_time(self) -> float:
        clock = self.get_clock() if self.simulated else self.steady
        return convert.seconds_of(clock.now().nanoseconds)

    def _positions(self, now: float) -> tuple[float, ...]:
        return self._commands.at(now) or self._start

    def _rates(self, now: float) -> tuple[float, ...]:
        silent = self._receipt_time() - self._heard > self._values['velocity_timeout']
        if silent:
            self._commands.clear()
        return self._commands.at(now) or (0.0,) * len(self._names)

    def _tick(self) -> None:
        if self._torn:
            return  # whoever drives these joints hears that they are silent
        now = self.get_clock().now()
        began = time.perf_counter()
        try:
            reading = self._mechanism.advance(self._told(convert.seconds_of(now.nanoseconds)))
        except UnstableError as error:
            self._torn = str(error)
            self.get_logger().error(self._torn)
            return
        self._cost += NEWEST_SHARE * (time.perf_counter() - began - self._cost)
        stamp = now.to_msg()
        positions, rates, efforts, pose = reading
        header = Header(stamp=stamp)
        self._states.publish(convert.joint_message(header, self._names, positions, rates, efforts))
        header = Header(stamp=stamp, frame_id=self._values['forearm_frame'])
        self._poses.publish(convert.pose_message(header, pose))

    def _check(self, changed: dict[str, Any]) -> None:
        check_stuck(self._wrist, changed.get('stuck_joint', ''))

    def _apply(self, changed: dict[str, Any]) -> None:
        self._values.update(changed)
        self._mechanism.stick(self._values['stuck_joint'])

    def _health(self) -> Health:
        share = self._cost / self._period
        reading = self._mechanism.reading
        values = {'share of real time': f'{share:.3f}'}
        for name, position, effort in zip(
            self._names, reading.positions, reading.efforts, strict=True
        ):
            values[name] = f'{position:.6f}, effort {effort:.4f}'
        if self._torn:
            return ERROR, self._torn, values
        if self._values['stuck_joint']:
            return WARN, f'{self._values["stuck_joint"]} sticks, as it was told to.', values
        if share > 1.0 and not self.simulated:
            sentence = f'The physics takes {share:.1f} times real time; '
            return WARN, f'{sentence}lower the rate, or lengthen physics_step.', values
        return OK, f'Simulating the mechanism of {self._values["wrist"]}.', values


def main() -> None:
    """Run the physics simulator."""
    sys.exit(run(PhysicsSimulator))
