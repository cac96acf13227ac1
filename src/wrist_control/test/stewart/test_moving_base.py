"""A platform whose base anchors move, as the tips of horns do: what is proved there is so.

The truth is a walk in many small steps, by plain Newton steps on matrices of its own.
"""

import math

import numpy as np
import pytest

from wrist_control import UnreachableError, make_wrist
from wrist_control.rotations import Pose, turned
from wrist_control.stewart import general, stages
from wrist_control.stewart.forward_kinematics import ForwardKinematics, Status

from .platforms import CROOKED, exactly

WRIST = make_wrist('rotary_stewart')
HOME, SIZE = WRIST.home.pose, WRIST.size
P = np.array(WRIST.platform)
ROD = WRIST.rod_length
STEPS = 120


def random_pose(rng, shift, turn, near=HOME):
    axis = rng.normal(size=3)
    rates = turn * rng.uniform() / np.linalg.norm(axis) * axis
    place = np.array(near.position) + shift * rng.uniform(-1.0, 1.0, 3)
    return Pose(turned(near.quaternion, tuple(rates.tolist()), 1.0), tuple(place.tolist()))


def reachable(rng, shift=0.03, turn=0.9):
    while True:
        try:
            return WRIST.assembly_at(random_pose(rng, shift, turn))
        except UnreachableError:
            pass


def turn_by(vector):
    angle = np.linalg.norm(vector)
    if not angle:
        return np.eye(3)
    x, y, z = vector / angle
    cross = np.array([[0, -z, y], [z, 0, -x], [-y, x, 0]])
    return np.eye(3) + math.sin(angle) * cross + (1 - math.cos(angle)) * cross @ cross


def rods_at(d, R, tips):
    return d + P @ R.T - tips


def corrected(d, R, tips, squares):
    """Return the pose with these squares of the rods, by Newton steps; and the last rows."""
    for _ in range(4):
        rods = rods_at(d, R, tips)
        rows = np.hstack([rods, np.cross(P @ R.T, rods)])
        step = np.linalg.solve(rows, 0.5 * (squares - (rods**2).sum(axis=1)))
        d, R = d + step[:3], turn_by(step[3:]) @ R
    return d, R, rows


def walked(pose, tips, squares):
    """Follow a pose along tips and squares, shapes (n, 6, 3) and (n, 6); None where it locks."""
    d, R = np.array(pose.position), pose.rotation.T
    side = None
    for now, wanted in zip(tips, squares, strict=True):
        before = d, R
        d, R, rows = corrected(d, R, now, wanted)
        jump = math.hypot(np.linalg.norm(d - before[0]) / SIZE, np.linalg.norm(R - before[1]))
        scaled = rows / ROD * ([1.0] * 3 + [1.0 / SIZE] * 3)
        det = np.linalg.det(scaled)
        if side is not None and (det * side <= 0.0 or abs(det) < 0.02 * abs(side)):
            return None
        if not jump < 0.3:
            return None
        side = det if side is None else math.copysign(max(abs(side), abs(det)), det)
    return d, R


def apart(solution, truth):
    d, R = truth
    return math.hypot(
        np.linalg.norm(d - solution.pose.position) / SIZE,
        np.linalg.norm(R - solution.pose.rotation.T),
    )


def straight(pose, tips):
    """Return the way of (S11): the tips as they are, and squares that go straight to the rods'."""
    begin = (rods_at(np.array(pose.position), pose.rotation.T, tips) ** 2).sum(axis=1)
    share = np.linspace(0.0, 1.0, STEPS)[:, None]
    return np.array([tips] * STEPS), begin + share * (ROD**2 - begin)


def one_go(angles, near):
    """Return the track of a single go, without stages."""
    known = general.scaled(WRIST.platform, WRIST.tips(angles), SIZE)
    goal = general.squares(known, (ROD,) * 6)
    return known, general.solve_general(known, goal, stages.unknowns(near, SIZE))


def near_lock(rng):
    """Return an assembly whose rods hardly hold it: at random, the worst of a few dozen."""
    some = [reachable(rng, 0.035, 1.2) for _ in range(40)]
    return min(some, key=lambda one: abs(one.hadamard_ratio))


def at_a_twin(rng):
    """Return an assembly, and the pose of another that has the same angles."""
    while True:
        one = reachable(rng)
        kinematics, lengths = WRIST.kinematics_at(tuple(one))
        for other in kinematics.assemblies(lengths):
            if kinematics.apart(other.pose, one.pose) > 1e-3 * SIZE:
                return one, other.pose


@pytest.mark.parametrize('chosen', [reachable, near_lock], ids=['anywhere', 'near lock'])
def test_what_one_go_proves_is_where_small_steps_lead(chosen):
    """From starts at all distances, some so far that hardly anything is proved."""
    rng, proved, refused = np.random.default_rng(0), 0, 0
    for _ in range(120):
        angles = chosen(rng)
        reach = 10.0 ** rng.uniform(-3.0, 0.0)
        near = random_pose(rng, SIZE * reach, reach, angles.pose)
        _, track = one_go(tuple(angles), near)
        if track is None or not track.followed:
            refused += 1
            continue
        proved += 1
        truth = walked(near, *straight(near, np.array(WRIST.tips(angles))))
        assert truth is not None
        solution = WRIST.solve(tuple(angles), near)
        assert solution.status in (Status.CONVERGED, Status.NEAR_SINGULAR)
        assert apart(solution, truth) < 1e-9
    assert proved > 30
    assert refused > 15


