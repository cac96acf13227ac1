"""Forward kinematics: the right pose, for every platform, from every pose near by."""

import math

import numpy as np
import pytest
from hypothesis import given, settings

from wrist_control.rotations import IDENTITY, Pose, about_y, turned
from wrist_control.stewart import stages, tracking
from wrist_control.stewart.forward_kinematics import Status

from .platforms import (
    CROOKED,
    FK,
    HOME,
    SCATTERED,
    SIZE,
    WRIST,
    apart,
    lengths_of,
    poses,
    random_poses,
)


@given(poses(0.05, 0.3))
@settings(max_examples=60, deadline=None)
def test_home_leads_to_the_pose_that_made_the_lengths(pose):
    solution = FK.solve(lengths_of(pose))
    assert solution.status == Status.CONVERGED
    assert apart(solution.pose, pose) < 1e-14


@given(poses(0.06, 0.4), poses(0.003, 0.02))
@settings(max_examples=60, deadline=None)
def test_tracking_keeps_to_the_pose_before(pose, step):
    offset = np.subtract(step.position, HOME.position)
    near = Pose(turned(pose.quaternion, step.quaternion[:0:-1], 0.02), pose.position)
    near = near._replace(position=tuple(np.add(pose.position, offset).tolist()))
    solution = FK.solve(lengths_of(pose), near)
    assert solution.status == Status.CONVERGED
    assert apart(solution.pose, pose) <= solution.error_bound < 1e-12


@pytest.mark.parametrize('wrist', [CROOKED, SCATTERED], ids=['crooked', 'scattered'])
def test_any_twelve_anchors_are_solved(wrist):
    for pose in random_poses(20, 0.04, 0.3):
        solution = wrist.forward_kinematics.solve(lengths_of(pose, wrist))
        assert solution.status == Status.CONVERGED
        assert apart(solution.pose, pose) <= solution.error_bound < 1e-12


def test_scattered_planar_anchors_take_the_fast_way_and_crooked_ones_do_not():
    assert SCATTERED.forward_kinematics.planar is not None
    assert CROOKED.forward_kinematics.planar is None


def test_an_independent_solver_finds_the_same_pose():
    optimize = pytest.importorskip('scipy.optimize')
    p, b = np.array(WRIST.platform), np.array(WRIST.base)
    from scipy.spatial.transform import Rotation

    for pose in random_poses(10, 0.03, 0.2):
        lengths = lengths_of(pose)

        def miss(x, lengths=lengths):
            arms = p @ Rotation.from_rotvec(x[3:]).as_matrix().T
            return np.linalg.norm(x[:3] + arms - b, axis=1) - lengths

        found = optimize.fsolve(miss, [0, 0, HOME.position[2], 0, 0, 0], xtol=1e-13)
        solution = FK.solve(lengths)
        assert solution.pose.position == pytest.approx(found[:3], abs=1e-11)
        expected = Rotation.from_rotvec(found[3:]).as_matrix()
        assert pytest.approx(expected, abs=1e-11) == solution.pose.rotation.T


@pytest.mark.parametrize('turn', [0.5 * math.pi, -0.5 * math.pi])
def test_pitch_of_a_quarter_turn_is_no_singularity(turn):
    pose = Pose(about_y(turn), (0.05, 0.0, 0.45))
    near = Pose(about_y(turn - 0.01), (0.051, 0.001, 0.449))
    solution = FK.solve(lengths_of(pose), near)
    assert solution.status == Status.CONVERGED
    assert apart(solution.pose, pose) <= solution.error_bound < 1e-12


@given(poses(0.05, 0.3))
@settings(max_examples=30, deadline=None)
def test_the_mirror_image_below_the_base_is_never_taken_for_the_pose(pose):
    lengths = lengths_of(pose)
    x, y, z = pose.position
    a1, a2, a3, a4 = pose.quaternion
    mirrored = Pose((a1, a2, -a3, -a4), (x, y, -z))
    assert lengths_of(mirrored) == pytest.approx(lengths, rel=1e-13)
    below = FK.solve(lengths, mirrored)
    assert below.status == Status.CONVERGED
    assert apart(below.pose, mirrored) < 1e-12
    assert FK.solve(lengths).pose.position[2] > 0.0


def test_a_low_platform_is_solved_six_legs_at_a_time():
    low = Pose(turned(IDENTITY, (0.5, 0.2, 0.3), 1.0), (0.02, 0.01, 0.02))
    near = Pose(turned(IDENTITY, (0.5, 0.21, 0.3), 1.0), (0.021, 0.01, 0.021))
    assert not tracking.is_high_enough(stages.unknowns(low, SIZE))
    solution = FK.solve(lengths_of(low), near)
    assert solution.pose is not None
    assert apart(solution.pose, low) <= solution.error_bound < 1e-11


def test_tracking_from_its_own_answers_is_as_right_and_as_proved_as_from_any_pose():
    """What is kept of the last answer makes the next one faster, never different."""
    near = HOME
    for step in range(1000):
        phase = 2.0 * math.pi * step / 1000.0
        turn = (0.2 * math.sin(phase), 0.15 * math.sin(2.0 * phase), 0.25 * math.sin(phase))
        shift = 0.03 * math.sin(phase)
        pose = Pose(turned(HOME.quaternion, turn, 1.0), (shift, -shift, HOME.position[2] + shift))
        lengths = lengths_of(pose)
        own = FK.solve(lengths, near)
        copied = FK.solve(lengths, Pose(*near))
        assert own.status == copied.status == Status.CONVERGED
        assert own.error_bound < 1e-12
        np.testing.assert_allclose(own.pose.position, pose.position, rtol=0.0, atol=1e-14)
        np.testing.assert_allclose(own.pose.rotation, pose.rotation, rtol=0.0, atol=1e-13)
        np.testing.assert_allclose(own.pose.position, copied.pose.position, rtol=0.0, atol=1e-14)
        near = own.pose
