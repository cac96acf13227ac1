"""The fourth gimbal near the end of a joint's range: it slows, and nothing else gives way."""

import math

import pytest

from wrist_control import make_wrist

STILL = (0.0, 1e-12, 0.0)  # a command, and practically none: what is left is α̇ and its effects
THETA = 1.0
LAW = 0.8 * math.sin(THETA)  # [Barker1986], eq. (1), K = 0.8 rad/s


def alpha_rate(space, side, joint=3, positions=(0.0, THETA, 0.3, 0.0)):
    """Return α̇ with so much space before a limit of a joint, rad."""
    lower, upper = [-9.0] * 4, [9.0] * 4
    (upper if side > 0.0 else lower)[joint] = positions[joint] + side * space
    wrist = make_wrist('four_gimbal').with_limits(lower=lower, upper=upper)
    return wrist.rates(positions, STILL)[3]


@pytest.mark.parametrize('space', [0.1, 0.05, 0.01, 0.001])
@pytest.mark.parametrize('phi', [0.3, -0.3])
def test_alpha_takes_a_quarter_of_a_second_for_what_is_left_of_its_range(space, phi):
    side = -math.copysign(1.0, phi)
    rate = alpha_rate(space, side, positions=(0.0, THETA, phi, 0.0))
    assert rate == pytest.approx(side * space / 0.25, rel=1e-6)


@pytest.mark.parametrize('space', [0.25 * LAW + 1e-3, 1.0])
def test_with_more_space_alpha_follows_barkers_law(space):
    assert alpha_rate(space, -1.0) == pytest.approx(-LAW)


def test_a_limit_behind_alpha_does_not_matter():
    assert alpha_rate(1e-6, 1.0) == pytest.approx(-LAW)


def test_at_or_beyond_its_limit_alpha_stands_still():
    assert alpha_rate(0.0, -1.0) == 0.0
    assert alpha_rate(-0.1, -1.0) == 0.0


@pytest.mark.parametrize('joint', [0, 1, 2])
def test_alpha_gives_any_other_joint_a_quarter_of_a_second_too(joint):
    """With the hand at rest the other three move against α, each at a speed of its own."""
    free = make_wrist('four_gimbal')
    positions, space = (0.0, THETA, 0.3, 0.0), 0.01
    speed = free.rates(positions, STILL)[joint]
    side = math.copysign(1.0, speed)
    slowed = alpha_rate(space, side, joint)
    assert slowed == pytest.approx(-LAW * space / (0.25 * abs(speed)), rel=1e-6)
    assert alpha_rate(space, -side, joint) == pytest.approx(-LAW)


@pytest.mark.parametrize('joint', [0, 1, 2])
def test_beyond_a_right_angle_of_theta_it_is_the_same(joint):
    """There cos θ < 0, and α turns the other way, as on the other branch of the same hand."""
    positions, space = (0.0, math.pi - THETA, 0.3, 0.0), 0.01
    speed = make_wrist('four_gimbal').rates(positions, STILL)[joint]
    side = math.copysign(1.0, speed)
    slowed = alpha_rate(space, side, joint, positions)
    assert slowed == pytest.approx(LAW * space / (0.25 * abs(speed)), rel=1e-6)
