"""Two legs that contradict each other: to within rounding, and no further."""

import math
from itertools import combinations

import pytest

from wrist_control import InvalidValueError, make_wrist
from wrist_control.stewart.measurement import check_possible

from .platforms import said

WRIST = make_wrist('stewart')
SHORT = 0.4  # m


def apart(legs):
    """Return how far the anchors of two legs are apart, on the platform and on the base, m."""
    i, j = legs
    return math.dist(WRIST.platform[i], WRIST.platform[j]) + math.dist(
        WRIST.base[i], WRIST.base[j]
    )


NEIGHBOURS = min(combinations(range(6), 2), key=apart)


def lengths_at_the_edge(beyond):
    """Return lengths of which one is as much longer than another as their anchors allow."""
    lengths = [SHORT + 0.5 * apart(NEIGHBOURS)] * 6
    lengths[NEIGHBOURS[0]] = SHORT
    lengths[NEIGHBOURS[1]] = SHORT + apart(NEIGHBOURS) * (1.0 + beyond)
    return lengths


@pytest.mark.parametrize('beyond', [1e-6, 1e-4, 0.1])
def test_a_leg_that_is_too_long_for_another_is_named_with_it(beyond):
    one, other = (leg + 1 for leg in NEIGHBOURS)
    lengths = lengths_at_the_edge(beyond)
    with pytest.raises(
        InvalidValueError, match=f'leg_{one} at 0.4 m and leg_{other} at .* fit no'
    ):
        check_possible(WRIST.platform, WRIST.base, lengths, said(lengths))


@pytest.mark.parametrize('beyond', [1e-12, 0.0, -1e-6])
def test_legs_that_just_fit_may_be_rounded(beyond):
    lengths = lengths_at_the_edge(beyond)
    check_possible(WRIST.platform, WRIST.base, lengths, said(lengths))
