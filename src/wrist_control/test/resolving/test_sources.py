"""One source leads the hand, and nothing of another is ever mixed into its motion."""

import itertools

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

from wrist_control.errors import RefusedError
from wrist_control.resolving.sources import NEAR, NOTICED, PROVED, Origin, Sources

TIMEOUT = 0.25
PERIOD = 0.02


def reason(sources, now, number, publishers=1, topic='cmd_vel', sent=None):
    """Return why a message is refused, empty when it is let through."""
    sent = round(1e9 * now) if sent is None else sent
    try:
        sources.admit(Origin(topic, number, sent, publishers), now, TIMEOUT)
    except RefusedError as error:
        return error.reason
    return ''


def led(sources=None, last=100, publishers=1):
    """Return sources whose leader has just sent its number `last` at time 0."""
    sources = sources or Sources()
    for step in range(PROVED):
        now = (step + 1 - PROVED) * PERIOD
        reason(sources, now, last + step + 1 - PROVED, publishers)
    return sources


def test_who_is_alone_counts_from_its_first_message_whatever_is_lost():
    sources = Sources()
    for index, number in enumerate((7, 8, 60, 3000)):
        assert reason(sources, PERIOD * index, number) == ''
    assert not sources.refused(PERIOD)


@given(st.integers(1, 10**6), st.integers(1, 10**6))
def test_of_two_topics_the_first_leads_until_it_is_silent(one, other):
    sources = led(last=one)
    assert reason(sources, 0.01, other, topic='cmd_vel_unstamped') == 'another source leads'
    assert sources.refused(0.02) == ['cmd_vel_unstamped']
    assert reason(sources, TIMEOUT, other + 1, topic='cmd_vel_unstamped') != ''
    assert reason(sources, TIMEOUT + 0.01, other + 2, topic='cmd_vel_unstamped') == ''
    assert sources.leading == 'cmd_vel_unstamped'
    assert reason(sources, TIMEOUT + 0.02, one + 1) == 'another source leads'


def test_a_refused_source_is_named_for_a_while():
    sources = led()
    reason(sources, 0.0, 1, topic='cmd_vel_unstamped')
    assert sources.refused(NOTICED) == ['cmd_vel_unstamped']
    assert sources.refused(NOTICED + 0.01) == []


def test_numbers_far_from_the_leaders_are_anothers():
    sources = led(last=5000, publishers=2)
    for number in (1, 5000 - NEAR - 1, 5000 + NEAR + 1, 90000):
        assert reason(sources, 0.01, number, publishers=2) == 'another source leads'
    assert reason(sources, 0.02, 5001, publishers=2) == ''
    assert not sources.mixed(0.02)


@pytest.mark.parametrize('step', [0, -1, -NEAR])
def test_a_number_that_does_not_go_up_shows_two_sources_and_nobody_leads(step):
    sources = led(last=5000, publishers=2)
    assert reason(sources, 0.01, 5000 + step, publishers=2) == 'sources not told apart'
    assert sources.mixed(0.01)
    assert reason(sources, 0.02, 5001, publishers=2) == 'sources not told apart'
    assert reason(sources, 0.03, 1, topic='cmd_vel_unstamped') != ''


def test_a_number_that_was_sent_before_the_last_shows_two_sources():
    sources = led(publishers=2)
    assert reason(sources, 0.01, 101, 2, sent=-1) == 'sources not told apart'


def test_a_gap_beside_another_publisher_is_not_followed_and_the_next_number_is():
    sources = led(last=100, publishers=2)
    assert reason(sources, 0.02, 103, publishers=2) == 'not certain whose'
    assert reason(sources, 0.04, 104, publishers=2) == ''


def test_beside_another_publisher_a_new_source_is_proved_by_numbers_in_a_row():
    sources = Sources()
    found = [reason(sources, PERIOD * n, n, publishers=2) for n in range(1, 5)]
    assert found == ['not certain whose'] * (PROVED - 1) + [''] * (5 - PROVED)


