"""Nguyen's platform by topic only: six components, its limits, and its pose measured again."""

import itertools
import math

import numpy as np
import pytest
import yaml
from geometry_msgs.msg import PoseStamped, PoseWithCovarianceStamped, TwistStamped
from sensor_msgs.msg import JointState
from std_srvs.srv import Trigger

from wrist_control import WristError, make_wrist
from wrist_control.graph.processes import config_file
from wrist_control.nodes.joint_simulator import JointSimulator
from wrist_control.nodes.resolver import Resolver
from wrist_control.nodes.stewart_forward_kinematics import StewartForwardKinematics
from wrist_control.rotations import IDENTITY, Pose, turned
from wrist_control.wrists.stewart import EDGE
from wrist_interfaces.msg import ForwardKinematicsStatus, LimitAtWork, WristStatus

WRIST = make_wrist('stewart')
LEGS = [joint.name for joint in WRIST.joints]
HOME = list(WRIST.home)
RATE = 50.0
SIX = ('vx', 'vy', 'vz', 'p', 'q', 'r')


class Flown:
    """A resolver on a clock that the test ticks, and everything that it says."""

    def __init__(self, graph, **parameters):
        self.graph = graph
        self.clock = graph.lockstep(1.0 / RATE)
        common = {'use_sim_time': True, 'rate': RATE, 'command_timeout': 10.0}
        self.node = graph.start(Resolver, 'stewart', **{**common, **parameters})
        self.clock.listen({'wrist_status': WristStatus, 'hand_pose': PoseStamped})
        self.clock.listen({'joint_command': JointState})
        self.publisher = graph.publisher(TwistStamped, 'cmd_vel')

    def command(self, twist, frame=''):
        """Command a twist (vx, vy, vz, p, q, r) from the next tick on."""
        message = TwistStamped()
        message.header.frame_id = frame
        message.header.stamp = self.clock.heard['wrist_status'][-1].header.stamp
        linear, angular = message.twist.linear, message.twist.angular
        linear.x, linear.y, linear.z, angular.x, angular.y, angular.z = map(float, twist)
        self.publisher.publish(message)
        self.graph.spin(0.05)

    def ticks(self, count):
        for _ in range(count):
            self.clock.tick()

    @property
    def status(self):
        return self.clock.heard['wrist_status'][-1]

    @property
    def pose(self):
        return pose_of(self.clock.heard['hand_pose'][-1].pose)


def pose_of(pose):
    turn, where = pose.orientation, pose.position
    return Pose((turn.w, turn.z, turn.y, turn.x), (where.x, where.y, where.z))


def values(twist):
    linear, angular = twist.linear, twist.angular
    return [linear.x, linear.y, linear.z, angular.x, angular.y, angular.z]


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


# Resolver, simulated legs and forward kinematics in one graph


class Closed(Flown):
    """The three nodes of the platform, with the ready parameters."""

    def __init__(self, graph, **parameters):
        super().__init__(graph, **{**ready('stewart_resolver'), **parameters, 'rate': RATE})
        common = {'use_sim_time': True, 'rate': RATE}
        graph.start(JointSimulator, **{**ready('joint_simulator'), **common})
        graph.start(
            StewartForwardKinematics,
            **{**ready('stewart_forward_kinematics'), 'use_sim_time': True},
        )
        self.clock.listen(
            {
                'joint_states': JointState,
                'platform_pose': PoseWithCovarianceStamped,
                'platform_twist': TwistStamped,
                'forward_kinematics_status': ForwardKinematicsStatus,
            }
        )

    def measured(self):
        """Return pairs of what was meant and what was measured of it.

        The joints follow one tick later: each carries out the command of the tick before.
        """
        poses, measured = self.clock.heard['hand_pose'], self.clock.heard['platform_pose']
        by_stamp = {stamp_of(m): pose_of(m.pose.pose) for m in measured}
        stamps = [stamp_of(message) for message in poses]
        return [
            (pose_of(message.pose), by_stamp[after])
            for message, after in zip(poses, stamps[1:], strict=False)
            if after in by_stamp
        ]


def stamp_of(message):
    return message.header.stamp.sec * 10**9 + message.header.stamp.nanosec


def ready(node):
    return yaml.safe_load(config_file('stewart.yaml').read_text())[f'/**/{node}'][
        'ros__parameters'
    ]


