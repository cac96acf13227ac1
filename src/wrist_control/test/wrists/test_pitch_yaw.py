"""The serial pitch-yaw pointer against [Canfield1997], (4.30), and explicit matrices."""

import math

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

from wrist_control import fly
from wrist_control.operating.maneuvers import Maneuver, Segment
from wrist_control.wrists.pitch_yaw import PitchYaw

WRIST = PitchYaw()
joints = st.tuples(st.floats(-4.0, 4.0), st.floats(-4.0, 4.0))
regular = st.tuples(st.floats(-1.3, 1.3), st.floats(-4.0, 4.0))
rates = st.tuples(*(st.floats(-1.0, 1.0),) * 3)


def pointing(t1, t2):
    """Return N of [Canfield1997], (4.30)."""
    return [math.sin(t2) * math.cos(t1), -math.sin(t1), math.cos(t2) * math.cos(t1)]


@given(joints)
def test_hand_is_turned_about_y_and_then_about_its_own_x(positions):
    (s1, c1), (s2, c2) = ((math.sin(x), math.cos(x)) for x in positions)
    about_x = np.array([[1.0, 0.0, 0.0], [0.0, c1, -s1], [0.0, s1, c1]])
    about_y = np.array([[c2, 0.0, s2], [0.0, 1.0, 0.0], [-s2, 0.0, c2]])
    rotation = WRIST.forward(positions).rotation
    np.testing.assert_allclose(rotation.T, about_y @ about_x, atol=1e-12)
    np.testing.assert_allclose(rotation[2], pointing(*positions), atol=1e-12)


@given(joints)
def test_inverse_undoes_forward_to_the_same_turn(positions):
    assert WRIST.inverse(WRIST.forward(positions), positions) == pytest.approx(positions)


@given(regular, rates)
def test_yaw_forces_a_roll_that_grows_with_the_tangent_of_theta_1(positions, twist):
    r = (WRIST.jacobian(positions) @ WRIST.rates(positions, twist))[2]
    assert r == pytest.approx(-twist[1] * math.tan(positions[0]), abs=1e-9)


def test_margin_is_zero_where_the_hand_points_along_the_first_axis():
    assert WRIST.margin((0.5 * math.pi, 1.0)) == pytest.approx(0.0, abs=1e-12)
    assert np.linalg.svd(WRIST.jacobian((1.0, 2.0))[:2])[1].min() == pytest.approx(
        WRIST.margin((1.0, 2.0))
    )


@pytest.mark.parametrize('limit', [None, 1.0])
def test_hand_goes_straight_through_lock(limit):
    over = Maneuver('over', (Segment((1.0, 0.0, 0.0), math.pi),))
    flight = fly(WRIST, over, joint_rate_limits=limit)
    assert flight.completed
    assert flight.time_lost[-1] == pytest.approx(0.0, abs=1e-9)
    assert flight.joint_positions[-1] == pytest.approx([math.pi, 0.0], abs=1e-9)


def test_near_lock_the_pointing_slows_and_keeps_its_rate_limits():
    beside = Maneuver('beside', (Segment((1.0, 0.02, 0.0), 0.5 * math.pi),))
    flight = fly(WRIST, beside, joint_rate_limits=1.5)
    assert flight.scale_factor.min() < 0.9
    assert np.abs(flight.joint_rates).max() <= 1.5 * (1.0 + 1e-6)
