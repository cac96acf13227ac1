"""A servo's horn: where its tip goes, and the angles at which a rod ends at a point."""

import math

import numpy as np
import pytest
from hypothesis import assume, given
from hypothesis import strategies as st

from wrist_control import InvalidValueError
from wrist_control.wrists.horn import horn, in_pairs

CENTRE, AXIS, DIRECTION = (0.1, -0.2, 0.3), (1.0, 2.0, -2.0), (0.3, 0.1, 0.5)
HORN = horn('servo_1', 0.04, CENTRE, AXIS, DIRECTION)
ROD = 0.085
angles = st.floats(-math.pi, math.pi)
component = st.floats(-1.0, 1.0)


def about(axis, angle):
    """The matrix of a turn, by Rodrigues' formula."""
    x, y, z = np.array(axis) / np.linalg.norm(axis)
    cross = np.array([[0, -z, y], [z, 0, -x], [-y, x, 0]])
    return np.eye(3) + math.sin(angle) * cross + (1 - math.cos(angle)) * cross @ cross


def square_to_axis():
    along = np.array(DIRECTION) - np.dot(DIRECTION, AXIS) / np.dot(AXIS, AXIS) * np.array(AXIS)
    return along / np.linalg.norm(along)


@given(angles)
def test_the_tip_goes_round_the_axis(angle):
    expected = CENTRE + 0.04 * about(AXIS, angle) @ square_to_axis()
    assert HORN.tip(angle) == pytest.approx(expected, abs=1e-15)
    assert HORN.pose(angle).point((0.04, 0.0, 0.0)) == pytest.approx(expected, abs=1e-15)
    assert pytest.approx(HORN.axis, abs=1e-15) == HORN.pose(angle).rotation.T @ [0, 0, 1]


@given(angles)
def test_the_tip_rate_is_its_finite_difference(angle):
    ahead, behind = HORN.tip(angle + 1e-6), HORN.tip(angle - 1e-6)
    assert HORN.tip_rate(angle) == pytest.approx(np.subtract(ahead, behind) / 2e-6, abs=1e-9)


@given(angles, component, component, component, st.integers(-2, 2))
def test_the_angle_is_that_of_the_nearer_of_two_branches(angle, x, y, z, turns):
    direction = np.array([x, y, z])
    assume(np.linalg.norm(direction) > 0.1)
    direction /= np.linalg.norm(direction)
    end = HORN.tip(angle) + ROD * direction
    near = angle + math.tau * turns
    found = HORN.angle(tuple(end), ROD, near)
    crooked = abs(np.dot(HORN.tip_rate(angle), direction)) / HORN.length
    assume(crooked > 1e-3)
    assert found == pytest.approx(near, abs=1e-9)
    # The other branch mirrors the horn in the plane of its axis and the end.
    across = np.subtract(end, CENTRE)
    middle = math.atan2(across @ HORN.aside, across @ HORN.along)
    other = HORN.angle(tuple(end), ROD, 2.0 * middle - near)
    assert other == pytest.approx(2.0 * middle - near, abs=1e-9)
    assert math.dist(HORN.tip(other), end) == pytest.approx(ROD, rel=1e-12)


@pytest.mark.parametrize('reach', [0.126, 0.044, 0.5])
def test_beyond_a_straight_horn_there_is_no_angle(reach):
    """They reach from 0.085 − 0.04 to 0.085 + 0.04 m in the horn's own plane."""
    assert HORN.angle(tuple(CENTRE + reach * square_to_axis()), ROD, 0.0) is None


def test_a_horn_in_no_direction_is_refused():
    with pytest.raises(InvalidValueError, match='The axis of servo_3 has no direction'):
        horn('servo_3', 0.04, CENTRE, (0.0, 0.0, 0.0), DIRECTION)
    with pytest.raises(InvalidValueError, match='The horn of servo_3 has no direction, or'):
        horn('servo_3', 0.04, CENTRE, AXIS, tuple(-2.0 * np.array(AXIS)))


def test_pairs_stand_around_the_base_and_turn_up_in_opposite_senses():
    centres, axes, directions = in_pairs(0.3, 0.1)
    for number, (centre, axis, direction) in enumerate(
        zip(centres, axes, directions, strict=True)
    ):
        assert math.hypot(*centre[:2]) == pytest.approx(math.hypot(0.3, 0.1))
        assert centre[2] == 0.0
        up = np.cross(axis, direction)
        assert up == pytest.approx([0, 0, -1 if number % 2 else 1])
        assert np.dot(axis, centre) == pytest.approx(-0.3)
        assert np.dot(direction, centre) == pytest.approx(0.1)
    assert centres[2] == pytest.approx((-0.3, 0.1, 0.0))
    assert centres[3] == pytest.approx((-0.3, -0.1, 0.0))
