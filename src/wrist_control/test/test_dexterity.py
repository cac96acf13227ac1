"""The measures against the printed formulas and the definition; the sweeps of every wrist."""

import math

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

from wrist_control import WRISTS, InvalidValueError, make_wrist
from wrist_control.dexterity import (
    determinant,
    dexterity,
    dexterous_measure,
    disc,
    is_dexterous,
    jacobians,
    principal,
    singular_ratio,
    sweep,
)

seeds = st.integers(0, 10_000)


def drawn(seed, *shape):
    return np.random.default_rng(seed).normal(size=shape)


@given(seeds)
def test_square_dexterity_is_the_printed_one(seed):
    """[Canfield1997], (4.4)."""
    J, v = drawn(seed, 3, 3), drawn(seed + 1, 3)
    inverse = np.linalg.inv(J)
    printed = math.sqrt(v @ v / (v @ inverse.T @ inverse @ v))
    assert dexterity(J, v) == pytest.approx(printed, rel=1e-6)


@given(seeds)
def test_tall_dexterity_is_the_printed_one(seed):
    """[Canfield1997], (4.5), for a velocity that the joints can make."""
    J = drawn(seed, 3, 2)
    v = J @ drawn(seed + 1, 2)
    gram = np.linalg.inv(J.T @ J)
    printed = math.sqrt(v @ v / (v @ J @ gram.T @ gram @ J.T @ v))
    assert dexterity(J, v) == pytest.approx(printed, rel=1e-6)


@given(seeds)
def test_short_dexterity_is_the_printed_one(seed):
    """[Canfield1997], (4.6), R from the polar decomposition J = R Q of (4.7)."""
    J, v = drawn(seed, 2, 3), drawn(seed + 1, 2)
    left, stretch, _ = np.linalg.svd(J, full_matrices=False)
    R = np.linalg.inv(left @ np.diag(stretch) @ left.T)
    printed = math.sqrt(v @ v / (v @ R.T @ R @ v))
    assert dexterity(J, v) == pytest.approx(printed, rel=1e-6)


@given(seeds)
def test_dexterity_lies_between_the_principal_ones(seed):
    J, v = drawn(seed, 5, 2, 3), drawn(seed + 1, 5, 2)
    values, found = principal(J), dexterity(J, v)
    assert np.all(found <= values[:, 0] * (1.0 + 1e-9))
    assert np.all(found >= values[:, -1] * (1.0 - 1e-9))


@given(seeds)
def test_determinant_is_the_volume_for_every_shape(seed):
    square, tall, short = drawn(seed, 3, 3), drawn(seed, 3, 2), drawn(seed, 2, 3)
    assert determinant(square) == pytest.approx(abs(np.linalg.det(square)), rel=1e-6)
    assert determinant(tall) == pytest.approx(math.sqrt(np.linalg.det(tall.T @ tall)), rel=1e-6)
    assert determinant(short) == pytest.approx(math.sqrt(np.linalg.det(short @ short.T)), rel=1e-6)


def test_singular_ratio_is_one_for_a_rotation_and_infinite_at_a_lock():
    assert singular_ratio(np.eye(3)) == pytest.approx(1.0)
    assert singular_ratio(np.diag([1.0, 0.0])) == math.inf


def test_high_dexterity_needs_both_measures_of_table_4_1():
    large_even, large_uneven = np.diag([1.0, 1.0]), np.diag([20.0, 0.1])
    small_even, small_uneven = np.diag([0.1, 0.1]), np.diag([0.1, 0.001])
    stack = np.array([large_even, large_uneven, small_even, small_uneven])
    assert is_dexterous(stack).tolist() == [True, False, False, False]


def test_outside_the_workspace_every_measure_is_nan():
    stack = np.array([np.eye(2), np.full((2, 2), np.nan)])
    for measure in (determinant, singular_ratio):
        values = measure(stack)
        assert values[0] == pytest.approx(1.0)
        assert math.isnan(values[1])
    assert is_dexterous(stack).tolist() == [True, False]


