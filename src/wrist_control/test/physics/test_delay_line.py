"""What comes out of a delay is what went in, that much later, to the instant."""

import math

import pytest
from hypothesis import given
from hypothesis import strategies as st

from wrist_control.physics.delay_line import DelayLine


def test_without_a_delay_a_value_holds_in_the_period_that_it_comes_in():
    line = DelayLine(0.0, 0.01, before=0)
    assert [line.hand_on(value) for value in (1, 2)] == [[(0.01, 1)], [(0.01, 2)]]


def test_a_delay_of_whole_periods_hands_on_older_values():
    line = DelayLine(0.02, 0.01, before=0)
    assert [line.hand_on(value) for value in (1, 2, 3, 4)] == [
        [(0.01, 0)],
        [(0.01, 0)],
        [(0.01, 1)],
        [(0.01, 2)],
    ]


def test_a_delay_that_ends_within_a_period_changes_the_value_there():
    line = DelayLine(0.013, 0.01, before=0)
    parts = [line.hand_on(value) for value in (1, 2, 3)]
    assert [[value for _, value in period] for period in parts] == [[0, 0], [0, 1], [1, 2]]
    for period in parts:
        assert [seconds for seconds, _ in period] == pytest.approx([0.003, 0.007])


@given(
    st.floats(0.0, 0.5),
    st.floats(0.001, 0.1),
    st.integers(0, 200),
)
def test_each_value_begins_to_hold_exactly_the_delay_after_it_came(delay, period, which):
    line = DelayLine(delay, period, before=-1)
    time = 0.0
    for value in range(which + math.ceil(delay / period) + 2):
        parts = line.hand_on(value)
        assert sum(seconds for seconds, _ in parts) == pytest.approx(period)
        assert all(seconds > 0.0 for seconds, _ in parts)
        for seconds, held in parts:
            if held == which:
                assert time == pytest.approx(which * period + delay, abs=1e-6)
                return
            time += seconds
    pytest.fail('it never came out')


@pytest.mark.parametrize('periods', range(1, 60))
def test_round_off_adds_no_sliver_of_a_period(periods):
    line = DelayLine(periods / 100.0, 0.01, before=0)
    assert all(len(line.hand_on(value)) == 1 for value in range(5))
