"""Every row of docs/errata.md for [Barker1986]: as printed it fails, corrected it holds."""

import math

import numpy as np
import pytest
from scipy.spatial.transform import Rotation

from wrist_control import fly, make_wrist
from wrist_control.operating.maneuvers import BARKER_SPEED
from wrist_control.rotations import quaternion_of, rates_between, turned, unit

THREE = make_wrist('three_gimbal')
FOUR = make_wrist('four_gimbal')
PSI, THETA, PHI, ALPHA = GIMBALS = (0.7, -0.5, 1.1, 0.4)
TWIST = (0.3, -0.2, 0.5)
H = 1.0 / 32.0


def sin(x):
    return math.sin(x)


def cos(x):
    return math.cos(x)


def quaternion(psi, theta, phi, alpha=0.0):
    """Return Barker's quaternion of a hand turned about z, y, x, z, from SciPy's rotations."""
    turn = Rotation.from_euler('ZYX', [psi, theta, phi]) * Rotation.from_euler('Z', alpha)
    return np.array(quaternion_of(turn.as_matrix().T))


def same(a, b):
    """Tell whether two quaternions are one rotation."""
    return abs(abs(np.dot(a, b)) - 1.0) < 1e-12


def three_gimbal_rates():
    positions = np.array(GIMBALS[:3])
    return np.linalg.solve(THREE.jacobian(positions), TWIST)


def test_figure_1b_psi_rate_is_divided_by_cos_theta():
    _, q, r = TWIST
    numerator = r * cos(PHI) + q * sin(PHI)
    printed = r * cos(PHI) + q * sin(PHI) * cos(THETA)
    assert numerator / cos(THETA) == pytest.approx(three_gimbal_rates()[0])
    assert printed != pytest.approx(three_gimbal_rates()[0], rel=0.01)


def test_figure_1c_third_quaternion_rate():
    a1, a2, a3, a4 = a = quaternion(*GIMBALS[:3])
    p, q, r = TWIST
    h = 1e-6
    rate = (np.array(turned(tuple(a), TWIST, h)) - turned(tuple(a), TWIST, -h)) / (2.0 * h)
    correct = [
        (-a4 * p - a3 * q - a2 * r) / 2.0,
        (-a3 * p + a4 * q + a1 * r) / 2.0,
        (a2 * p + a1 * q - a4 * r) / 2.0,
        (a1 * p - a2 * q + a3 * r) / 2.0,
    ]
    np.testing.assert_allclose(rate, correct, atol=1e-9)
    as_printed = (a1 * q - (a2 * p + a4 * r)) / 2.0
    assert as_printed != pytest.approx(rate[2], rel=0.01)


def test_figure_1c_element_c12_has_a_plus():
    a1, a2, a3, a4 = quaternion(*GIMBALS[:3])
    c12 = THREE.forward(GIMBALS[:3]).rotation[0, 1]
    assert 2.0 * (a3 * a4 + a1 * a2) == pytest.approx(c12)
    assert 2.0 * (a3 * a4 - a1 * a2) != pytest.approx(c12, rel=0.01)


def test_figures_1c_and_2d_element_c33_has_squares_and_a_plus():
    a1, a2, a3, a4 = quaternion(*GIMBALS[:3])
    c33 = THREE.forward(GIMBALS[:3]).rotation[2, 2]
    assert a1**2 + a2**2 - a3**2 - a4**2 == pytest.approx(c33)
    for printed in (a1**2 + a2 - a3 - a4, a1**2 - a2**2 - a3**2 - a4**2):
        assert printed != pytest.approx(c33, rel=0.01)


def test_c_goes_from_forearm_axes_to_hand_axes_with_every_gimbal_in_it():
    """Axes that any gimbal carries would leave that gimbal's turn out of C."""
    hand_axes = Rotation.from_euler('ZYX', GIMBALS[:3]).as_matrix()  # in forearm axes, columns
    a1, a2, a3, a4 = quaternion(*GIMBALS[:3])
    c11, c12, c13 = (
        a1**2 - a2**2 - a3**2 + a4**2,
        2.0 * (a3 * a4 + a1 * a2),
        2.0 * (a2 * a4 - a1 * a3),
    )
    np.testing.assert_allclose((c11, c12, c13), hand_axes[:, 0], atol=1e-12)
    without_psi = Rotation.from_euler('YX', GIMBALS[1:3]).as_matrix()
    assert np.abs(without_psi[:, 0] - (c11, c12, c13)).max() > 0.1


def test_the_tip_is_computed_in_forearm_axes():
    """The maneuver's three points are given in forearm axes, and L c11, L c12, L c13 are there."""
    flight = fly('three_gimbal', 'basic_test')
    tips = 6.0 * flight.hand_rotation[[0, 90, -1], 0]
    np.testing.assert_allclose(tips, [(6, 0, 0), (0, 0, -6), (0, 6, 0)], atol=1e-9)


