"""The rotary Stewart platform: geometry by matrices, both of its edges, and what is refused."""

import math

import numpy as np
import pytest
from hypothesis import assume, given, settings
from hypothesis import strategies as st

from wrist_control import InvalidValueError, UnreachableError, make_wrist
from wrist_control.resolving import start, step
from wrist_control.rotations import Pose, rates_between, turned
from wrist_control.stewart.forward_kinematics import Status
from wrist_control.wrists.platform import EDGE, Assembly

from .near_home import poses_near

WRIST = make_wrist('rotary_stewart')
HOME = WRIST.home.pose
# [ReachyMini]: limits of the six joints, rad.
LOWER = np.radians([-48.0, -80.0, -48.0, -80.0, -70.0, -80.0])
UPPER = np.radians([80.0, 70.0, 80.0, 48.0, 80.0, 48.0])

poses = poses_near(HOME, 0.02)
twists = st.tuples(*[st.floats(-1.0, 1.0)] * 6)


def reached(pose):
    """Return the angles of a pose, where there are such."""
    try:
        return WRIST.assembly_at(pose)
    except UnreachableError:
        assume(False)


def rods(angles, pose):
    """The rods by matrices in base axes, shape (6, 3): from the tips to d + R p."""
    tips = []
    for number, angle in enumerate(angles):
        azimuth = math.radians((60, 60, 180, 180, 300, 300)[number])
        side = 1.0 if number % 2 else -1.0
        # In the pair's own axes: out, and square to it; an odd servo lifts its horn, an even one
        # sinks it.
        out, across = 0.0366606, side * (0.01 + 0.04 * math.cos(angle))
        up = -side * 0.04 * math.sin(angle)
        c, s = math.cos(azimuth), math.sin(azimuth)
        tips.append((out * c - across * s, out * s + across * c, up))
    heads = np.array(pose.position) + np.array(WRIST.platform) @ pose.rotation
    return heads - tips


def test_the_default_dimensions_are_those_of_reachy_mini():
    """[ReachyMini]: centres of two circles, and two anchors, m, to the digits of its model."""
    centres = [one.centre for one in WRIST.horns]
    assert centres[0] == pytest.approx((0.0269906, 0.0267489, 0.0), abs=2e-7)
    assert centres[3] == pytest.approx((-0.0366607, -0.01, 0.0), abs=2e-7)
    assert WRIST.platform[1] == pytest.approx((0.0085238, 0.0287637, 0.0), abs=1e-7)
    assert WRIST.platform[2] == pytest.approx((-0.0291719, 0.007, 0.0), abs=1e-7)


@given(poses)
def test_angles_are_those_at_which_every_rod_has_its_length(pose):
    angles = reached(pose)
    assert np.linalg.norm(rods(angles, pose), axis=1) == pytest.approx([0.085] * 6, rel=1e-13)


@given(poses, twists)
def test_rates_are_the_change_of_the_angles(pose, twist):
    angles, h = reached(pose), 1e-7
    assume(WRIST.margin(angles) > 0.05)
    ahead, behind = (
        np.array(WRIST.inverse(WRIST.target_pose(pose, twist, dt), angles)) for dt in (h, -h)
    )
    assert WRIST.rates(angles, twist) == pytest.approx((ahead - behind) / (2 * h), abs=2e-5)
    assert WRIST.jacobian(angles) @ WRIST.rates(angles, twist) == pytest.approx(twist, abs=1e-9)


@given(poses, st.tuples(*[st.floats(-5.0, 5.0)] * 6))
def test_servos_do_the_work_that_the_platform_gets(pose, forces):
    """What the rods push, times how fast their tips move, is what the platform is pushed."""
    angles = reached(pose)
    assume(WRIST.margin(angles) > 0.01)
    along = rods(angles, pose) / 0.085
    arms = np.array(WRIST.platform) @ pose.rotation
    pushes = along * np.array(forces)[:, None]
    wrench = np.concatenate(
        [pose.rotation @ pushes.sum(axis=0), pose.rotation @ np.cross(arms, pushes).sum(axis=0)]
    )
    h = 1e-6
    tips = [(np.array(WRIST.tips(np.add(angles, d))) * along).sum(axis=1) for d in (h, -h)]
    torques = np.array(forces) * (tips[0] - tips[1]) / (2 * h)
    assert WRIST.jacobian(angles).T @ wrench == pytest.approx(torques, abs=1e-7)


