"""Forward kinematics: right answers, sound proofs, honest statuses."""

import math

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from wrist_control import InvalidValueError, make_wrist
from wrist_control.rotations import IDENTITY, Pose, about_y, about_z, quaternion_of, turned, unit
from wrist_control.stewart import general, quadratics, stages, tracking
from wrist_control.stewart.forward_kinematics import Solutions, Status

WRIST = make_wrist('stewart')
FK = WRIST.forward_kinematics
HOME = WRIST.home.pose
SIZE = WRIST.size
# A platform and a base that are not planar, and not regular either.
CROOKED = make_wrist(
    'stewart',
    platform_anchors=np.array(WRIST.platform) + 0.03 * np.sin(np.arange(18.0)).reshape(6, 3),
    base_anchors=np.array(WRIST.base) + 0.04 * np.cos(np.arange(18.0)).reshape(6, 3),
)
# Six different points on each plane: planar, and not rings.
SCATTERED = make_wrist(
    'stewart',
    platform_anchors=np.array(WRIST.platform)
    + 0.03 * np.sin(np.arange(18.0)).reshape(6, 3) * [1, 1, 0],
    base_anchors=np.array(WRIST.base) + 0.04 * np.cos(np.arange(18.0)).reshape(6, 3) * [1, 1, 0],
)
# These lengths, m, hold the platform above the base in two poses on the same side of lock.
TWICE = Pose(unit((0.9687, -0.0673, -0.1093, 0.2126)), (0.0828, 0.0223, 0.5081))


def poses(shift, turn):
    d, a = st.floats(-shift, shift), st.floats(-turn, turn)
    return st.builds(
        lambda x, y, z, p, q, r: Pose(
            turned(HOME.quaternion, (p, q, r), 1.0), (x, y, HOME.position[2] + z)
        ),
        d, d, d, a, a, a,
    )  # fmt: skip


def random_poses(n, shift, turn, seed=0):
    rng = np.random.default_rng(seed)
    return [
        Pose(
            turned(HOME.quaternion, tuple(rng.uniform(-turn, turn, 3).tolist()), 1.0),
            tuple((np.array(HOME.position) + rng.uniform(-shift, shift, 3)).tolist()),
        )
        for _ in range(n)
    ]


def lengths_of(pose, wrist=WRIST):
    return tuple(wrist.assembly_at(pose))


def apart(one, other):
    """The distance in which proofs are stated: ‖(Δd, L Δu, L Δv)‖, m."""
    return SIZE * math.dist(stages.unknowns(one, SIZE), stages.unknowns(other, SIZE))


def exactly(lengths, pose):
    """Polish a pose to about 19 digits: Newton steps with residuals in extended precision.

    Returns position and rotation matrix (platform to base) as extended arrays.
    """
    p, b = (np.array(x, dtype=np.longdouble) for x in (WRIST.platform, WRIST.base))
    wanted = np.array(lengths, dtype=np.longdouble)
    a1, a2, a3, a4 = (np.longdouble(x) for x in pose.quaternion)
    q, d = np.array([a1, a4, a3, a2]), np.array(pose.position, dtype=np.longdouble)
    for _ in range(4):
        q = q / np.sqrt((q * q).sum())
        w, x, y, z = q
        rotation = np.array(
            [
                [1 - 2 * (y * y + z * z), 2 * (x * y - w * z), 2 * (x * z + w * y)],
                [2 * (x * y + w * z), 1 - 2 * (x * x + z * z), 2 * (y * z - w * x)],
                [2 * (x * z - w * y), 2 * (y * z + w * x), 1 - 2 * (x * x + y * y)],
            ]
        )
        arms = p @ rotation.T
        legs = d + arms - b
        found = np.sqrt((legs * legs).sum(axis=1))
        n = legs / found[:, None]
        lines = np.hstack([n, np.cross(arms, n)]).astype(float)
        change = np.linalg.solve(lines, (wanted - found).astype(float)).astype(np.longdouble)
        d = d + change[:3]
        half = change[3:] / 2
        dw = np.concatenate([[np.longdouble(1)], half])
        q = np.array(
            [
                dw[0] * w - half @ q[1:],
                *(dw[0] * q[1:] + w * half + np.cross(half, q[1:])),
            ]
        )
    return d, rotation


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


# What is proved is sound


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


# Statuses


def test_lengths_that_contradict_each_other_are_unreachable():
    solution = FK.solve((0.1, 0.5, 0.5, 0.5, 0.5, 2.5))
    assert solution.status == Status.UNREACHABLE
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
    assert 'also fit' in cold.message


def test_a_cold_start_of_home_is_not_ambiguous_on_its_side_of_lock():
    cold = FK.cold_start(tuple(WRIST.home))
    assert cold.others == ()
    assert 'found no other' in cold.message
    assert len(FK.assemblies(tuple(WRIST.home))) == 4  # three more, beyond lock


def test_a_cold_start_from_nonsense_says_so():
    assert 'No pose fits' in FK.cold_start((0.1, 0.5, 0.5, 0.5, 0.5, 2.5)).message
    cold = FK.cold_start((0.381, 0.399, 0.657, 0.296, 0.550, 0.614))
    assert cold.solution.status in (Status.DIVERGED, Status.UNPROVEN)


def test_a_crooked_platform_has_cold_starts_too():
    pose = random_poses(1, 0.03, 0.2)[0]
    cold = CROOKED.forward_kinematics.cold_start(lengths_of(pose, CROOKED))
    assert apart(cold.solution.pose, pose) < 1e-11


# Batches


def many(n=300, shift=0.05, turn=0.3):
    found = random_poses(n, shift, turn)
    rng = np.random.default_rng(1)
    near = Pose(
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
