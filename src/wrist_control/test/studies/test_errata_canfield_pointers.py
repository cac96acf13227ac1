"""The printed equations of [Canfield1997], chapter 4, for the two pointers: docs/errata.md."""

import math

import numpy as np
import pytest

from wrist_control.studies.canfield_pointing import transform
from wrist_control.wrists.five_bar import FiveBar
from wrist_control.wrists.pitch_yaw import PitchYaw

DIRECTIONS = np.random.default_rng(8).uniform([0.1, 0.1], [6.2, 1.3], (20, 2))


@pytest.mark.parametrize(('alpha', 'beta'), DIRECTIONS)
def test_4_30_to_4_32_are_right_as_printed(alpha, beta):
    theta_1 = math.asin(-math.sin(beta) * math.sin(alpha))
    theta_2 = math.asin(math.sin(beta) * math.cos(alpha) / math.cos(theta_1))
    np.testing.assert_allclose(
        PitchYaw().forward((theta_1, theta_2)).rotation[2],
        [
            math.sin(beta) * math.cos(alpha),
            math.sin(beta) * math.sin(alpha),
            math.cos(beta),
        ],
        atol=1e-12,
    )


@pytest.mark.parametrize(('alpha', 'beta'), DIRECTIONS)
def test_4_33_needs_the_cosine_of_theta_1(slopes, direction, alpha, beta):
    theta = np.array(
        [math.asin(-math.sin(beta) * math.sin(alpha)), math.atan(math.tan(beta) * math.cos(alpha))]
    )
    truth = slopes(lambda t: direction(PitchYaw(), t), theta)
    (s1, s2), (c1, c2) = np.sin(theta), np.cos(theta)
    T = transform(np.array(alpha), np.array(beta))
    np.testing.assert_allclose(T @ [[-s1 * s2, c1 * c2], [-c1, 0.0]], truth, atol=1e-6)
    printed = T @ [[-s1 * s2, c1 * c2], [-c2, 0.0]]
    assert np.abs(printed - truth).max() > abs(c1 - c2)


def passive_angles(positions):
    """Return the turns of the five-bar's two moving joints, 0 at home."""
    wrist = FiveBar()
    x, y, _ = wrist.forward(positions).rotation[2]
    return math.asin(x), math.asin(y)


@pytest.mark.parametrize(('alpha', 'beta'), DIRECTIONS)
def test_4_34_is_the_five_bar_seen_from_its_passive_joints(alpha, beta):
    """Wrong in the original: the actuated joints have tangents, not sines."""
    N = np.array([math.cos(alpha), math.sin(alpha), 1.0 / math.tan(beta)]) * math.sin(beta)
    actuated = (math.atan2(N[0], N[2]), math.atan2(N[1], N[2]))
    first = np.array([math.cos(actuated[0]), 0.0, -math.sin(actuated[0])])
    second = np.array([0.0, math.cos(actuated[1]), -math.sin(actuated[1])])
    assert (N @ first, N @ second) == pytest.approx((0.0, 0.0), abs=1e-12)
    by_sines = (math.asin(N[0]), math.asin(N[1]))
    assert np.abs(np.subtract(by_sines, actuated)).max() > 1e-5
    # The moving joint of chain 1 lies along `first`: N turns about it from the plane y = 0.
    home = np.cross(first, [0.0, 1.0, 0.0])
    turn = math.atan2(np.cross(home, N) @ first, home @ N)
    assert abs(turn) == pytest.approx(abs(by_sines[1]))
    home = np.cross([1.0, 0.0, 0.0], second)
    turn = math.atan2(np.cross(home, N) @ second, home @ N)
    assert abs(turn) == pytest.approx(abs(by_sines[0]))


@pytest.mark.parametrize(('alpha', 'beta'), DIRECTIONS)
def test_4_35_needs_a_cosine_in_its_first_line(alpha, beta):
    sines = (math.sin(beta) * math.cos(alpha), math.sin(beta) * math.sin(alpha))
    theta_1, theta_2 = (math.asin(s) for s in sines)
    assert math.atan2(math.sin(theta_2), math.sin(theta_1)) % math.tau == pytest.approx(alpha)
    assert math.asin(math.hypot(math.sin(theta_1), math.sin(theta_2))) == pytest.approx(beta)
    assert abs(theta_1 - theta_2) > 1e-3


@pytest.mark.parametrize(('alpha', 'beta'), DIRECTIONS)
def test_4_36_is_the_jacobian_of_4_34_and_not_of_the_five_bar(slopes, direction, alpha, beta):
    theta = np.arcsin(np.array([math.cos(alpha), math.sin(alpha)]) * math.sin(beta))

    def model(t):
        x, y = np.sin(t)
        return np.array([math.atan2(y, x), math.asin(math.hypot(x, y))])

    T = transform(np.array(alpha), np.array(beta))
    printed = T @ np.diag(np.cos(theta))
    np.testing.assert_allclose(printed, slopes(model, theta), atol=1e-6)
    actuated = np.arctan(np.array([math.cos(alpha), math.sin(alpha)]) * math.tan(beta))
    truth = slopes(lambda t: direction(FiveBar(), t), actuated)
    assert np.abs(printed - truth).max() > 1e-3
