"""The newest message stamped before now counts, whoever was faster."""

from hypothesis import given
from hypothesis import strategies as st

from wrist_control.resolving.latest_message import LatestMessage


def test_before_the_first_message_nothing_counts():
    assert LatestMessage().at(1e9) is None


def test_a_message_counts_from_the_first_step_after_its_stamp_and_stays():
    newest = LatestMessage()
    newest.put(1.0, 'a')
    assert [newest.at(now) for now in (0.9, 1.0, 1.1, 5.0)] == [None, None, 'a', 'a']


def test_a_message_without_a_stamp_counts_at_once():
    newest = LatestMessage()
    newest.put(None, 'a')
    assert newest.at(0.0) == 'a'


def test_a_message_that_waits_is_heard_when_the_next_one_comes():
    newest = LatestMessage()
    newest.put(1.0, 'a')
    newest.put(2.0, 'b')
    assert [newest.at(now) for now in (0.5, 1.5, 2.5)] == ['a', 'a', 'b']


def test_a_sender_whose_clock_is_ahead_is_one_message_late_and_never_unheard():
    newest = LatestMessage()
    heard = []
    for now in range(5):
        newest.put(now + 100.0, now)
        heard.append(newest.at(now))
    assert heard == [None, 0, 1, 2, 3]


@given(st.lists(st.booleans(), min_size=2, max_size=30))
def test_the_order_of_sender_and_listener_within_a_tick_does_not_matter(sender_first):
    newest, heard = LatestMessage(), []
    for now, first in enumerate(sender_first):
        if first:
            newest.put(now, now)
        heard.append(newest.at(now))
        if not first:
            newest.put(now, now)
    assert heard == [None, *range(len(heard) - 1)]


def test_a_cleared_message_never_counts_whether_it_waited_or_not():
    newest = LatestMessage()
    newest.put(1.0, 'a')
    newest.clear()
    assert newest.at(2.0) is None
    newest.put(3.0, 'b')
    assert newest.at(4.0) == 'b'
    newest.clear()
    assert newest.at(5.0) is None
