"""What a resolver shows of its mechanism: markers, and the frames of its bodies."""

from __future__ import annotations

from collections.abc import Mapping
from typing import Any

from rclpy.node import Node
from std_msgs.msg import Header
from tf2_msgs.msg import TFMessage
from visualization_msgs.msg import MarkerArray

from wrist_control.resolving import Step
from wrist_control.ros.frames import frame_transforms
from wrist_control.ros.markers import wrist_markers
from wrist_control.ros.mechanism_markers import MechanismMarkers
from wrist_control.ros.qos import FRAMES, OUTPUT
from wrist_control.ros.shown import shown
from wrist_control.rotations import Vector
from wrist_control.wrists import Wrist

# Pictures need not be drawn at the rate of the control loop.
MARKERS_PER_SECOND = 20.0


class Pictures:
    """Publishes markers and frames, while somebody listens to them."""

    def __init__(self, node: Node, wrist: Wrist, values: Mapping[str, Any]) -> None:
        """Make the publishers.

        Args:
            node: The resolver.
            wrist: What is drawn.
            values: The resolver's parameters.
        """
        self._node = node
        self._wrist = wrist
        self._hand = values['hand_frame']
        path, slash, _ = self._hand.rpartition('/')
        self._prefix = path + slash
        self._every = max(1, round(values['rate'] / MARKERS_PER_SECOND))
        self._count = 0
        self._broken = False
        self._drawn: MechanismMarkers | None = None
        self._markers = node.create_publisher(MarkerArray, 'markers', OUTPUT)
        self._frames = node.create_publisher(TFMessage, '/tf', FRAMES)

    def publish(self, header: Header, taken: Step, lost_axis: Vector, message: str) -> None:
        """Show what one step did.

        Args:
            header: Stamp and forearm frame.
            taken: The step.
            lost_axis: The rotation hardest to make, unit vector in hand axes.
            message: The sentence for the operator.
        """
        if self._broken:
            return
        try:
            self._publish(header, taken, lost_axis, message)
        except Exception as error:  # the hand does not stop because it cannot be drawn
            self._broken = True
            self._node.get_logger().error(f'Shows no more pictures: {shown(str(error))}')

    def _publish(self, header: Header, taken: Step, lost_axis: Vector, message: str) -> None:
        draw = self._count % self._every == 0 and self._markers.get_subscription_count() > 0
        self._count += 1
        frame = self._frames.get_subscription_count() > 0
        if not (draw or frame):
            return
        bodies = self._wrist.bodies(taken.state.positions)
        if frame:
            _, *moving, hand = bodies
            frames = [(self._prefix + body.name, body.pose) for body in moving]
            self._frames.publish(frame_transforms(header, [*frames, (self._hand, hand.pose)]))
        if draw:
            if self._drawn is None:
                self._drawn = MechanismMarkers(self._wrist)
            drawn = wrist_markers(header, taken.state.pose, lost_axis, taken.margin, message)
            mechanism = self._drawn.at(header, bodies, taken.state.positions, taken.joint_rates)
            self._markers.publish(MarkerArray(markers=[*drawn.markers, *mechanism]))