def initialized(signs):
    """Return figure 2(b) with a sign before each second product."""
    s, c = zip(*((sin(0.5 * x), cos(0.5 * x)) for x in GIMBALS[:3]), strict=True)
    return (
        c[0] * c[1] * c[2] + signs[0] * s[0] * s[1] * s[2],
        s[0] * c[1] * c[2] + signs[1] * c[0] * s[1] * s[2],
        c[0] * s[1] * c[2] + signs[2] * s[0] * c[1] * s[2],
        c[0] * c[1] * s[2] + signs[3] * s[0] * s[1] * c[2],
    )


def test_figure_2b_signs_of_the_initial_quaternion():
    truth = quaternion(*GIMBALS[:3])
    assert same(initialized((1, -1, 1, -1)), truth)
    assert not same(initialized((1, 1, 1, 1)), truth)


def updated(a, rates, h, sign):
    """Return figure 2(c) with the sign of G."""
    p, q, r = rates
    omega = math.sqrt(p * p + q * q + r * r)
    rho = 0.5 * omega * h
    c2 = math.sin(rho) / omega
    big_h, g, j, k = math.cos(rho), sign * c2 * r, c2 * q, c2 * p
    a1, a2, a3, a4 = a
    return unit(
        (
            big_h * a1 + g * a2 - j * a3 - k * a4,
            -g * a1 + big_h * a2 - k * a3 + j * a4,
            j * a1 + k * a2 + big_h * a3 + g * a4,
            k * a1 - j * a2 - g * a3 + big_h * a4,
        )
    )


def test_figure_2c_g_is_minus_c2_r():
    a = quaternion(*GIMBALS[:3])
    spin = Rotation.from_rotvec(0.3 * np.array(TWIST)).as_matrix()
    truth = quaternion_of(spin.T @ THREE.forward(GIMBALS[:3]).rotation)
    assert same(updated(a, TWIST, 0.3, sign=-1.0), truth)
    assert not same(updated(a, TWIST, 0.3, sign=1.0), truth)
    assert same(turned(tuple(a), TWIST, 0.3), truth)


def test_figure_2c_divides_by_zero_when_nothing_is_commanded():
    a = tuple(quaternion(*GIMBALS[:3]))
    with pytest.raises(ZeroDivisionError):
        updated(a, (0.0, 0.0, 0.0), H, sign=-1.0)
    assert turned(a, (0.0, 0.0, 0.0), H) == a


def test_figure_2f_theta_has_a_minus():
    c = THREE.forward(GIMBALS[:3]).rotation
    below = c[1, 2] * sin(PHI) + c[2, 2] * cos(PHI)
    assert math.atan(-c[0, 2] / below) == pytest.approx(THETA)
    assert math.atan(c[0, 2] / below) == pytest.approx(-THETA)


def test_figure_2f_arctangents_of_one_argument_lose_the_quadrant():
    beyond = (0.3, 0.4, math.radians(120.0))
    pose = THREE.forward(beyond)
    c = pose.rotation
    assert math.degrees(math.atan(c[1, 2] / c[2, 2])) == pytest.approx(-60.0)
    np.testing.assert_allclose(THREE.inverse(pose, beyond), beyond)


def test_figure_2f_roundoff_can_turn_phi_by_180_deg_at_lock():
    roundoff = 1e-17  # what is left of c33 = cos θ cos φ at θ = 90°; c23 is 0
    angles = [math.degrees(math.atan2(0.0, c33)) for c33 in (roundoff, -roundoff)]
    assert angles == [0.0, 180.0]
    for theta in (90.0 - 1e-14, 90.0 + 1e-14):
        at_lock = (0.0, math.radians(theta), 0.0)
        found = THREE.inverse(THREE.forward(at_lock), at_lock)
        np.testing.assert_allclose(found, at_lock, atol=1e-9)


def test_figure_3a_scaling_by_the_largest_excess_leaves_another_rate_over_its_limit():
    rates, limits = np.array([60.0, 19.0]), np.array([40.0, 10.0])
    most = int(np.argmax(rates - limits))
    assert most == 0
    assert list(rates * (limits[most] / rates[most]) > limits) == [False, True]
    assert (rates * np.min(limits / rates) <= limits).all()


