"""Between ROS messages and the library's plain values. The only place that knows both."""

from __future__ import annotations

import array
from collections.abc import Sequence

from builtin_interfaces.msg import Time
from geometry_msgs.msg import (
    Point,
    PoseStamped,
    Quaternion,
    Transform,
    Twist,
    TwistStamped,
    Vector3,
)
from sensor_msgs.msg import JointState
from std_msgs.msg import Header

from wrist_control.rotations import Pose, xyzw

# In place of what has no bound: JSON, and whoever plots it, know no infinity.
LARGEST = 1e9


def seconds(stamp: Time) -> float | None:
    """Return a stamp in s, None when it is zero and so says nothing."""
    if stamp.sec == 0 and stamp.nanosec == 0:
        return None
    return seconds_of(stamp.sec * 10**9 + stamp.nanosec)


def seconds_of(nanoseconds: int) -> float:
    """Return a time in s: equal times give equal floats, whatever they came as."""
    return 1e-9 * nanoseconds


def finite(value: float) -> float:
    """Return a value that every reader understands: what has no bound is LARGEST."""
    return max(-LARGEST, min(LARGEST, value))


def twist_values(twist: Twist) -> tuple[float, float, float, float, float, float]:
    """Return (vx, vy, vz, p, q, r)."""
    linear, angular = twist.linear, twist.angular
    return (linear.x, linear.y, linear.z, angular.x, angular.y, angular.z)


def twist_message(values: Sequence[float]) -> Twist:
    """Return a Twist of (vx, vy, vz, p, q, r)."""
    vx, vy, vz, p, q, r = values
    return Twist(linear=Vector3(x=vx, y=vy, z=vz), angular=Vector3(x=p, y=q, z=r))


def command_message(
    header: Header, rates: Sequence[float], travel: Sequence[float] = (0.0, 0.0, 0.0)
) -> TwistStamped:
    """Return a command of p, q, r, rad/s, and (vx, vy, vz), m/s."""
    return TwistStamped(header=header, twist=twist_message((*travel, *rates)))


def joint_message(
    header: Header,
    names: Sequence[str],
    positions: Sequence[float],
    rates: Sequence[float],
    efforts: Sequence[float] = (),
) -> JointState:
    """Return a JointState; positions in rad or m, rates in rad/s or m/s, efforts in N·m or N."""
    return JointState(
        header=header,
        name=list(names),
        position=array.array('d', positions),
        velocity=array.array('d', rates),
        effort=array.array('d', efforts),
    )


def pose_message(header: Header, pose: Pose) -> PoseStamped:
    """Return a PoseStamped of a hand pose in the forearm frame."""
    message = PoseStamped(header=header)
    fill(message.pose.position, message.pose.orientation, pose)
    return message


def transform_message(pose: Pose) -> Transform:
    """Return the Transform from the axes that a pose is in to those that it is of."""
    message = Transform()
    fill(message.translation, message.rotation, pose)
    return message


def fill(where: Point | Vector3, turn: Quaternion, pose: Pose) -> None:
    """Write a pose into the two parts of a message that hold one."""
    where.x, where.y, where.z = pose.position
    turn.x, turn.y, turn.z, turn.w = xyzw(pose.quaternion)
