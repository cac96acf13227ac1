"""Leg lengths in, proved poses out; and what must never become a pose."""

import math
from pathlib import Path

import numpy as np
import pytest
from builtin_interfaces.msg import Time
from diagnostic_msgs.msg import DiagnosticArray, DiagnosticStatus
from geometry_msgs.msg import PoseWithCovarianceStamped, TwistStamped
from sensor_msgs.msg import JointState

from wrist_control import WristError, make_wrist
from wrist_control.nodes import stewart_forward_kinematics
from wrist_control.nodes.stewart_forward_kinematics import StewartForwardKinematics
from wrist_control.rotations import IDENTITY, Pose, rates_between, turned
from wrist_interfaces.msg import ForwardKinematicsStatus

WRIST = make_wrist('stewart')
LEGS = [f'leg_{leg}' for leg in range(1, 7)]
HOME = tuple(WRIST.home)
INTERFACES = (Path(__file__).resolve().parents[1] / 'docs' / 'interfaces.md').read_text()


class Watched:
    """A forward-kinematics node, and everything that it says."""

    def __init__(self, graph, **parameters):
        self.graph = graph
        self.node = graph.start(StewartForwardKinematics, **parameters)
        self.poses = graph.listen(PoseWithCovarianceStamped, 'platform_pose')
        self.twists = graph.listen(TwistStamped, 'platform_twist')
        self.statuses = graph.listen(ForwardKinematicsStatus, 'forward_kinematics_status')
        self.diagnostics = graph.listen(DiagnosticArray, '/diagnostics')
        self.publisher = graph.publisher(JointState, 'joint_states')
        graph.until(lambda: graph.outside.count_publishers('forward_kinematics_status'))
        self.stamp = 10.0

    def send(self, lengths, names=LEGS, velocities=(), after=0.1):
        self.stamp += after
        message = JointState(
            name=list(names),
            position=[float(x) for x in lengths],
            velocity=[float(x) for x in velocities],
        )
        nanoseconds = round(self.stamp * 1e9)
        message.header.stamp = Time(sec=nanoseconds // 10**9, nanosec=nanoseconds % 10**9)
        self.publisher.publish(message)
        return message

    def status_of(self, *arguments, **named):
        """Send a reading, and return the status that belongs to it."""
        stamp = self.send(*arguments, **named).header.stamp
        self.graph.until(lambda: self.statuses and self.statuses[-1].header.stamp == stamp)
        self.graph.spin(0.05)
        return self.statuses[-1]

    def begin(self):
        self.graph.until(lambda: self.status_of(HOME).status == ForwardKinematicsStatus.CONVERGED)
        return len(self.poses), len(self.twists)

    def part(self, ending):
        """Wait for the diagnostics, and return the newest of their parts with such a name."""
        self.graph.until(lambda: self.diagnostics)
        return next(
            status for status in self.diagnostics[-1].status if status.name.endswith(ending)
        )

    def values(self, ending):
        return {value.key: value.value for value in self.part(ending).values}

    def refused(self, reason):
        """Wait until something is refused for a reason; return the last such sentence."""
        key = f'refused joint_states: {reason}'
        self.graph.until(lambda: int(self.values(': input').get(key, 0)) > 0)
        return self.values(': state')['last refused']


def pose_of(message):
    pose = message.pose.pose
    turn, where = pose.orientation, pose.position
    return Pose((turn.w, turn.z, turn.y, turn.x), (where.x, where.y, where.z))


def assert_same_pose(found, expected, tolerance=1e-12):
    assert found.position == pytest.approx(expected.position, abs=tolerance)
    np.testing.assert_allclose(found.rotation, expected.rotation, atol=tolerance)


# Good readings


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
    assert_same_pose(pose_of(watched.poses[-1]), pose)
    assert watched.poses[-1].header == status.header
    assert status.header.frame_id == 'forearm'


def test_legs_may_come_in_any_order_with_a_prefix_and_among_other_joints(graph):
    watched = Watched(graph, joint_prefix='left_', base_frame='base')
    pose = Pose(turned(IDENTITY, (0.05, -0.04, 0.06), 1.0), (0.01, -0.01, 0.44))
    joints = list(zip([f'left_{leg}' for leg in LEGS], WRIST.assembly_at(pose), strict=True))
    joints = [('elbow', math.nan), *reversed(joints), ('leg_1', 7.0)]
    names, lengths = zip(*joints, strict=True)
    graph.until(lambda: watched.status_of(lengths, names).status == 0)
    assert_same_pose(pose_of(watched.poses[-1]), pose)
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
    watched = Watched(graph, length_noise=noise)
    pose = Pose(turned(IDENTITY, (0.1, -0.15, 0.2), 1.0), (0.02, -0.01, 0.44))
    lengths = np.array(WRIST.assembly_at(pose))
    graph.until(lambda: watched.status_of(lengths).status == 0)
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
    before = pose_of(watched.poses[-1])
    watched.status_of(ends[1], after=dt)
    after = pose_of(watched.poses[-1])
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
    assert_same_pose(pose_of(watched.poses[-1]), pose)


# Readings that must not become a pose


def changed(index, value):
    lengths = list(HOME)
    lengths[index] = value
    return lengths


BAD = {
    'a missing leg': (HOME[:5], LEGS[:5], 'wrong joint names', 'leg_6 is named 0 times'),
    'a repeated leg': ((*HOME, 0.49), [*LEGS, 'leg_2'], 'wrong joint names', 'leg_2 is named 2'),
    'no joints': ((), (), 'wrong joint names', 'leg_1 is named 0 times'),
    'too few values': (HOME[:5], LEGS, 'wrong length', '6 joint names and 5 values'),
    'too many values': ((*HOME, 1.0), LEGS, 'wrong length', '6 joint names and 7 values'),
    'nan': (changed(2, math.nan), LEGS, 'not finite', 'leg_3 is nan'),
    'inf': (changed(2, math.inf), LEGS, 'not finite', 'leg_3 is inf'),
    'zero': (changed(3, 0.0), LEGS, 'impossible length', 'leg_4 is 0.0'),
    'negative': (changed(3, -0.5), LEGS, 'impossible length', 'leg_4 is -0.5'),
    'too long': (changed(4, 0.75), LEGS, 'outside its limits', 'leg_5 is 0.75 m long; valid'),
    'too short': (changed(4, 0.25), LEGS, 'outside its limits', 'leg_5 is 0.25 m long; valid'),
    'a jump': (changed(1, 0.56), LEGS, 'jump', 'leg_2 jumped by 0.0691703 m in 0.1 s'),
}


@pytest.mark.parametrize('case', BAD)
def test_a_bad_reading_is_refused_counted_and_named_and_the_pose_not_published_again(graph, case):
    lengths, names, reason, says = BAD[case]
    watched = Watched(graph, joint_lower_limits=[0.3], joint_upper_limits=[0.7])
    poses, _ = watched.begin()
    statuses = len(watched.statuses)
    watched.send(lengths, names, velocities=())
    assert says in watched.refused(reason)
    assert len(watched.poses) == poses
    assert len(watched.statuses) == statuses
    assert watched.status_of(HOME).status == ForwardKinematicsStatus.CONVERGED
    assert len(watched.poses) == poses + 1


def test_lengths_that_contradict_each_other_are_unreachable_by_name(graph):
    watched = Watched(graph)
    poses, _ = watched.begin()
    status = watched.status_of(changed(0, 2.5))
    assert status.status == ForwardKinematicsStatus.UNREACHABLE
    assert 'leg_1 at 2.5 m and leg_2' in status.message
    assert status.error_bound == -1.0
    assert status.unique_radius == 0.0
    assert 'leg_1 at 2.5 m' in watched.refused('unreachable')
    assert len(watched.poses) == poses


def test_a_reading_older_than_the_last_is_refused(graph):
    watched = Watched(graph)
    poses, _ = watched.begin()
    watched.send(HOME, after=-0.05)
    assert '0.050 s older' in watched.refused('older than the last')
    assert len(watched.poses) == poses


def test_a_clock_that_is_set_back_is_not_the_end(graph):
    watched = Watched(graph)
    poses, _ = watched.begin()
    assert watched.status_of(HOME, after=-5.0).status == ForwardKinematicsStatus.CONVERGED
    assert len(watched.poses) == poses + 1


@pytest.mark.parametrize(
    ('velocities', 'reason', 'says'),
    [
        ([0.0] * 5, 'wrong length', '6 joint names and 5 values'),
        ([0.0, math.nan, 0.0, 0.0, 0.0, 0.0], 'impossible velocity', 'leg_2 is nan m/s'),
        ([0.0, 0.0, math.inf, 0.0, 0.0, 0.0], 'impossible velocity', 'leg_3 is inf m/s'),
        ([0.0, 0.0, 0.0, 2.0, 0.0, 0.0], 'impossible velocity', 'leg_4 is 2 m/s'),
    ],
)
def test_bad_leg_rates_cost_the_twist_and_not_the_pose(graph, velocities, reason, says):
    watched = Watched(graph)
    poses, twists = watched.begin()
    watched.status_of(HOME, velocities=velocities)
    assert (len(watched.poses), len(watched.twists)) == (poses + 1, twists)
    assert says in watched.refused(reason)


def test_near_lock_the_status_says_so_and_no_pose_is_published(graph):
    """Level, and turned by nearly 90° about z: [Nguyen1991]'s legs lose a direction there."""
    watched = Watched(graph, jump_limit=math.inf)
    poses, _ = watched.begin()
    for turn in np.radians([10.0, 20.0, 30.0, 40.0, 50.0, 60.0, 70.0, 80.0, 87.0, 89.8]):
        pose = Pose(turned(IDENTITY, (0.0, 0.0, float(turn)), 1.0), (0.0, 0.0, 0.4318))
        status = watched.status_of(WRIST.assembly_at(pose))
        if status.status != ForwardKinematicsStatus.CONVERGED:
            break
        poses += 1
        assert_same_pose(pose_of(watched.poses[-1]), pose, 1e-9)
    assert status.status == ForwardKinematicsStatus.NEAR_SINGULAR
    assert len(watched.poses) == poses
    graph.until(lambda: watched.part(': state').level == DiagnosticStatus.WARN)


def test_a_start_where_the_lengths_fit_several_poses_says_so_until_they_do_not(graph):
    watched = Watched(graph)
    lengths = ambiguous()
    graph.until(lambda: watched.status_of(lengths).status == ForwardKinematicsStatus.UNPROVEN)
    for _ in range(3):
        status = watched.status_of(lengths)
        assert status.status == ForwardKinematicsStatus.UNPROVEN
        assert 'the lengths alone also fit' in status.message
    assert watched.poses == []
    assert watched.status_of(HOME, after=2.0).status == ForwardKinematicsStatus.CONVERGED
    assert len(watched.poses) == 1


def ambiguous():
    """Return lengths that fit several poses, though home leads to one of them."""
    rng = np.random.default_rng(0)
    while True:
        lengths = HOME[0] + rng.choice([-0.1, 0.1], 6)
        if WRIST.forward_kinematics.cold_start(tuple(lengths)).others:
            return lengths


def test_after_a_gap_the_search_from_home_starts_again(graph):
    watched = Watched(graph, gap_limit=0.5)
    poses, _ = watched.begin()
    assert watched.status_of(ambiguous(), after=0.6).status == ForwardKinematicsStatus.UNPROVEN
    assert len(watched.poses) == poses


def test_diagnostics_say_when_no_pose_has_come_for_long(graph):
    watched = Watched(graph, gap_limit=0.5)
    watched.begin()
    graph.until(lambda: watched.part(': state').message.startswith('No good pose for'))
    assert watched.part(': state').level == DiagnosticStatus.WARN


# Parameters and processes


def test_every_parameter_says_what_it_is_and_is_in_the_interfaces_document(graph):
    node = graph.start(StewartForwardKinematics)
    for spec in stewart_forward_kinematics.SPECS:
        descriptor = node.describe_parameter(spec.name)
        assert descriptor.description, spec.name
        assert descriptor.additional_constraints.startswith('valid: '), spec.name
        assert f'`{spec.name}`' in INTERFACES, spec.name


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
