"""The lease of the stick: one holder at a time, ended by silence, and never revived."""

import math

import hypothesis.strategies as st
import pytest
from hypothesis import given

from wrist_control.operating.lease import LASTS, OLDEST, Lease, Renewal

NOW = 100.0
JUST = 1e-6
# Page, seconds until it says something, whether the grip is a new one, and how old the beat is.
SAYINGS = st.lists(
    st.tuples(
        st.sampled_from(['a', 'b']),
        st.floats(0.0, 0.4),
        st.booleans(),
        st.floats(0.0, 0.6),
        st.sampled_from(['renew', 'release', 'nothing']),
    ),
    max_size=40,
)


def renewal(holder='page', grip=1, beat=NOW, asked='up'):
    return Renewal(holder, grip, beat, asked)


def taken():
    lease = Lease()
    assert lease.renew(renewal(), NOW) == ''
    return lease


def test_what_is_asked_for_lasts_exactly_as_long_as_it_may():
    assert Lease().held(NOW) is None
    assert taken().held(NOW + LASTS).asked == 'up'
    assert taken().held(NOW + LASTS + JUST) is None


def test_a_silent_page_drives_for_a_quarter_of_a_second_and_a_late_one_for_less():
    """In plain numbers: they are what the documents promise."""
    assert taken().held(NOW + 0.24) is not None
    assert taken().held(NOW + 0.26) is None
    late = Lease()
    assert late.renew(renewal(beat=NOW - 0.3), NOW) == ''
    assert late.held(NOW + 0.14) is not None
    assert late.held(NOW + 0.16) is None
    assert 'too late' in Lease().renew(renewal(beat=NOW - 0.46), NOW)


def test_a_renewal_asks_for_something_else():
    lease = taken()
    assert lease.renew(renewal(beat=NOW + 0.2, asked='down'), NOW + 0.2) == ''
    assert lease.held(NOW + 0.2 + LASTS).asked == 'down'


def test_a_grip_that_was_silent_is_over_whatever_comes_later():
    lease = taken()
    late = NOW + LASTS + JUST
    assert 'has ended' in lease.renew(renewal(beat=late), late)
    assert lease.held(late) is None
    assert lease.renew(renewal(grip=2, beat=late), late) == ''


def test_what_was_under_way_for_long_does_not_count_and_ends_its_grip():
    """A page that was frozen sends, when it goes on, what it would have sent before."""
    lease = Lease()
    assert 'too late' in lease.renew(renewal(beat=NOW - OLDEST - JUST), NOW)
    assert lease.held(NOW) is None
    assert 'has ended' in lease.renew(renewal(), NOW)


@pytest.mark.parametrize('beat', [NOW - OLDEST - JUST, NOW + JUST, math.nan, math.inf, -math.inf])
def test_a_beat_that_is_not_of_just_now_ends_a_grip_that_was_held(beat):
    lease = taken()
    assert 'too late' in lease.renew(renewal(beat=beat), NOW)
    assert lease.held(NOW) is None


def test_another_can_take_it_only_anew_when_it_is_free():
    lease = taken()
    assert 'Somebody else' in lease.renew(renewal('other'), NOW)
    lease.release('other')
    assert lease.held(NOW).holder == 'page'
    lease.release('page')
    assert 'has ended' in lease.renew(renewal('other'), NOW)
    assert lease.renew(renewal('other', grip=2), NOW) == ''
    assert lease.held(NOW).holder == 'other'


def test_a_grip_that_was_let_go_is_over():
    for let_go in (lambda lease: lease.release('page'), lambda lease: lease.release_all()):
        lease = taken()
        let_go(lease)
        assert lease.held(NOW) is None
        assert 'has ended' in lease.renew(renewal(), NOW)


def test_an_older_grip_than_the_one_that_is_held_is_over():
    lease = Lease()
    lease.renew(renewal(grip=5), NOW)
    assert 'has ended' in lease.renew(renewal(grip=4, asked='down'), NOW)
    assert lease.held(NOW).asked == 'up'


def test_who_is_forgotten_begins_anew():
    lease = taken()
    lease.forget('page')
    assert lease.held(NOW) is None
    assert lease.renew(renewal(), NOW) == ''


@given(SAYINGS)
def test_held_is_only_what_its_holder_said_just_now(sayings):
    """Against a second account of the same rules: a list of all that was ever said."""
    lease, now = Lease(), NOW
    grips, dead = {'a': 0, 'b': 0}, set()
    last = None  # (holder, grip, until) of the last renewal that counted
    for holder, pause, anew, age, does in sayings:
        now += pause
        if last is not None and now > last[2]:
            dead.add(last[:2])
            last = None
        if does == 'release' and last is not None and last[0] == holder:
            dead.add(last[:2])
            last = None
        if does == 'release':
            lease.release(holder)
        if does == 'renew':
            grips[holder] += anew or not grips[holder]
            grip = (holder, grips[holder])
            counts = grip not in dead and age <= OLDEST and (last is None or last[0] == holder)
            said = lease.renew(Renewal(*grip, now - age, None), now)
            if math.isclose(age, OLDEST, abs_tol=1e-9):
                return  # on the edge rounding decides
            assert (said == '') == counts
            if counts:
                last = (*grip, min(now + LASTS, now - age + OLDEST))
            else:
                if last is not None and last[0] == holder:
                    last = None
                dead.add(grip)
        held = lease.held(now)
        assert (held and (held.holder, held.grip)) == (last and last[:2])
