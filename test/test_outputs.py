"""What a resolver publishes: how often, and what comes last before it falls silent."""

import math

import numpy as np
import pytest
from geometry_msgs.msg import PoseStamped, Twist
from sensor_msgs.msg import JointState
from std_msgs.msg import Float64MultiArray
from std_srvs.srv import SetBool
from visualization_msgs.msg import Marker, MarkerArray

from wrist_control.nodes.resolver import Resolver
from wrist_interfaces.msg import WristStatus

NODE = 'three_gimbal_resolver'


def turning(x=0.0, y=0.0, z=0.0):
    twist = Twist()
    twist.angular.x, twist.angular.y, twist.angular.z = x, y, z
    return twist


def test_markers_come_twenty_times_a_second_whatever_the_rate_of_the_steps(graph):
    clock = graph.lockstep(1.0 / 100.0)
    graph.start(Resolver, 'three_gimbal', use_sim_time=True, rate=100.0)
    markers = graph.listen(MarkerArray, 'markers')
    clock.listen({'wrist_status': WristStatus})
    clock.begin()
    graph.spin(0.1)
    before = len(markers)
    for _ in range(50):
        clock.tick()
    graph.until(lambda: len(markers) >= before + 10)
    graph.spin(0.1)
    assert len(markers) == before + 10


def test_the_last_velocity_before_silence_is_zero(graph):
    graph.start(Resolver, 'three_gimbal', command_timeout=10.0)
    velocities = graph.listen(Float64MultiArray, 'joint_velocity_command')
    publisher = graph.publisher(Twist, 'cmd_vel_unstamped')

    def moving():
        publisher.publish(turning(x=0.1))
        return velocities and velocities[-1].data[2] > 0.05

    graph.until(moving)
    assert graph.call(SetBool, f'{NODE}/enable', SetBool.Request(data=False)).success
    graph.until(lambda: not any(velocities[-1].data))
    assert list(velocities[-1].data) == [0.0, 0.0, 0.0]
    graph.spin(0.1)
    count = len(velocities)
    graph.spin(0.2)
    assert len(velocities) == count


def test_the_status_says_what_is_lost_and_by_which_limit(graph):
    """φ at half of what is asked for: F is 1/2, and half of the time is lost."""
    rate, asked = 50.0, 0.4
    clock = graph.lockstep(1.0 / rate)
    limits = [1.0, 1.0, 0.5 * asked]
    graph.start(
        Resolver,
        'three_gimbal',
        use_sim_time=True,
        rate=rate,
        joint_rate_limits=limits,
        free_joints=True,
        hand_frame='palm',
        forearm_frame='arm',
        joint_prefix='left_',
    )
    clock.listen(
        {'wrist_status': WristStatus, 'joint_command': JointState, 'hand_pose': PoseStamped}
    )
    publisher = graph.publisher(Twist, 'cmd_vel_unstamped')
    clock.begin()
    publisher.publish(turning(x=asked))
    graph.spin(0.1)
    for _ in range(10):
        clock.tick()
    status = clock.heard['wrist_status'][-1]
    command, pose = clock.heard['joint_command'][-1], clock.heard['hand_pose'][-1]
    assert status.header.frame_id == 'palm'
    assert command.header.frame_id == pose.header.frame_id == 'arm'
    assert list(command.name) == ['left_psi', 'left_theta', 'left_phi']
    assert status.state == WristStatus.SCALED
    assert status.scale_factor == pytest.approx(0.5)
    assert status.time_lost == pytest.approx(10 * 0.5 / rate)
    assert status.margin == pytest.approx(1.0)
    assert status.commanded.angular.x == asked
    assert status.achieved.angular.x == pytest.approx(0.5 * asked)
    (limit,) = status.limits
    assert (limit.joint, limit.kind) == ('phi', limit.RATE)
    assert (limit.asked, limit.allowed) == pytest.approx((asked, 0.5 * asked))
    np.testing.assert_allclose(command.position, (0.0, 0.0, 10 * 0.5 * asked / rate), atol=1e-12)
    np.testing.assert_allclose(command.velocity, (0.0, 0.0, 0.5 * asked), atol=1e-12)


def test_markers_draw_the_hands_axes_the_lost_one_and_the_sentence(graph):
    """Pitched by 60° the hand's x axis points down by as much; lost is what ψ would have to do."""
    pitch, length = math.radians(60.0), 0.15
    graph.start(Resolver, 'three_gimbal', initial_positions=[0.0, pitch, 0.0])
    heard = graph.listen(MarkerArray, 'markers')
    graph.until(lambda: heard)
    drawn = [marker for marker in heard[-1].markers if marker.ns == 'wrist']
    *arrows, text = drawn
    assert [marker.type for marker in arrows] == [Marker.ARROW] * 4
    assert [marker.id for marker in drawn] == [0, 1, 2, 3, 4]
    assert {marker.action for marker in drawn} == {Marker.ADD}
    assert {marker.pose.orientation.w for marker in drawn} == {1.0}
    assert all((m.points[0].x, m.points[0].y, m.points[0].z) == (0.0, 0.0, 0.0) for m in arrows)
    tips = np.array([(m.points[1].x, m.points[1].y, m.points[1].z) for m in arrows])
    s, c = length * math.sin(pitch), length * math.cos(pitch)
    np.testing.assert_allclose(
        tips[:3], [[c, 0.0, -s], [0.0, length, 0.0], [s, 0.0, c]], atol=1e-12
    )
    # Half of the margin is gone, so the warning is half as strong and half as long.
    np.testing.assert_allclose(np.linalg.norm(tips[3]), 0.5 * length)
    assert arrows[3].color.a == pytest.approx(0.5)
    assert [tuple(m.color.__getattribute__(k) > 0.5 for k in 'rgb') for m in arrows[:3]] == [
        (True, False, False),
        (False, True, False),
        (False, False, True),
    ]
    assert {marker.color.a for marker in (*arrows[:3], text)} == {1.0}
    assert text.type == Marker.TEXT_VIEW_FACING
    assert text.text == 'Ready: no motion is commanded.'
    assert text.pose.position.z == pytest.approx(1.5 * length)
    assert text.scale.z > 0.0
    assert all(m.scale.x > 0.0 and m.scale.y > m.scale.x and m.scale.z > 0.0 for m in arrows)
