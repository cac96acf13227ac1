"""Nguyen's platform by topic only: six components, its limits, other platforms."""

import math

import numpy as np
import pytest
from geometry_msgs.msg import PoseStamped
from sensor_msgs.msg import JointState

from wrist_control import WristError, make_wrist
from wrist_control.nodes.resolver import Resolver
from wrist_control.rotations import IDENTITY, Pose, turned
from wrist_control.wrists.platform import EDGE
from wrist_interfaces.msg import LimitAtWork, WristStatus

from .stewart_flown import HOME, RATE, WRIST, Flown, pose_of, values

SIX = ('vx', 'vy', 'vz', 'p', 'q', 'r')


@pytest.mark.parametrize('component', range(6), ids=SIX)
def test_each_component_of_a_command_moves_the_hand_that_way(graph, component):
    flown = Flown(graph)
    flown.clock.begin()
    twist = np.zeros(6)
    twist[component] = 0.02 if component < 3 else 0.05
    flown.command(twist)
    start = len(flown.clock.heard['hand_pose'])
    flown.ticks(25)
    assert flown.status.state == WristStatus.TRACKING
    np.testing.assert_allclose(values(flown.status.commanded), twist, atol=1e-12)
    np.testing.assert_allclose(values(flown.status.achieved), twist, atol=1e-9)
    moved = (len(flown.clock.heard['hand_pose']) - start) / RATE
    expected = WRIST.target_pose(WRIST.home.pose, twist, moved)
    assert flown.pose.position == pytest.approx(expected.position, abs=1e-9)
    np.testing.assert_allclose(flown.pose.rotation, expected.rotation, atol=1e-9)


def test_a_command_of_all_six_is_slowed_to_the_leg_rates_and_keeps_its_direction(graph):
    flown = Flown(graph, joint_rate_limits=[0.03])
    flown.clock.begin()
    twist = np.array([0.05, -0.03, 0.02, 0.2, -0.1, 0.3])
    flown.command(twist)
    flown.ticks(30)
    status = flown.status
    assert status.state == WristStatus.SCALED
    assert 0.1 < status.scale_factor < 0.9
    assert {limit.kind for limit in status.limits} == {LimitAtWork.RATE}
    achieved = np.array(values(status.achieved))
    np.testing.assert_allclose(achieved, status.scale_factor * twist, atol=2e-3)
    fastest = max(abs(x) for c in flown.clock.heard['joint_command'] for x in c.velocity)
    assert 0.029 < fastest <= 0.03 * (1.0 + 1e-8)


def test_a_command_in_the_forearm_frame_is_turned_into_hand_axes_all_of_it(graph):
    pose = Pose(turned(IDENTITY, (0.1, -0.2, 0.3), 1.0), (0.0, 0.0, 0.43))
    flown = Flown(graph, initial_positions=list(WRIST.assembly_at(pose)))
    flown.clock.begin()
    flown.command((0.01, 0.0, 0.0, 0.0, 0.0, 0.02), frame='forearm')
    flown.ticks(3)
    expected = [*(0.01 * pose.rotation[:, 0]), *(0.02 * pose.rotation[:, 2])]
    status = next(s for s in flown.clock.heard['wrist_status'] if any(values(s.commanded)))
    np.testing.assert_allclose(values(status.commanded), expected, atol=1e-9)


def test_at_the_end_of_the_stroke_it_stops_and_backs_out(graph):
    flown = Flown(graph, joint_upper_limits=[HOME[0] + 0.02], joint_rate_limits=[math.inf])
    flown.clock.begin()
    flown.command((0.0, 0.0, 0.1, 0.0, 0.0, 0.0))
    flown.ticks(25)
    assert flown.status.state == WristStatus.LIMITED
    assert 'at its limit of 0.511 m' in flown.status.message
    assert {limit.kind for limit in flown.status.limits} == {LimitAtWork.POSITION}
    longest = max(x for c in flown.clock.heard['joint_command'] for x in c.position)
    assert HOME[0] + 0.0199 < longest <= HOME[0] + 0.02 + 1e-8
    edge = flown.pose.position[2]
    flown.command((0.0, 0.0, -0.1, 0.0, 0.0, 0.0))
    flown.ticks(5)
    assert flown.status.state == WristStatus.TRACKING
    assert flown.pose.position[2] < edge - 0.005


@pytest.mark.parametrize('sign', [1.0, -1.0])
def test_near_lock_at_a_quarter_turn_it_slows_stops_short_and_backs_out(graph, sign):
    """Turned by 90° about z the legs lose a direction: the paper's yaw is not about x here."""
    flown = Flown(graph, joint_rate_limits=[math.inf])
    flown.clock.begin()
    flown.command((0.0, 0.0, 0.0, 0.0, 0.0, sign * 1.0))
    flown.ticks(200)
    statuses = flown.clock.heard['wrist_status']
    margins = [status.margin for status in statuses]
    assert min(margins) > EDGE
    assert margins[-1] < 0.05
    rates = [abs(status.achieved.angular.z) for status in statuses[-150:]]
    assert rates == pytest.approx(sorted(rates, reverse=True), abs=2e-3)  # ever slower
    assert flown.status.state == WristStatus.LIMITED
    assert 'lock' in flown.status.message
    turned_by = 2.0 * math.atan2(flown.pose.quaternion[1], flown.pose.quaternion[0])
    assert 1.2 < sign * turned_by < math.pi / 2
    flown.command((0.0, 0.0, 0.0, 0.0, 0.0, -sign * 1.0))
    flown.ticks(5)
    assert flown.status.state == WristStatus.TRACKING
    assert flown.status.margin > margins[-1]


def test_tilted_until_the_legs_lose_a_direction_it_backs_out(graph):
    flown = Flown(graph, joint_rate_limits=[math.inf])
    flown.clock.begin()
    flown.command((0.0, 0.0, 0.0, 1.0, 0.0, 0.0))
    flown.ticks(250)
    assert flown.status.state == WristStatus.LIMITED
    assert EDGE < flown.status.margin < 0.05
    flown.command((0.0, 0.0, 0.0, -1.0, 0.0, 0.0))
    flown.ticks(5)
    assert flown.status.state == WristStatus.TRACKING


def test_a_platform_of_other_anchors_starts_at_its_own_home(graph):
    raised = [(x, y, 0.03 * (-1) ** leg) for leg, (x, y, _) in enumerate(WRIST.platform)]
    wrist = make_wrist('stewart', platform_anchors=raised)
    graph.start(Resolver, 'stewart', platform_anchors=[float(x) for p in raised for x in p])
    poses = graph.listen(PoseStamped, 'hand_pose')
    commands = graph.listen(JointState, 'joint_command')
    graph.until(lambda: poses and commands)
    assert list(commands[-1].position) == pytest.approx(wrist.home, abs=1e-12)
    assert pose_of(poses[-1].pose).position == pytest.approx((0.0, 0.0, wrist.home_height))


def test_half_a_platform_is_refused_in_one_sentence(graph):
    with pytest.raises(WristError, match='base_anchors has 9 numbers; give six points of three'):
        graph.start(Resolver, 'stewart', base_anchors=[0.1] * 9)
