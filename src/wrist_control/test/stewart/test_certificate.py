"""The proof itself: radii, the bound β, and rounding, each against a truth of its own."""

import math

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

from wrist_control import make_wrist
from wrist_control.rotations import IDENTITY, Pose, turned
from wrist_control.stewart import batch, general, quadratics, stages, tracking
from wrist_control.stewart.certificate import (
    BRANCH_LIMIT,
    NOTHING_PROVED,
    beta_nearby,
    kantorovich,
)
from wrist_control.stewart.geometry import legs

WRIST = make_wrist('stewart')
SIZE = WRIST.size
KNOWN = WRIST.forward_kinematics.planar
ANY = general.scaled(WRIST.platform, WRIST.base, SIZE)

poses = st.builds(
    lambda x, y, z, p, q, r: Pose(turned(IDENTITY, (p, q, r), 1.0), (x, y, 0.4 + z)),
    *[st.floats(-0.1, 0.1)] * 3,
    *[st.floats(-0.6, 0.6)] * 3,
)


def entries_of(at, right):
    """All six entries of E in Frobenius weights, from the matrices they are defined by."""
    _, _, u1, _, u2, v2, z, u3, v3 = at
    linear = np.array(right) + np.array(KNOWN.per_t) @ [u1, u2, v2]
    s, m, n = linear[3:]
    X = np.array([[linear[0], u1, linear[2]], [linear[1], u2, v2], [z, u3, v3]])
    E = np.array([[s, m, n], [m, 1, 0], [n, 0, 1]]) - X.T @ X
    root = math.sqrt(2.0)
    return np.array([E[0, 0], root * E[0, 1], root * E[0, 2], E[1, 1], root * E[1, 2], E[2, 2]])


def exact_beta(at, right):
    """‖E'⁻¹‖ between the norms that the proof uses, by central differences (E is quadratic)."""
    t_h = np.array([at[2], at[4], at[5], at[6], at[7], at[8]])

    def unknowns(v):
        linear = np.array(right) + np.array(KNOWN.per_t) @ v[:3]
        return (linear[0], linear[1], v[0], linear[2], v[1], v[2], *v[3:])

    columns, lift = [], []
    for axis in np.eye(6):
        ahead, behind = unknowns(t_h + axis), unknowns(t_h - axis)
        columns.append(0.5 * (entries_of(ahead, right) - entries_of(behind, right)))
        lift.append(0.5 * np.subtract(ahead, behind))
    return np.linalg.norm(np.array(lift).T @ np.linalg.inv(np.array(columns).T), 2)


@given(poses)
def test_nine_numbers_of_the_pose_say_the_lengths(pose):
    at = stages.unknowns(pose, SIZE)
    right = quadratics.right_side(KNOWN, WRIST.assembly_at(pose))
    assert right == pytest.approx(quadratics.right_side_at(KNOWN, at), abs=1e-13)
    assert entries_of(at, right) == pytest.approx(np.zeros(6), abs=1e-13)


@given(poses)
def test_the_bound_is_never_below_the_exact_norm(pose):
    at = stages.unknowns(pose, SIZE)
    rows = quadratics.newton_inverse(KNOWN.per_t, at)
    exact = exact_beta(at, quadratics.right_side(KNOWN, WRIST.assembly_at(pose)))
    bound = quadratics.kantorovich_beta(KNOWN, at, rows)
    assert bound >= exact
    assert bound <= 30.0 * exact


@given(poses)
def test_the_bound_for_any_platform_is_hardly_above_the_norm_that_differences_show(pose):
    """β is ‖H'⁻¹ T‖, where T takes the products ΔXᵀΔX to the second-order part of H."""
    p, b = np.array(ANY.platform), np.array(ANY.base)

    def equations(x):
        d, R = x[:3], x[3:].reshape(3, 3).T
        legs = ((d + p @ R.T - b) ** 2).sum(axis=1)
        # Squares of the parts that are constant for orthonormal axes do not belong to H.
        legs += (p * p).sum(axis=1) - ((p @ R.T) ** 2).sum(axis=1)
        gram, root = R.T @ R, math.sqrt(2.0)
        return np.array(
            [*legs, gram[0, 0], gram[1, 1], gram[2, 2],
             root * gram[0, 1], root * gram[0, 2], root * gram[1, 2]]
        )  # fmt: skip

    scaled = Pose(pose.quaternion, tuple(x / SIZE for x in pose.position))
    x0 = np.concatenate([scaled.position, scaled.rotation.ravel()])
    basis = np.eye(12)
    derivative = np.array([0.5 * (equations(x0 + e) - equations(x0 - e)) for e in basis]).T
    vectors = legs(ANY.platform, ANY.base, scaled)
    _, beta, inverse_norm = general.linearised(ANY, vectors)
    inverse = np.linalg.inv(derivative)
    exact = np.linalg.norm(inverse, 2)
    assert exact <= inverse_norm <= 3.0 * exact
    deltas = np.random.default_rng(0).normal(size=(40, 12))
    second = [0.5 * (equations(x0 + e) + equations(x0 - e)) - equations(x0) for e in deltas]
    root = math.sqrt(2.0)
    upper = np.triu_indices(4)
    weight = np.where(upper[0] == upper[1], 1.0, root)
    products = [
        weight * (columns.T @ columns)[upper]
        for columns in (delta.reshape(4, 3).T for delta in deltas)
    ]
    per_product = np.linalg.lstsq(np.array(products), np.array(second), rcond=None)[0].T
    assert np.array(products) @ per_product.T == pytest.approx(np.array(second), abs=1e-9)
    exact = np.linalg.norm(inverse @ per_product, 2)
    assert exact * (1.0 - 1e-12) <= beta <= 1.25 * exact


