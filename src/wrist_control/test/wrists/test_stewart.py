"""The Stewart platform as a wrist: geometry, six rates, and what happens near lock."""

import math

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from wrist_control import InvalidValueError, UnreachableError, make_wrist
from wrist_control.resolving import LimitKind, start, step
from wrist_control.resolving.homing import has_reached, step_home
from wrist_control.rotations import IDENTITY, Pose, about_z, rates_between, turned
from wrist_control.stewart.forward_kinematics import Status
from wrist_control.units import INCH
from wrist_control.wrists.platform import EDGE, Assembly

from .near_home import poses_near

WRIST = make_wrist('stewart')
HOME = WRIST.home.pose
DT = 0.01

poses = poses_near(HOME, 0.06)
twists = st.tuples(*[st.floats(-1.0, 1.0)] * 6).filter(lambda t: max(map(abs, t)) > 0.05)


def explicit_lengths(pose):
    """The same by matrices in base axes: l = |d + R p − b|, R from the rotation vector."""
    rotation = pose.rotation.T
    platform, base = np.array(WRIST.platform), np.array(WRIST.base)
    return np.linalg.norm(np.array(pose.position) + platform @ rotation.T - base, axis=1)


def fly(wrist, twist, steps, state=None):
    state = state or start(wrist)
    made = None
    for _ in range(steps):
        made = step(wrist, state, twist, DT)
        state = made.state
    return made


def test_anchors_lie_where_the_figure_shows_them():
    # [Nguyen1991], fig. 3: x is perpendicular to the lines from anchor 1 to 6; 1 to 2 spans θ.
    for anchors, radius, angle in (
        (WRIST.platform, 10.441 * INCH, math.radians(99.2)),
        (WRIST.base, 13.838 * INCH, math.radians(16.0)),
    ):
        points = np.array(anchors)
        assert points[0, 0] == pytest.approx(points[5, 0], abs=1e-15)
        for leg in (0, 2, 4):
            between = points[leg] @ points[leg + 1] / radius**2
            assert math.acos(between) == pytest.approx(angle, abs=1e-12)
        for one, other in ((0, 2), (2, 4)):
            assert points[one] @ points[other] / radius**2 == pytest.approx(-0.5, abs=1e-12)
        assert np.allclose(points.sum(axis=0), 0.0, atol=1e-15)


@given(poses)
def test_lengths_are_those_of_explicit_matrices(pose):
    assert WRIST.inverse(pose, WRIST.home) == pytest.approx(explicit_lengths(pose), rel=1e-14)


@given(poses, twists)
def test_rates_are_the_change_of_the_lengths(pose, twist):
    lengths, h = WRIST.assembly_at(pose), 1e-6
    ahead, behind = (explicit_lengths(WRIST.target_pose(pose, twist, dt)) for dt in (h, -h))
    assert WRIST.rates(lengths, twist) == pytest.approx((ahead - behind) / (2 * h), abs=1e-8)


@given(poses, twists)
def test_jacobian_gives_back_the_twist(pose, twist):
    lengths = WRIST.assembly_at(pose)
    rates = WRIST.rates(lengths, twist)
    assert WRIST.jacobian(lengths) @ rates == pytest.approx(twist, abs=1e-11)


@given(poses, twists, st.tuples(*[st.floats(-50.0, 50.0)] * 6))
def test_legs_do_the_work_that_the_platform_gets(pose, twist, forces):
    lengths = WRIST.assembly_at(pose)
    rotation, d = pose.rotation.T, np.array(pose.position)
    arms = np.array(WRIST.platform) @ rotation.T
    pulls = d + arms - np.array(WRIST.base)
    pulls *= (np.array(forces) / np.linalg.norm(pulls, axis=1))[:, None]
    force, moment = pulls.sum(axis=0), np.cross(arms, pulls).sum(axis=0)
    power = force @ rotation @ twist[:3] + moment @ rotation @ twist[3:]
    assert np.dot(forces, WRIST.rates(lengths, twist)) == pytest.approx(power, abs=1e-9)


def test_home_is_level_centred_and_all_legs_are_equal():
    assert HOME.position == (0.0, 0.0, 17.0 * INCH)
    assert max(WRIST.home) == pytest.approx(min(WRIST.home), rel=1e-14)


