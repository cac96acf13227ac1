"""The spare joint's share of the space, and its way in a step."""

import math

import pytest

from wrist_control.wrists.joint import Joint
from wrist_control.wrists.spare_joint import CUSHION, increment, share_of_space

BOUNDED = [Joint('a', lower=-1.0, upper=1.0), Joint('b')]


@pytest.mark.parametrize('determinant', [0.5, -0.5])
@pytest.mark.parametrize('side', [1.0, -1.0])
def test_a_joint_near_its_limit_leaves_the_share_that_ends_there_in_time(determinant, side):
    """Its rate is move × law / determinant, 2 rad/s towards the limit that is 0.1 rad away."""
    moves = (side * 2.0 * determinant, 1.0)
    share = share_of_space(BOUNDED, (side * 0.9, 0.0), moves, determinant, 1.0)
    assert 2.0 * share * CUSHION == pytest.approx(0.1)
    away = share_of_space(BOUNDED, (side * 0.9, 0.0), moves, determinant, -1.0)
    assert away == 1.0


def test_without_limits_and_without_motion_the_share_is_whole():
    assert share_of_space(BOUNDED, (0.0, 99.0), (0.0, 5.0), 1.0, 3.0) == 1.0
    assert share_of_space(BOUNDED, (1.0, 0.0), (0.0, 1.0), 1.0, 1.0) == 1.0


def test_beyond_its_limit_a_joint_leaves_nothing():
    assert share_of_space(BOUNDED, (1.2, 0.0), (1.0, 0.0), 1.0, 1.0) == 0.0


def test_the_way_of_a_step_is_right_to_second_order():
    """Of ẏ = −y the error of a way falls with the square of the step."""

    def error(steps):
        y, state = 1.0, ()
        for _ in range(steps):
            way, state = increment(-y, 1.0, 1.0 / steps, state)
            y += way
        return abs(y - math.exp(-1.0))

    assert error(100) / error(200) == pytest.approx(4.0, abs=0.3)


def test_without_space_only_the_rate_of_now_counts():
    assert increment(2.0, 0.5, 0.1, (7.0,)) == (pytest.approx(0.1), (1.0,))
