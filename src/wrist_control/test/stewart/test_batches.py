"""Many solves at once: the same answers, and what is refused."""

import math

import numpy as np
import pytest

from wrist_control import InvalidValueError
from wrist_control.rotations import IDENTITY, Pose, Poses, quaternion_of, turned
from wrist_control.stewart import quadratics, stages, tracking
from wrist_control.stewart.batch import CHUNK, Roots, chunks, prove
from wrist_control.stewart.forward_kinematics import Solutions, Status

from .platforms import CROOKED, FK, HOME, WRIST, apart, lengths_of, random_poses


def many(n=300, shift=0.05, turn=0.3):
    found = random_poses(n, shift, turn)
    rng = np.random.default_rng(1)
    near = Poses(
        np.array([turned(p.quaternion, tuple(rng.normal(size=3)), 0.01) for p in found]),
        np.array([p.position for p in found]) + rng.normal(scale=1e-3, size=(n, 3)),
    )
    return found, np.array([lengths_of(p) for p in found]), near


@pytest.mark.parametrize('n', [0, 1, CHUNK - 1, CHUNK, 2 * CHUNK + 5])
def test_chunks_hold_every_row_once_and_never_more_than_fit(n):
    rows = [row for part in chunks(n) for row in range(n)[part]]
    assert rows == list(range(n))
    assert all(part.stop - part.start <= CHUNK for part in chunks(n))


def test_a_proof_from_far_away_is_that_of_a_single_solve():
    """Linearised 5 mm and 0.02 rad off, where β of (S7) has to be carried over by (S8)."""
    known, size = FK.planar, WRIST.size
    for pose, shift in zip(random_poses(20, 0.05, 0.3), random_poses(20, 5e-3, 0.02), strict=True):
        moved = Pose(
            turned(pose.quaternion, shift.quaternion[:0:-1], 2.0),
            tuple(np.add(pose.position, shift.position) - HOME.position),
        )
        at, origin = (stages.unknowns(one, size) for one in (pose, moved))
        inverse = quadratics.newton_inverse(known.per_t, origin)
        single = tracking._proved(known, at, origin, 3, origin, inverse, 1e-9)
        many = Roots(at, np.array([1e-9]), np.array([3]), origin, inverse)
        error, unique, followed = prove(known, many, np.array([origin]).T)
        assert error[0] == pytest.approx(single.proof.error, rel=1e-12, abs=0.0)
        assert unique[0] == pytest.approx(single.proof.unique, rel=1e-12, abs=0.0)
        assert followed[0] == single.followed
        beta = quadratics.kantorovich_beta(known, origin, inverse)
        assert 0.05 < 2.0 * beta * math.dist(at, origin) < 0.9


@pytest.mark.parametrize('wrist', [WRIST, CROOKED], ids=['planar', 'crooked'])
def test_a_batch_gives_what_single_solves_give(wrist):
    found, _, near = many(40)
    lengths = np.array([lengths_of(p, wrist) for p in found])
    batch = wrist.forward_kinematics.solve_batch(lengths, near)
    for row, pose in enumerate(found):
        before = Pose(tuple(near.quaternion[row].tolist()), tuple(near.position[row].tolist()))
        single = wrist.forward_kinematics.solve(lengths[row], before)
        got = Pose(tuple(batch.quaternion[row]), tuple(batch.position[row]))
        assert batch.status[row] == single.status == Status.CONVERGED
        assert apart(got, pose) <= batch.error_bound[row] < 1e-12
        assert batch.unique_radius[row] == pytest.approx(single.unique_radius, rel=0.05)


def test_a_batch_that_starts_at_its_answers_corrects_their_rounding_at_most():
    found, lengths, _ = many(50)
    there = Poses(np.array([p.quaternion for p in found]), np.array([p.position for p in found]))
    assert FK.solve_batch(lengths, there).iterations.max() <= 1


def test_a_pose_that_was_filled_with_arrays_counts_as_poses():
    _, lengths, near = many(5)
    for one, other in zip(
        FK.solve_batch(lengths, Pose(*near)), FK.solve_batch(lengths, near), strict=True
    ):
        np.testing.assert_array_equal(one, other)


def test_a_batch_from_home_finds_every_pose():
    found, lengths, _ = many()
    batch = FK.solve_batch(lengths)
    assert (batch.status == Status.CONVERGED).all()
    assert np.abs(batch.position - [p.position for p in found]).max() < 1e-13


def test_a_batch_marks_what_has_no_pose():
    lengths = np.array([tuple(WRIST.home), (0.1, 0.5, 0.5, 0.5, 0.5, 2.5)])
    batch = FK.solve_batch(lengths)
    assert isinstance(batch, Solutions)
    assert batch.status.tolist() == [Status.CONVERGED, Status.UNREACHABLE]
    assert np.isnan(batch.position[1]).all()


def test_a_batch_turned_by_more_than_a_third_of_a_turn_is_right():
    turn = Pose(turned(IDENTITY, (0.3, 2.6, 0.2), 1.0), (0.05, 0.02, 0.5))
    near = Pose(turned(IDENTITY, (0.3, 2.6, 0.21), 1.0), (0.05, 0.02, 0.5))
    batch = FK.solve_batch(np.array([lengths_of(turn)]), near)
    quaternion = tuple(batch.quaternion[0])
    assert apart(Pose(quaternion, tuple(batch.position[0])), turn) < 1e-11
    assert quaternion_of(turn.rotation) == pytest.approx(
        quaternion if quaternion[0] > 0 else [-x for x in quaternion], abs=1e-11
    )


@pytest.mark.parametrize(
    ('lengths', 'says'),
    [
        (np.ones((3, 5)), r'the shape \(3, 5\)'),
        (np.array([[0.5] * 6, [0.5, 0.5, 0.0, 0.5, 0.5, 0.5]]), 'leg_3 in row 1 is 0.0'),
    ],
)
def test_what_cannot_be_a_batch_is_refused(lengths, says):
    with pytest.raises(InvalidValueError, match=says):
        FK.solve_batch(lengths)


def test_a_batch_with_another_number_of_poses_before_is_refused():
    found, lengths, near = many(4)
    assert len(found) == 4
    with pytest.raises(InvalidValueError, match=r'one for each of the 3 rows'):
        FK.solve_batch(lengths[:3], near)
