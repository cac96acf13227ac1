"""Every printed equation of [Canfield1997], chapter 4, for the Carpal wrist: docs/errata.md.

What is right as printed is tested too, so that the list is known to be whole.
"""

import math

import numpy as np
import pytest

from wrist_control.dexterity import sweep
from wrist_control.studies.canfield_closure import (
    TABLE_4_2,
    TABLE_4_2_AZIMUTH,
    TABLE_4_2_PRINTED,
    TABLE_4_2_TILTS,
    PrintedCarpal,
    sample,
)
from wrist_control.studies.canfield_pointing import transform
from wrist_control.wrists.carpal import Carpal

B, L = 0.075, 0.1
ROOT = math.sqrt(3.0)
POSES = np.random.default_rng(7).uniform(0.2, 1.2, (20, 3))
DIRECTIONS = np.random.default_rng(8).uniform([0.1, 0.1], [6.2, 1.3], (20, 2))


def mid_nodes(angles):
    azimuths = np.radians([0.0, 120.0, 240.0])
    out = B + L * np.cos(angles)
    return np.stack([out * np.cos(azimuths), out * np.sin(azimuths), L * np.sin(angles)], axis=1)


def normal(angles):
    """Return N of the mid-nodes, not of unit length: the truth for (4.8)."""
    m = mid_nodes(angles)
    return np.cross(m[1] - m[0], m[2] - m[0])


def plunge(angles):
    """Return where the base's axis meets the midplane: the truth for (4.9)."""
    n = normal(angles)
    return n @ mid_nodes(angles)[0] / n[2]


def sc(angles):
    return (*np.sin(angles), *np.cos(angles))


@pytest.mark.parametrize('angles', POSES)
def test_4_8_is_right_as_printed(angles):
    s1, s2, s3, c1, c2, c3 = sc(angles)
    k = B / L
    printed = [
        0.5 * ROOT * L**2 * (s1 * (-2 * k - c2 - c3) + s2 * (k + c3) + s3 * (k + c2)),
        0.5 * L**2 * (s1 * (-c2 + c3) + s2 * (-3 * k - 2 * c1 - c3) + s3 * (3 * k + 2 * c1 + c2)),
        0.5 * ROOT * L**2 * (3 * k**2 + 2 * k * (c1 + c2 + c3) + c1 * c2 + c1 * c3 + c2 * c3),
    ]
    np.testing.assert_allclose(printed, normal(angles), atol=1e-12)


def plunge_4_9(angles, sign, factor, square, share):
    """Return (4.9) with what differs between print and truth as arguments."""
    s1, s2, s3, c1, c2, c3 = sc(angles)
    k = B / L
    above = s1 * (sign * 2 * k - c2 - c3) + s2 * (k + c3) + s3 * (k + c2)
    below = square + c1 * (share * k + 2 * c2 + 2 * c3) + c2 * (4 * k + 2 * c3) + 4 * k * c3
    return factor * (B + L * c1) * above / below + L * s1


@pytest.mark.parametrize('angles', POSES)
def test_4_9_needs_a_sign_a_factor_and_two_terms(angles):
    k = B / L
    assert plunge_4_9(angles, -1, 2, 6 * k**2, 4) == pytest.approx(plunge(angles))
    for sign, factor, square, share in (
        (1, 2, 6 * k**2, 4),
        (-1, 1, 6 * k**2, 4),
        (-1, 2, 6 * B**2, 4),
        (-1, 2, 6 * k**2, 2),
        (1, 1, 6 * B**2, 2),
    ):
        wrong = plunge_4_9(angles, sign, factor, square, share)
        assert abs(wrong - plunge(angles)) > 1e-6 * L


@pytest.mark.parametrize('angles', POSES)
def test_4_13_and_4_14_are_right_as_printed(slopes, angles):
    x, y, z = normal(angles)
    dx, dy, dz = slopes(normal, angles)
    length = (x * x + y * y + z * z) ** 1.5
    printed = [
        (dx * (y * y + z * z) - dy * x * y - dz * x * z) / length,
        (dy * (x * x + z * z) - dx * x * y - dz * y * z) / length,
    ]
    truth = Carpal(B, L, 0.07).normal_jacobian(tuple(angles))
    np.testing.assert_allclose(printed, truth[:2], atol=1e-7)


