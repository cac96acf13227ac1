"""The double Hooke wrist against the product of its joints' transformations. [McKinney1988]."""

import math

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st
from scipy.spatial.transform import Rotation

from wrist_control import InvalidValueError, fly, make_wrist
from wrist_control.operating.maneuvers import BARKER_SPEED, Maneuver, turn
from wrist_control.wrists.double_hooke import DoubleHooke

WRIST = DoubleHooke(shaft_length=0.2)
angles = st.floats(-3.0, 3.0)
bends = st.floats(-1.2, 1.2)
joints = st.tuples(angles, bends, bends)


def carried(positions, length=0.2):
    """Return the hand's axes and origin in forearm axes: [McKinney1988], eq. (13)."""
    phi, theta, psi = positions
    first = Rotation.from_euler('XYZ', [phi, theta, psi])
    second = Rotation.from_euler('ZY', [psi, theta])
    return (first * second).as_matrix(), first.apply([length, 0.0, 0.0])


@given(joints)
def test_the_second_joint_repeats_the_bend_of_the_first(positions):
    axes, origin = carried(positions)
    pose = WRIST.forward(positions)
    np.testing.assert_allclose(pose.rotation, axes.T, atol=1e-12)
    np.testing.assert_allclose(pose.position, origin, atol=1e-12)


@given(joints)
def test_the_hand_bends_twice_as_far_as_the_shaft_and_the_same_way(positions):
    pose = WRIST.forward(positions)
    shaft = np.array(pose.position) / 0.2
    x = pose.rotation[0]
    bend = math.acos(min(1.0, shaft[0]))
    assert x[0] == pytest.approx(math.cos(2.0 * bend), abs=1e-9)
    np.testing.assert_allclose(np.cross(shaft, (1.0, 0.0, 0.0)) @ x, 0.0, atol=1e-12)
    assert math.cos(bend) == pytest.approx(math.cos(positions[1]) * math.cos(positions[2]))


@given(joints)
def test_the_hand_is_tilted_without_torsion_then_rolled(positions):
    about_shaft_and_x = np.diag([1.0, -1.0, -1.0])
    shaft = np.array(WRIST.forward(positions).position) / 0.2
    half_turn = 2.0 * np.outer(shaft, shaft) - np.eye(3)
    tilt = half_turn @ about_shaft_and_x
    roll = Rotation.from_euler('X', positions[0]).as_matrix()
    np.testing.assert_allclose(WRIST.forward(positions).rotation, (tilt @ roll).T, atol=1e-12)


@pytest.mark.parametrize('positions', [(0.3, math.pi / 2, 0.4), (0.3, 0.4, math.pi / 2)])
def test_it_locks_where_either_joint_locks(positions):
    assert WRIST.margin(positions) == pytest.approx(0.0, abs=1e-15)
    assert abs(np.linalg.det(WRIST.jacobian(positions))) < 1e-12
    found = WRIST.inverse(WRIST.forward(positions), positions)
    np.testing.assert_allclose(found, positions, atol=1e-7)


@given(joints)
def test_the_determinant_vanishes_with_the_margin_only(positions):
    determinant = 4.0 * math.cos(positions[1]) * math.cos(positions[2]) ** 2
    assert np.linalg.det(WRIST.jacobian(positions)) == pytest.approx(determinant)


@given(joints)
def test_pure_roll_turns_the_driver_shaft_at_the_commanded_rate(positions):
    phi_rate, theta_rate, psi_rate = WRIST.rates(positions, (0.7, 0.0, 0.0))
    assert phi_rate == pytest.approx(0.7)
    assert theta_rate == pytest.approx(0.7 * math.cos(positions[1]) * math.tan(positions[2]))
    assert psi_rate == pytest.approx(-0.7 * math.sin(positions[1]))


def test_a_whole_roll_at_full_bend_moves_neither_the_direction_nor_the_origin():
    roll = Maneuver('roll', (turn(0, math.tau, BARKER_SPEED),))
    flight = fly(WRIST, roll, initial_positions=(0.0, math.radians(45.0), 0.0))
    assert flight.completed
    assert flight.time_lost[-1] == 0.0
    np.testing.assert_allclose(np.ptp(flight.hand_rotation[:, 0], axis=0), 0.0, atol=1e-9)
    np.testing.assert_allclose(np.ptp(flight.hand_position, axis=0), 0.0, atol=1e-9)
    np.testing.assert_allclose(flight.joint_rates[:-1, 0], BARKER_SPEED, rtol=1e-9)


def test_barkers_basic_maneuver_rides_on_the_cone_and_completes():
    flight = fly('double_hooke', 'basic_test')
    all_remaining = [flight.wrist.clearances(row)[0].remaining for row in flight.joint_positions]
    assert flight.completed
    assert flight.time_lost[-1] == 0.0
    np.testing.assert_allclose(all_remaining[90:], 0.0, atol=1e-9)
    np.testing.assert_allclose(np.degrees(flight.joint_positions[-1]), (90, 45, 0), atol=1e-6)


def test_position_is_flown_as_well_as_orientation():
    flight = fly(WRIST, 'basic_test')
    reached = [WRIST.forward(row).position for row in flight.joint_positions]
    np.testing.assert_allclose(flight.hand_position, reached, atol=1e-12)
    speeds = np.diff(flight.hand_position, axis=0) / np.diff(flight.time)[:, None]
    middles = 0.5 * (flight.joint_positions[1:] + flight.joint_positions[:-1])
    rates = flight.joint_rates[:-1]
    expected = [WRIST.origin_jacobian(q) @ v for q, v in zip(middles, rates, strict=True)]
    np.testing.assert_allclose(speeds, expected, atol=2e-5)


@pytest.mark.parametrize('length', [0.0, -0.1, math.inf])
def test_a_shaft_without_length_is_refused(length):
    with pytest.raises(InvalidValueError, match='shaft_length is '):
        make_wrist('double_hooke', shaft_length=length)
