"""The dead-man's switch, and the ramp when motion is not allowed any more."""

import pytest
from hypothesis import given
from hypothesis import strategies as st

from wrist_control.resolving.permission import Deadman, Permission

TIMEOUT = 0.25


def heard(*messages, publishers=1):
    deadman = Deadman()
    for when, held in messages:
        deadman.take(held, when, publishers)
    return deadman


def test_nothing_moves_before_the_switch_was_heard():
    assert Deadman().withheld(0.0, TIMEOUT).startswith('Held: nothing was heard on deadman yet')


@given(st.lists(st.tuples(st.floats(0.0, 10.0), st.booleans()), min_size=1), st.floats(0.0, 11.0))
def test_the_hand_may_move_only_while_a_press_is_fresh(messages, later):
    messages.sort(key=lambda one: one[0])
    when, held = messages[-1]
    now = when + later
    withheld = heard(*messages).withheld(now, TIMEOUT)
    assert (withheld == '') == (held and now - when <= TIMEOUT)
    assert withheld == '' or withheld.endswith('.')


def test_the_sentence_says_whether_it_was_released_or_fell_silent():
    assert 'is released; press it' in heard((0.0, True), (0.1, False)).withheld(0.1, TIMEOUT)
    assert 'silent for more than 0.25 s' in heard((0.0, True)).withheld(0.3, TIMEOUT)


def test_of_several_switches_each_can_stop():
    two = heard((0.0, True), (0.1, False), (0.11, True), publishers=2)
    assert 'released' in two.withheld(0.12, TIMEOUT)
    two.take(True, 0.36, 2)
    assert two.withheld(0.36, TIMEOUT) == ''
    assert heard((0.0, True), (0.1, False), (0.11, True)).withheld(0.12, TIMEOUT) == ''


def test_what_was_never_allowed_is_not_ramped_down():
    assert Permission().share(True, 5.0, 0.1) == 0.0


def test_what_is_withheld_is_ramped_to_a_stop_from_then_on():
    permission = Permission()
    assert permission.share(False, 4.0, 0.1) == 1.0
    found = [permission.share(True, 5.0 + age, 0.1) for age in (0.0, 0.025, 0.1, 9.0)]
    assert found == pytest.approx([1.0, 0.75, 0.0, 0.0], abs=1e-9)
    assert permission.share(False, 20.0, 0.1) == 1.0
    assert permission.share(True, 21.0, 0.1) == 1.0


def test_a_clock_that_goes_back_allows_no_more_than_everything():
    permission = Permission()
    permission.share(False, 99.0, 0.1)
    permission.share(True, 99.0, 0.1)
    assert permission.share(True, 1.0, 0.1) == 1.0
