"""Joints that stand in for the hardware: they follow commands at real rates, within limits."""

from __future__ import annotations

import math
import sys
from typing import Any

from sensor_msgs.msg import JointState
from std_msgs.msg import Header

from wrist_control.errors import InvalidValueError, RefusedError
from wrist_control.resolving.joint_order import finite_in_joint_order
from wrist_control.resolving.latest_message import LatestMessage
from wrist_control.resolving.simulated_joint import follow
from wrist_control.ros import convert
from wrist_control.ros.diagnostics import OK, Diagnostics
from wrist_control.ros.guarded import GuardedNode
from wrist_control.ros.parameters import Spec
from wrist_control.ros.qos import EVERY, LASTING, OUTPUT
from wrist_control.ros.running import run
from wrist_control.wrists.joint import Joint, broadcast_to_joints

EACH = 'one for each joint, or one for all'
SPECS = [
    Spec('rate', 100.0, 'Joint states per second, from the node clock', 'Hz', 1.0, 2000.0),
    Spec(
        'joints', [], 'Joint names; taken from initial_joints or joint_command when empty', 'names'
    ),
    Spec(
        'initial_positions',
        [],
        f'Where the joints start, {EACH}; as first heard when empty',
        'rad or m',
    ),
    Spec(
        'joint_rate_limits',
        [math.radians(64.0)],
        f'Fastest joint motion, {EACH}',
        'rad/s or m/s',
        0.0,
    ),
    Spec('joint_lower_limits', [-math.inf], f'Lowest joint position, {EACH}', 'rad or m'),
    Spec('joint_upper_limits', [math.inf], f'Highest joint position, {EACH}', 'rad or m'),
]


class JointSimulator(GuardedNode):
    """Follows `joint_command` and publishes `joint_states`."""

    def __init__(self, **node_options: Any) -> None:
        """Declare the parameters and start following.

        Args:
            node_options: Passed on to rclpy.

        Raises:
            WristError: A parameter cannot be used; the sentence says why.
        """
        super().__init__('joint_simulator', **node_options)
        self._values = self.declare(SPECS)
        self._joints: list[Joint] = []
        self._positions: list[float] = []
        self._commands: LatestMessage[list[float]] = LatestMessage()
        if self._values['joints']:
            self._begin(self._values['joints'], None)
        self._diagnostics = Diagnostics(self, self._health)
        self._publisher = self.create_publisher(JointState, 'joint_states', OUTPUT)
        self.create_subscription(JointState, 'joint_command', self._on_command, EVERY)
        self.create_subscription(JointState, 'initial_joints', self._on_initial_joints, LASTING)
        self.create_timer(1.0 / self._values['rate'], self._tick)

    def _begin(self, names: list[str], commanded: list[float] | None) -> None:
        limits = zip(
            names,
            self._spread('joint_lower_limits', names),
            self._spread('joint_upper_limits', names),
            self._spread('joint_rate_limits', names),
            strict=True,
        )
        joints = [
            Joint(name, lower=low, upper=up, rate_limit=rate) for name, low, up, rate in limits
        ]
        if self._values['initial_positions']:
            commanded = self._spread('initial_positions', names)
        positions = commanded or [0.0] * len(names)
        for joint, position in zip(joints, positions, strict=True):
            if not (joint.rate_limit > 0.0 and joint.lower <= position <= joint.upper):
                raise InvalidValueError(
                    f'{joint.name} cannot start at {position:g} with limits {joint.lower:g} to '
                    f'{joint.upper:g} and rate limit {joint.rate_limit:g}; start it inside its '
                    'limits, with a rate limit above 0.'
                )
        self._joints, self._positions = joints, list(positions)

    def _spread(self, parameter: str, names: list[str]) -> list[float]:
        return broadcast_to_joints(parameter, self._values[parameter], names)

    def _on_command(self, message: JointState) -> None:
        try:
            wanted = self._wanted(list(message.name), list(message.position))
        except RefusedError as error:
            self._diagnostics.refuse('joint_command', error)
        except InvalidValueError as error:
            self._diagnostics.refuse('joint_command', RefusedError('unusable', str(error)))
        else:
            self._commands.put(convert.seconds(message.header.stamp), wanted)

    def _on_initial_joints(self, message: JointState) -> None:
        """Learn the joints of a resolver that waits for them before it commands anything."""
        if self._joints:
            return
        try:
            self._wanted(list(message.name), list(message.position))
        except (RefusedError, InvalidValueError) as error:
            self._diagnostics.refuse('initial_joints', RefusedError('unusable', str(error)))

    def _wanted(self, names: list[str], positions: list[float]) -> list[float]:
        known = [joint.name for joint in self._joints] or names
        wanted = list(finite_in_joint_order(known, names, positions))
        if not self._joints:
            self._begin(names, wanted)
        return wanted

    def _tick(self) -> None:
        if not self._joints:
            return
        now = self.get_clock().now()
        before, dt = self._positions, 1.0 / self._values['rate']
        targets = self._commands.at(convert.seconds_of(now.nanoseconds)) or before
        self._positions = [
            follow(joint, position, target, dt)
            for joint, position, target in zip(self._joints, before, targets, strict=True)
        ]
        rates = [(new - old) / dt for old, new in zip(before, self._positions, strict=True)]
        header = Header(stamp=now.to_msg())
        names = [joint.name for joint in self._joints]
        self._publisher.publish(convert.joint_message(header, names, self._positions, rates))

    def _health(self) -> tuple[bytes, str, dict[str, str]]:
        if not self._joints:
            return OK, 'Waiting for initial_joints or joint_command to learn the joints.', {}
        values = {
            joint.name: f'{position:.6f}'
            for joint, position in zip(self._joints, self._positions, strict=True)
        }
        return OK, f'Simulating {len(self._joints)} joints.', values


def main() -> None:
    """Run the joint simulator."""
    sys.exit(run(JointSimulator))
