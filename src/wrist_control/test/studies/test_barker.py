"""[Barker1986], figures 6, 7 and 8, as the three-gimbal wrist flies them."""

import math

import numpy as np
import pytest

from wrist_control import fly
from wrist_control.operating.maneuvers import BARKER_SPEED
from wrist_control.studies.barker import (
    angle_from_vertical,
    arc_error,
    pause,
    peak_rates,
    three_gimbal_table,
    tip_error,
)
from wrist_control.wrists.body import ALONG_X

H = 1.0 / 32.0
EPSILON = 0.001  # ε0: nearer to lock than this, steps are made in the joints
LENGTH = ALONG_X[0]
LOCKED = 90  # the step at which the probe points down: 1° for each


@pytest.fixture(scope='module')
def unscaled():
    return fly('three_gimbal', 'basic_test')


@pytest.fixture(scope='module')
def scaled():
    return fly('three_gimbal', 'basic_test', joint_rate_limits=BARKER_SPEED)


@pytest.fixture(scope='module')
def half():
    """Return the flight with ψ and φ held to half of Barker's limit, and θ to the whole."""
    limits = (0.5 * BARKER_SPEED, BARKER_SPEED, 0.5 * BARKER_SPEED)
    return fly('three_gimbal', 'basic_test', joint_rate_limits=limits)


def digits(x):
    """Round as the tables do."""
    return round(float(x), 4)


# Figure 6: the tip of the probe


def test_figure_6_the_tip_goes_down_and_then_to_the_left_along_two_quarter_circles(unscaled):
    degree = np.radians(np.arange(91))
    s, c, o = np.sin(degree), np.cos(degree), np.zeros(91)
    down = np.column_stack([c, o, -s])
    left = np.column_stack([o, s, -c])
    expected = LENGTH * np.vstack([down, left[1:]])
    np.testing.assert_allclose(unscaled.tip, expected, atol=1e-12)
    np.testing.assert_allclose(unscaled.time, H * np.arange(181), atol=1e-12)


def test_figure_6_the_probe_is_vertical_after_2_8125_seconds(unscaled):
    assert unscaled.time[LOCKED] == 2.8125
    assert angle_from_vertical(unscaled)[LOCKED] < 1e-12
    assert tip_error(unscaled, LOCKED, (0.0, 0.0, -1.0)) < 1e-12
    assert tip_error(unscaled, -1, (0.0, 1.0, 0.0)) < 1e-12
    assert tip_error(unscaled, 0, (0.0, 0.0, -1.0)) == pytest.approx(math.sqrt(2.0))


def test_figure_6_the_whole_hand_follows_the_command_and_nothing_is_lost(unscaled):
    assert (unscaled.scale_factor == 1.0).all()
    assert unscaled.time_lost[-1] == 0.0
    np.testing.assert_allclose(unscaled.achieved[:, 3:], unscaled.command, atol=1e-12)
    assert arc_error(unscaled) < 1e-12


# Figure 7: the jump at lock


def test_figure_7_psi_and_phi_jump_by_90_degrees_in_one_step(unscaled):
    angles = np.degrees(unscaled.joint_positions)
    before = np.minimum(np.arange(91), 90.0)
    np.testing.assert_allclose(angles[:91], np.outer(before, (0.0, 1.0, 0.0)), atol=1e-9)
    after = np.column_stack([np.full(90, 90.0), 89.0 - np.arange(90), np.full(90, 90.0)])
    np.testing.assert_allclose(angles[91:], after, atol=1e-9)


def test_figure_7_the_jump_is_2880_deg_per_s_and_theta_never_more_than_32(unscaled):
    assert [digits(rate) for rate in peak_rates(unscaled)] == [2880.0, 32.0, 2880.0]
    assert np.abs(unscaled.joint_rates[:, 0]).argmax() == LOCKED


@pytest.mark.parametrize('rate', [16.0, 50.0, 64.0, 100.0, 128.0])
def test_figure_7_the_true_rate_at_lock_is_90_degrees_per_step_whatever_the_step(rate):
    peaks = peak_rates(fly('three_gimbal', 'basic_test', rate))
    assert peaks == pytest.approx([90.0 * rate, 32.0, 90.0 * rate])


# Figure 8: the pause, with every gimbal held to 32 deg/s