@pytest.mark.parametrize('angles', POSES)
def test_4_15_ends_with_the_height_of_the_mid_node_not_its_x(slopes, angles):
    x, _, z = normal(angles)
    dx, _, dz = slopes(normal, angles)
    m = mid_nodes(angles)[0]
    dm = slopes(lambda a: mid_nodes(a)[0], angles)
    begin = -x * m[0] * dz + x * z * dm[0] + z * m[0] * dx
    truth = Carpal(B, L, 0.07).normal_jacobian(tuple(angles))[2]
    np.testing.assert_allclose((begin + z**2 * dm[2]) / z**2, truth, atol=1e-7)
    assert np.abs((begin + z**2 * dm[0]) / z**2 - truth).max() > 1e-3


@pytest.mark.parametrize('angles', POSES)
def test_4_16_to_4_18_are_right_as_printed(slopes, angles):
    s1, s2, s3, c1, c2, c3 = sc(angles)
    k, half = B / L, 0.5 * L**2
    printed = [
        [
            ROOT * half * c1 * (-2 * k - c2 - c3),
            ROOT * half * (s1 * s2 - s2 * s3 + c2 * (k + c3)),
            ROOT * half * (s1 * s3 - s2 * s3 + c3 * (k + c2)),
        ],
        [
            half * (-c1 * c2 + c1 * c3 + 2 * s1 * s2 - 2 * s3 * s1),
            half * (s1 * s2 - s2 * s3 - 2 * c1 * c2 - c2 * c3 - 3 * k * c2),
            half * (-s1 * s3 + s2 * s3 + 3 * k * c3 + 2 * c1 * c3 + c2 * c3),
        ],
        [
            -ROOT * half * s1 * (2 * k + c2 + c3),
            -ROOT * half * s2 * (2 * k + c1 + c3),
            -ROOT * half * s3 * (2 * k + c1 + c2),
        ],
    ]
    np.testing.assert_allclose(printed, slopes(normal, angles), atol=1e-9)


@pytest.mark.parametrize('angles', POSES)
def test_4_19_begins_with_the_x_of_mid_node_1_alone(slopes, angles):
    truth = slopes(lambda a: mid_nodes(a)[0], angles)
    s1, c1 = math.sin(angles[0]), math.cos(angles[0])
    np.testing.assert_allclose(truth[:, 0], [-L * s1, 0.0, L * c1], atol=1e-9)
    np.testing.assert_allclose(truth[:, 1:], 0.0, atol=1e-9)


@pytest.mark.parametrize('angles', POSES)
def test_4_23_is_the_rule_of_sarrus_once_its_subscripts_are(angles):
    J = Carpal(B, L, 0.07).normal_jacobian(tuple(angles))
    (a, b, c), (d, e, f), (g, h, i) = J
    truth = np.linalg.det(J)
    assert (a * e * i + b * f * g + c * d * h) - (
        c * e * g + a * f * h + b * d * i
    ) == pytest.approx(truth, rel=1e-9)
    rows = {1: J[0], 2: J[1], 3: J[2]}
    printed = (
        rows[1][0] * rows[1][1] * i + rows[1][1] * rows[2][2] * g + rows[1][2] * rows[3][0] * h
    ) - (rows[3][2] * rows[1][1] * g + rows[1][0] * rows[2][2] * h + rows[3][1] * rows[3][0] * i)
    assert abs(printed - truth) > 1e-3 * abs(truth)


def carpal_tilt(alpha, beta):
    wrist = PrintedCarpal(B, L, 0.05)
    axis = (-math.sin(alpha), math.cos(alpha), 0.0)
    return wrist, np.array(sweep(wrist, axis, np.linspace(0.0, beta, 20).tolist())[-1])


@pytest.mark.parametrize(('alpha', 'beta'), DIRECTIONS)
def test_4_21_and_4_22_are_right_as_printed(alpha, beta):
    _, angles = carpal_tilt(alpha, beta)
    x, y, _ = normal(angles) / np.linalg.norm(normal(angles))
    assert (x, y) == pytest.approx(
        (math.sin(beta / 2) * math.cos(alpha), math.sin(beta / 2) * math.sin(alpha))
    )
    assert np.angle(x + 1j * y) % math.tau == pytest.approx(alpha)
    assert 2.0 * math.asin(math.hypot(x, y)) == pytest.approx(beta)