MOTION = [
    (0.02, 0.01, -0.02, 0.05, 0.0, 0.1),
    (-0.03, 0.0, 0.01, -0.1, 0.1, 0.0),
    (0.0, -0.02, 0.02, 0.0, -0.15, -0.2),
]


def test_the_measured_pose_is_the_hand_pose_while_it_moves(graph):
    flown = Closed(graph)
    flown.clock.begin()
    for twist in MOTION:
        flown.command(twist)
        flown.ticks(30)
    pairs = flown.measured()
    assert len(pairs) > 85
    for meant, found in pairs:
        assert found.position == pytest.approx(meant.position, abs=1e-9)
        np.testing.assert_allclose(found.rotation, meant.rotation, atol=1e-9)
    travel = [math.dist(meant.position, pairs[0][0].position) for meant, _ in pairs]
    assert max(travel) > 0.01
    statuses = flown.clock.heard['forward_kinematics_status']
    assert {status.status for status in statuses[3:]} == {ForwardKinematicsStatus.CONVERGED}
    # The simulated legs' rates are those of the step: the twist is that of its middle.
    achieved = values(flown.clock.heard['wrist_status'][-2].achieved)
    found = values(flown.clock.heard['platform_twist'][-1].twist)
    np.testing.assert_allclose(found, achieved, atol=5e-3)


def test_reset_brings_the_platform_home_by_no_jump_and_is_measured_all_the_way(graph):
    flown = Closed(graph)
    flown.clock.begin()
    for twist in MOTION:
        flown.command(twist)
        flown.ticks(30)
    flown.command((0.0,) * 6)
    away = math.dist(flown.pose.position, WRIST.home.pose.position)
    assert away > 0.005
    answer = flown.graph.call(Trigger, 'stewart_resolver/reset', Trigger.Request())
    assert answer.success, answer.message
    before = len(flown.clock.heard['joint_command'])
    flown.ticks(60)
    way = flown.clock.heard['joint_command'][before - 1 :]
    steps = [
        abs(new - old)
        for a, b in itertools.pairwise(way)
        for old, new in zip(a.position, b.position, strict=True)
    ]
    assert 0.0 < max(steps) <= 0.05 / RATE * (1.0 + 1e-8)
    assert list(way[-1].position) == pytest.approx(HOME, abs=1e-12)
    assert flown.status.state == WristStatus.IDLE
    assert flown.status.time_lost == 0.0
    for meant, found in flown.measured()[-60:]:
        assert found.position == pytest.approx(meant.position, abs=1e-9)
        np.testing.assert_allclose(found.rotation, meant.rotation, atol=1e-9)
    assert flown.pose.position == pytest.approx(WRIST.home.pose.position, abs=1e-9)


def test_a_start_elsewhere_is_taken_over_from_the_measured_legs(graph):
    pose = Pose(turned(IDENTITY, (0.06, -0.05, 0.1), 1.0), (0.02, -0.01, 0.44))
    lengths = list(WRIST.assembly_at(pose))
    graph.start(JointSimulator, joints=LEGS, initial_positions=lengths)
    states = graph.listen(JointState, 'joint_states')
    graph.until(lambda: states)
    graph.start(Resolver, 'stewart')
    poses = graph.listen(PoseStamped, 'hand_pose')
    commands = graph.listen(JointState, 'joint_command')
    graph.until(
        lambda: commands and list(commands[-1].position) == pytest.approx(lengths, abs=1e-12)
    )
    graph.until(lambda: poses and poses[-1].header.stamp == commands[-1].header.stamp)
    found = pose_of(poses[-1].pose)
    assert found.position == pytest.approx(pose.position, abs=1e-9)
    np.testing.assert_allclose(found.rotation, pose.rotation, atol=1e-9)


def test_a_start_that_the_lengths_do_not_tell_is_a_fault_and_nothing_moves(graph):
    """Taken for granted, home's pose would be commanded from elsewhere: a jump."""
    graph.start(Resolver, 'stewart')
    statuses = graph.listen(WristStatus, 'wrist_status')
    publisher = graph.publisher(JointState, 'joint_states')

    def stopped():
        publisher.publish(JointState(name=LEGS, position=[0.2, 2.9, 0.2, 2.9, 0.2, 2.9]))
        return statuses and statuses[-1].state == WristStatus.FAULT

    graph.until(stopped)
    assert 'no pose' in statuses[-1].message


# Other platforms


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
