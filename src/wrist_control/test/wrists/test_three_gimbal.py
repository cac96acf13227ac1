"""The three-gimbal wrist against explicit rotations and finite differences, and at its lock."""

import math

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

from wrist_control.rotations import Pose, quaternion_of, rates_between, turned
from wrist_control.wrists.three_gimbal import ThreeGimbal

WRIST = ThreeGimbal()
LOCKED = 0.5 * math.pi

angles = st.floats(-8.0, 8.0)
gimbals = st.tuples(angles, angles, angles)
unlocked = gimbals.filter(lambda x: abs(math.cos(x[1])) > 0.01)
twists = st.tuples(*(st.floats(-2.0, 2.0),) * 3)
roundoff = st.lists(st.floats(-1e-15, 1e-15), min_size=9, max_size=9)


def X(phi):
    s, c = math.sin(phi), math.cos(phi)
    return np.array([[1.0, 0.0, 0.0], [0.0, c, s], [0.0, -s, c]])


def Y(theta):
    s, c = math.sin(theta), math.cos(theta)
    return np.array([[c, 0.0, -s], [0.0, 1.0, 0.0], [s, 0.0, c]])


def Z(psi):
    s, c = math.sin(psi), math.cos(psi)
    return np.array([[c, s, 0.0], [-s, c, 0.0], [0.0, 0.0, 1.0]])


def test_joints_are_called_by_their_symbols_outermost_first():
    assert [joint.name for joint in WRIST.joints] == ['psi', 'theta', 'phi']
    assert {joint.kind for joint in WRIST.joints} == {'revolute'}


@given(gimbals)
def test_forward_turns_about_z_then_y_then_x(positions):
    psi, theta, phi = positions
    pose = WRIST.forward(positions)
    np.testing.assert_allclose(pose.rotation, X(phi) @ Y(theta) @ Z(psi), atol=1e-14)
    assert pose.position == (0.0, 0.0, 0.0)


@given(gimbals)
def test_jacobian_is_the_finite_difference_of_forward(positions):
    h = 1e-5
    here = WRIST.forward(positions).quaternion
    for joint, column in enumerate(WRIST.jacobian(positions).T):
        along = h * np.eye(3)[joint]
        ahead = rates_between(here, WRIST.forward(np.array(positions) + along).quaternion, h)
        behind = rates_between(here, WRIST.forward(np.array(positions) - along).quaternion, h)
        np.testing.assert_allclose(column, 0.5 * np.subtract(ahead, behind), atol=1e-8)


@given(unlocked, twists)
def test_rates_are_those_that_make_the_twist(positions, twist):
    rates = WRIST.rates(positions, twist)
    np.testing.assert_allclose(WRIST.jacobian(positions) @ rates, twist, atol=1e-12)


@given(gimbals)
def test_margin_is_the_determinant_of_the_jacobian(positions):
    determinant = abs(np.linalg.det(WRIST.jacobian(positions)))
    assert WRIST.margin(positions) == pytest.approx(determinant, abs=1e-12)


def test_the_axis_that_is_lost_at_lock_is_the_hands_own_across_both_gimbals():
    for phi in (0.0, 0.4, 2.0):
        axis = WRIST.lost_axis((0.3, LOCKED, phi))
        across = (0.0, math.sin(phi), math.cos(phi))
        assert abs(np.dot(axis, across)) == pytest.approx(1.0)


@given(unlocked, st.tuples(*(st.floats(-0.5, 0.5),) * 3))
def test_inverse_finds_the_branch_and_the_whole_turns_of_its_neighbour(positions, off):
    near = np.array(positions) + off
    found = WRIST.inverse(WRIST.forward(positions), near)
    np.testing.assert_allclose(found, positions, atol=1e-11)


@given(unlocked)
def test_inverse_finds_the_other_branch_when_that_is_near(positions):
    psi, theta, phi = positions
    other = (psi + math.pi, math.pi - theta, phi + math.pi)
    np.testing.assert_allclose(WRIST.inverse(WRIST.forward(positions), other), other, atol=1e-11)


@given(angles, st.sampled_from([-1.0, 1.0]), angles, roundoff)
def test_at_lock_phi_stays_where_it_is_whatever_round_off_does(psi, side, phi, noise):
    theta = side * LOCKED
    shaken = (X(phi) @ Y(theta) @ Z(psi)) + np.reshape(noise, (3, 3))
    found = WRIST.inverse(Pose(quaternion_of(shaken)), (psi, theta, phi))
    assert found[2] == phi
    np.testing.assert_allclose(found, (psi, theta, phi), atol=1e-7)


@given(
    angles,
    st.sampled_from([-1.0, 1.0]),
    angles,
    st.floats(-12.0, -3.0),
    st.sampled_from([-1.0, 1.0]),
    roundoff,
)
def test_near_lock_nothing_flips_by_half_a_turn(psi, side, phi, exponent, beyond, noise):
    theta = side * LOCKED + beyond * 10.0**exponent
    shaken = (X(phi) @ Y(theta) @ Z(psi)) + np.reshape(noise, (3, 3))
    found = WRIST.inverse(Pose(quaternion_of(shaken)), (psi, theta, phi))
    assert max(abs(a - b) for a, b in zip(found, (psi, theta, phi), strict=True)) < 1e-4
    np.testing.assert_allclose(WRIST.forward(found).rotation, shaken, atol=1e-8)


@given(angles, st.floats(-7.0, -2.0), angles, st.tuples(*(st.floats(-0.5, 0.5),) * 3))
def test_near_lock_the_hand_is_still_where_the_gimbals_say(psi, exponent, phi, off):
    positions = (psi, LOCKED - 10.0**exponent, phi)
    found = WRIST.inverse(WRIST.forward(positions), np.array(positions) + off)
    np.testing.assert_allclose(found, positions, atol=1e-7)


@given(angles, st.floats(1e-4, 0.05), st.sampled_from([-1.0, 1.0]))
def test_pitching_over_the_pole_takes_theta_beyond_90_degrees(psi, angle, side):
    positions = (psi, side * (LOCKED - 10.4 * angle), 0.0)
    pose = WRIST.forward(positions)
    for k in range(20):
        pose = Pose(turned(pose.quaternion, (0.0, side * angle, 0.0), 1.0))
        positions = WRIST.inverse(pose, positions)
        expected = (psi, side * (LOCKED + (k - 9.4) * angle), 0.0)
        np.testing.assert_allclose(positions, expected, atol=1e-9)


def test_yaw_exactly_at_lock_turns_psi_and_phi_by_a_quarter():
    pose = Pose(turned(WRIST.forward((0.0, LOCKED, 0.0)).quaternion, (0.0, 0.0, 0.02), 1.0))
    found = WRIST.inverse(pose, (0.0, LOCKED, 0.0))
    assert np.abs(found) == pytest.approx((LOCKED, LOCKED - 0.02, LOCKED))
    assert found[0] == pytest.approx(found[2])
