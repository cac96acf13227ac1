"""Frames as tf2 takes them: one stamp, one parent, and a point goes where the pose takes it."""

import math

import numpy as np
import pytest
from builtin_interfaces.msg import Time
from rclpy.qos import DurabilityPolicy, HistoryPolicy, ReliabilityPolicy
from scipy.spatial.transform import Rotation
from std_msgs.msg import Header

from wrist_control.ros.convert import pose_message
from wrist_control.ros.frames import frame_transforms
from wrist_control.ros.qos import FRAMES
from wrist_control.rotations import Pose, about_x, about_z, product, to_forearm

HEADER = Header(stamp=Time(sec=5, nanosec=7), frame_id='left/forearm')
POSE = Pose(product(about_z(0.7), about_x(-1.1)), (0.1, -0.2, 0.3))


def components(message):
    return [getattr(message, name) for name in message.get_fields_and_field_types()]


def test_every_frame_is_a_child_of_the_forearm_at_the_same_moment():
    frames = iter([('left/plate', Pose(about_z(0.1))), ('left/hand', POSE)])
    transforms = frame_transforms(HEADER, frames).transforms
    assert [one.child_frame_id for one in transforms] == ['left/plate', 'left/hand']
    assert all(one.header == HEADER for one in transforms)


def test_without_frames_nothing_is_told():
    assert frame_transforms(HEADER, []).transforms == []


def test_a_quarter_turn_about_z_takes_x_to_y():
    (one,) = frame_transforms(HEADER, [('hand', Pose(about_z(math.pi / 2)))]).transforms
    turn = Rotation.from_quat(components(one.transform.rotation))
    assert turn.apply([1.0, 0.0, 0.0]) == pytest.approx([0.0, 1.0, 0.0], abs=1e-15)


def test_a_point_of_the_frame_is_where_the_pose_has_it_in_the_forearm():
    (one,) = frame_transforms(HEADER, [('hand', POSE)]).transforms
    point = (0.05, 0.06, -0.07)  # in the hand's axes, m
    turn = Rotation.from_quat(components(one.transform.rotation))
    found = turn.apply(point) + components(one.transform.translation)
    expected = np.add(to_forearm(POSE.quaternion, point), POSE.position)
    assert found == pytest.approx(expected, abs=1e-15)


def test_it_is_where_hand_pose_says():
    (one,) = frame_transforms(HEADER, [('hand', POSE)]).transforms
    pose = pose_message(HEADER, POSE).pose
    assert components(one.transform.translation) == components(pose.position)
    assert components(one.transform.rotation) == components(pose.orientation)


def test_frames_are_published_as_tf2_publishes_them():
    assert FRAMES.reliability == ReliabilityPolicy.RELIABLE
    assert FRAMES.durability == DurabilityPolicy.VOLATILE
    assert (FRAMES.history, FRAMES.depth) == (HistoryPolicy.KEEP_LAST, 100)