def test_stages_lead_where_small_steps_lead():
    rng, proved = np.random.default_rng(1), 0
    for _ in range(60):
        angles, near = reachable(rng), reachable(rng, 0.025, 0.7).pose
        solution = WRIST.solve(tuple(angles), near)
        if solution.status == Status.CONVERGED:
            proved += 1
            truth = walked(near, *straight(near, np.array(WRIST.tips(angles))))
            assert truth is not None
            assert apart(solution, truth) < 1e-9
    assert proved > 50


def test_a_twin_leads_to_itself_and_never_to_the_other():
    rng = np.random.default_rng(2)
    for _ in range(15):
        one, twin = at_a_twin(rng)
        for pose in (one.pose, twin):
            near = random_pose(rng, 0.01 * SIZE, 0.01, pose)
            solution = WRIST.solve(tuple(one), near)
            if solution.status == Status.CONVERGED:
                assert math.dist(solution.pose.position, pose.position) < 1e-9
        found = WRIST.solve(tuple(one), one.pose)
        assert found.unique_radius < WRIST.kinematics_at(tuple(one))[0].apart(one.pose, twin)


def test_horns_that_turn_a_little_carry_the_platform_where_it_is_proved_to_be():
    """The horns' own way, tips on their circles and rods as they are, in small steps."""
    rng, proved = np.random.default_rng(3), 0
    for _ in range(40):
        before = reachable(rng)
        after = np.add(tuple(before), rng.uniform(-0.1, 0.1, 6))
        solution = WRIST.solve(tuple(after.tolist()), before.pose)
        if solution.status != Status.CONVERGED:
            continue
        proved += 1
        ways = np.linspace(tuple(before), after, STEPS)
        tips = np.array([WRIST.tips(way.tolist()) for way in ways])
        truth = walked(before.pose, tips, np.full((STEPS, 6), ROD**2))
        assert truth is not None
        assert apart(solution, truth) < 1e-9
    assert proved > 30


@pytest.mark.parametrize('wrist', [WRIST, CROOKED], ids=['horns', 'crooked'])
def test_the_true_error_of_a_step_without_another_look_is_within_its_bound(wrist):
    """To nineteen digits, from starts at all distances."""
    rng, used = np.random.default_rng(4), []
    home, size = wrist.home.pose, wrist.size
    for _ in range(150):
        pose = random_pose(rng, 0.2 * size, 0.4, home)
        try:
            angles = wrist.assembly_at(pose)
        except UnreachableError:
            continue
        kinematics, lengths = wrist.kinematics_at(tuple(angles))
        reach = 10.0 ** rng.uniform(-8.0, -1.0)
        near = random_pose(rng, size * reach, reach, pose)
        solution = kinematics.solve(lengths, near)
        if solution.status != Status.CONVERGED:
            continue
        anchors = kinematics.platform, kinematics.base
        d, R = exactly(lengths, solution.pose, *anchors)
        off = np.concatenate(
            [d - solution.pose.position, size * (R - solution.pose.rotation.T)[:, :2].ravel()]
        )
        used.append(float(np.sqrt((off * off).sum()) / solution.error_bound))
        assert solution.error_bound < 1e-12 * size / 0.03
    assert len(used) > 80
    assert max(used) <= 1.0


def test_moved_anchors_give_what_new_ones_give():
    rng = np.random.default_rng(5)
    first = WRIST.kinematics_at(tuple(WRIST.home))[0]
    for _ in range(20):
        angles = reachable(rng, 0.02, 0.5)
        tips = WRIST.tips(angles)
        new = ForwardKinematics(WRIST.platform, tips, SIZE, HOME)
        one, other = (k.solve((ROD,) * 6, HOME) for k in (new, first.moved_to(tips)))
        assert one.status == other.status
        assert one.pose.position == pytest.approx(other.pose.position, abs=1e-13)
        assert one.unique_radius == pytest.approx(other.unique_radius, rel=1e-6)


def test_the_last_linearisation_saves_the_first_and_proves_nothing():
    """After a first answer the next start is that answer: fewer inverses, the same proof."""
    pose = WRIST.home.pose
    made = []
    for _ in range(20):
        pose = WRIST.target_pose(pose, (0.02, 0.01, -0.02, 0.3, 0.5, -0.2), 0.01)
        made.append((tuple(WRIST.assembly_at(pose)), pose))
    near = WRIST.home.pose
    for angles, pose in made:
        warm = WRIST.solve(angles, near)
        cold = WRIST.solve(angles, Pose(near.quaternion, near.position))
        assert warm.status == cold.status == Status.CONVERGED
        assert warm.pose.position == pytest.approx(pose.position, abs=1e-14)
        assert warm.unique_radius == pytest.approx(cold.unique_radius, rel=1e-3)
        near = warm.pose