def test_when_one_of_the_two_falls_silent_the_other_leads_again():
    sources = led(last=100, publishers=2)
    assert reason(sources, 0.0, 100, publishers=2) == 'sources not told apart'
    found = [reason(sources, PERIOD * n, 100 + n, publishers=2) for n in range(1, 80)]
    count = found.index('')
    assert PERIOD * count == pytest.approx(NOTICED, abs=PERIOD)
    assert set(found[:count]) == {'sources not told apart'}
    assert set(found[count:]) == {''}


def test_an_operator_that_starts_again_leads_after_the_silence():
    sources = led(last=5000)
    assert reason(sources, 0.1, 1) == 'another source leads'
    assert reason(sources, TIMEOUT + 0.01, 12) == ''


def test_one_that_was_killed_and_starts_again_leads_although_its_ghost_is_still_listed():
    """A killed process stays in the graph for a while, and its numbers may have been near."""
    sources = led(last=30)
    found = [reason(sources, PERIOD * n, n, publishers=2) for n in range(1, 140)]
    assert set(found[100:]) == {''}


def test_without_numbers_one_publisher_counts_and_two_do_not():
    sources = Sources()
    assert [reason(sources, PERIOD * n, None) for n in range(3)] == ['', '', '']
    assert reason(sources, 0.06, None, publishers=2) == 'sources not told apart'


def test_a_simulated_clock_that_starts_again_locks_nobody_out():
    sources = Sources()
    assert reason(sources, 1000.0, 5) == ''
    assert reason(sources, 0.0, 1, topic='cmd_vel_unstamped') == ''


def quick_turns(chance):
    """Return how often two that send for four seconds, a third of it lost, take quick turns."""
    sent = sorted(
        (phase + index * period, name, first + index)
        for name in ('one', 'other')
        for period in (float(chance.uniform(0.01, 0.1)),)
        for phase in (float(chance.uniform(0.0, 0.1)),)
        for first in (int(chance.integers(1, 200)),)
        for index in range(round(4.0 / period))
        if chance.random() > 0.3
    )
    sources = Sources()
    followed = [
        (now, name)
        for now, name, number in sent
        if reason(sources, now, number, publishers=2) == ''
    ]
    return sum(
        before != after and later - now <= TIMEOUT
        for (now, before), (later, after) in itertools.pairwise(followed)
    )


def test_two_that_send_at_once_hardly_ever_take_turns_and_never_go_on_with_it():
    """A message of another may pass as the leader's next, where it has just that number.

    The leader's own next one shows it, and stops the hand for a second.
    """
    chance = np.random.default_rng(1)
    turns = [quick_turns(chance) for _ in range(400)]
    assert sum(count > 0 for count in turns) < 0.05 * len(turns)
    assert max(turns) <= 3


@given(st.lists(st.floats(0.0, 1.0), min_size=200, max_size=200), st.integers(1, 2))
def test_with_a_third_of_the_messages_lost_the_one_that_sends_is_followed(chances, publishers):
    sources = Sources()
    came = [n for n, chance in enumerate(chances, 1) if chance > 0.3]
    found = [reason(sources, PERIOD * n, n, publishers) for n in came]
    if publishers == 1:
        assert set(found) <= {''}
    else:
        assert set(found) <= {'', 'not certain whose'}
    assert not sources.mixed(PERIOD * 200)


def test_many_gaps_beside_an_idle_publisher_still_leave_every_number_in_a_row():
    sources, number = led(last=100, publishers=2), 100
    for index in range(20):
        now = 2 * PERIOD * index
        number += 2
        assert reason(sources, now + PERIOD, number, publishers=2) == 'not certain whose'
        number += 3
        assert reason(sources, now + 1.5 * PERIOD, number, publishers=2) == 'not certain whose'
        number += 1
        assert reason(sources, now + 2 * PERIOD, number, publishers=2) == ''
