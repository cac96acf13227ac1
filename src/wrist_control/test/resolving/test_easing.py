"""Joints that cannot change their rates at once: starts, turns, stops. Sums by hand."""

import math

import numpy as np
import pytest

from wrist_control import make_wrist
from wrist_control.resolving import LimitKind, start, step
from wrist_control.resolving.easing import brought_to_rest

DT = 0.01
UP, DOWN = 2.0, 5.0  # rad/s²
GIMBALS = make_wrist('three_gimbal').with_limits(rates=0.5, accelerations=UP, decelerations=DOWN)
P = (1.0, 0.0, 0.0)


def rolled(wrist, state, rates, count):
    """Return the steps of a hand that is rolled at a rate: for these gimbals φ alone turns."""
    steps = []
    for _ in range(count):
        steps.append(step(wrist, state, (rates, 0.0, 0.0), DT))
        state = steps[-1].state
    return steps


def phi(steps):
    return [taken.joint_rates[2] for taken in steps]


def test_a_hand_gathers_speed_by_the_acceleration_up_to_the_rate_limit():
    steps = rolled(GIMBALS, start(GIMBALS), 0.8, 30)
    expected = np.minimum(UP * DT * np.arange(1, 31), 0.5)
    np.testing.assert_allclose(phi(steps), expected, atol=1e-9)
    np.testing.assert_allclose([one.scale_factor for one in steps], expected / 0.8, atol=1e-9)
    (rate, acceleration) = steps[3].limits
    assert (rate.joint, rate.kind) == ('phi', LimitKind.RATE)
    assert (acceleration.joint, acceleration.kind) == ('phi', LimitKind.ACCELERATION)
    assert acceleration.asked == pytest.approx((0.5 - 0.06) / DT)
    assert acceleration.allowed == pytest.approx(UP)
    assert acceleration.share == pytest.approx(0.08 / 0.5)
    assert {limit.kind for limit in steps[-1].limits} == {LimitKind.RATE}


def test_a_hand_that_turns_back_slows_down_and_speeds_up_and_does_nothing_of_the_command_before():
    fast = rolled(GIMBALS, start(GIMBALS), 0.4, 30)[-1].state
    steps = rolled(GIMBALS, fast, -0.4, 40)
    down = 0.4 - DOWN * DT * np.arange(1, 9)
    up = -UP * DT * np.arange(1, 33)
    np.testing.assert_allclose(phi(steps), [*down, *np.maximum(up, -0.4)], atol=1e-8)
    np.testing.assert_allclose([one.scale_factor for one in steps[:8]], 0.0, atol=1e-12)
    assert steps[8].scale_factor == pytest.approx(UP * DT / 0.4)


def test_less_of_the_same_command_is_come_down_to_along_it():
    wrist = GIMBALS.with_limits(lower=-2.0, upper=2.0)
    twist = np.array([0.2, 0.3, -0.1])
    state = start(wrist, (0.1, 0.2, 0.3))
    for _ in range(40):
        state = step(wrist, state, twist, DT).state
    taken = step(wrist, state, 0.2 * twist, DT)
    achieved = np.array(taken.achieved[3:])
    np.testing.assert_allclose(np.cross(achieved, twist), 0.0, atol=1e-9)
    assert 0.2 < achieved @ twist / (twist @ twist) < 1.0
    assert taken.scale_factor == 1.0
    assert {limit.kind for limit in taken.limits} == {LimitKind.ACCELERATION}


def test_where_no_factor_can_do_it_the_joints_take_the_nearest_rates():
    """From a roll to a pitch: φ slows down, θ speeds up, both as quickly as they may."""
    state = start(GIMBALS)._replace(joint_rates=(0.0, 0.0, 0.4))
    taken = step(GIMBALS, state, (0.0, 0.4, 0.0), DT)
    assert taken.joint_rates == pytest.approx((0.0, UP * DT, 0.4 - DOWN * DT), abs=1e-9)
    assert taken.scale_factor == pytest.approx(UP * DT / 0.4)
    assert LimitKind.ACCELERATION in {limit.kind for limit in taken.limits}


