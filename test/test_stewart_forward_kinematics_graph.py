"""Leg lengths in, proved poses out; and the parameters of the node that does it."""

import math
from pathlib import Path

import numpy as np
import pytest
from sensor_msgs.msg import JointState

from wrist_control import WristError, make_wrist
from wrist_control.nodes import stewart_forward_kinematics
from wrist_control.nodes.stewart_forward_kinematics import StewartForwardKinematics
from wrist_control.rotations import IDENTITY, Pose, rates_between, turned
from wrist_interfaces.msg import ForwardKinematicsStatus

from .stewart_flown import pose_of
from .stewart_readings import HOME, LEGS, WRIST, Watched, assert_same_pose

DOCS = Path(__file__).resolve().parents[1] / 'docs'
DOCUMENTED = (DOCS / 'interfaces.md').read_text() + (DOCS / 'wrists.md').read_text()


def test_the_pose_is_that_of_the_lengths_with_its_proof(graph):
    watched = Watched(graph)
    watched.begin()
    pose = Pose(turned(IDENTITY, (0.05, -0.04, 0.06), 1.0), (0.01, -0.01, 0.44))
    status = watched.status_of(WRIST.assembly_at(pose))
    assert status.status == ForwardKinematicsStatus.CONVERGED
    assert status.error_bound < 1e-12
    assert status.unique_radius > 0.01
    assert status.iterations > 0
    assert 'proved' in status.message
    assert_same_pose(pose_of(watched.poses[-1].pose.pose), pose)
    assert watched.poses[-1].header == status.header
    assert status.header.frame_id == 'forearm'


def test_legs_may_come_in_any_order_with_a_prefix_and_among_other_joints(graph):
    watched = Watched(graph, joint_prefix='left_', base_frame='base')
    pose = Pose(turned(IDENTITY, (0.05, -0.04, 0.06), 1.0), (0.01, -0.01, 0.44))
    joints = list(zip([f'left_{leg}' for leg in LEGS], WRIST.assembly_at(pose), strict=True))
    joints = [('elbow', math.nan), *reversed(joints), ('leg_1', 7.0)]
    names, lengths = zip(*joints, strict=True)
    graph.until(lambda: watched.status_of(lengths, names).status == 0)
    assert_same_pose(pose_of(watched.poses[-1].pose.pose), pose)
    assert watched.poses[-1].header.frame_id == 'base'


def test_a_reading_without_a_stamp_counts_as_just_made(graph):
    watched = Watched(graph)
    bare = JointState(name=LEGS, position=list(HOME))

    def heard():
        watched.publisher.publish(bare)
        return watched.poses

    graph.until(heard)
    now = graph.outside.get_clock().now().nanoseconds
    stamp = watched.poses[-1].header.stamp
    assert abs(now - stamp.sec * 10**9 - stamp.nanosec) < 5e9


def test_until_the_first_reading_the_status_says_that_there_is_no_data(graph):
    watched = Watched(graph)
    graph.until(lambda: len(watched.statuses) > 1)
    assert {status.status for status in watched.statuses} == {ForwardKinematicsStatus.NO_DATA}
    assert watched.statuses[-1].error_bound == -1.0
    assert 'leg_1 to leg_6' in watched.statuses[-1].message
    assert watched.poses == []


def test_the_covariance_is_the_spread_of_poses_from_noisy_lengths(graph):
    """Finite differences of the pose itself, leg by leg: J Σ Jᵀ in base axes."""
    noise = [1e-4, 2e-4, 3e-4, 4e-4, 5e-4, 6e-4]
    watched = Watched(graph, length_noise=noise, jump_limit=math.inf)
    watched.begin()
    pose = Pose(turned(IDENTITY, (0.1, -0.15, 0.2), 1.0), (0.02, -0.01, 0.44))
    lengths = np.array(WRIST.assembly_at(pose))
    assert watched.status_of(lengths).status == ForwardKinematicsStatus.CONVERGED
    columns = []
    for leg in range(6):
        ends = [
            WRIST.forward_kinematics.solve(tuple(lengths + step * np.eye(6)[leg]), pose).pose
            for step in (1e-6, -1e-6)
        ]
        shift = np.subtract(ends[0].position, ends[1].position)
        # Turns in platform axes, then in base axes by the textbook's matrix.
        turn = pose.rotation.T @ rates_between(ends[1].quaternion, ends[0].quaternion, 1.0)
        columns.append(np.concatenate([shift, turn]) / 2e-6)
    jacobian = np.array(columns).T
    expected = jacobian @ np.diag(np.square(noise)) @ jacobian.T
    found = np.array(watched.poses[-1].pose.covariance).reshape(6, 6)
    np.testing.assert_allclose(found, expected, atol=1e-6 * np.abs(expected).max())
    assert np.linalg.eigvalsh(found).min() > 0.0


