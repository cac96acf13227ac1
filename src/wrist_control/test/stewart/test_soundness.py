"""What the forward kinematics prove is so: errors, radii, and the branch."""

import math

import numpy as np
from hypothesis import given, settings

from wrist_control.rotations import Pose, about_z, turned
from wrist_control.stewart import general, quadratics, stages, tracking
from wrist_control.stewart.forward_kinematics import Status

from .platforms import FK, HOME, SIZE, WRIST, apart, exactly, lengths_of, poses, random_poses


@given(poses(0.12, 0.7))
@settings(max_examples=60, deadline=None)
def test_the_true_error_stays_within_its_bound_to_nineteen_digits(pose):
    lengths = lengths_of(pose)
    solution = FK.solve(lengths, pose)
    if solution.status != Status.CONVERGED:
        return
    d, rotation = exactly(lengths, solution.pose)
    got = solution.pose.rotation.T.astype(np.longdouble)
    miss = np.concatenate([d - solution.pose.position, SIZE * (rotation - got)[:, :2].ravel()])
    assert np.sqrt((miss * miss).sum()) <= solution.error_bound
    assert solution.error_bound < 1e-11


def test_answers_are_right_to_a_hundred_trillionth():
    for pose in random_poses(100, 0.08, 0.5):
        lengths = lengths_of(pose)
        solution = FK.solve(lengths)
        d, rotation = exactly(lengths, solution.pose)
        assert np.abs(d - solution.pose.position).max() < 1e-14 * np.linalg.norm(pose.position)
        assert np.abs(rotation - solution.pose.rotation.T).max() < 1e-14


def test_no_two_assemblies_are_nearer_than_either_says():
    pairs = 0
    for pose in random_poses(40, 0.12, 0.7):
        found = FK.assemblies(lengths_of(pose))
        for one in found:
            for other in found:
                if one is not other:
                    pairs += 1
                    assert apart(one.pose, other.pose) > max(
                        one.unique_radius, other.unique_radius
                    )
    assert pairs > 50


def test_nothing_else_within_the_unique_radius_fits_the_lengths():
    rng = np.random.default_rng(3)
    for pose in random_poses(6, 0.1, 0.6):
        lengths = np.array(lengths_of(pose))
        solution = FK.solve(tuple(lengths), pose)
        for _ in range(300):
            reach = solution.unique_radius * rng.uniform(0.05, 1.0)
            near = Pose(
                turned(pose.quaternion, tuple(rng.normal(size=3).tolist()), 0.4 * reach / SIZE),
                tuple((np.array(pose.position) + 0.4 * reach * rng.normal(size=3)).tolist()),
            )
            gap = apart(near, pose)
            if 0.0 < gap < solution.unique_radius:
                # A Newton step of the proof cannot be all of the gap: the lengths differ.
                assert np.abs(np.array(lengths_of(near)) - lengths).max() > 1e-3 * gap


def test_a_pose_close_to_lock_does_not_claim_its_twin_away():
    # Two poses on either side of a quarter turn of yaw have the same lengths.
    for yaw in (1.2, 1.4, 1.5, 1.54):
        one = Pose(about_z(yaw), HOME.position)
        twin = next(
            other.pose
            for other in FK.assemblies(lengths_of(one))
            if 1e-6 < apart(other.pose, one) < 2.5 * SIZE * (0.5 * math.pi - yaw) * 2.0
        )
        solution = FK.solve(lengths_of(one), one)
        assert solution.unique_radius < apart(one, twin)


def test_a_way_that_crosses_lock_is_not_called_proved():
    # Home cannot lead to a pose beyond lock: what fits there must not be called CONVERGED.
    beyond = Pose(about_z(2.0), HOME.position)
    solution = FK.solve(lengths_of(beyond))
    assert solution.status != Status.CONVERGED or apart(solution.pose, beyond) > 0.1 * SIZE
    side = math.copysign(1.0, WRIST.home.hadamard_ratio)
    if solution.status == Status.CONVERGED:
        assert side * WRIST.assembly_at(solution.pose).hadamard_ratio > 0.0


@given(poses(0.15, 0.9))
@settings(max_examples=60, deadline=None)
def test_what_home_leads_to_lies_on_its_own_side_of_lock(pose):
    solution = FK.solve(lengths_of(pose))
    if solution.status == Status.CONVERGED:
        assert WRIST.assembly_at(solution.pose).hadamard_ratio * WRIST.home.hadamard_ratio > 0.0
        assert (
            apart(solution.pose, pose) < 1e-11
            or WRIST.assembly_at(pose).hadamard_ratio * WRIST.home.hadamard_ratio < 0.0
        )


def test_the_two_ways_agree_on_the_pose_and_both_bounds_hold():
    any_platform = general.scaled(WRIST.platform, WRIST.base, SIZE)
    for pose in random_poses(20, 0.08, 0.5):
        lengths = lengths_of(pose)
        start = stages.unknowns(pose, SIZE)
        fast = tracking.solve_planar(FK.planar, quadratics.right_side(FK.planar, lengths), start)
        slow = general.solve_general(any_platform, general.squares(any_platform, lengths), start)
        assert math.dist(fast.at, slow.at) <= fast.proof.error + slow.proof.error