def test_lengths_without_a_pose_belong_to_home():
    pose = Pose(turned(HOME.quaternion, (0.2, -0.1, 0.3), 1.0), (0.03, -0.02, 0.45))
    plain = tuple(WRIST.assembly_at(pose))
    found = WRIST.forward(plain)
    assert not isinstance(plain, Assembly)
    assert found.position == pytest.approx(pose.position, abs=1e-14)
    assert rates_between(found.quaternion, pose.quaternion, 1.0) == pytest.approx(
        (0, 0, 0), abs=1e-13
    )
    assert WRIST.margin(plain) == pytest.approx(WRIST.margin(WRIST.assembly_at(pose)))


def test_lengths_that_no_pose_has_are_refused():
    with pytest.raises(UnreachableError, match='UNREACHABLE'):
        WRIST.forward((0.1, 0.5, 0.5, 0.5, 0.5, 2.5))


def test_a_platform_on_its_base_is_refused():
    pose = Pose(HOME.quaternion, tuple(np.subtract(WRIST.base[0], WRIST.platform[0])))
    with pytest.raises(UnreachableError, match='no length'):
        WRIST.assembly_at(pose)


@pytest.mark.parametrize('side', [-1.0, 1.0])
def test_yaw_of_a_quarter_turn_is_lock(side):
    at = Pose(about_z(side * 0.5 * math.pi), HOME.position)
    assert WRIST.margin(WRIST.assembly_at(at)) == pytest.approx(0.0, abs=1e-12)


def test_margin_has_no_unit():
    pose = Pose(turned(HOME.quaternion, (0.2, 0.3, 0.4), 1.0), (0.03, 0.02, 0.4))
    ten = make_wrist(
        'stewart',
        platform_anchors=10.0 * np.array(WRIST.platform),
        base_anchors=10.0 * np.array(WRIST.base),
        home_height=10.0 * WRIST.home_height,
    )
    larger = Pose(pose.quaternion, tuple(10.0 * x for x in pose.position))
    assert ten.margin(ten.assembly_at(larger)) == pytest.approx(
        WRIST.margin(WRIST.assembly_at(pose))
    )


@given(poses)
def test_margin_is_at_most_one(pose):
    assert 0.0 <= WRIST.margin(WRIST.assembly_at(pose)) <= 1.0


def test_the_lost_axis_at_a_quarter_turn_is_the_normal():
    lengths = WRIST.assembly_at(Pose(about_z(0.5 * math.pi - 1e-6), HOME.position))
    assert np.abs(WRIST.lost_axis(lengths)) == pytest.approx((0, 0, 1), abs=1e-3)


def test_where_no_turn_is_lost_the_lost_axis_is_still_a_unit_vector():
    """Six legs that hold all but a shift along x: rows of (n, p × n) without its first column."""
    lines = tuple(tuple(row) for row in np.eye(6)[[1, 2, 3, 4, 5, 5]].tolist())
    axis = WRIST.lost_axis(Assembly(tuple(WRIST.home), HOME, lines, WRIST.size))
    assert axis == (0.0, 0.0, 1.0)  # the turn that locks a platform at last


def test_a_leg_cannot_be_shorter_than_nothing():
    assert {joint.lower for joint in WRIST.joints} == {0.0}


@given(twists)
@settings(max_examples=30)
def test_all_six_rates_are_scaled_alike(twist):
    wrist = WRIST.with_limits(rates=0.05)
    made = step(wrist, start(wrist), twist, DT)
    assert made.achieved == pytest.approx([made.scale_factor * x for x in twist], abs=1e-9)
    assert max(map(abs, made.joint_rates)) <= 0.05 * (1 + 1e-6)


LOCKS = {
    'yaw': (0, 0, 0, 0, 0, 1.0),
    'yaw the other way': (0, 0, 0, 0, 0, -1.0),
    'tilt about x': (0, 0, 0, 1.0, 0, 0),
    'tilt about y': (0, 0, 0, 0, 1.0, 0),
    'tilt about −y': (0, 0, 0, 0, -1.0, 0),
    'sinking': (0, 0, -0.2, 0, 0, 0),
}


@pytest.mark.parametrize('twist', LOCKS.values(), ids=LOCKS)
def test_the_hand_slows_before_lock_and_backs_out_freely(twist):
    made = fly(WRIST, twist, 500)
    assert made.scale_factor < 0.01
    assert EDGE < made.margin < EDGE + 0.002
    assert made.limits[0].joint == 'the legs near lock'
    back = step(WRIST, made.state, [-x for x in twist], DT)
    assert back.scale_factor == 1.0


def test_one_long_step_cannot_jump_over_lock():
    made = step(WRIST, start(WRIST), (0, 0, 0, 0, 0, 1.0), 2.5)
    assert made.scale_factor < 1.0
    assert WRIST.clearances(made.state.positions)[0].remaining > -1e-8


