"""What both pointers do alike: two joints make p and q, and the roll is what follows."""

import math

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

from wrist_control import UnreachableError
from wrist_control.rotations import Pose, about_z, product, rates_between
from wrist_control.wrists.carpal import Carpal
from wrist_control.wrists.five_bar import FiveBar
from wrist_control.wrists.pitch_yaw import PitchYaw

both = pytest.mark.parametrize('wrist', [PitchYaw(), FiveBar()], ids=['pitch_yaw', 'five_bar'])
# In every assembly, away from lock and from the equator.
joints = st.tuples(*(st.floats(-4.0, 4.0),) * 2).filter(
    lambda positions: min(abs(math.cos(x)) for x in positions) > 0.15
)
rates = st.tuples(*(st.floats(-1.0, 1.0),) * 3)


@both
@pytest.mark.parametrize('roll', [0.01, -0.01])
def test_a_roll_of_its_own_is_out_of_reach(wrist, roll):
    pose = wrist.forward((0.3, 0.4))
    with pytest.raises(UnreachableError, match='point'):
        wrist.inverse(Pose(product(pose.quaternion, about_z(roll))), (0.0, 0.0))


@pytest.mark.parametrize(
    'wrist', [PitchYaw(), FiveBar(), Carpal()], ids=['pitch_yaw', 'five_bar', 'carpal']
)
def test_a_roll_of_a_millionth_is_round_off_and_one_of_five_is_none(wrist):
    """Half of that for the Carpal wrist, whose quaternion has half the angle."""
    positions = tuple(x + 0.1 for x in wrist.home)
    pose = wrist.forward(positions)

    def rolled(angle):
        return Pose(product(pose.quaternion, about_z(angle)), pose.position)

    found = wrist.inverse(rolled(5e-7), positions)
    np.testing.assert_allclose(found, positions, atol=1e-5)
    for roll in (5e-6, -5e-6):
        with pytest.raises(UnreachableError):
            wrist.inverse(rolled(roll), positions)


@both
@given(joints)
def test_jacobian_is_the_finite_difference_of_forward(wrist, positions):
    h = 1e-6
    columns = []
    for along in h * np.eye(2):
        low, high = (wrist.forward(positions + side * along) for side in (-1.0, 1.0))
        columns.append(rates_between(low.quaternion, high.quaternion, 2.0 * h))
    exact = wrist.jacobian(positions)
    steep = np.abs(exact).max() ** 3
    np.testing.assert_allclose(exact, np.array(columns).T, atol=1e-9 * (1.0 + steep))


@both
@given(joints, rates)
def test_rates_make_p_and_q(wrist, positions, twist):
    p, q, _ = wrist.jacobian(positions) @ wrist.rates(positions, twist)
    assert (p, q) == pytest.approx(twist[:2], abs=1e-9)


@both
@given(joints, rates)
def test_advance_stays_in_reach_and_makes_p_and_q_to_second_order(wrist, positions, twist):
    pose = wrist.forward(positions)
    curvature = 1.0 / wrist.margin(positions) ** 2
    for dt in (0.02, 0.01):
        after = wrist.target_pose(pose, twist, dt)
        p, q, _ = rates_between(pose.quaternion, after.quaternion, dt)
        assert abs(p - twist[0]) < 2.0 * curvature * dt**2
        assert abs(q - twist[1]) < 2.0 * curvature * dt**2
        remade = wrist.forward(wrist.inverse(after, positions))
        np.testing.assert_allclose(remade.rotation, after.rotation, atol=1e-9)
