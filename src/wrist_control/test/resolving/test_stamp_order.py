"""Stamps of one topic only go up: what is late does not undo a stop."""

import pytest
from hypothesis import given
from hypothesis import strategies as st

from wrist_control.errors import RefusedError
from wrist_control.resolving.commands import CLOCK_SKEW, Command
from wrist_control.resolving.stamp_order import StampOrder

ZERO = (0.0,) * 6
TIMEOUT = 0.25
delays = st.floats(0.0, 0.24)


def passes(order, stamp, now):
    command = Command(ZERO, False, stamp, now)
    try:
        order.check(command, stamp_time=now, timeout=TIMEOUT)
    except RefusedError as error:
        return error.reason != 'out of order'
    return True


@given(st.lists(st.tuples(st.floats(0.001, 0.1), delays), min_size=2, max_size=50))
def test_what_passes_is_in_the_order_of_its_stamps(messages):
    order, made, arrivals = StampOrder(), 0.0, []
    for wait, delay in messages:
        made += wait
        arrivals.append((made + delay, made))
    passed = [stamp for now, stamp in sorted(arrivals) if passes(order, stamp, now)]
    assert passed == sorted(passed)
    assert passed


def test_a_late_command_does_not_undo_a_stop_and_the_sentence_says_how_late():
    order = StampOrder()
    assert passes(order, 10.0, 10.01)
    with pytest.raises(RefusedError, match=r'stamped 0\.100 s before the last one; send'):
        order.check(Command(ZERO, False, 9.9, 10.02), stamp_time=10.02, timeout=TIMEOUT)
    assert passes(order, 10.0, 10.03)
    assert passes(order, 10.02, 10.03)


def test_after_a_command_without_a_stamp_what_was_made_before_it_came_is_late():
    order = StampOrder()
    assert passes(order, None, 10.0)
    assert not passes(order, 9.99, 10.01)
    assert passes(order, 10.01, 10.01)


def test_a_clock_that_was_set_back_is_believed_once_everything_before_is_too_old():
    order = StampOrder()
    assert passes(order, 10.0, 10.0)
    assert not passes(order, 5.0, 10.0 + TIMEOUT + 0.99 * CLOCK_SKEW)
    assert passes(order, 5.0, 10.0 + TIMEOUT + 1.01 * CLOCK_SKEW)


def test_a_simulated_clock_that_starts_again_is_believed_at_once():
    order = StampOrder()
    assert passes(order, 1000.0, 1000.0)
    assert passes(order, 1.0, 1.0)
