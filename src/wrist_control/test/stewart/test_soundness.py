"""What the forward kinematics prove is so: errors, radii, and the branch."""

import math
from fractions import Fraction

import numpy as np
import pytest
from hypothesis import given, settings

from wrist_control.rotations import IDENTITY, Pose, about_x, about_z, turned
from wrist_control.stewart import batch, general, quadratics, stages, tracking
from wrist_control.stewart.certificate import ROUNDING, Proof
from wrist_control.stewart.forward_kinematics import Solutions, Status

from .platforms import (
    FK,
    HOME,
    SCATTERED,
    SIZE,
    WRIST,
    apart,
    exactly,
    lengths_of,
    poses,
    random_poses,
)


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


def worst_axes(pose, error, sign):
    """Return axes u, v that far from a pose's, in the direction where (S10) is reached.

    The pose is turned about x, so that x is u: v is stretched, and turned about u.
    """
    u, v, w = pose.rotation
    pollution = math.tan(math.acos(abs(pose.quaternion[0])))
    stretch, turn = error * np.array([pollution, sign]) / math.hypot(pollution, 1.0)
    return u, v + stretch * v + turn * w


TRACES = (0.06, 0.2, 0.4999, 0.5001, 1.0, 2.0, 3.9)


def rotation_about_x(trace):
    """Return the pose at home's place turned about x, where 1 + tr C is a given number."""
    return Pose(about_x(2.0 * math.acos(0.5 * math.sqrt(trace))), HOME.position)


def unknowns_with(pose, u, v):
    x, y, z = (one / SIZE for one in pose.position)
    return tuple(float(one) for one in (x, y, u[0], v[0], u[1], v[1], z, u[2], v[2]))


@pytest.mark.parametrize('trace', TRACES)
@pytest.mark.parametrize('sign', [-1.0, 1.0])
def test_the_pose_made_of_skewed_axes_is_within_its_bound(trace, sign):
    error, pose = 1e-6, rotation_about_x(trace)
    at = unknowns_with(pose, *worst_axes(pose, error, sign))
    solution = FK._solution(stages.Track(at, 0, Proof(error, 1.0), True))
    assert apart(solution.pose, pose) <= solution.error_bound
    many = batch.Tracks(np.array([at]).T, np.zeros(1), np.full(1, error), np.ones(1), np.ones(1))
    found = Solutions.unsolved(1)
    FK._fill(found, slice(1), many._replace(followed=np.array([True])))
    other = Pose(tuple(found.quaternion[0].tolist()), tuple(found.position[0].tolist()))
    assert apart(other, pose) <= found.error_bound[0] == pytest.approx(solution.error_bound)


def test_the_bound_on_a_pose_made_of_skewed_axes_is_nearly_reached():
    """2 / √trace is what a trace of just above 1/2 makes of an error: √8 of 3."""
    error, pose = 1e-6, rotation_about_x(0.5001)
    used = []
    for sign in (-1.0, 1.0):
        at = unknowns_with(pose, *worst_axes(pose, error, sign))
        solution = FK._solution(stages.Track(at, 0, Proof(error, 1.0), True))
        used.append(apart(solution.pose, pose) / solution.error_bound)
    assert 0.93 < max(used) < 0.95


def test_rounding_of_the_pose_itself_is_within_its_bound():
    """Unknowns without any error, rounded once: what making a pose of them adds."""
    rng, used = np.random.default_rng(0), []
    for _ in range(3000):
        rotation = extended_rotation(rng.normal(size=4))
        u, v = rotation[:, 0], rotation[:, 1]
        at = unknowns_with(Pose(IDENTITY), u, v)
        solution = FK._solution(stages.Track(at, 0, Proof(0.0, 1.0), True))
        miss = (extended_rotation(solution.pose.quaternion) - rotation)[:, :2]
        used.append(SIZE * float(np.sqrt((miss * miss).sum())) / solution.error_bound)
    assert 0.1 < max(used) < 1.0


@pytest.mark.parametrize('x', [-0.9, 0.4])
@pytest.mark.parametrize('y', [-0.8, 0.5])
@pytest.mark.parametrize('z', [-0.7, 0.6])
def test_a_batch_bounds_rounding_as_single_solves_do(x, y, z):
    """All that is left of the bound where the unknowns have no error."""
    at = stages.unknowns(Pose(IDENTITY, (x, y, z)), SIZE)
    single = FK._solution(stages.Track(at, 0, Proof(0.0, 1.0), True))
    found, one = Solutions.unsolved(1), np.ones(1)
    FK._fill(found, slice(1), batch.Tracks(np.array([at]).T, one, 0.0 * one, one, one == 1.0))
    assert found.error_bound[0] == pytest.approx(single.error_bound, rel=1e-12, abs=0.0)


def extended_rotation(quaternion):
    """Return platform axes as columns, to nineteen digits, of a quaternion of any length."""
    w, z, y, x = np.array(quaternion, np.longdouble) / np.sqrt(
        (np.array(quaternion, np.longdouble) ** 2).sum()
    )
    return np.array(
        [
            [1 - 2 * (y * y + z * z), 2 * (x * y - w * z), 2 * (x * z + w * y)],
            [2 * (x * y + w * z), 1 - 2 * (x * x + z * z), 2 * (y * z - w * x)],
            [2 * (x * z - w * y), 2 * (y * z + w * x), 1 - 2 * (x * x + y * y)],
        ]
    )


def rounding_of_E(wrist, pose):
    """Return how far E is from exact fractions of the same floats, per its largest term."""
    known, f = wrist.forward_kinematics.planar, Fraction
    _, _, u1, _, u2, v2, height, _, _ = stages.unknowns(pose, wrist.size)
    right = quadratics.right_side(known, wrist.assembly_at(pose))
    side = math.copysign(1.0, height)
    at, *e = quadratics.unknowns_and_residual(right, known.per_t, u1, u2, v2, side)
    _, _, u1, _, u2, v2, z, u3, v3 = map(f, at)
    x, y, v1, s, m, n = (
        f(number) + sum(f(per) * t for per, t in zip(row, (u1, u2, v2), strict=True))
        for number, row in zip(right, known.per_t, strict=True)
    )
    e22, e23, e33 = map(f, e)
    off = (
        (1, s - x * x - y * y - z * z),
        (2, m - x * u1 - y * u2 - z * u3),
        (2, n - x * v1 - y * v2 - z * v3),
        (1, 1 - u1 * u1 - u2 * u2 - u3 * u3 - e22),
        (2, -u1 * v1 - u2 * v2 - u3 * v3 - e23),
        (1, 1 - v1 * v1 - v2 * v2 - v3 * v3 - e33),
    )
    total = math.sqrt(sum(weight * entry * entry for weight, entry in off))
    return total / (1.0 + abs(right[3]))


def test_rounding_of_the_equations_is_within_its_bound_at_any_height():
    rng, worst = np.random.default_rng(0), 0.0
    for height in (0.16, 0.5, 1.0, 3.0, 10.0):
        for _ in range(500):
            turn = turned(IDENTITY, tuple(rng.uniform(-1.5, 1.5, 3).tolist()), 1.0)
            x, y = rng.uniform(-0.2, 0.2, 2).tolist()
            pose = Pose(turn, (x, y, height * SCATTERED.size))
            worst = max(worst, rounding_of_E(SCATTERED, pose))
    assert 0.05 * ROUNDING < worst < ROUNDING


def test_the_bound_on_an_answer_at_home_is_below_a_thousandth_of_a_nanometre():
    assert FK.solve(tuple(WRIST.home)).error_bound < 1e-13
