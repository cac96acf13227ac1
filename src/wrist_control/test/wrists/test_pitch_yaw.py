"""The serial pitch-yaw pointer against [Canfield1997], (4.30), and explicit matrices."""

import math

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

from wrist_control import UnreachableError, fly
from wrist_control.operating.maneuvers import Maneuver, Segment
from wrist_control.rotations import Pose, about_z, product, rates_between
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


def test_a_roll_of_its_own_is_out_of_reach():
    pose = WRIST.forward((0.3, 0.4))
    with pytest.raises(UnreachableError, match='point'):
        WRIST.inverse(Pose(product(pose.quaternion, about_z(0.01))), (0.0, 0.0))


@given(joints)
def test_jacobian_is_the_finite_difference_of_forward(positions):
    h = 1e-6
    columns = []
    for joint in range(2):
        low, high = (
            WRIST.forward([x + side * h * (i == joint) for i, x in enumerate(positions)])
            for side in (-1.0, 1.0)
        )
        columns.append(rates_between(low.quaternion, high.quaternion, 2.0 * h))
    np.testing.assert_allclose(WRIST.jacobian(positions), np.array(columns).T, atol=1e-8)


@given(regular, rates)
def test_rates_make_p_and_q_and_the_roll_they_force(positions, twist):
    p, q, r = WRIST.jacobian(positions) @ WRIST.rates(positions, twist)
    assert (p, q) == pytest.approx(twist[:2], abs=1e-9)
    assert r == pytest.approx(-q * math.tan(positions[0]), abs=1e-9)


@given(regular, rates)
def test_advance_makes_p_and_q_to_second_order(positions, twist):
    pose = WRIST.forward(positions)
    for dt in (0.02, 0.01):
        after = WRIST.target_pose(pose, twist, dt)
        p, q, _ = rates_between(pose.quaternion, after.quaternion, dt)
        curvature = 1.0 / math.cos(positions[0]) ** 2
        assert abs(p - twist[0]) < 2.0 * curvature * dt**2
        assert abs(q - twist[1]) < 2.0 * curvature * dt**2


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