def test_the_twist_is_the_change_of_the_pose_in_platform_axes(graph):
    watched = Watched(graph, platform_frame='platform')
    watched.begin()
    twist, dt = (0.02, -0.03, 0.01, 0.1, -0.05, 0.08), 1e-4
    pose = Pose(turned(IDENTITY, (0.05, -0.04, 0.06), 1.0), (0.01, -0.01, 0.44))
    ends = [WRIST.assembly_at(WRIST.target_pose(pose, twist, share * dt)) for share in (-0.5, 0.5)]
    rates = np.subtract(ends[1], ends[0]) / dt
    watched.status_of(WRIST.assembly_at(pose), velocities=rates)
    watched.status_of(ends[0])
    before = pose_of(watched.poses[-1].pose.pose)
    watched.status_of(ends[1], after=dt)
    after = pose_of(watched.poses[-1].pose.pose)
    travel = np.subtract(after.position, before.position) / dt
    expected = [
        *pose.rotation @ travel,
        *rates_between(before.quaternion, after.quaternion, dt),
    ]
    found = watched.twists[-1]
    assert found.header.frame_id == 'platform'
    linear, angular = found.twist.linear, found.twist.angular
    values = [linear.x, linear.y, linear.z, angular.x, angular.y, angular.z]
    np.testing.assert_allclose(values, expected, atol=1e-6)
    np.testing.assert_allclose(values, twist, atol=1e-6)


@pytest.mark.parametrize('velocities', [[], [math.nan] * 6])
def test_without_leg_rates_there_is_a_pose_and_no_twist(graph, velocities):
    watched = Watched(graph)
    poses, twists = watched.begin()
    watched.status_of(HOME, velocities=velocities)
    assert (len(watched.poses), len(watched.twists)) == (poses + 1, twists)


def test_other_platforms_are_described_by_their_anchors(graph):
    raised = [(x, y, 0.03 * (-1) ** leg) for leg, (x, y, _) in enumerate(WRIST.platform)]
    wrist = make_wrist('stewart', platform_anchors=raised)
    watched = Watched(graph, platform_anchors=[float(x) for point in raised for x in point])
    pose = Pose(turned(IDENTITY, (0.02, -0.04, 0.03), 1.0), (0.01, -0.01, 0.43))
    graph.until(lambda: watched.status_of(wrist.assembly_at(pose)).status == 0)
    assert_same_pose(pose_of(watched.poses[-1].pose.pose), pose)


def test_every_parameter_says_what_it_is_and_is_in_the_documents(graph):
    node = graph.start(StewartForwardKinematics)
    for spec in stewart_forward_kinematics.SPECS:
        descriptor = node.describe_parameter(spec.name)
        assert descriptor.description, spec.name
        assert descriptor.additional_constraints.startswith('valid: '), spec.name
        assert f'`{spec.name}`' in DOCUMENTED, spec.name


@pytest.mark.parametrize(
    ('parameters', 'sentence'),
    [
        ({'length_noise': [1e-4, 1e-4]}, 'length_noise has 2 values; give 1 for all legs or 6'),
        ({'length_noise': [-1e-4]}, 'length_noise is -0.0001; valid is'),
        ({'length_noise': [math.inf]}, r'length_noise is \[inf\]; give finite values'),
        ({'jump_limit': 0.0}, 'jump_limit is 0.0; valid is'),
        ({'platform_anchors': [0.1] * 17}, 'platform_anchors has 17 numbers; give six points'),
        ({'platform_anchors': [0.1] * 18}, 'do not hold the platform at home'),
        ({'base_radius': math.nan}, 'base_radius is nan; valid is'),
        ({'joint_lower_limits': [0.5], 'joint_upper_limits': [0.4]}, 'limits of leg_1 cross'),
        ({'joint_upper_limits': [0.4, 0.5]}, 'joint_upper_limits has 2 values; give 1 for all'),
    ],
)
def test_it_refuses_to_start_with_a_bad_value(graph, parameters, sentence):
    with pytest.raises(WristError, match=sentence):
        graph.start(StewartForwardKinematics, **parameters)
