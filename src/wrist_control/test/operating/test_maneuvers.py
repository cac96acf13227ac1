"""What the operator asks for: segments of constant hand rates, flown to their exact end."""

import math

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

from wrist_control import InvalidValueError, make_maneuver
from wrist_control.operating.maneuvers import (
    BARKER_SPEED,
    MANEUVERS,
    Maneuver,
    Order,
    Segment,
    stick,
    turn,
)

H = 1.0 / 32.0
NAMES = [name for name in MANEUVERS if name != 'hold']
TWO = Maneuver('two', (Segment((1.0, 0.0, 0.0), 0.35), Segment((0.0, 2.0, 0.0), 0.25)))


def asked(maneuver, dt):
    """Return the turn that an operator asks for who waits for the hand, rad, and the steps."""
    total, clock, steps = np.zeros(3), 0.0, 0
    while clock < maneuver.duration - 1e-9:
        order = maneuver.order(clock, dt)
        total += dt * np.abs(order.rates)
        clock += order.share * dt
        steps += 1
        assert steps < 10_000
    return total, steps


def test_barkers_speed_is_one_degree_for_each_step():
    assert math.degrees(BARKER_SPEED * H) == pytest.approx(1.0)


def test_the_basic_test_pitches_then_yaws_by_a_quarter_turn():
    maneuver = make_maneuver('basic_test')
    assert maneuver.duration == pytest.approx(5.625)
    assert maneuver.order(0.0, H).rates == (0.0, BARKER_SPEED, 0.0)
    assert maneuver.order(2.8, H / 32).rates == (0.0, BARKER_SPEED, 0.0)
    assert maneuver.order(2.8125, H).rates == (0.0, 0.0, BARKER_SPEED)
    assert maneuver.order(5.625, H) == Order((0.0, 0.0, 0.0), 1.0)


@pytest.mark.parametrize(
    ('name', 'turns'),
    [
        ('basic_test', (0.0, 90.0, 90.0)),
        ('extended_test', (0.0, 90.0, 360.0)),
        ('pitch_then_roll', (360.0, 40.0, 0.0)),
        ('roll_at_full_bend', (360.0, 90.0, 0.0)),
        ('hold', (0.0, 0.0, 0.0)),
    ],
)
@pytest.mark.parametrize('dt', [H, 0.01, 0.037])
def test_every_maneuver_asks_for_its_turns_exactly_at_any_step(name, turns, dt):
    total, _ = asked(make_maneuver(name), dt)
    np.testing.assert_allclose(np.degrees(total), turns, atol=1e-6)


@pytest.mark.parametrize('name', NAMES)
@pytest.mark.parametrize('speed', [0.1, 2.0])
def test_no_maneuver_is_faster_than_its_speed(name, speed):
    fastest = max(math.hypot(*segment.rates) for segment in make_maneuver(name, speed).segments)
    assert fastest <= speed * (1.0 + 1e-12)
    assert name == 'stick' or fastest == pytest.approx(speed)


def test_a_segment_that_ends_within_a_step_is_flown_slower_and_ends_exactly():
    order = TWO.order(0.3, 0.1)
    assert order.share == pytest.approx(0.5)
    assert order.rates == pytest.approx((0.5, 0.0, 0.0))
    assert asked(TWO, 0.1)[1] == 7  # 4 + 3, where 6 steps would have been the time


@given(
    st.lists(st.floats(0.01, 1.0), min_size=1, max_size=5),
    st.floats(0.005, 0.3),
)
def test_the_operator_who_waits_asks_for_each_segment_in_full(durations, dt):
    maneuver = Maneuver(
        'any', tuple(Segment((1.0, 0.0, -1.0), duration) for duration in durations)
    )
    total, _ = asked(maneuver, dt)
    np.testing.assert_allclose(total, (sum(durations), 0.0, sum(durations)), atol=1e-7)


@given(st.floats(-1.0, 2.0), st.floats(1e-3, 1.0))
def test_the_share_is_between_nothing_and_all_and_slows_the_rates_alike(time, dt):
    order = TWO.order(time, dt)
    assert 0.0 < order.share <= 1.0
    full = TWO.order(time, 1e-9).rates
    np.testing.assert_allclose(order.rates, order.share * np.array(full))


def test_an_operator_who_does_not_wait_never_slows():
    hasty = Maneuver('hasty', TWO.segments, waits=False)
    assert hasty.order(0.3, 0.1) == Order((1.0, 0.0, 0.0), 1.0)


def test_round_off_in_a_sum_of_steps_adds_no_step():
    for almost in (0.35 - 1e-12, 0.35, 0.35 + 1e-12):
        assert TWO.order(almost, 0.05) == Order((0.0, 2.0, 0.0), 1.0)


def test_before_its_start_a_maneuver_begins_and_after_its_end_it_rests():
    assert TWO.order(-1.0, 0.1) == TWO.order(0.0, 0.1)
    assert TWO.order(1e9, 0.1) == Order((0.0, 0.0, 0.0), 1.0)


@pytest.mark.parametrize('axis', [0, 1, 2])
@given(st.floats(-7.0, 7.0), st.floats(0.01, 5.0))
def test_a_turn_takes_its_angle_over_its_speed(axis, angle, speed):
    rates, duration = turn(axis, angle, speed)
    assert abs(rates[axis]) == speed
    assert rates[axis] * duration == pytest.approx(angle)
    assert sum(map(abs, rates)) == speed


def test_the_stick_is_pseudo_random_the_same_each_time_and_does_not_wait():
    assert stick(1.0) == stick(1.0)
    assert stick(1.0) != stick(1.0, seed=2)
    assert stick(1.0).duration == pytest.approx(60.0)
    assert not stick(1.0).waits
    rates = np.array([segment.rates for segment in stick(1.0).segments])
    assert len(np.unique(rates, axis=0)) == 120
    assert np.abs(rates.mean(axis=0)).max() < 0.2
    assert (np.abs(rates).max(axis=0) > 0.5).all()


def test_an_unknown_maneuver_is_refused_and_told_which_there_are():
    with pytest.raises(InvalidValueError, match=r"no maneuver 'loop'; the maneuvers are basic_te"):
        make_maneuver('loop')


@pytest.mark.parametrize('speed', [0.0, -1.0, math.nan, math.inf])
def test_a_speed_that_moves_nothing_or_everything_is_refused(speed):
    with pytest.raises(InvalidValueError, match=r'speed is .*; it must be finite and above 0'):
        make_maneuver('basic_test', speed)
