"""Sentences that can be read, and an axis that does not flip."""

import pytest
from hypothesis import given
from hypothesis import strategies as st

from wrist_control.resolving.announcer import HELD, Announcer, SteadyAxis
from wrist_control.resolving.report import WristState

TRACKING, SCALED, STALE = WristState.TRACKING, WristState.SCALED, WristState.STALE


def test_a_sentence_stays_until_it_could_be_read():
    announcer = Announcer()
    said = [announcer.say(SCALED, f'{n}', 10.0 + 0.01 * n) for n in range(120)]
    assert said == ['0'] * 50 + ['50'] * 50 + ['100'] * 20


def test_another_state_is_told_at_once():
    announcer = Announcer()
    assert announcer.say(SCALED, 'a', 0.0) == 'a'
    assert announcer.say(TRACKING, 'b', 0.01) == 'b'
    assert announcer.say(TRACKING, 'c', 0.49) == 'b'
    assert announcer.say(TRACKING, 'c', 0.01 + HELD) == 'c'


@pytest.mark.parametrize('state', [WristState.FAULT, WristState.DISABLED, STALE])
def test_what_stops_the_hand_is_told_at_once(state):
    announcer = Announcer()
    assert [announcer.say(state, text, 0.0) for text in 'abc'] == ['a', 'b', 'c']


def test_a_sentence_that_is_the_same_again_may_be_followed_by_another_soon():
    announcer = Announcer()
    for n in range(100):
        announcer.say(TRACKING, 'a', 0.01 * n)
    assert announcer.say(TRACKING, 'b', 1.0) == 'b'


def test_a_clock_that_goes_back_holds_nothing_for_ever():
    announcer = Announcer()
    announcer.say(TRACKING, 'a', 1000.0)
    assert announcer.say(TRACKING, 'b', 0.0) == 'b'


axes = st.tuples(*(st.floats(-1.0, 1.0),) * 3)


@given(st.lists(axes, min_size=2))
def test_the_sign_of_an_axis_never_flips_from_step_to_step(found):
    steady = SteadyAxis()
    last = None
    for axis in found:
        turned = steady.turned(axis)
        assert turned in (axis, tuple(-a for a in axis))
        if last is not None:
            assert sum(a * b for a, b in zip(last, turned, strict=True)) >= 0.0
        last = turned if any(turned) else last
