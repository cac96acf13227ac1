"""Every wrist of the suite as a resolver node: a Twist in, joint commands out, by topic only."""

import math
import re
from pathlib import Path

import numpy as np
import pytest
from geometry_msgs.msg import PoseStamped, Twist, TwistStamped
from sensor_msgs.msg import JointState
from std_msgs.msg import Float64MultiArray
from visualization_msgs.msg import MarkerArray

from wrist_control import WRISTS, make_wrist
from wrist_control.nodes.resolver import Resolver
from wrist_control.resolving import LimitKind
from wrist_control.resolving.report import WristState
from wrist_interfaces.msg import WristStatus

# The contract: other programs talk to these joints, outermost first.
CONTRACT = {
    'three_gimbal': 'psi theta phi',
    'four_gimbal': 'psi theta phi alpha',
    'roll_pitch_roll': 'theta_4 theta_5 theta_6',
    'single_hooke': 'phi theta psi',
    'double_hooke': 'phi theta psi',
    'omni_wrist': 'phi theta_a psi_a',
    'carpal': 'theta_1 theta_2 theta_3',
    'pitch_yaw': 'theta_1 theta_2',
    'five_bar': 'theta_1 theta_2',
    'stewart': 'leg_1 leg_2 leg_3 leg_4 leg_5 leg_6',
    'rotary_stewart': 'servo_1 servo_2 servo_3 servo_4 servo_5 servo_6',
}
PITCH = 0.1
MESSAGES = Path(__file__).resolve().parents[1] / 'src' / 'wrist_interfaces' / 'msg'


def pitching():
    twist = Twist()
    twist.angular.y = PITCH
    return twist


@pytest.mark.parametrize('wrist', CONTRACT)
def test_every_wrist_of_the_contract_has_the_joints_of_the_contract(wrist):
    assert [joint.name for joint in make_wrist(wrist).joints] == CONTRACT[wrist].split()


@pytest.mark.parametrize(
    ('enumeration', 'message'), [(WristState, 'WristStatus'), (LimitKind, 'LimitAtWork')]
)
def test_the_librarys_states_and_limits_are_numbered_as_in_the_messages(enumeration, message):
    text = (MESSAGES / f'{message}.msg').read_text(encoding='utf-8')
    constants = {name: int(value) for name, value in re.findall(r'^uint8 (\w+)=(\d+)', text, re.M)}
    assert constants == {one.name: one.value for one in enumeration}


@pytest.mark.parametrize('wrist', WRISTS)
def test_two_wrists_side_by_side_obey_their_own_commands_only(graph, wrist):
    left = graph.start(Resolver, wrist, namespace='left', joint_prefix='left_')
    graph.start(Resolver, wrist, namespace='right', joint_prefix='right_')
    commands = graph.listen(JointState, 'left/joint_command')
    others = graph.listen(JointState, 'right/joint_command')
    statuses = graph.listen(WristStatus, 'left/wrist_status')
    poses = graph.listen(PoseStamped, 'left/hand_pose')
    publisher = graph.publisher(Twist, 'left/cmd_vel_unstamped')
    graph.until(lambda: commands and others and statuses and poses)

    def tracked():
        publisher.publish(pitching())
        return statuses[-1].state in (WristStatus.TRACKING, WristStatus.SCALED)

    graph.until(tracked)
    count = len(commands)
    graph.until(lambda: tracked() and len(commands) > count + 20)

    last = commands[-1]
    assert list(last.name) == [f'left_{joint.name}' for joint in make_wrist(wrist).joints]
    assert len(last.position) == len(last.velocity) == len(last.name)
    assert last.position != commands[0].position
    assert all(other.position == others[0].position for other in others)
    assert statuses[-1].achieved.angular.y == pytest.approx(
        statuses[-1].scale_factor * PITCH, abs=2e-3
    )
    assert all(math.isfinite(x) for message in commands for x in message.position)
    assert left.get_namespace() == '/left'


@pytest.mark.parametrize('wrist', WRISTS)
def test_the_published_pose_is_that_of_the_published_joints(graph, wrist):
    graph.start(Resolver, wrist)
    commands = graph.listen(JointState, 'joint_command')
    poses = graph.listen(PoseStamped, 'hand_pose')
    publisher = graph.publisher(Twist, 'cmd_vel_unstamped')

    def turned():
        publisher.publish(pitching())
        return len(commands) > 30 and len(poses) > 30

    graph.until(turned)
    by_stamp = {(c.header.stamp.sec, c.header.stamp.nanosec): c for c in commands}
    pose = next(
        p for p in reversed(poses) if (p.header.stamp.sec, p.header.stamp.nanosec) in by_stamp
    )
    command = by_stamp[pose.header.stamp.sec, pose.header.stamp.nanosec]
    expected = make_wrist(wrist).forward(tuple(command.position))
    x, y, z, w = (getattr(pose.pose.orientation, axis) for axis in 'xyzw')
    rotation = np.array(  # the textbook's matrix of a unit quaternion, hand to forearm
        [
            [1 - 2 * (y * y + z * z), 2 * (x * y - z * w), 2 * (x * z + y * w)],
            [2 * (x * y + z * w), 1 - 2 * (x * x + z * z), 2 * (y * z - x * w)],
            [2 * (x * z - y * w), 2 * (y * z + x * w), 1 - 2 * (x * x + y * y)],
        ]
    )
    np.testing.assert_allclose(rotation.T, expected.rotation, atol=1e-9)
    position = pose.pose.position
    np.testing.assert_allclose([position.x, position.y, position.z], expected.position, atol=1e-9)


def test_velocities_for_ros2_control_are_those_of_the_joint_command(graph):
    graph.start(Resolver, 'three_gimbal', namespace='arm')
    velocities = graph.listen(Float64MultiArray, 'arm/joint_velocity_command')
    commands = graph.listen(JointState, 'arm/joint_command')
    publisher = graph.publisher(Twist, 'arm/cmd_vel_unstamped')

    def moving():
        publisher.publish(pitching())
        return velocities and any(velocities[-1].data)

    graph.until(moving)
    graph.spin(0.2)
    said = {tuple(message.data) for message in velocities}
    assert {tuple(message.velocity) for message in commands[-5:]} <= said


def test_markers_show_the_hand_and_the_sentence(graph):
    graph.start(Resolver, 'three_gimbal')
    heard = graph.listen(MarkerArray, 'markers')
    graph.until(lambda: heard)
    texts = [marker.text for marker in heard[-1].markers if marker.text]
    assert texts == ['Ready: no motion is commanded.']
    assert {marker.header.frame_id for marker in heard[-1].markers} == {'forearm'}


def test_a_stamped_command_in_forearm_axes_turns_about_forearm_axes(graph):
    """At θ = 60° the forearm's z axis is not the hand's."""
    graph.start(Resolver, 'three_gimbal', initial_positions=[0.0, 1.0, 0.0])
    statuses = graph.listen(WristStatus, 'wrist_status')
    publisher = graph.publisher(TwistStamped, 'cmd_vel')
    message = TwistStamped()
    message.header.frame_id = 'forearm'
    message.twist.angular.z = 0.1

    def followed():
        message.header.stamp = graph.outside.get_clock().now().to_msg()
        publisher.publish(message)
        return statuses and statuses[-1].state == WristStatus.TRACKING

    graph.until(followed)
    asked = statuses[-1].commanded.angular
    np.testing.assert_allclose(
        [asked.x, asked.y, asked.z],
        [-0.1 * math.sin(1.0), 0.0, 0.1 * math.cos(1.0)],
        atol=1e-9,
    )