@pytest.mark.parametrize(('alpha', 'beta'), DIRECTIONS)
def test_4_27_makes_half_of_the_tilt_rate_of_the_carpal_wrist(slopes, direction, alpha, beta):
    """Wrong in the original: N̂ of (4.20) is at β/2, and nothing doubles the second row."""
    wrist, angles = carpal_tilt(alpha, beta)
    truth = slopes(lambda a: direction(wrist, a), angles)
    x, y, z = normal(angles) / np.linalg.norm(normal(angles))
    flat = math.hypot(x, y)
    T = np.array([[-y / flat**2, x / flat**2], [x / (z * flat), y / (z * flat)]])
    np.testing.assert_allclose(T, transform(np.array(alpha), np.array(beta / 2)), atol=1e-9)
    printed = T @ wrist.normal_jacobian(tuple(angles))[:2]
    np.testing.assert_allclose(printed[0], truth[0], atol=1e-4)
    np.testing.assert_allclose(2.0 * printed[1], truth[1], atol=1e-4)


@pytest.mark.parametrize(('alpha', 'beta'), DIRECTIONS)
def test_4_27_needs_the_unit_normal(alpha, beta):
    _, angles = carpal_tilt(alpha, beta)
    x, y, z = normal(angles)
    flat = math.hypot(x, y)
    literal = np.array([[-y / flat**2, x / flat**2], [x / (z * flat), y / (z * flat)]])
    unit = transform(np.array(alpha), np.array(beta / 2))
    assert np.abs(literal - unit).max() > 1.0


@pytest.mark.parametrize(('alpha', 'beta'), DIRECTIONS)
def test_4_28_is_right_with_the_doubled_row(slopes, direction, alpha, beta):
    wrist, angles = carpal_tilt(alpha, beta)
    truth = slopes(lambda a: np.array([*direction(wrist, a), plunge(a)]), angles)
    tool = np.eye(3)
    tool[:2, :2] = np.diag([1.0, 2.0]) @ transform(np.array(alpha), np.array(beta / 2))
    np.testing.assert_allclose(tool @ wrist.normal_jacobian(tuple(angles)), truth, atol=1e-4)


@pytest.mark.parametrize('row', range(4))
def test_table_4_2_is_met_in_every_digit(row):
    found = sample(TABLE_4_2, TABLE_4_2_AZIMUTH, TABLE_4_2_TILTS[row])
    assert found.rounded() == TABLE_4_2_PRINTED[row]


def test_determinant_falls_with_the_root_of_the_discriminant():
    """Why both columns of Table 4.2 come to 0 together: the square of one is the other's share."""
    rows = [sample(TABLE_4_2, TABLE_4_2_AZIMUTH, tilt) for tilt in TABLE_4_2_TILTS]
    ratios = [row.determinant**2 / row.discriminant for row in rows]
    assert max(ratios) / min(ratios) < 1.05


def test_4_3_is_the_inverse_mechanical_advantage_along_principal_directions_alone():
    """μ is force over torque: by virtual work a force f at the hand needs the torques Jᵀ f."""
    chance = np.random.default_rng(3)
    jacobian = chance.normal(size=(3, 3))
    for _ in range(5):
        along, rates = chance.normal(size=(2, 3))
        along /= np.linalg.norm(along)
        torques = jacobian.T @ along
        assert torques @ rates == pytest.approx(along @ jacobian @ rates)
        d = 1.0 / np.linalg.norm(np.linalg.solve(jacobian, along))
        assert d < 0.99 * np.linalg.norm(torques)
    left, values, _ = np.linalg.svd(jacobian)
    for along, value in zip(left.T, values, strict=True):
        assert 1.0 / np.linalg.norm(np.linalg.solve(jacobian, along)) == pytest.approx(value)
        assert np.linalg.norm(jacobian.T @ along) == pytest.approx(value)


def test_4_5_holds_for_velocities_that_the_joints_can_make_alone():
    chance = np.random.default_rng(4)
    jacobian = chance.normal(size=(3, 2))
    gram = np.linalg.inv(jacobian.T @ jacobian)

    def printed(v):
        return np.sqrt(v @ v / (v @ jacobian @ gram.T @ gram @ jacobian.T @ v))

    rates = chance.normal(size=2)
    reachable = jacobian @ rates
    true = np.linalg.norm(reachable) / np.linalg.norm(rates)
    assert printed(reachable) == pytest.approx(true)
    outward = np.cross(*jacobian.T)
    outward /= np.linalg.norm(outward)
    for share in (1.0, 10.0, 1e6):
        v = reachable + share * np.linalg.norm(reachable) * outward
        assert printed(v) == pytest.approx(true * np.hypot(1.0, share))
