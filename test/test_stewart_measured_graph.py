"""The platform flown and its pose measured again, in one graph."""

import itertools
import math

import numpy as np
import pytest
import yaml
from geometry_msgs.msg import PoseStamped, PoseWithCovarianceStamped, TwistStamped
from sensor_msgs.msg import JointState
from std_srvs.srv import Trigger

from wrist_control.graph.processes import config_file
from wrist_control.nodes.joint_simulator import JointSimulator
from wrist_control.nodes.resolver import Resolver
from wrist_control.nodes.stewart_forward_kinematics import StewartForwardKinematics
from wrist_control.rotations import IDENTITY, Pose, turned
from wrist_interfaces.msg import ForwardKinematicsStatus, WristStatus

from .stewart_flown import HOME, LEGS, RATE, WRIST, Flown, pose_of, values

MOTION = [
    (0.02, 0.01, -0.02, 0.05, 0.0, 0.1),
    (-0.03, 0.0, 0.01, -0.1, 0.1, 0.0),
    (0.0, -0.02, 0.02, 0.0, -0.15, -0.2),
]


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

    def move(self):
        """Begin, and follow three twists for 0.6 s each."""
        self.clock.begin()
        for twist in MOTION:
            self.command(twist)
            self.ticks(30)

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


def test_the_measured_pose_is_the_hand_pose_while_it_moves(graph):
    flown = Closed(graph)
    flown.move()
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
    flown.move()
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
    graph.start(Resolver, 'stewart', require_joint_states=True)
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
