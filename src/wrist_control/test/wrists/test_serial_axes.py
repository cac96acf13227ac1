"""Axes in series against SciPy's rotations and finite differences, and what is chosen of them."""

import math

import numpy as np
import pytest
from scipy.spatial.transform import Rotation

from wrist_control import InvalidValueError
from wrist_control.wrists.robot_description import serial_chain
from wrist_control.wrists.serial_axes import PARALLEL, SerialAxes

from .robots import SHIPPED, robot, row, shipped

X, Y, Z = (1.0, 0.0, 0.0), (0.0, 1.0, 0.0), (0.0, 0.0, 1.0)
SKEW = (1.0, 2.0, 2.0)
RPYS = ((0.3, -0.4, 0.5), (-1.0, 0.2, 2.0), (0.1, 1.0, 0.0), (2.0, 0.2, -0.3))
ORIGINS = ((0.1, 0.2, 0.3), (0.4, 0.5, 0.6), (0.7, 0.8, 0.9), (0.2, 0.1, 0.0), (0.0, 0.1, 0.2))
TIP = (0.1, 0.2, 0.3)


def axes_of(*axes, **geometry):
    names = [f'j{number}' for number in range(len(axes))]
    return SerialAxes(serial_chain(robot(axes, **geometry), 'tip', names))


def matrix(xyz, rotation):
    found = np.eye(4)
    found[:3, :3], found[:3, 3] = rotation.as_matrix(), xyz
    return found


@pytest.mark.parametrize('count', [2, 3, 4])
def test_every_link_and_the_hand_are_where_4_by_4_matrices_have_them(count):
    rows = (Z, SKEW, X, (0.3, 0.2, 1.0))[:count]
    serial = axes_of(*rows, tip_rpy=TIP, origins=[*ORIGINS[:count], ORIGINS[4]], rpys=RPYS[:count])
    positions = np.random.default_rng(1).uniform(-3.0, 3.0, count)
    at, places = np.eye(4), []
    for axis, xyz, rpy, turn in zip(rows, ORIGINS, RPYS, positions, strict=False):
        along = np.array(axis) / np.linalg.norm(axis)
        at = at @ matrix(xyz, Rotation.from_euler('xyz', rpy))
        at = at @ matrix((0, 0, 0), Rotation.from_rotvec(turn * along))
        places.append(at[:3, 3])
    at = at @ matrix(ORIGINS[4], Rotation.from_euler('xyz', TIP))
    *links, hand = serial.poses(positions)
    np.testing.assert_allclose([link.position for link in links], places, atol=1e-14)
    np.testing.assert_allclose(hand.rotation, at[:3, :3].T, atol=1e-14)
    np.testing.assert_allclose(hand.position, at[:3, 3], atol=1e-14)


@pytest.mark.parametrize(
    ('one', 'other'), [(Z, Z), (X, (-1.0, 0.0, 0.0)), (Z, (0.0, 0.9 * PARALLEL, 1.0))]
)
def test_parallel_axes_in_a_row_are_refused_with_their_names(one, other):
    with pytest.raises(InvalidValueError, match='The axes of j0 and j1 are parallel and turn the'):
        axes_of(one, other, X)
    with pytest.raises(InvalidValueError, match='The axes of j1 and j2 are parallel'):
        axes_of(SKEW, one, other)


def test_the_first_and_the_last_axis_may_be_parallel():
    assert axes_of(X, Y, X).three.lock == 0.0


def test_of_four_joints_the_spare_one_leaves_the_others_all_that_can_be_reached():
    square = axes_of(Z, Y, X, Z)
    assert square.spare == 3
    assert axes_of(Z, Y, X, SKEW).spare == 3
    outer = axes_of(SKEW, Z, Y, X)
    assert outer.spare == 0
    assert outer.of_three('abcd') == 'bcd'
    assert square.of_three('abcd') == 'abc'
    assert [end.beyond for end in outer.three.ends] == pytest.approx([0.0, 0.0], abs=1e-12)


@pytest.mark.parametrize(
    ('rpy', 'followed'), [((0, 0, 0), (1, 2)), ((-math.pi / 2, 0, -math.pi / 2), (0, 1))]
)
def test_two_joints_point_along_the_hand_axis_that_is_square_to_both(rpy, followed):
    """Pan about z and tilt about y: x of the head, z of a camera whose z looks along that."""
    assert axes_of(Z, Y, tip_rpy=rpy).followed_axes == followed


def test_three_joints_turn_about_every_axis_and_point_along_the_last():
    serial = axes_of(Z, Y, X)
    assert serial.followed_axes == (0, 1, 2)
    assert serial.pointing_axis == 0


@pytest.mark.parametrize('name', SHIPPED)
def test_home_is_inside_the_limits_and_far_from_lock(name):
    wrist = shipped(name)
    assert wrist.margin(wrist.home) >= 0.5
    for joint, position in zip(wrist.joints, wrist.home, strict=True):
        assert joint.lower < position < joint.upper


def limited(lower, upper):
    """Return a wrist whose middle joint locks at 0 and has limits."""
    text = robot((X, Y, X))
    limit = f'<limit lower="{lower}" upper="{upper}"/>'
    middle = text.replace('name="j1" type="continuous"', 'name="j1" type="revolute"')
    axis = f'<axis xyz="{row(Y)}"/>'
    return SerialAxes(serial_chain(middle.replace(axis, axis + limit), 'tip'))


@pytest.mark.parametrize(
    ('lower', 'upper', 'home'),
    [
        (-7.0, 7.0, -math.pi / 2),  # both are as near
        (-1.0, 2.0, math.pi / 2),
        (-0.2, 0.4, 0.2),  # nowhere is there much
        (0.5, 0.9, 0.7),
        (2.9, 3.3, 3.0),
        (1.0, 7.0, 3 * math.pi / 2),  # the middle, 4.0, has room enough
    ],
)
def test_a_home_near_lock_is_moved_to_where_the_margin_is_large(lower, upper, home):
    found = limited(lower, upper).home[1]
    assert lower < found < upper
    if home == 3 * math.pi / 2:
        assert found == 4.0
    else:
        assert found == pytest.approx(home, abs=0.05)