def test_figure_3a_scaling_rates_alone_lets_the_increments_exceed_the_limit():
    def largest_increment(positions, limit):
        rates = np.array(THREE.rates(positions, (0.0, 0.0, BARKER_SPEED)))
        factor = min(1.0, limit / np.abs(rates).max())
        pose = THREE.forward(positions)
        moved = turned(pose.quaternion, (0.0, 0.0, factor * BARKER_SPEED), H)
        after = THREE.inverse(pose._replace(quaternion=moved), positions)
        return np.abs(np.subtract(after, positions)).max() / H

    near_lock = (0.0, math.radians(88.0), math.radians(-80.0))
    assert largest_increment(near_lock, BARKER_SPEED) > 1.02 * BARKER_SPEED
    flight = fly('three_gimbal', 'basic_test', joint_rate_limits=BARKER_SPEED)
    assert np.abs(flight.joint_rates).max() <= BARKER_SPEED * (1.0 + 1e-9)


def test_gain_must_exceed_32_pi_over_180():
    assert 32.0 * math.pi / 180.0 == pytest.approx(0.56, abs=0.005)


def test_equation_1_looks_at_the_sign_of_sin_phi_not_of_sin_theta():
    def theta_rate(sign):  # with the hand at rest, from figure 4(b)
        return -FOUR.gain * sin(theta) * sign * sin(phi)

    for theta in (-0.6, 0.6):
        for phi in (-1.2, 1.2):
            assert theta_rate(math.copysign(1.0, sin(phi))) * theta < 0.0
    theta, phi = 0.6, -1.2
    assert theta_rate(math.copysign(1.0, sin(theta))) * theta > 0.0


def test_equation_1_needs_a_sign_at_zero():
    """With sgn 0 = 0 the basic maneuver, which starts at φ = 0, pitches straight into lock."""
    alpha_rates = [
        FOUR.rates((0.0, math.radians(k), 0.0, 0.0), (0.0, BARKER_SPEED, 0.0))[3] for k in (1, 45)
    ]
    assert all(rate < 0.0 for rate in alpha_rates)
    assert fly('four_gimbal', 'basic_test').margin.min() == pytest.approx(0.72627, abs=1e-5)


def test_figure_4b_psi_rate_has_sin_phi_and_is_divided_by_cos_theta():
    p, q, r = TWIST
    alpha_rate = FOUR.rates(GIMBALS, TWIST)[3]
    along = p * sin(ALPHA) + q * cos(ALPHA)
    rest = r - alpha_rate
    psi_rate = (along * sin(PHI) + rest * cos(PHI)) / cos(THETA)
    theta_rate = along * cos(PHI) - rest * sin(PHI)
    phi_rate = p * cos(ALPHA) - q * sin(ALPHA) + psi_rate * sin(THETA)
    rates = (psi_rate, theta_rate, phi_rate, alpha_rate)
    np.testing.assert_allclose(FOUR.jacobian(GIMBALS) @ rates, TWIST, atol=1e-12)
    printed = along * sin(THETA) + rest * cos(PHI) * cos(THETA)
    assert printed != pytest.approx(psi_rate, rel=0.01)


def test_figures_4c_and_5b_gimbal_angles():
    c = FOUR.forward(GIMBALS).rotation
    s, k = sin(ALPHA), cos(ALPHA)
    mixed = c[0] * s + c[1] * k
    phi = math.atan2(mixed[2], c[2, 2])
    psi = math.atan2(
        c[2, 0] * sin(phi) - mixed[0] * cos(phi), mixed[1] * cos(phi) - c[2, 1] * sin(phi)
    )
    below = mixed[2] * sin(phi) + c[2, 2] * cos(phi)
    theta = math.atan2(c[1, 2] * s - c[0, 2] * k, below)
    assert (psi, theta, phi) == pytest.approx((PSI, THETA, PHI))
    printed = math.atan2(c[1, 2] * sin(0.0) - c[0, 2] * k, below)  # figure 4(c): sin 0
    assert printed != pytest.approx(THETA, rel=0.01)


def test_figure_5a_alpha_extrapolates_from_two_rates():
    (*_, alpha), _ = FOUR.choose_branch_reference(GIMBALS, 1.0, H, (0.1,))
    rate = FOUR.rates(GIMBALS, TWIST)[3]
    assert alpha == pytest.approx(ALPHA + 0.5 * H * (3.0 * rate - 0.1))


def test_figure_5c_signs_of_the_initial_quaternion():
    b1, b2, b3, b4 = initialized((1, -1, 1, -1))
    s, c = sin(0.5 * ALPHA), cos(0.5 * ALPHA)
    truth = quaternion(*GIMBALS)
    assert same((b1 * c - b2 * s, b1 * s + b2 * c, b3 * c - b4 * s, b3 * s + b4 * c), truth)
    assert not same((b1 * c - b2 * s, b1 * s + b2 * c, b3 * c - b4 * s, b3 + b4 * c), truth)
    assert rates_between(tuple(truth), FOUR.forward(GIMBALS).quaternion, 1.0) == pytest.approx(
        (0.0, 0.0, 0.0), abs=1e-12
    )
