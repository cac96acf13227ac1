"""Many solves at once: the same answers, and what is refused."""

import numpy as np
import pytest

from wrist_control import InvalidValueError
from wrist_control.rotations import IDENTITY, Pose, Poses, quaternion_of, turned
from wrist_control.stewart.forward_kinematics import Solutions, Status

from .platforms import CROOKED, FK, WRIST, apart, lengths_of, random_poses


def many(n=300, shift=0.05, turn=0.3):
    found = random_poses(n, shift, turn)
    rng = np.random.default_rng(1)
    near = Poses(
        np.array([turned(p.quaternion, tuple(rng.normal(size=3)), 0.01) for p in found]),
        np.array([p.position for p in found]) + rng.normal(scale=1e-3, size=(n, 3)),
    )
    return found, np.array([lengths_of(p) for p in found]), near


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
