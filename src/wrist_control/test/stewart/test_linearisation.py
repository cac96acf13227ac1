"""Newton's matrix against differences, and its bounds, on platforms with nothing symmetric."""

import numpy as np
import pytest

from wrist_control import make_wrist
from wrist_control.rotations import Pose, unit
from wrist_control.stewart import quadratics, stages, tracking
from wrist_control.stewart.forward_kinematics import ForwardKinematics, Status

from .platforms import FK, HOME, SCATTERED, SIZE, WRIST, lengths_of, random_poses

STEP = 1e-6
UNKNOWNS = [2, 4, 5]  # u1, u2, v2 among the nine


@pytest.mark.parametrize('wrist', [WRIST, SCATTERED], ids=['rings', 'scattered'])
def test_newtons_matrix_is_the_derivative_of_the_residual(wrist):
    known, size = wrist.forward_kinematics.planar, wrist.size
    for pose in random_poses(10, 0.05, 0.4):
        at = stages.unknowns(pose, size)
        right = quadratics.right_side_at(known, at)

        def residual(t, right=right):
            found = quadratics.unknowns_and_residual(right, known.per_t, *t, 1.0)
            return np.array(found[1:])

        there = np.array(at)[UNKNOWNS]
        columns = [
            (residual(there + STEP * step) - residual(there - STEP * step)) / (2.0 * STEP)
            for step in np.eye(3)
        ]
        # The entries on the diagonal of E stand halved.
        slope = np.array(columns).T * np.array([[0.5], [1.0], [0.5]])
        matrix = quadratics.newton_matrix(known.per_t, at)
        np.testing.assert_allclose(matrix, slope, atol=1e-7)


@pytest.mark.parametrize('wrist', [WRIST, SCATTERED], ids=['rings', 'scattered'])
def test_the_bound_on_the_inverse_is_the_one_that_was_derived(wrist):
    """(S7), from the matrices that it is written with."""
    known, size = wrist.forward_kinematics.planar, wrist.size
    for pose in random_poses(10, 0.1, 0.8):
        at = x, y, u1, v1, u2, v2, z, u3, v3 = stages.unknowns(pose, size)
        inverse = quadratics.newton_inverse(known.per_t, at)
        across = np.array([[-u3 / z, 1.0, 0.0], [-v3 / z, 0.0, 1.0]])
        k, root = np.linalg.norm(across, 2) ** 2, np.sqrt(2.0)
        turn = k * np.linalg.norm(np.array(inverse) @ np.diag([1.0, 1.0 / root, 1.0]))
        flat = np.linalg.norm([x, y, u1, v1, u2, v2]) * known.flat_norm * turn
        rise = (1.0 + known.s_norm * turn + 2.0 * flat) / (root * np.linalg.norm([z, u3, v3]))
        expected = np.hypot(known.flat_norm * turn, rise)
        found = quadratics.kantorovich_beta(known, at, inverse)
        assert found == pytest.approx(expected, rel=1e-12)


@pytest.mark.parametrize('wrist', [WRIST, SCATTERED], ids=['rings', 'scattered'])
def test_norms_are_the_largest_that_any_change_shows(wrist):
    known = wrist.forward_kinematics.planar
    changes = np.random.default_rng(0).normal(size=(3, 3000))
    changes /= np.linalg.norm(changes, axis=0)
    x, y, v1, s, m, n = np.array(known.per_t) @ changes
    flat = np.linalg.norm([x, y, v1, *changes], axis=0).max()
    heights = np.sqrt(s * s + 2.0 * m * m + 2.0 * n * n).max()
    assert 0.995 * known.flat_norm < flat <= known.flat_norm * (1.0 + 1e-12)
    assert 0.995 * known.s_norm < heights <= known.s_norm * (1.0 + 1e-12)


def test_an_inverse_serves_for_several_corrections_and_is_renewed_once(monkeypatch):
    """It costs twice as much as a look at what is left; an answer again needs none at all."""
    made = []

    def inverse(*given):
        made.append(given)
        return quadratics.newton_inverse(*given)

    monkeypatch.setattr(tracking, 'newton_inverse', inverse)
    for pose in random_poses(20, 1e-3, 5e-3):
        goal = quadratics.right_side(FK.planar, lengths_of(pose))
        made.clear()
        track = tracking.solve_planar(FK.planar, goal, stages.unknowns(HOME, SIZE))
        assert track.followed
        assert len(made) == 2 <= track.iterations
        made.clear()
        assert tracking.solve_planar(FK.planar, goal, track.at, track.tangent).followed
        assert not made


def test_poses_near_home_need_no_solve_of_their_own(monkeypatch):
    found = random_poses(50, 0.002, 0.005)
    lengths = np.array([lengths_of(pose) for pose in found])
    monkeypatch.setattr(ForwardKinematics, 'solve', None)
    solutions = FK.solve_batch(lengths)
    assert (solutions.status == Status.CONVERGED).all()
    assert (solutions.iterations > 0).all()
    np.testing.assert_allclose(solutions.position, [p.position for p in found], atol=1e-9)


def test_where_home_leads_nowhere_a_cold_start_takes_the_pose_nearest_to_home():
    """Lengths of a pose tilted far over: two poses are found, and a lock lies before both."""
    far = Pose((0.5977, 0.5054, 0.3642, -0.5046), (-0.079, -0.070, 0.341))
    lengths = lengths_of(far._replace(quaternion=unit(far.quaternion)))
    assert FK.solve(lengths).pose is None
    away = [FK.apart(solution.pose, HOME) for solution in FK.assemblies(lengths)]
    assert len(away) > 1
    chosen = FK.cold_start(lengths).solution.pose
    assert FK.apart(chosen, HOME) == pytest.approx(min(away))
    assert max(away) - min(away) > 1e-3


def test_the_scattered_platform_is_planar_and_not_a_ring():
    assert SCATTERED.forward_kinematics.planar is not None
    assert make_wrist('stewart').platform != SCATTERED.platform
