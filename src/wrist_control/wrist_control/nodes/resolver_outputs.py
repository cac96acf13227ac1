"""What a resolver publishes after each step."""

from __future__ import annotations

import array
from collections.abc import Mapping
from typing import Any

from builtin_interfaces.msg import Time
from geometry_msgs.msg import PoseStamped, Vector3
from rclpy.duration import Duration
from rclpy.node import Node
from sensor_msgs.msg import JointState
from std_msgs.msg import Float64MultiArray, Header

from wrist_control.nodes.resolver_pictures import Pictures
from wrist_control.resolving.announcer import SteadyAxis
from wrist_control.resolving.period import PeriodResult
from wrist_control.ros import convert
from wrist_control.ros.qos import LASTING, OUTPUT
from wrist_control.wrists import Wrist
from wrist_interfaces.msg import LimitAtWork, WristStatus

# So long whoever listens may take to acknowledge the last words before the node is gone.
LAST_WORDS = Duration(seconds=0.2)


class Outputs:
    """The publishers of a resolver."""

    def __init__(self, node: Node, wrist: Wrist, values: Mapping[str, Any]) -> None:
        """Make the publishers.

        Args:
            node: The resolver.
            wrist: For joint names and the lost axis.
            values: The resolver's parameters.
        """
        self._wrist = wrist
        self._forearm, self._hand = values['forearm_frame'], values['hand_frame']
        self._names = [values['joint_prefix'] + joint.name for joint in wrist.joints]
        self._was_allowed = False
        self._lost_axis = SteadyAxis()
        self._command = node.create_publisher(JointState, 'joint_command', OUTPUT)
        self._velocity = node.create_publisher(Float64MultiArray, 'joint_velocity_command', OUTPUT)
        self._pose = node.create_publisher(PoseStamped, 'hand_pose', OUTPUT)
        self._status = node.create_publisher(WristStatus, 'wrist_status', OUTPUT)
        self._pictures = Pictures(node, wrist, values)
        # Not a command: joints that are simulated learn from it which they are, and where.
        self._initial = node.create_publisher(JointState, 'initial_joints', LASTING)
        start = values['initial_positions'] or wrist.home
        self._initial.publish(
            convert.joint_message(Header(), self._names, start, [0.0] * len(self._names))
        )

    def publish(self, result: PeriodResult, stamp: Time) -> None:
        """Publish what one step did."""
        header = Header(stamp=stamp, frame_id=self._forearm)
        taken = result.step
        if result.moving_allowed:
            self._command.publish(
                convert.joint_message(
                    header, self._names, taken.state.positions, taken.joint_rates
                )
            )
        if result.moving_allowed or self._was_allowed:
            # Velocity controllers keep the last value: the last one before silence must be zero.
            self._velocity.publish(Float64MultiArray(data=array.array('d', taken.joint_rates)))
        self._was_allowed = result.moving_allowed
        self._pose.publish(convert.pose_message(header, taken.state.pose))
        status = self._status_message(result, stamp)
        self._status.publish(status)
        lost = status.lost_axis
        self._pictures.publish(header, taken, (lost.x, lost.y, lost.z), result.message)

    def settle(self) -> None:
        """Leave a zero as the last velocity, and see it arrive."""
        self.zero()
        self._velocity.wait_for_all_acked(LAST_WORDS)

    def zero(self) -> None:
        """Leave a zero as the last velocity, even when no step can be made any more."""
        if self._was_allowed:
            zero = array.array('d', [0.0] * len(self._names))
            self._velocity.publish(Float64MultiArray(data=zero))
            self._was_allowed = False

    def _status_message(self, result: PeriodResult, stamp: Time) -> WristStatus:
        taken = result.step
        x, y, z = self._lost_axis.turned(self._wrist.lost_axis(taken.state.positions))
        return WristStatus(
            header=Header(stamp=stamp, frame_id=self._hand),
            state=int(result.wrist_state),
            scale_factor=taken.scale_factor,
            time_lost=taken.state.time_lost,
            margin=taken.margin,
            lost_axis=Vector3(x=x, y=y, z=z),
            commanded=convert.twist_message(result.commanded),
            achieved=convert.twist_message(taken.achieved),
            limits=[
                LimitAtWork(
                    joint=limit.joint,
                    kind=int(limit.kind),
                    asked=convert.finite(limit.asked),
                    allowed=convert.finite(limit.allowed),
                )
                for limit in taken.limits
            ],
            message=result.message,
        )
