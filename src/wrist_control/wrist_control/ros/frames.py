"""Frames of a wrist as tf2 knows them: each where it is in the forearm frame."""

from __future__ import annotations

from collections.abc import Iterable

from geometry_msgs.msg import TransformStamped
from std_msgs.msg import Header
from tf2_msgs.msg import TFMessage

from wrist_control.ros.convert import transform_message
from wrist_control.rotations import Pose


def frame_transforms(header: Header, frames: Iterable[tuple[str, Pose]]) -> TFMessage:
    """Return what tells tf2 where some frames are.

    Args:
        header: Stamp and forearm frame, which is the parent of every one.
        frames: Names of the frames, each with its pose in the forearm frame, m.
    """
    return TFMessage(
        transforms=[
            TransformStamped(header=header, child_frame_id=name, transform=transform_message(pose))
            for name, pose in frames
        ]
    )