def test_figure_8_no_increment_exceeds_its_limit(scaled, half):
    for flight in (scaled, half):
        limits = [joint.rate_limit for joint in flight.wrist.joints]
        increments = np.abs(np.diff(flight.joint_positions, axis=0))
        assert (increments <= H * np.array(limits) * (1.0 + 2e-9)).all()
    assert [digits(rate) for rate in peak_rates(scaled)] == [32.0, 32.0, 32.0]
    assert [digits(rate) for rate in peak_rates(half)] == [16.0, 32.0, 16.0]


def test_figure_8_the_whole_maneuver_takes_2_8125_seconds_longer(unscaled, scaled):
    assert digits(scaled.time[-1] - unscaled.time[-1]) == 2.8125
    assert digits(scaled.time_lost[-1]) == 2.7887
    assert scaled.completed


def test_figure_8_the_pause_is_the_time_that_90_degrees_take_at_the_limit(scaled):
    assert digits(pause(scaled)) == 2.7394
    assert scaled.time_lost[-1] == pytest.approx(90.0 / 32.0, abs=H)


def test_figure_8_half_the_limit_is_twice_the_pause(scaled, half):
    assert digits(half.time_lost[-1]) == 5.5697
    assert half.time_lost[-1] == pytest.approx(2.0 * scaled.time_lost[-1], abs=H)
    slow = fly('three_gimbal', 'basic_test', joint_rate_limits=0.5 * BARKER_SPEED)
    assert digits(pause(slow)) == 5.4864
    assert pause(slow) == pytest.approx(2.0 * pause(scaled), abs=H)


@pytest.mark.parametrize('rate', [32.0, 64.0, 128.0])
def test_without_scaling_there_is_no_pause(rate):
    assert pause(fly('three_gimbal', 'basic_test', rate)) == pytest.approx(0.0, abs=1e-12)


def test_figure_8_psi_and_phi_turn_at_their_limit_all_through_the_pause(scaled):
    lock = slice(LOCKED, LOCKED + 75)
    psi_and_phi = np.degrees(scaled.joint_rates[lock][:, [0, 2]])
    np.testing.assert_allclose(psi_and_phi[:6], 32.0, rtol=1e-5)
    np.testing.assert_allclose(psi_and_phi, 32.0, rtol=0.06)
    assert (scaled.scale_factor[lock] < 0.1).all()
    assert (scaled.scale_factor[:LOCKED] == 1.0).all()
    assert (scaled.scale_factor[-80:] == 1.0).all()
    for row in range(LOCKED, LOCKED + 6):
        assert set(scaled.limited[row]) <= {'psi', 'phi'}


def test_figure_8_the_path_of_the_hand_is_the_same_to_0_0677_degrees(scaled):
    assert digits(math.degrees(arc_error(scaled))) == 0.0677
    assert arc_error(scaled) == pytest.approx(0.001182, abs=5e-7)
    assert tip_error(scaled, -1, (0.0, 1.0, 0.0)) < 0.0012


def test_figure_8_the_path_error_is_what_the_singular_region_leaves_behind(scaled):
    """Inside, the probe is off by less than ε0; outside, the direction is exact and keeps that."""
    inside = np.flatnonzero(scaled.margin < EPSILON)
    assert list(inside) == list(range(LOCKED, LOCKED + 6))
    assert np.sin(angle_from_vertical(scaled))[inside].max() < EPSILON
    out = inside[-1] + 1
    psi = scaled.joint_positions[out, 0]
    left_behind = scaled.margin[out] * math.cos(psi)
    assert arc_error(scaled) == pytest.approx(left_behind, rel=1e-5)
    one_step = scaled.margin[out] - scaled.margin[out - 1]
    assert arc_error(scaled) < EPSILON + one_step
    z_of_hand = scaled.hand_rotation[out:, 2]
    np.testing.assert_allclose(
        z_of_hand, np.broadcast_to(z_of_hand[0], z_of_hand.shape), atol=1e-12
    )


def test_figure_8_shorter_steps_bring_the_path_error_below_epsilon():
    errors = [
        arc_error(fly('three_gimbal', 'basic_test', rate, BARKER_SPEED))
        for rate in (32.0, 64.0, 128.0)
    ]
    assert errors == sorted(errors, reverse=True)
    assert errors[1] < EPSILON


# The table


def test_the_table_says_what_was_measured_to_four_digits(unscaled, scaled):
    rows = three_gimbal_table(unscaled, scaled)
    measured = ' | '.join(row.measured for row in rows)
    for value in ('2.8125 s', '90.0000°', '2880.0000', '32.0000', '2.7394 s', '2.7887', '0.0677°'):
        assert value in measured
    assert {row.what[0] for row in rows} == {'6', '7', '8'}
    assert all(row.paper for row in rows)
