"""The largest share of a step: guessed, or searched for where a guess leads nowhere."""

import math

import pytest
from hypothesis import given
from hypothesis import strategies as st

from wrist_control.resolving.limits import LimitAtWork, LimitKind
from wrist_control.resolving.search import RESOLUTION, largest_share


def limit(share=0.0, joint='psi'):
    return LimitAtWork(joint, LimitKind.POSITION, 1.0, 0.0, share)


def attempts(left):
    """Return a step of which `left` tells what is left of a limit, and the shares it was asked."""
    asked = []

    def attempt(share):
        asked.append(share)
        rest = left(share)
        return (share, []) if rest >= 0.0 else (None, [limit(left(0.0) / (left(0.0) - rest))])

    return attempt, asked


def test_what_fits_is_made_at_once():
    attempt, asked = attempts(lambda share: 1.0)
    assert largest_share(attempt, 0.7) == (0.7, 0.7, [])
    assert asked == [0.7]


def test_a_limit_that_falls_in_proportion_is_met_by_the_first_guess():
    attempt, asked = attempts(lambda share: 0.30000001 - share)
    share, made, (found,) = largest_share(attempt, 1.0)
    assert share == made == pytest.approx(0.3, abs=1e-7)
    assert found.joint == 'psi'
    assert len(asked) == 3  # the last a little more than can be made


@given(st.floats(2e-6, 0.97))
def test_a_limit_that_first_lets_go_is_searched_for(end):
    """Guesses of 0.98, again and again: what is left is a parabola that rises first."""
    attempt, asked = attempts(lambda share: 1.0 + 49.0 * share / end - 50.0 * (share / end) ** 2)
    share, made, _ = largest_share(attempt, 1.0)
    assert made == share
    assert (1.0 - 1.01 * RESOLUTION) * end <= share <= end
    assert len(asked) < 40


@given(st.floats(2e-6, 0.999))
def test_an_edge_of_which_nothing_is_known_is_searched_for(end):
    share, made, (found,) = largest_share(
        lambda share: (share, []) if share <= end else (None, [limit(0.0)]), 1.0
    )
    assert made == share
    assert (1.0 - 1.01 * RESOLUTION) * end <= share <= end
    assert found == limit(0.0)


def test_where_less_than_a_millionth_could_be_made_nothing_is():
    attempt, asked = attempts(lambda share: 0.0 if share == 0.0 else -1.0)
    share, made, found = largest_share(attempt, 0.5)
    assert (share, made, len(found)) == (0.0, None, 1)
    assert min(asked) >= 0.5e-6
    assert len(asked) < 10  # a joint rests on its limit at every step of a command that is held


def test_the_limits_that_chose_the_share_stay_and_each_is_named_once_as_first_asked():
    rate = limit(0.5)._replace(kind=LimitKind.RATE)
    first, second = [limit(0.5), limit(0.6, 'phi')], [limit(0.9), limit(0.9, 'theta')]
    broken = iter((first, second, [], [limit(0.99, 'a little more')]))

    def attempt(share):
        found = next(broken)
        return (None, found) if found else (share, [])

    share, _, found = largest_share(attempt, 0.5, [rate])
    assert share == pytest.approx(0.5 * 0.5 * 0.9)
    assert found == [rate, limit(0.5), limit(0.6, 'phi'), limit(0.9, 'theta')]


def test_a_share_of_nothing_is_not_searched_for():
    share, made, _ = largest_share(lambda share: (None, [limit(math.nan)]), 0.0)
    assert (share, made) == (0.0, None)


def test_after_six_guesses_that_lead_nowhere_a_tenth_is_tried_and_again():
    asked = []

    def attempt(share):
        asked.append(share)
        return (share, []) if share < 0.01 else (None, [limit(0.9)])

    largest_share(attempt, 1.0)
    tried = asked[: next(i for i, share in enumerate(asked) if share < 0.01) + 1]
    guesses = [0.9**number for number in range(7)]
    assert tried == pytest.approx([*guesses, 0.1 * guesses[-1], 0.01 * guesses[-1]])
