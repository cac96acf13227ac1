"""The way back to the start: within the rate limits, all joints arriving together."""

import math

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

from wrist_control import make_wrist
from wrist_control.resolving import start
from wrist_control.resolving.homing import has_reached, step_home

WRIST = make_wrist('three_gimbal')
CALM = 0.5  # rad/s, for a joint without a rate limit
places = st.tuples(st.floats(-3.0, 3.0), st.floats(-1.4, 1.4), st.floats(-3.0, 3.0))
rate_limits = st.lists(st.one_of(st.floats(0.05, 5.0), st.just(math.inf)), min_size=3, max_size=3)


def way(wrist, state, aim, dt):
    """Yield the states on the way to an aim, until there."""
    while not has_reached(state, aim):
        state = step_home(wrist, state, aim, dt).state
        yield state


@given(places, places, rate_limits)
def test_no_joint_ever_moves_faster_than_its_limit_or_than_calm(there, aim, rates):
    wrist = WRIST.with_limits(rates=rates)
    allowed = [CALM if math.isinf(rate) else rate for rate in rates]
    state = start(wrist, there)
    for after in way(wrist, state, aim, 0.1):
        moved = np.abs(np.subtract(after.positions, state.positions))
        assert (moved <= 0.1 * np.array(allowed) * (1.0 + 2e-9)).all()
        state = after


@given(places, places)
def test_the_joints_go_straight_and_arrive_together_in_the_time_of_the_slowest(there, aim):
    rates = (0.5, 1.0, 2.0)
    wrist = WRIST.with_limits(rates=rates)
    path = np.array(
        [there, *(state.positions for state in way(wrist, start(wrist, there), aim, 0.1))]
    )
    longest = max(np.abs(np.subtract(aim, there)) / rates)
    assert len(path) - 1 == pytest.approx(longest / 0.1, abs=1.0 + 1e-6)
    np.testing.assert_allclose(path[-1], aim, atol=1e-9)
    along = np.subtract(aim, there)
    if np.abs(along).max() > 1e-3:
        shares = (path - there) @ along / (along @ along)
        np.testing.assert_allclose(path, there + shares[:, None] * along, atol=1e-9)
        assert (np.diff(shares) > 0.0).all()


def test_the_hand_goes_with_the_joints_and_time_lost_stands_on_the_way():
    state = start(WRIST, (0.5, 0.5, 0.5))._replace(time_lost=3.0, steering_state=(1.0,))
    after = step_home(WRIST, state, (0.0, 0.0, 0.0), 0.1).state
    assert after.pose == WRIST.forward(after.positions)
    assert after.time_lost == 3.0
    assert after.steering_state == ()


def test_a_prismatic_joint_without_a_limit_goes_calmly_too():
    wrist = make_wrist('stewart').with_limits(rates=math.inf)
    state = start(wrist)
    aim = tuple(x + 0.01 for x in state.positions)
    after = step_home(wrist, state, aim, 0.1).state
    assert np.subtract(after.positions, state.positions) == pytest.approx([0.1 * 0.02] * 6)


def test_a_joint_outside_its_range_comes_back_into_it():
    wrist = WRIST.with_limits(lower=-1.0, upper=1.0)
    outside = start(WRIST, (2.0, 0.0, -1.5))
    *_, last = way(wrist, outside, (0.0, 0.0, 0.0), 0.1)
    assert last.positions == pytest.approx((0.0, 0.0, 0.0), abs=1e-9)


def test_arrived_is_every_joint_in_its_place():
    state = start(WRIST, (0.1, 0.2, 0.3))
    assert has_reached(state, (0.1, 0.2, 0.3))
    assert not has_reached(state, (0.1, 0.2, 0.3 + 1e-6))


def test_without_limits_joints_go_home_at_half_a_radian_and_legs_at_two_centimetres_a_second():
    turning = make_wrist('three_gimbal')
    turned = step_home(turning, start(turning), (1.0, 0.0, 0.0), 0.01).state
    assert turned.positions == pytest.approx((0.005, 0.0, 0.0))
    platform = make_wrist('stewart')
    higher = [length + 0.01 for length in platform.home]
    lifted = step_home(platform, start(platform), higher, 0.01).state
    assert list(lifted.positions) == pytest.approx([x + 0.0002 for x in platform.home])


def test_joints_that_take_their_time_speed_up_and_slow_down_on_a_straight_line():
    wrist = WRIST.with_limits(rates=0.5, accelerations=2.0, decelerations=5.0)
    state, dt, rates = start(wrist, (0.4, -0.2, 0.1)), 0.01, [(0.0, 0.0, 0.0)]
    aim = (0.0, 0.0, 0.0)
    while not has_reached(state, aim):
        taken = step_home(wrist, state, aim, dt)
        state = taken.state
        rates.append(taken.joint_rates)
        np.testing.assert_allclose(np.cross(state.positions, (0.4, -0.2, 0.1)), 0.0, atol=1e-9)
        assert len(rates) < 200
    changes = np.diff(np.abs(rates), axis=0) / dt
    assert changes.max() == pytest.approx(2.0, rel=1e-6)
    assert -5.0 * (1.0 + 1e-6) <= changes.min() < -4.0
    assert np.abs(rates).max() == pytest.approx(0.5)


def test_a_hand_that_moves_elsewhere_is_led_home_without_a_jerk():
    wrist = WRIST.with_limits(rates=0.5, accelerations=2.0, decelerations=5.0)
    state = start(wrist, (0.4, -0.2, 0.1))._replace(joint_rates=(0.4, 0.3, 0.0))
    rates, dt = [state.joint_rates], 0.01
    while not has_reached(state, (0.0, 0.0, 0.0)):
        taken = step_home(wrist, state, (0.0, 0.0, 0.0), dt)
        state = taken.state
        rates.append(taken.joint_rates)
        assert len(rates) < 400
    assert np.abs(np.diff(rates, axis=0)).max() / dt <= 5.0 * (1.0 + 1e-6)


def test_a_stop_on_the_way_home_ends_at_rest():
    wrist = WRIST.with_limits(rates=0.5, accelerations=2.0, decelerations=5.0)
    state = start(wrist, (0.4, 0.0, 0.0))
    for share in (*[1.0] * 30, *[0.0] * 11):
        state = step_home(wrist, state, (0.0, 0.0, 0.0), 0.01, share).state
    assert state.joint_rates == ()
    assert 0.1 < state.positions[0] < 0.35