def test_home_is_level_and_its_servos_are_alike():
    assert HOME.position == (0.0, 0.0, 0.1003667)
    assert [*WRIST.home] == pytest.approx([0.6265407, -0.6265407] * 3, abs=1e-7)
    assert WRIST.clearances(WRIST.home)[0].remaining > 0.2


def test_angles_within_the_makers_limits_lead_to_their_pose_from_home_and_from_sleep():
    """[ReachyMini]: its head sleeps 44 mm below home, pitched by 24°."""
    sleep = Pose(turned(HOME.quaternion, (0.0, 0.426, 0.0), 1.0), (-0.021, 0.001, 0.0563667))
    rng, seen = np.random.default_rng(0), 0
    while seen < 100:
        rates = tuple(rng.uniform(-0.5, 0.5, 3).tolist())
        place = np.array(HOME.position) + rng.uniform(-0.03, 0.03, 3)
        pose = Pose(turned(HOME.quaternion, rates, 1.0), tuple(place.tolist()))
        try:
            angles = tuple(WRIST.assembly_at(pose))
        except UnreachableError:
            continue
        if np.any(angles < LOWER) or np.any(angles > UPPER):
            continue
        seen += 1
        for near in (None, sleep):
            found = WRIST.solve(angles, near)
            assert found.status == Status.CONVERGED
            assert math.dist(found.pose.position, pose.position) < 1e-12
            off = rates_between(found.pose.quaternion, pose.quaternion, 1.0)
            assert off == pytest.approx((0, 0, 0), abs=1e-11)


def test_angles_without_a_pose_belong_to_home():
    pose = Pose(turned(HOME.quaternion, (0.2, -0.1, 0.3), 1.0), (0.01, -0.01, 0.0983667))
    plain = tuple(WRIST.assembly_at(pose))
    assert not isinstance(plain, Assembly)
    assert WRIST.forward(plain).position == pytest.approx(pose.position, abs=1e-14)
    assert WRIST.margin(plain) == pytest.approx(WRIST.margin(WRIST.assembly_at(pose)))


def test_angles_that_no_pose_has_are_refused():
    with pytest.raises(UnreachableError, match=r'angles .* rad have no pose that home'):
        WRIST.forward((1.4, 1.4, -1.4, -1.4, 1.4, 1.4))


def test_angles_far_from_a_pose_that_fit_another_as_well_are_refused():
    pose = Pose(turned(HOME.quaternion, (0.3, 0.2, 0.1), 1.0), (0.01, -0.015, 0.0883667))
    angles = tuple(WRIST.assembly_at(pose))
    kinematics, lengths = WRIST.kinematics_at(angles)
    assert kinematics.cold_start(lengths).others
    with pytest.raises(UnreachableError, match=r'within 0\.25 rad of them, or drive the rods'):
        WRIST.resolve_assembly(angles, HOME)
    near = Pose(pose.quaternion, (0.01, -0.013, 0.0893667))
    assert WRIST.resolve_assembly(angles, near).pose.position == pytest.approx(pose.position)


EDGES = {
    'yaw': (0, 0, 0, 0, 0, 0.5),
    'tilt about x': (0, 0, 0, 0.5, 0, 0),
    'tilt about −y': (0, 0, 0, 0, -0.5, 0),
    'rising': (0, 0, 0.05, 0, 0, 0),
    'sinking': (0, 0, -0.05, 0, 0, 0),
    'sideways': (0, 0.05, 0, 0, 0, 0),
}


@pytest.mark.parametrize('twist', EDGES.values(), ids=EDGES)
def test_the_hand_slows_before_its_edges_and_backs_out_freely(twist):
    state = start(WRIST)
    for _ in range(700):
        made = step(WRIST, state, twist, 0.01)
        state = made.state
    assert made.scale_factor < 0.02
    assert 'straight with its rod' in made.limits[0].joint or 'lock' in made.limits[0].joint
    clear = [clearance.remaining for clearance in WRIST.clearances(state.positions)]
    assert -1e-9 < min(clear) < 0.01
    assert step(WRIST, state, [-x for x in twist], 0.01).scale_factor > 0.5


