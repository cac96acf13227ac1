"""A node that is told before it ends: it has a last word while ROS is still there."""

from __future__ import annotations

from rclpy.node import Node


class GuardedNode(Node):
    """What every node of this package is."""

    def wind_down(self) -> None:
        """Bring to rest whatever this node moves; called once, after its last callback."""