def test_without_a_command_all_joints_slow_down_together_on_a_straight_line():
    rates = (0.5, 0.2, -0.1)
    state = start(GIMBALS)._replace(joint_rates=rates)
    way = []
    while state.joint_rates:
        state = step(GIMBALS, state, (0.0, 0.0, 0.0), DT).state
        way.append(state.joint_rates or (0.0, 0.0, 0.0))
    shares = 1.0 - DOWN * DT / 0.5 * np.arange(1, len(way) + 1)
    np.testing.assert_allclose(way, shares[:, None] * rates, atol=1e-9)
    assert len(way) == 10


@pytest.mark.parametrize('speed', [0.1, 0.5])
def test_a_joint_limit_is_reached_and_not_overshot_however_fast(speed):
    wrist = GIMBALS.with_limits(upper=0.3)
    steps = rolled(wrist, start(wrist), speed, 500)
    positions = [taken.state.positions[2] for taken in steps]
    assert max(positions) <= 0.3 + 1e-9
    assert positions[-1] == pytest.approx(0.3, abs=1e-6)
    losses = -np.diff([0.0, *phi(steps)]) / DT
    assert losses.max() <= DOWN * (1.0 + 1e-6)
    assert losses.max() > 0.5 * DOWN
    assert LimitKind.POSITION in {limit.kind for limit in steps[-1].limits}


def test_a_limit_that_was_lowered_too_late_is_kept_and_the_joint_stops_sooner_than_it_should():
    state = rolled(GIMBALS, start(GIMBALS), 0.5, 30)[-1].state
    near = GIMBALS.with_limits(upper=state.positions[2] + 0.5 * DT)
    after = brought_to_rest(near, state, DT)
    assert after.positions[2] == pytest.approx(state.positions[2] + 0.45 * DT)
    assert brought_to_rest(near, after._replace(joint_rates=(0.0, 0.0, 0.45)), DT).positions[
        2
    ] == pytest.approx(state.positions[2] + 0.5 * DT, abs=0.01 * DT)


def test_a_rate_limit_that_was_lowered_is_come_down_to_as_quickly_as_joints_may():
    state = rolled(GIMBALS, start(GIMBALS), 0.5, 30)[-1].state
    slower = GIMBALS.with_limits(rates=0.1)
    steps = rolled(slower, state, 0.5, 12)
    expected = np.maximum(0.5 - DOWN * DT * np.arange(1, 13), 0.1)
    np.testing.assert_allclose(phi(steps), expected, atol=1e-9)


def test_at_rest_and_where_joints_stop_at_once_nothing_is_brought_to_rest():
    state = start(GIMBALS)
    assert brought_to_rest(GIMBALS, state, DT) is state
    free = make_wrist('three_gimbal')
    moving = state._replace(joint_rates=(0.0, 0.0, 1.0))
    assert brought_to_rest(free, moving, DT) is moving


@pytest.mark.parametrize('size', [1e-300, 8.3e-296, 1e-30, 1e-14])
def test_a_command_that_is_nothing_beside_the_motion_is_rest(size):
    state = start(GIMBALS)._replace(joint_rates=(0.0, 0.0, -0.4))
    taken = step(GIMBALS, state, (size, 0.0, 0.0), DT)
    assert taken.joint_rates == pytest.approx((0.0, 0.0, -0.4 + DOWN * DT))


def test_infinite_limits_are_no_limits_to_the_last_bit():
    free = make_wrist('three_gimbal').with_limits(rates=0.5, lower=-2.0, upper=1.0)
    told = free.with_limits(accelerations=math.inf, decelerations=math.inf)
    one = other = start(free)
    for twist in np.random.default_rng(3).normal(size=(60, 3)):
        one, other = step(free, one, twist, DT).state, step(told, other, twist, DT).state
        assert one == other


def test_a_hand_at_lock_turns_its_joints_into_place_no_more_quickly_than_they_may(at):
    state = at(GIMBALS, (0.0, math.pi / 2.0, 0.0))
    twist = 0.3 * np.array(GIMBALS.lost_axis(state.positions))
    rates = [(0.0, 0.0, 0.0)]
    for _ in range(600):
        taken = step(GIMBALS, state, twist, DT)
        state = taken.state
        rates.append(taken.joint_rates)
    assert GIMBALS.margin(state.positions) > 0.2
    changes = np.diff(np.abs(rates), axis=0) / DT
    assert changes.max() <= UP * (1.0 + 1e-6)
    assert changes.min() >= -DOWN * (1.0 + 1e-6)