def test_straight_up_a_horn_and_its_rod_are_straight():
    """At its highest level pose the rods' tips, servos and anchors lie in one line each."""
    low, high = 0.1003667, 0.2
    for _ in range(60):
        middle = 0.5 * (low + high)
        try:
            WRIST.assembly_at(Pose(HOME.quaternion, (0.0, 0.0, middle)))
            low = middle
        except UnreachableError:
            high = middle
    with pytest.raises(UnreachableError) as refused:
        WRIST.assembly_at(Pose(HOME.quaternion, (0.0, 0.0, high)))
    assert refused.value.limit == 'servo_1 straight with its rod'
    apart = math.dist(WRIST.platform[0][:2], WRIST.horns[0].centre[:2])
    out = math.cos(math.pi / 3.0), math.sin(math.pi / 3.0)
    between = np.subtract(WRIST.platform[0][:2], WRIST.horns[0].centre[:2])
    aside = abs(between @ out)  # a horn has no part in what is along its servo's axis
    in_plane = math.sqrt(apart**2 - aside**2)
    reach = 0.04 + math.sqrt(0.085**2 - aside**2)
    assert low == pytest.approx(math.sqrt(reach**2 - in_plane**2), abs=1e-9)
    assert WRIST.margin(WRIST.assembly_at(Pose(HOME.quaternion, (0.0, 0.0, low)))) < 1e-5


def test_the_edge_that_is_near_names_what_is_lost():
    top = Pose(HOME.quaternion, (0.0, 0.0, 0.1003667))
    for shift in np.linspace(0.0, 0.06, 601):
        try:
            angles = WRIST.assembly_at(Pose(HOME.quaternion, (0.0, shift, 0.1003667)))
        except UnreachableError:
            break
        top = angles
    rates = np.array([WRIST.rates(top, row) for row in np.eye(6).tolist()]).T
    worst = np.linalg.svd(rates)[2][0][3:]
    lost = np.array(WRIST.lost_axis(top))
    assert np.linalg.norm(np.cross(lost, worst / np.linalg.norm(worst))) < 0.05


def test_points_given_one_by_one_are_the_same_wrist():
    same = make_wrist(
        'rotary_stewart',
        hinge_centres=np.array([one.centre for one in WRIST.horns]),
        hinge_axes=[[2.0 * x for x in one.axis] for one in WRIST.horns],
        horn_directions=[x for one in WRIST.horns for x in one.along],
        platform_anchors=np.array(WRIST.platform),
        platform_radius=1.0,
        hinge_radius=1.0,
    )
    assert [*same.home] == pytest.approx([*WRIST.home], abs=1e-12)
    assert same.size == pytest.approx(0.03)


@given(poses)
@settings(max_examples=30)
def test_horns_of_any_pose_make_the_same_rods(pose):
    """Axes that are neither level nor radial, another length of each horn's zero."""
    tilted = make_wrist(
        'rotary_stewart',
        hinge_axes=np.array([one.axis for one in WRIST.horns]) + 0.2 * np.eye(6, 3),
        horn_directions=np.array([one.along for one in WRIST.horns]) + 0.3 * np.eye(6, 3, -2),
    )
    try:
        angles = tilted.assembly_at(pose)
    except UnreachableError:
        assume(False)
    heads = np.array(pose.position) + np.array(tilted.platform) @ pose.rotation
    found = np.linalg.norm(heads - tilted.tips(angles), axis=1)
    assert found == pytest.approx([0.085] * 6, rel=1e-12)
    solved = tilted.solve(tuple(angles), pose)
    assert math.dist(solved.pose.position, pose.position) < 1e-12


@pytest.mark.parametrize(
    ('wrong', 'says'),
    [
        ({'rod_length': 0.0}, 'rod_length is 0.0; valid is 1e-06'),
        ({'horn_length': math.nan}, 'horn_length is nan'),
        ({'hinge_axes': [0.0] * 18}, 'The axis of servo_1 has no direction'),
        ({'hinge_centres': [0.0] * 6}, 'hinge_centres has 6 numbers; give six points'),
        ({'home_height': 0.5}, 'horn of servo_1 and its rod do not reach the platform'),
        ({'rod_length': 0.01}, 'horn of servo_1 and its rod do not reach the platform'),
        ({'platform_anchors': np.eye(3)[0] * np.arange(6)[:, None] * 1e-3}, 'do not hold the pl'),
    ],
)
def test_what_cannot_be_a_platform_is_refused(wrong, says):
    with pytest.raises(InvalidValueError, match=says):
        make_wrist('rotary_stewart', **wrong)


def test_the_hand_stops_before_lock_and_not_at_it():
    assert all(c.horizon > 0.0 for c in WRIST.clearances(WRIST.home))
    assert WRIST.clearances(WRIST.home)[0].remaining == pytest.approx(
        abs(WRIST.home.hadamard_ratio) - EDGE
    )
