"""The Omni-Wrist against the double Hooke wrist and the planes of its drives. [McKinney1988]."""

import math

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st
from scipy.spatial.transform import Rotation

from wrist_control import InvalidValueError, UnreachableError, fly, make_wrist
from wrist_control.operating.maneuvers import BARKER_SPEED, Maneuver, turn
from wrist_control.resolving import start
from wrist_control.wrists.double_hooke import DoubleHooke
from wrist_control.wrists.omni_wrist import OmniWrist

WRIST = OmniWrist(shaft_length=0.2)
HOOKE = DoubleHooke(shaft_length=0.2)
angles = st.floats(-3.0, 3.0)
bends = st.floats(-1.2, 1.2)
joints = st.tuples(angles, bends, bends)
commands = st.tuples(*(st.floats(-1.0, 1.0),) * 3)


def drives(positions):
    """Return the drives' axes Y_igd and Z_ogd in forearm axes. [McKinney1988], (28) and (29)."""
    _, theta_a, psi_a = positions
    inner = Rotation.from_euler('Z', psi_a).as_matrix()
    outer = Rotation.from_euler('Y', theta_a).as_matrix()
    return inner[:, 1], outer[:, 2]


def as_hooke(positions):
    """Return the double Hooke wrist's φ, θ, ψ that put its shaft where the drives hold it."""
    inner, outer = drives(positions)
    shaft = np.cross(inner, outer)
    phi = positions[0]
    x, y, z = Rotation.from_euler('X', -phi).apply(shaft / np.linalg.norm(shaft))
    return (phi, math.atan2(-z, x), math.asin(y))


@given(joints)
def test_the_shaft_rides_square_to_both_drives(positions):
    shaft = WRIST.forward(positions).position
    np.testing.assert_allclose([shaft @ axis for axis in drives(positions)], 0.0, atol=1e-12)
    assert np.linalg.norm(shaft) == pytest.approx(0.2)


@given(joints)
def test_the_hand_is_that_of_the_double_hooke_wrist(positions):
    pose, expected = WRIST.forward(positions), HOOKE.forward(as_hooke(positions))
    np.testing.assert_allclose(pose.rotation, expected.rotation, atol=1e-9)
    np.testing.assert_allclose(pose.position, expected.position, atol=1e-9)


@given(joints)
def test_equations_35_and_36_give_the_drives_angles(positions):
    phi, theta, psi = as_hooke(positions)
    shaft = Rotation.from_euler('XYZ', [phi, theta, psi]).apply([1.0, 0.0, 0.0])
    found = WRIST.inverse(HOOKE.forward((phi, theta, psi)), positions)
    np.testing.assert_allclose(found, positions, atol=1e-9)
    assert math.tan(found[1]) == pytest.approx(-shaft[2] / shaft[0])
    assert math.tan(found[2]) == pytest.approx(shaft[1] / shaft[0])


@given(joints, commands)
def test_actuator_rates_move_the_shaft_as_the_double_hooke_rates_do(positions, twist):
    """θ̇a and ψ̇a follow from (35) and (36), differentiated along eqs. (20) and (24) to (26)."""
    hooke = as_hooke(positions)
    hooke_rates = HOOKE.rates(hooke, twist)
    x, y, z = HOOKE.forward(hooke).position
    dx, dy, dz = HOOKE.origin_jacobian(hooke) @ hooke_rates
    theta_rate = (z * dx - x * dz) / (x * x + z * z)
    psi_rate = (x * dy - y * dx) / (x * x + y * y)
    expected = (hooke_rates[0], theta_rate, psi_rate)
    np.testing.assert_allclose(WRIST.rates(positions, twist), expected, rtol=1e-8, atol=1e-8)


@given(joints)
def test_pure_roll_needs_one_actuator_alone(positions):
    assert WRIST.rates(positions, (0.7, 0.0, 0.0)) == (0.7, 0.0, 0.0)


def test_roll_at_full_bend_leaves_the_drives_at_rest():
    roll = Maneuver('roll', (turn(0, math.tau, BARKER_SPEED),))
    flight = fly(WRIST, roll, initial_positions=(0.0, math.radians(45.0), 0.0))
    assert flight.completed
    np.testing.assert_allclose(np.ptp(flight.joint_positions[:, 1:], axis=0), 0.0, atol=1e-9)


def test_its_flight_is_that_of_the_double_hooke_wrist():
    omni, hooke = fly('omni_wrist', 'basic_test'), fly('double_hooke', 'basic_test')
    assert omni.completed
    assert omni.time_lost[-1] == 0.0
    np.testing.assert_allclose(omni.hand_rotation, hooke.hand_rotation, atol=1e-9)
    np.testing.assert_allclose(omni.tip, hooke.tip, atol=1e-9)
    np.testing.assert_allclose(omni.margin, hooke.margin, atol=1e-9)


def test_figure_8_has_the_outer_drive_alone_at_45_deg():
    pose = HOOKE.forward((0.0, math.radians(45.0), 0.0))
    found = WRIST.inverse(pose, (0.0, 0.0, 0.0))
    np.testing.assert_allclose(np.degrees(found), (0.0, 45.0, 0.0), atol=1e-12)


def test_drives_that_hold_no_shaft_are_refused():
    flat = (0.0, 0.5 * math.pi, 0.5 * math.pi)
    with pytest.raises(UnreachableError, match='hold no shaft'):
        WRIST.forward(flat)
    with pytest.raises(InvalidValueError, match='cannot be taken'):
        start(WRIST, flat)
    with pytest.raises(InvalidValueError, match='outside: cone'):
        start(WRIST, (0.0, math.pi, 0.0))
    with pytest.raises(InvalidValueError, match='cone_half_angle'):
        make_wrist('omni_wrist', cone_half_angle=math.radians(91.0))