def test_the_stroke_ends_the_motion_and_backing_out_is_free():
    reach = WRIST.home[0] + 0.02
    wrist = WRIST.with_limits(upper=reach)
    made = fly(wrist, (0, 0, 0.1, 0, 0, 0), 100)
    assert made.scale_factor == pytest.approx(0.0, abs=1e-6)
    assert max(made.state.positions) == pytest.approx(reach, abs=1e-8)
    assert {limit.kind for limit in made.limits} == {LimitKind.POSITION}
    assert step(wrist, made.state, (0, 0, -0.1, 0, 0, 0), DT).scale_factor == 1.0


def test_the_pose_does_not_drift_from_its_lengths():
    made = fly(WRIST, (0.02, -0.03, 0.01, 0.1, -0.2, 0.15), 200)
    state = made.state
    assert state.positions == pytest.approx(explicit_lengths(state.pose), rel=1e-13)


def test_the_way_home_is_made_of_lengths_alone():
    wrist = WRIST.with_limits(rates=0.1)
    state = fly(wrist, (0.05, -0.05, 0.02, 0.3, 0.2, -0.3), 100, start(wrist)).state
    for _ in range(200):
        state = step_home(wrist, state, wrist.home, DT).state
    assert has_reached(state, wrist.home)
    assert state.pose.position == pytest.approx(HOME.position, abs=1e-9)
    assert step(wrist, state, (0, 0, 0, 0, 0, 0.1), DT).scale_factor == 1.0


def test_twelve_anchors_are_the_same_wrist_as_the_ring():
    same = make_wrist(
        'stewart',
        platform_anchors=[x for point in WRIST.platform for x in point],
        base_anchors=np.array(WRIST.base),
    )
    assert tuple(same.home) == tuple(WRIST.home)
    assert same.size == pytest.approx(10.441 * INCH)


@pytest.mark.parametrize(
    ('wrong', 'says'),
    [
        ({'platform_radius': -1.0}, 'platform_radius is -1.0'),
        ({'base_angle': 3.0}, 'base_angle is 3.0'),
        ({'platform_anchors': [[0.0, 0.0, 0.0]]}, 'platform_anchors has 3 numbers'),
        ({'base_anchors': [math.nan] * 18}, 'base_anchors has 18 numbers'),
        ({'platform_angle': 0.3, 'base_angle': 0.3}, 'do not hold the platform'),
        *(
            ({name: 0.0}, f'{name} is 0.0; valid is 1e-06 to inf m')
            for name in ('platform_radius', 'base_radius', 'home_height')
        ),
        *(
            ({name: -1e-9}, f'{name} is -1e-09; valid is 0 to 2.0944 rad')
            for name in ('platform_angle', 'base_angle')
        ),
    ],
)
def test_what_cannot_be_a_platform_is_refused(wrong, says):
    with pytest.raises(InvalidValueError, match=says):
        make_wrist('stewart', **wrong)


def yaw_of(pose):
    return rates_between(HOME.quaternion, pose.quaternion, 1.0)[2]


def test_yaw_comes_within_three_degrees_of_lock_and_its_pose_is_still_proved():
    state = fly(WRIST, (0, 0, 0, 0, 0, 1.0), 1500).state
    assert 0.5 * math.pi - math.radians(3.0) < yaw_of(state.pose) < 0.5 * math.pi
    found = WRIST.forward_kinematics.solve(tuple(state.positions), state.pose)
    assert found.status == Status.CONVERGED


def test_the_hand_brakes_gently_before_lock():
    """From 1 rad/s of yaw, in rad/s²."""
    state, factors = start(WRIST), [1.0]
    for _ in range(400):
        made = step(WRIST, state, (0, 0, 0, 0, 0, 1.0), DT)
        state = made.state
        factors.append(made.scale_factor)
    assert np.diff(factors).min() > -3.0 * DT
    assert factors[-1] < 0.01


def pose_with_first_leg(share):
    """Return a pose whose leg 1 has a length of so much of the platform's size."""
    x, y, z = np.subtract(WRIST.base[0], WRIST.platform[0]).tolist()
    return Pose(IDENTITY, (x, y, z + share * WRIST.size))


def test_a_leg_of_a_millionth_of_the_size_is_the_shortest_that_has_a_direction():
    shortest = WRIST.assembly_at(pose_with_first_leg(2e-6))
    assert shortest.lines[0][:3] == pytest.approx((0.0, 0.0, 1.0), abs=1e-9)
    with pytest.raises(UnreachableError, match='leg_1 would have no length'):
        WRIST.assembly_at(pose_with_first_leg(5e-7))