def test_dexterous_measure_is_the_sample_deviation():
    found = dexterous_measure(np.array([1.0, 2.0, 4.0, np.nan]))
    assert found.deviation == pytest.approx(np.std([1.0, 2.0, 4.0], ddof=1))
    assert (found.least, found.largest) == (1.0, 4.0)
    assert found.relative == pytest.approx(found.deviation / found.mean)


def test_weights_count_a_place_as_often_as_they_say():
    weighted = dexterous_measure(np.array([1.0, 4.0]), np.array([3.0, 1.0]))
    repeated = np.array([1.0, 1.0, 1.0, 4.0])
    assert weighted.mean == pytest.approx(repeated.mean())
    assert weighted.deviation == pytest.approx(repeated.std())


def test_a_measure_of_nothing_is_refused():
    with pytest.raises(InvalidValueError, match='at least two'):
        dexterous_measure(np.array([1.0, np.nan]))


@pytest.mark.parametrize('name', WRISTS)
def test_sweep_turns_the_hand_about_the_axis_it_was_given(name):
    wrist = make_wrist(name)
    for axis in wrist.followed_axes:
        direction = np.eye(3)[axis]
        angles = np.linspace(0.0, 0.5, 11)
        positions = sweep(wrist, direction.tolist(), angles.tolist())
        assert len(positions) == len(angles)
        for angle, place in zip(angles, positions, strict=True):
            turned = wrist.forward(place).rotation @ np.array(wrist.forward(wrist.home).rotation).T
            assert np.trace(turned) == pytest.approx(1.0 + 2.0 * math.cos(angle), abs=1e-9)
            np.testing.assert_allclose(turned @ direction, direction, atol=1e-9)


@pytest.mark.parametrize('name', WRISTS)
def test_maps_of_every_wrist_are_the_measures_of_its_jacobians(name):
    wrist = make_wrist(name)
    headings, angles = [0.3, 2.0], [0.0, 0.2, 0.4]
    stack = disc(wrist, (0, 1), headings, angles)
    free = wrist.followed_axes
    assert stack.shape == (2, 3, len(free), len(wrist.joints))
    axis = (math.cos(2.0), math.sin(2.0), 0.0)
    place = sweep(wrist, axis, angles)[2]
    rows = [axis - 3 for axis in free]
    np.testing.assert_allclose(stack[1, 2], wrist.jacobian(place)[rows])
    np.testing.assert_allclose(jacobians(wrist, [place])[0], stack[1, 2])


def test_lock_of_the_three_gimbal_wrist_shows_where_barker_has_it():
    stack = disc(make_wrist('three_gimbal'), (0, 1), [0.0, 0.5 * math.pi], [0.0, 0.5 * math.pi])
    assert determinant(stack)[0, 1] == pytest.approx(1.0)
    assert determinant(stack)[1, 1] == pytest.approx(0.0, abs=1e-9)


@pytest.mark.parametrize(('name', 'edge'), [('five_bar', 88.9), ('carpal', 107.1)])
def test_sweep_does_not_step_over_the_edge_of_the_workspace(name, edge):
    wrist = make_wrist(name)
    angles = np.radians(np.arange(0.0, 180.0, 4.0)).tolist()
    for heading in np.linspace(0.0, 6.0, 25):
        axis = (math.cos(heading), math.sin(heading), 0.0)
        for place in sweep(wrist, axis, angles):
            tilt = math.acos(min(1.0, wrist.forward(place).rotation[2, 2]))
            assert tilt < math.radians(edge)


def test_position_limits_end_a_sweep():
    wrist = make_wrist('pitch_yaw').with_limits(lower=-0.5, upper=0.5)
    assert len(sweep(wrist, (1.0, 0.0, 0.0), [0.0, 0.4, 0.6, 0.8])) == 2
