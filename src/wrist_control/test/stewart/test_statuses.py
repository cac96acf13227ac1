"""What the forward kinematics say of an answer, of none, and of lengths alone."""

import math

import numpy as np
import pytest

from wrist_control import InvalidValueError, make_wrist
from wrist_control.rotations import IDENTITY, Pose, about_z, turned, unit
from wrist_control.stewart import quadratics, stages, tracking
from wrist_control.stewart.forward_kinematics import Status

from .platforms import CROOKED, FK, HOME, SCATTERED, SIZE, WRIST, apart, lengths_of, random_poses

# These lengths, m, hold the platform above the base in two poses on the same side of lock.
TWICE = Pose(unit((0.9687, -0.0673, -0.1093, 0.2126)), (0.0828, 0.0223, 0.5081))


def test_lengths_that_contradict_each_other_are_unreachable():
    solution = FK.solve((0.1, 0.5, 0.5, 0.5, 0.5, 2.5))
    assert (solution.status, solution.iterations) == (Status.UNREACHABLE, 0)
    assert solution.pose is None


def test_lengths_that_no_pose_was_found_for_have_none():
    solution = FK.solve((0.381, 0.399, 0.657, 0.296, 0.550, 0.614))
    assert solution.status == Status.DIVERGED
    assert solution.pose is None
    assert solution.error_bound == math.inf


def test_close_to_lock_the_status_says_so():
    pose = Pose(about_z(0.5 * math.pi - 1e-3), HOME.position)
    solution = FK.solve(lengths_of(pose), pose)
    assert solution.status == Status.NEAR_SINGULAR
    assert apart(solution.pose, pose) <= solution.error_bound


def test_statuses_have_the_numbers_of_the_message():
    assert [status.name for status in Status] == [
        'CONVERGED', 'UNPROVEN', 'UNREACHABLE', 'DIVERGED', 'NEAR_SINGULAR',
    ]  # fmt: skip


def test_random_lengths_never_get_a_pose_that_does_not_fit():
    rng = np.random.default_rng(5)
    seen = set()
    for lengths in rng.uniform(0.2, 0.8, (150, 6)):
        solution = FK.solve(tuple(lengths))
        seen.add(solution.status)
        if solution.pose is not None:
            assert lengths_of(solution.pose) == pytest.approx(lengths, abs=1e-11)
    assert Status.CONVERGED in seen
    assert Status.DIVERGED in seen


@pytest.mark.parametrize(
    ('lengths', 'says'),
    [
        ((0.5,) * 5, 'There are 5 leg lengths'),
        ((0.5, 0.5, math.nan, 0.5, 0.5, 0.5), 'leg_3 is nan'),
        ((0.5, 0.5, 0.5, 0.5, 0.5, math.inf), 'leg_6 is inf'),
        ((-0.5, 0.5, 0.5, 0.5, 0.5, 0.5), 'leg_1 is -0.5'),
    ],
)
def test_what_cannot_be_lengths_is_refused(lengths, says):
    with pytest.raises(InvalidValueError, match=says):
        FK.solve(lengths)


# Cold start


def test_a_cold_start_finds_the_pose_and_says_that_the_lengths_are_ambiguous():
    cold = FK.cold_start(lengths_of(TWICE))
    assert cold.solution.status == Status.CONVERGED
    assert apart(cold.solution.pose, TWICE) < 1e-12
    assert len(cold.others) >= 1
    other = cold.others[0].pose
    assert other.position[2] > 0.0
    assert lengths_of(other) == pytest.approx(lengths_of(TWICE), abs=1e-12)
    assert WRIST.assembly_at(other).hadamard_ratio * WRIST.assembly_at(TWICE).hadamard_ratio > 0.0
    assert f'also fit at least {len(cold.others)} other pose' in cold.message


def test_a_cold_start_of_home_finds_no_other_on_its_side_of_lock_and_claims_no_more():
    cold = FK.cold_start(tuple(WRIST.home))
    assert cold.others == ()
    assert 'found no other on its side of lock, but there may be one' in cold.message
    assert len(FK.assemblies(tuple(WRIST.home))) == 4  # three more, beyond lock


def test_a_cold_start_from_nonsense_says_so():
    assert 'No pose fits' in FK.cold_start((0.1, 0.5, 0.5, 0.5, 0.5, 2.5)).message
    cold = FK.cold_start((0.381, 0.399, 0.657, 0.296, 0.550, 0.614))
    assert cold.solution.status in (Status.DIVERGED, Status.UNPROVEN)


def test_a_crooked_platform_has_cold_starts_too():
    pose = random_poses(1, 0.03, 0.2)[0]
    cold = CROOKED.forward_kinematics.cold_start(lengths_of(pose, CROOKED))
    assert apart(cold.solution.pose, pose) < 1e-11


@pytest.mark.parametrize(
    ('yaw', 'status'), [(1.54, Status.CONVERGED), (1.5607, Status.NEAR_SINGULAR)]
)
def test_a_twin_nearer_than_a_hundredth_of_the_size_is_near_singular(yaw, status):
    """The radii that are proved here are 1.5 % and 0.5 % of the size."""
    pose = Pose(about_z(yaw), HOME.position)
    assert FK.solve(lengths_of(pose), pose).status == status


def planar_platform(condition):
    """Return a platform whose equations for (x, y, v₁, s, m, n) are that ill-conditioned."""
    p, b = np.array(SCATTERED.platform), np.array(SCATTERED.base)

    def equations(by):
        x, y = p[:, 0] / SIZE, p[:, 1] / SIZE
        bx = b[:, 0] / SIZE
        base_y = np.array([*b[:5, 1], by]) / SIZE
        return np.stack([-2 * bx, -2 * base_y, -2 * bx * y, np.ones(6), 2 * x, 2 * y], axis=1)

    zero, one = np.linalg.det(equations(0.0)), np.linalg.det(equations(1.0))
    lock, off = zero / (zero - one), -0.2
    while np.linalg.cond(equations(lock + off)) < condition:
        off *= 0.9
    b[5, 1] = lock + off
    return make_wrist('stewart', platform_anchors=p, base_anchors=b)


@pytest.mark.parametrize('condition', [30.0, 600.0, 6000.0])
def test_a_planar_platform_that_its_legs_hold_is_proved_however_its_equations_are(condition):
    wrist = planar_platform(condition)
    assert wrist.margin(wrist.home) > 0.02
    for pose in random_poses(5, 0.02, 0.1):
        solution = wrist.forward_kinematics.solve(lengths_of(pose, wrist), pose)
        assert solution.status == Status.CONVERGED


def test_well_conditioned_equations_take_the_fast_way():
    assert planar_platform(30.0).forward_kinematics.planar is not None


def test_a_platform_close_to_its_base_is_proved_to_be_where_it_is():
    """At a tenth of its size z cannot lead: what it proves there is worth nothing."""
    pose = Pose(turned(IDENTITY, (0.1, -0.1, 0.1), 1.0), (0.01, 0.01, 0.1 * SIZE))
    assert FK.solve(lengths_of(pose), pose).status == Status.CONVERGED


def test_at_two_thirds_of_homes_height_the_fast_way_is_taken():
    pose = Pose(IDENTITY, (0.0, 0.0, 0.67 * HOME.position[2]))
    goal = quadratics.right_side(FK.planar, lengths_of(pose))
    assert tracking.solve_planar(FK.planar, goal, stages.unknowns(pose, SIZE)).followed
