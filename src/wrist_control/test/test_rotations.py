"""Rotations against two independent truths: explicitly written matrices and SciPy."""

import math

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st
from scipy.spatial.transform import Rotation

from wrist_control.rotations import (
    IDENTITY,
    Pose,
    about_x,
    about_y,
    about_z,
    conjugate,
    direction_cosines,
    nearest_turn,
    negated,
    product,
    quaternion_of,
    rates_between,
    to_forearm,
    to_hand,
    turned,
    unit,
    xyzw,
)

angles = st.floats(-10.0, 10.0)
vectors = st.tuples(*(st.floats(-3.0, 3.0),) * 3)
axes = vectors.filter(lambda v: math.hypot(*v) > 0.1).map(lambda v: np.array(v) / math.hypot(*v))
quaternions = (
    st.tuples(*(st.floats(-1.0, 1.0),) * 4).filter(lambda a: math.hypot(*a) > 0.1).map(unit)
)


def hand(a):
    """Return SciPy's rotation of a hand at Barker's quaternion: its columns are the hand axes."""
    a1, a2, a3, a4 = a
    return Rotation.from_quat([a4, a3, a2, a1])


def of(rotation):
    """Return Barker's quaternion of SciPy's rotation."""
    x, y, z, w = rotation.as_quat()
    return (w, z, y, x)


def assert_same_rotation(a, b, atol=1e-12):
    assert abs(np.dot(a, b)) == pytest.approx(1.0, abs=1e-12)
    np.testing.assert_allclose(direction_cosines(a), direction_cosines(b), atol=atol)


@given(angles)
def test_turns_about_x_y_z_are_the_matrices_of_the_textbook(angle):
    s, c = math.sin(angle), math.cos(angle)
    X = [[1.0, 0.0, 0.0], [0.0, c, s], [0.0, -s, c]]
    Y = [[c, 0.0, -s], [0.0, 1.0, 0.0], [s, 0.0, c]]
    Z = [[c, s, 0.0], [-s, c, 0.0], [0.0, 0.0, 1.0]]
    np.testing.assert_allclose(direction_cosines(about_x(angle)), X, atol=1e-14)
    np.testing.assert_allclose(direction_cosines(about_y(angle)), Y, atol=1e-14)
    np.testing.assert_allclose(direction_cosines(about_z(angle)), Z, atol=1e-14)


@given(quaternions)
def test_direction_cosines_take_forearm_components_to_hand_components(a):
    C = np.array(direction_cosines(a))
    np.testing.assert_allclose(C, hand(a).as_matrix().T, atol=1e-14)
    np.testing.assert_allclose(C @ C.T, np.eye(3), atol=1e-14)
    assert np.linalg.det(C) == pytest.approx(1.0)


@given(quaternions)
def test_quaternion_of_a_matrix_has_a_scalar_that_is_not_negative(a):
    found = quaternion_of(direction_cosines(a))
    assert found[0] >= 0.0
    assert_same_rotation(found, a)


@given(axes, st.sampled_from([0.0, 1e-16, -1e-16, 1e-12, 1e-8, 1e-3, -1e-3]))
def test_quaternion_of_half_turns_and_their_neighbours(axis, short):
    rotation = Rotation.from_rotvec((math.pi - short) * axis)
    found = quaternion_of(rotation.as_matrix().T)
    assert math.hypot(*found) == pytest.approx(1.0)
    assert_same_rotation(found, of(rotation))


@pytest.mark.parametrize('turn', [about_x, about_y, about_z])
def test_quaternion_of_half_turns_about_the_axes_is_exact(turn):
    diagonal = np.round(direction_cosines(turn(math.pi)))
    assert quaternion_of(diagonal) == pytest.approx(turn(math.pi), abs=1e-15)


@given(quaternions, quaternions)
def test_product_is_one_rotation_followed_by_the_other_about_the_turned_axes(a, b):
    np.testing.assert_allclose(
        direction_cosines(product(a, b)),
        np.array(direction_cosines(b)) @ direction_cosines(a),
        atol=1e-14,
    )
    assert_same_rotation(product(a, b), of(hand(a) * hand(b)))


@given(quaternions, quaternions, quaternions)
def test_rotations_are_a_group(a, b, c):
    np.testing.assert_allclose(product(product(a, b), c), product(a, product(b, c)), atol=1e-14)
    np.testing.assert_allclose(product(a, conjugate(a)), IDENTITY, atol=1e-14)
    np.testing.assert_allclose(product(conjugate(a), a), IDENTITY, atol=1e-14)
    assert product(a, IDENTITY) == product(IDENTITY, a) == a


@given(quaternions)
def test_the_negated_quaternion_is_the_same_rotation(a):
    assert direction_cosines(negated(a)) == direction_cosines(a)


