"""The keys of a terminal: each holds for a moment from when it came, and never longer."""

import pytest
from hypothesis import given
from hypothesis import strategies as st

from wrist_control.errors import InvalidValueError
from wrist_control.operating.keys import (
    ENABLE,
    LEASE,
    MOST_AT_ONCE,
    SLOWEST,
    STEP,
    STOP,
    ZEROS,
    Keys,
)

SPEED, MOST = 0.5, 1.0
P, Q, R = 0, 1, 2
ZERO = (0.0, 0.0, 0.0)


def keys():
    return Keys(SPEED, MOST)


@pytest.mark.parametrize(
    ('key', 'axis', 'sign'),
    [('w', Q, 1), ('s', Q, -1), ('d', P, 1), ('a', P, -1), ('q', R, 1), ('e', R, -1)],
)
def test_each_key_turns_the_hand_about_its_axis(key, axis, sign):
    held = keys()
    held.take(key, 10.0)
    expected = [0.0, 0.0, 0.0]
    expected[axis] = sign * SPEED
    assert held.rates(10.0) == tuple(expected)


def test_a_key_counts_for_a_lease_after_it_came_and_then_asks_for_zeros_and_then_for_nothing():
    held = keys()
    assert held.rates(10.0) is None
    held.take('w', 10.0)
    assert held.rates(10.0 + 0.99 * LEASE)[Q] == SPEED
    assert held.rates(10.0 + LEASE) == ZERO
    assert held.rates(10.0 + 0.99 * ZEROS) == ZERO
    assert held.rates(10.0 + 1.01 * ZEROS) is None


def test_the_lease_is_no_longer_than_is_promised_and_outlives_a_slow_repeat():
    assert 0.1 < LEASE < 0.25


@pytest.mark.parametrize('first_repeat', [0.25, 0.66])
@pytest.mark.parametrize('repeats_per_second', [11.0, 25.0, 40.0])
def test_a_held_key_makes_a_step_and_then_moves_on_until_it_repeats_no_more(
    first_repeat, repeats_per_second
):
    held, step = keys(), 0.005
    times = [0.0] + [first_repeat + i / repeats_per_second for i in range(30)]
    end = times[-1]
    moving = []
    for now in (step * i for i in range(int((end + 1.0) / step))):
        while times and times[0] <= now:
            held.take('w', now)
            times.pop(0)
        if (held.rates(now) or ZERO)[Q]:
            moving.append(now)
    assert all(now < LEASE or now >= first_repeat for now in moving)
    within = [now for now in moving if now >= first_repeat]
    assert len(within) == pytest.approx((within[-1] - within[0]) / step + 1)  # without a gap
    assert end < within[-1] <= end + LEASE + step


def test_of_two_keys_each_has_its_own_lease():
    held = keys()
    held.take('w', 10.0)
    held.take('d', 10.1)
    assert held.rates(10.1) == (SPEED, SPEED, 0.0)
    assert held.rates(10.05 + LEASE) == (SPEED, 0.0, 0.0)
    held.take('a', 10.1)
    assert held.rates(10.1)[P] == 0.0


@given(st.text(), st.floats(0.0, 1e6))
def test_whatever_is_typed_nothing_moves_once_the_lease_is_over(text, now):
    held = keys()
    held.take(text, now)
    assert held.rates(now + LEASE + 1e-6) in (None, ZERO)
    assert all(abs(rate) <= 2.0 * SPEED * STEP**MOST_AT_ONCE for rate in held.rates(now) or ZERO)


@pytest.mark.parametrize('text', ['w' * (MOST_AT_ONCE + 1), 'we dreamed'.replace(' ', '')])
def test_what_was_pasted_or_held_up_on_its_way_moves_nothing(text):
    held = keys()
    held.take(text, 10.0)
    assert held.rates(10.0) is None


@pytest.mark.parametrize('text', ['\x1b[A', '\x1b[1;5D', '\x1bOq', '\x1bw', '\x1b', '\x1b[1;2q'])
def test_arrows_and_the_like_are_no_letters(text):
    held = keys()
    held.take(text, 10.0)
    assert held.rates(10.0) is None


@pytest.mark.parametrize('text', [' ', 'w ', ' g', 'w' * 50 + ' '])
def test_a_stop_counts_whatever_comes_with_it_and_lets_go_of_every_key(text):
    held = keys()
    held.take('w', 10.0)
    assert held.take(text, 10.05) == STOP
    assert held.rates(10.05) == ZERO


def test_going_on_is_asked_for_and_no_key_is_held_over_it():
    held = keys()
    held.take('w', 10.0)
    assert held.take('g', 10.05) == ENABLE
    assert held.rates(10.05) == ZERO
    assert held.take('w', 10.1) == ''


def test_the_speed_is_changed_by_keys_within_its_bounds():
    held = keys()
    held.take('+', 0.0)
    assert held.speed == pytest.approx(SPEED * STEP)
    held.take('-', 0.0)
    assert held.speed == pytest.approx(SPEED)
    for _ in range(100):
        held.take('=', 0.0)
    assert held.speed == MOST
    for _ in range(100):
        held.take('_', 0.0)
    assert held.speed == pytest.approx(SLOWEST)
    assert held.rates(0.0) is None


def test_a_start_faster_than_it_may_be_is_refused():
    with pytest.raises(
        InvalidValueError, match='speed is 5 rad/s; valid is at most max_speed, 1 '
    ):
        Keys(5.0, MOST)
