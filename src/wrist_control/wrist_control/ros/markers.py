"""The hand as RViz and Foxglove draw it: its axes, the rotation being lost, and the sentence."""

from __future__ import annotations

from geometry_msgs.msg import Point, Vector3
from std_msgs.msg import ColorRGBA, Header
from visualization_msgs.msg import Marker, MarkerArray

from wrist_control.rotations import Pose, Vector, to_forearm

AXES: tuple[tuple[Vector, ColorRGBA], ...] = (
    ((1.0, 0.0, 0.0), ColorRGBA(r=0.8, g=0.1, b=0.1, a=1.0)),
    ((0.0, 1.0, 0.0), ColorRGBA(r=0.1, g=0.6, b=0.1, a=1.0)),
    ((0.0, 0.0, 1.0), ColorRGBA(r=0.1, g=0.2, b=0.8, a=1.0)),
)
AXIS_LENGTH = 0.15
SHAFT = Vector3(x=0.008, y=0.016, z=0.02)


def wrist_markers(
    header: Header, pose: Pose, lost_axis: Vector, margin: float, message: str
) -> MarkerArray:
    """Return the markers of one moment.

    Args:
        header: Stamp and forearm frame.
        pose: Where the hand is.
        lost_axis: The rotation hardest to make, unit vector in hand axes.
        margin: How far from singular; the lost axis is drawn the stronger the nearer.
        message: The sentence for the operator.
    """
    markers = [
        _arrow(header, index, pose, axis, AXIS_LENGTH, color)
        for index, (axis, color) in enumerate(AXES)
    ]
    nearness = max(0.0, 1.0 - margin)
    warning = ColorRGBA(r=1.0, g=0.6, b=0.0, a=nearness)
    markers.append(_arrow(header, 3, pose, lost_axis, AXIS_LENGTH * nearness, warning))
    markers.append(_text(header, 4, pose, message))
    return MarkerArray(markers=markers)


def _arrow(
    header: Header, number: int, pose: Pose, axis: Vector, length: float, color: ColorRGBA
) -> Marker:
    x, y, z = pose.position
    dx, dy, dz = to_forearm(pose.quaternion, axis)
    tip = Point(x=x + length * dx, y=y + length * dy, z=z + length * dz)
    marker = _marker(header, number, Marker.ARROW, SHAFT, color)
    marker.points = [Point(x=x, y=y, z=z), tip]
    return marker


def _text(header: Header, number: int, pose: Pose, message: str) -> Marker:
    x, y, z = pose.position
    white = ColorRGBA(r=1.0, g=1.0, b=1.0, a=1.0)
    marker = _marker(header, number, Marker.TEXT_VIEW_FACING, Vector3(z=0.02), white)
    marker.pose.position = Point(x=x, y=y, z=z + 1.5 * AXIS_LENGTH)
    marker.text = message
    return marker


def _marker(header: Header, number: int, kind: int, scale: Vector3, color: ColorRGBA) -> Marker:
    marker = Marker(
        header=header,
        ns='wrist',
        id=number,
        type=kind,
        action=Marker.ADD,
        scale=scale,
        color=color,
    )
    marker.pose.orientation.w = 1.0
    return marker