@given(quaternions, st.floats(1e-3, 1e3))
def test_unit_keeps_the_direction_and_gives_length_one(a, length):
    np.testing.assert_allclose(unit(tuple(length * x for x in a)), a, atol=1e-14)


@given(quaternions, vectors, st.floats(1e-4, 10.0))
def test_turned_is_exact_for_constant_hand_rates(a, rates, dt):
    expected = hand(a) * Rotation.from_rotvec(dt * np.array(rates))
    assert_same_rotation(turned(a, rates, dt), of(expected))


@given(quaternions, vectors, st.integers(1, 20))
def test_turned_in_many_steps_is_turned_in_one(a, rates, steps):
    b = a
    for _ in range(steps):
        b = turned(b, rates, 0.1)
    np.testing.assert_allclose(b, turned(a, rates, 0.1 * steps), atol=1e-13)


@given(quaternions)
def test_turned_at_rest_is_the_orientation_itself(a):
    assert turned(a, (0.0, 0.0, 0.0), 0.1) is a


@given(quaternions, axes, st.sampled_from([1e-6, 1e-9, 1e-12]))
def test_turned_by_a_small_angle_is_not_lost_in_roundoff(a, axis, angle):
    d1, d2, d3, d4 = product(conjugate(a), turned(a, tuple(angle * axis), 1.0))
    assert d1 == pytest.approx(1.0)
    np.testing.assert_allclose((d4, d3, d2), 0.5 * angle * axis, atol=1e-15)


@given(quaternions, st.floats(-1e-300, 1e-300), st.floats(1e150, 1e307))
def test_turned_is_a_rotation_at_any_finite_rate(a, small, large):
    for rates in ((small, 0.0, -small), (large, -large, small)):
        assert math.hypot(*turned(a, rates, 0.01)) == pytest.approx(1.0)


@given(quaternions, axes, st.floats(0.0, 3.1), st.floats(1e-3, 10.0))
def test_rates_between_are_the_hand_rates_that_made_the_turn(a, axis, angle, dt):
    rates = tuple(angle / dt * axis)
    found = rates_between(a, turned(a, rates, dt), dt)
    np.testing.assert_allclose(found, rates, atol=1e-12 / dt)


@given(quaternions, quaternions, st.floats(1e-3, 10.0))
def test_rates_between_lead_there_the_shorter_way(a, b, dt):
    rates = rates_between(a, b, dt)
    assert math.hypot(*rates) * dt <= math.pi + 1e-12
    assert_same_rotation(turned(a, rates, dt), b)
    np.testing.assert_allclose(
        dt * math.hypot(*rates), (hand(a).inv() * hand(b)).magnitude(), atol=1e-7
    )


@given(quaternions)
def test_no_rates_lie_between_an_orientation_and_itself(a):
    np.testing.assert_allclose(rates_between(a, a, 0.01), 0.0, atol=1e-13)
    np.testing.assert_allclose(rates_between(a, negated(a), 0.01), 0.0, atol=1e-13)
    assert rates_between(IDENTITY, IDENTITY, 0.01) == (0.0, 0.0, 0.0)


@given(quaternions, vectors)
def test_vectors_go_to_hand_axes_by_c_and_back_by_its_transpose(a, vector):
    C = np.array(direction_cosines(a))
    np.testing.assert_allclose(to_hand(a, vector), C @ vector, atol=1e-14)
    np.testing.assert_allclose(to_forearm(a, vector), C.T @ vector, atol=1e-14)
    np.testing.assert_allclose(to_forearm(a, vector), hand(a).apply(vector), atol=1e-13)
    np.testing.assert_allclose(to_hand(a, to_forearm(a, vector)), vector, atol=1e-13)


@given(quaternions)
def test_xyzw_is_the_order_of_scipy_and_ros(a):
    from_matrix = Rotation.from_matrix(np.array(direction_cosines(a)).T).as_quat()
    assert abs(np.dot(xyzw(a), from_matrix)) == pytest.approx(1.0)
    assert xyzw((0.9, 0.1, 0.2, 0.3)) == (0.3, 0.2, 0.1, 0.9)


@given(st.floats(-100.0, 100.0), st.floats(-100.0, 100.0))
def test_nearest_turn_adds_whole_turns_until_it_is_within_half_a_turn(angle, near):
    found = nearest_turn(angle, near)
    turns = (found - angle) / math.tau
    assert abs(found - near) <= math.pi + 1e-9
    assert turns == pytest.approx(round(turns), abs=1e-12)


def test_a_pose_shows_its_orientation_as_a_matrix():
    pose = Pose(about_z(0.5 * math.pi), (1.0, 2.0, 3.0))
    assert pose.rotation.shape == (3, 3)
    np.testing.assert_allclose(pose.rotation @ (0.0, 1.0, 0.0), (1.0, 0.0, 0.0), atol=1e-15)
