"""The four-gimbal wrist on both branches of a hand, and which way its fourth gimbal leads."""

import math

import numpy as np
import pytest
from hypothesis import assume, given
from hypothesis import strategies as st

from wrist_control import make_wrist

WRIST = make_wrist('four_gimbal')
angles = st.floats(-3.0, 3.0)
commands = st.tuples(*(st.floats(-1.0, 1.0),) * 3)


@given(st.tuples(angles, st.floats(-1.4, 1.4), angles, angles), commands)
def test_the_two_branches_of_a_hand_move_alike(positions, twist):
    """(ψ + π, π − θ, φ + π) holds the same hand, so α must not tell them apart."""
    assume(abs(math.sin(positions[2])) > 1e-6 and any(twist))
    psi, theta, phi, alpha = positions
    other = (psi + math.pi, math.pi - theta, phi + math.pi, alpha)
    np.testing.assert_allclose(
        WRIST.forward(other).rotation, WRIST.forward(positions).rotation, atol=1e-12
    )
    psi_rate, theta_rate, phi_rate, alpha_rate = WRIST.rates(positions, twist)
    np.testing.assert_allclose(
        WRIST.rates(other, twist),
        (psi_rate, -theta_rate, phi_rate, alpha_rate),
        rtol=1e-6,
        atol=1e-9,
    )


def test_equation_1_as_printed_leads_into_lock_beyond_a_right_angle():
    """With the hand at rest: −α̇ about z takes θ back to 90° and φ to 0, where the sign flips."""
    positions = (0.0, 2.0, 0.5, 0.0)
    printed = -0.8 * math.sin(2.0)  # sin φ > 0
    _, theta_rate, phi_rate = make_wrist('three_gimbal').rates(positions[:3], (0.0, 0.0, -printed))
    assert theta_rate < 0.0 < positions[1] - 0.5 * math.pi
    assert phi_rate < 0.0 < positions[2]
    assert WRIST.rates(positions, (0.0, 1e-12, 0.0))[3] == pytest.approx(-printed)


@pytest.mark.parametrize('theta', [1.0, 1.6, 2.5, 3.0, -1.0, -1.6, -2.5])
@pytest.mark.parametrize('phi', [-2.5, -0.5, 0.5, 2.5])
def test_the_fourth_gimbal_leads_away_from_lock_on_either_side_of_it(theta, phi):
    """With the hand all but at rest, |cos θ| grows and φ goes to ±90°."""
    rates = WRIST.rates((0.0, theta, phi, 0.0), (0.0, 1e-12, 0.0))
    assert -math.sin(theta) * rates[1] * math.cos(theta) > 0.0
    assert math.sin(phi) * math.cos(phi) * rates[2] > 0.0