@given(st.floats(0.3, 20.0), st.floats(0.0, 0.3))
def test_radii_of_a_scalar_quadratic_are_its_roots(a, share):
    # H(x) = a x² + x − η at 0: β = a, and the nearest roots lie exactly at the two radii.
    eta = share * 0.8 / a
    proof = kantorovich(a, eta)
    if 4.0 * a * eta < 1.0:
        # The worst case of the theorem bends the other way: x = η + a x².
        roots = np.sort(np.roots([a, -1.0, eta]).real)
        assert proof.error == pytest.approx(roots[0], rel=1e-9, abs=1e-12)
        assert proof.unique == pytest.approx(roots[1], rel=1e-9)


def test_nothing_is_proved_where_two_roots_can_meet():
    assert kantorovich(1.0, 0.25) == NOTHING_PROVED
    assert kantorovich(1.0, 0.3) == NOTHING_PROVED
    assert kantorovich(math.nan, 0.0) == NOTHING_PROVED


def test_a_bound_that_moved_too_far_bounds_nothing():
    assert beta_nearby(2.0, 0.1) == pytest.approx(2.0 / 0.6)
    assert beta_nearby(2.0, 0.25) == math.inf


@given(poses, poses, st.floats(0.0, 1.0))
def test_the_moved_bound_holds_at_the_other_pose(one, other, share):
    a, b = (stages.unknowns(p, SIZE) for p in (one, other))
    b = tuple((1 - share) * x + share * y for x, y in zip(a, b, strict=True))
    bound = beta_nearby(
        quadratics.kantorovich_beta(KNOWN, a, quadratics.newton_inverse(KNOWN.per_t, a)),
        math.dist(a, b),
    )
    if bound < math.inf:
        # The linear rows tie x, y, v₁ to t, so compare on the surface of the same lengths.
        right = quadratics.right_side(KNOWN, WRIST.assembly_at(one))
        x, y, v1, *_ = np.array(right) + np.array(KNOWN.per_t) @ [b[2], b[4], b[5]]
        on = (x, y, b[2], v1, *b[4:])
        at_most = beta_nearby(
            quadratics.kantorovich_beta(KNOWN, a, quadratics.newton_inverse(KNOWN.per_t, a)),
            math.dist(a, on),
        )
        if at_most < math.inf:
            assert exact_beta(on, right) <= at_most * (1 + 1e-9)


def test_the_branch_test_is_where_the_discriminant_vanishes():
    assert pytest.approx(1.0) == (BRANCH_LIMIT + BRANCH_LIMIT**2) * 4.0


def test_a_root_beyond_the_branch_test_is_not_called_followed():
    """The roots that lengths share with home lie further than any step that counts as proved."""
    for other in WRIST.forward_kinematics.assemblies(tuple(WRIST.home)):
        at = stages.unknowns(other.pose, SIZE)
        if math.dist(at, stages.unknowns(WRIST.home.pose, SIZE)) < 1e-9:
            continue
        right = quadratics.right_side(KNOWN, WRIST.home)
        start = stages.unknowns(WRIST.home.pose, SIZE)
        rows = quadratics.newton_inverse(KNOWN.per_t, at)
        track = tracking._proved(KNOWN, at, start, 0, at, rows, 1e-14)
        assert right is not None
        assert not track.followed


@pytest.mark.parametrize('spoil', [1e-9, 1e-6, 1e-3])
def test_a_spoiled_answer_is_not_given_a_small_error(spoil):
    """The residual, not the iteration, decides: a point off by `spoil` is told to be off."""
    pose = Pose(turned(IDENTITY, (0.1, 0.2, 0.3), 1.0), (0.02, 0.01, 0.42))
    right = quadratics.right_side(KNOWN, WRIST.assembly_at(pose))
    at = stages.unknowns(pose, SIZE)
    wrong, *e = quadratics.unknowns_and_residual(
        right, KNOWN.per_t, at[2] + spoil, at[4], at[5], 1.0
    )
    left = math.sqrt(e[0] ** 2 + 2 * e[1] ** 2 + e[2] ** 2)
    track = tracking._proved(
        KNOWN, wrong, at, 0, wrong, quadratics.newton_inverse(KNOWN.per_t, wrong), left
    )
    assert math.dist(wrong, at) <= track.proof.error


def test_the_batch_proves_the_same():
    rng = np.random.default_rng(4)
    found = [
        Pose(turned(IDENTITY, tuple(rng.uniform(-0.3, 0.3, 3)), 1.0),
             tuple(np.array([0, 0, 0.43]) + rng.uniform(-0.04, 0.04, 3)))
        for _ in range(30)
    ]  # fmt: skip
    lengths = np.array([tuple(WRIST.assembly_at(pose)) for pose in found])
    start = np.array([stages.unknowns(pose, SIZE) for pose in found]).T
    tracks = batch.solve_rows(KNOWN, lengths, start)
    for row, pose in enumerate(found):
        single = tracking.solve_planar(
            KNOWN, quadratics.right_side(KNOWN, lengths[row]), stages.unknowns(pose, SIZE)
        )
        assert tracks.unique[row] == pytest.approx(single.proof.unique, rel=1e-6)
        assert tracks.followed[row] == single.followed
