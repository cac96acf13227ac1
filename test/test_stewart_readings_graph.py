"""Readings of leg lengths that must never become a pose."""

import math

import numpy as np
import pytest
from diagnostic_msgs.msg import DiagnosticStatus

from wrist_control.rotations import IDENTITY, Pose, turned
from wrist_interfaces.msg import ForwardKinematicsStatus

from .stewart_flown import pose_of
from .stewart_readings import HOME, LEGS, WRIST, Watched, ambiguous, assert_same_pose


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
    'too long': (changed(4, 0.75), LEGS, 'outside its limits', 'leg_5 is at 0.75 m; valid'),
    'too short': (changed(4, 0.25), LEGS, 'outside its limits', 'leg_5 is at 0.25 m; valid'),
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


def test_near_lock_the_status_says_so_and_no_pose_is_published_until_home(graph):
    """Level, and turned by nearly 90° about z: [Nguyen1991]'s legs lose a direction there."""
    watched = Watched(graph, jump_limit=math.inf)
    poses, _ = watched.begin()
    for turn in np.radians([10.0, 20.0, 30.0, 40.0, 50.0, 60.0, 70.0, 80.0, 87.0, 89.8]):
        pose = Pose(turned(IDENTITY, (0.0, 0.0, float(turn)), 1.0), (0.0, 0.0, 0.4318))
        status = watched.status_of(WRIST.assembly_at(pose))
        if status.status != ForwardKinematicsStatus.CONVERGED:
            break
        poses += 1
        assert_same_pose(pose_of(watched.poses[-1].pose.pose), pose, 1e-9)
    assert status.status == ForwardKinematicsStatus.NEAR_SINGULAR
    assert 'drive it home' in status.message
    back = Pose(turned(IDENTITY, (0.0, 0.0, math.radians(80.0)), 1.0), (0.0, 0.0, 0.4318))
    status = watched.status_of(WRIST.assembly_at(back))
    assert status.status == ForwardKinematicsStatus.UNPROVEN
    assert 'drive it home' in status.message
    assert len(watched.poses) == poses
    graph.until(lambda: watched.part(': state').level == DiagnosticStatus.WARN)
    assert watched.status_of(HOME).status == ForwardKinematicsStatus.CONVERGED


def test_a_start_where_the_lengths_fit_several_poses_says_so_until_home(graph):
    watched = Watched(graph)
    lengths = ambiguous()
    graph.until(lambda: watched.status_of(lengths).status == ForwardKinematicsStatus.UNPROVEN)
    for _ in range(3):
        status = watched.status_of(lengths)
        assert status.status == ForwardKinematicsStatus.UNPROVEN
        assert 'the lengths alone may fit several' in status.message
    assert watched.poses == []
    assert watched.status_of(HOME, after=2.0).status == ForwardKinematicsStatus.CONVERGED
    assert len(watched.poses) == 1


def test_after_a_gap_the_platform_must_be_home_again(graph):
    watched = Watched(graph, gap_limit=0.5)
    poses, _ = watched.begin()
    assert watched.status_of(ambiguous(), after=0.6).status == ForwardKinematicsStatus.UNPROVEN
    assert len(watched.poses) == poses


def test_diagnostics_say_when_no_pose_has_come_for_long(graph):
    watched = Watched(graph, gap_limit=0.5)
    watched.begin()
    graph.until(lambda: watched.part(': state').message.startswith('No good pose for'))
    assert watched.part(': state').level == DiagnosticStatus.WARN


def test_a_reading_from_the_future_is_refused_and_blocks_no_other(graph):
    watched = Watched(graph)
    now = graph.outside.get_clock().now().nanoseconds * 1e-9
    watched.stamp = now - 5.0
    poses, _ = watched.begin()
    watched.stamp = graph.outside.get_clock().now().nanoseconds * 1e-9
    watched.status_of(HOME, after=-0.1)
    watched.send(HOME, after=0.9)
    assert 'synchronise the clocks' in watched.refused('stamp in the future')
    watched.stamp -= 0.75
    assert watched.status_of(HOME, after=0.0).status == ForwardKinematicsStatus.CONVERGED
    assert len(watched.poses) == poses + 2
