"""Which rates joints can have next: against the time that a change of rate takes."""

import math

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

from wrist_control.resolving.rate_windows import (
    Window,
    common_factors,
    nearest_factor,
    rate_windows,
    stopping_time,
)
from wrist_control.testing.eased import longest_change
from wrist_control.wrists import Joint

DT = 0.1
JOINT = Joint('psi', rate_limit=1.0, acceleration_limit=2.0, deceleration_limit=4.0)
rates = st.floats(-1.0, 1.0)
limits = st.floats(0.1, 20.0)


def window(rate, joint=JOINT):
    (found,) = rate_windows([joint], (rate,), DT)
    return found


@pytest.mark.parametrize(
    ('rate', 'low', 'high'),
    [
        (0.0, -0.2, 0.2),
        (0.5, 0.1, 0.7),
        (-0.5, -0.7, -0.1),
        (0.4, 0.0, 0.6),
        (0.2, -0.1, 0.4),  # half of the step slows down, half of it speeds up the other way
        (0.9, 0.5, 1.0),  # not above the rate limit
        (1.6, 1.2, 1.2),  # above a limit that was lowered: down as quickly as it may
    ],
)
def test_a_joint_gains_by_its_acceleration_and_loses_by_its_deceleration(rate, low, high):
    assert window(rate) == pytest.approx((low, high), abs=1e-12)


def test_at_rest_no_rates_are_needed_and_without_limits_only_the_rate_limit_counts():
    assert rate_windows([JOINT], (), DT) == (window(0.0),)
    free = Joint('psi', rate_limit=1.0)
    for rate in (-1.0, 0.0, 0.3):
        assert window(rate, free) == (-1.0, 1.0)
    assert window(0.3, Joint('psi')) == (-math.inf, math.inf)
    assert window(0.3, free._replace(deceleration_limit=4.0)) == pytest.approx((-1.0, 1.0))
    assert window(0.5, free._replace(deceleration_limit=4.0)) == pytest.approx((0.1, 1.0))
    assert window(0.5, free._replace(acceleration_limit=2.0)) == pytest.approx((-0.2, 0.7))


@given(rates, limits, limits, st.floats(-3.0, 3.0))
def test_a_rate_is_inside_exactly_when_a_step_is_time_enough_to_reach_it(old, up, down, new):
    joint = Joint('psi', acceleration_limit=up, deceleration_limit=down)
    low, high = window(old, joint)
    time = longest_change([joint], (old,), (new,))
    if low + 1e-9 < new < high - 1e-9:
        assert time < DT * (1.0 + 1e-9)
    elif not low - 1e-9 < new < high + 1e-9:
        assert time > DT * (1.0 - 1e-9)


def test_the_nearest_rate_is_the_one_asked_for_or_an_end():
    assert [Window(-1.0, 2.0).nearest(rate) for rate in (-3.0, 0.5, 4.0)] == [-1.0, 0.5, 2.0]


def test_joints_that_stop_together_take_the_time_of_the_slowest():
    slow = JOINT._replace(deceleration_limit=0.5)
    assert stopping_time([JOINT, slow], (0.8, -0.3)) == pytest.approx(0.6)
    assert stopping_time([JOINT, slow], (0.0, 0.0)) == 0.0
    assert stopping_time([Joint('psi')], (0.8,)) == 0.0


windows = st.tuples(rates, rates).map(lambda pair: Window(min(pair), max(pair)))
pairs = st.lists(st.tuples(rates, windows), min_size=1, max_size=6)


@given(pairs)
def test_a_factor_is_common_exactly_when_it_brings_every_rate_inside(pairs):
    wanted, ends = zip(*pairs, strict=True)
    smallest, largest = common_factors(wanted, ends)
    for factor in np.linspace(0.0, 3.0, 31):
        inside = all(low - 1e-12 <= factor * rate <= high + 1e-12 for rate, (low, high) in pairs)
        if smallest + 1e-9 < factor < largest - 1e-9:
            assert inside
        elif not smallest - 1e-9 < factor < largest + 1e-9:
            assert not all(low + 1e-9 < factor * rate < high - 1e-9 for rate, (low, high) in pairs)


def test_a_rate_that_must_stay_zero_and_may_not_has_no_factor():
    smallest, largest = common_factors((0.0, 1.0), (Window(0.1, 0.2), Window(0.0, 1.0)))
    assert smallest > largest


@given(pairs)
def test_no_other_factor_comes_nearer_to_the_windows(pairs):
    wanted, ends = zip(*pairs, strict=True)

    def distance(factor):
        return sum(
            (factor * rate - end.nearest(factor * rate)) ** 2
            for rate, end in zip(wanted, ends, strict=True)
        )

    found = nearest_factor(wanted, ends)
    assert found >= 0.0
    others = [distance(factor) for factor in np.linspace(0.0, 5.0, 101)]
    assert distance(found) <= min(others) + 1e-9
