"""Limits: what overruns them, and how much of a step keeps all of them."""

import math

import pytest
from hypothesis import given
from hypothesis import strategies as st

from wrist_control.resolving.limits import (
    LimitKind,
    clearance_overruns,
    joint_overruns,
    overruns,
    rate_overruns,
    smallest_share,
)
from wrist_control.wrists import Clearance, Joint, make_wrist

# What counts as kept: round-off, not motion. Relative for rates, rad or m for positions.
KEPT = 1e-9
numbers = st.floats(-10.0, 10.0)
driven = st.lists(
    st.tuples(numbers, st.floats(0.01, 10.0), numbers), min_size=1, max_size=6
)  # old position or rate, rate limit, new position


def bounded(lower=-1.0, upper=1.0, rate=math.inf):
    return (Joint('theta', lower=lower, upper=upper, rate_limit=rate),)


@given(driven)
def test_one_factor_brings_every_rate_inside_its_own_limit(joints):
    rates = tuple(5.0 * rate for rate, _, _ in joints)
    limited = [Joint(f'j{i}', rate_limit=limit) for i, (_, limit, _) in enumerate(joints)]
    factor = smallest_share(rate_overruns(limited, rates))
    assert 0.0 < factor <= 1.0
    loads = [
        factor * abs(rate) / joint.rate_limit for joint, rate in zip(limited, rates, strict=True)
    ]
    assert max(loads) <= 1.0 + 2.0 * KEPT
    if factor < 1.0:
        assert max(loads) == pytest.approx(1.0)


def test_the_rate_that_most_exceeds_its_limit_is_the_wrong_one_to_scale_by():
    slow, fast = Joint('slow', rate_limit=0.1), Joint('fast', rate_limit=1.0)
    rates = (0.3, 1.5)  # over by 0.2 and by 0.5, but three times and one and a half times
    barker = fast.rate_limit / rates[1]  # [Barker1986], fig. 3(a)
    assert barker * rates[0] > slow.rate_limit
    factor = smallest_share(rate_overruns((slow, fast), rates))
    assert factor * rates[0] == pytest.approx(slow.rate_limit)
    assert factor * rates[1] < fast.rate_limit


def test_a_rate_over_its_limit_is_reported_with_its_sign():
    (found,) = rate_overruns((Joint('psi', rate_limit=0.5), Joint('phi')), (-2.0, 1e9))
    assert found == ('psi', LimitKind.RATE, -2.0, -0.5, 0.25)
    assert rate_overruns((Joint('psi', rate_limit=0.5),), (0.5,)) == []


@given(driven, st.floats(1e-3, 0.1))
def test_the_smallest_share_of_a_motion_keeps_every_rate_and_position_limit(joints, dt):
    limited = [
        Joint(f'j{i}', lower=min(old, 0.0) - 0.5, upper=max(old, 0.0) + 0.5, rate_limit=limit)
        for i, (old, limit, _) in enumerate(joints)
    ]
    before = tuple(old for old, _, _ in joints)
    after = tuple(new for _, _, new in joints)
    share = smallest_share(joint_overruns(limited, before, after, dt))
    for joint, old, new in zip(limited, before, after, strict=True):
        made = old + share * (new - old)
        assert abs(made - old) <= joint.rate_limit * dt * (1.0 + 2.0 * KEPT)
        assert joint.lower - 2.0 * KEPT <= made <= joint.upper + 2.0 * KEPT


@pytest.mark.parametrize('side', [1.0, -1.0])
def test_a_joint_that_would_leave_its_range_may_go_up_to_its_limit(side):
    (found,) = joint_overruns(bounded(), (0.5 * side,), (2.5 * side,), 0.1)
    assert found == ('theta', LimitKind.POSITION, 2.5 * side, side, 0.25)


@pytest.mark.parametrize('side', [1.0, -1.0])
@pytest.mark.parametrize('beyond', [0.0, 1e-10, 0.3])
def test_a_joint_at_or_outside_its_limit_goes_no_further_but_back_freely(side, beyond):
    old = side * (1.0 + beyond)
    (found,) = joint_overruns(bounded(), (old,), (old + 0.1 * side,), 0.1)
    assert (found.kind, found.share) == (LimitKind.POSITION, 0.0)
    assert joint_overruns(bounded(), (old,), (old - 0.1 * side,), 0.1) == []
    assert joint_overruns(bounded(), (old,), (old,), 0.1) == []


def test_a_joint_outside_one_limit_cannot_run_through_the_other():
    (found,) = joint_overruns(bounded(), (1.5,), (-3.5,), 0.1)
    assert found.allowed == -1.0
    assert found.share == pytest.approx(0.5)


def test_many_steps_cannot_creep_past_a_limit():
    position = 1.0
    for _ in range(1000):
        ahead = position + 0.5 * KEPT
        if joint_overruns(bounded(), (position,), (ahead,), 0.1):
            ahead = position
        position = ahead
    assert position <= 1.0 + 1.01 * KEPT


def test_one_joint_can_overrun_its_rate_and_its_range_at_once():
    found = joint_overruns(bounded(rate=1.0), (0.5,), (2.5,), 0.1)
    assert [limit.kind for limit in found] == [LimitKind.RATE, LimitKind.POSITION]
    assert found[0].asked == pytest.approx(20.0)
    assert smallest_share(found) == found[0].share == pytest.approx(0.05)


def test_no_limit_at_work_is_a_share_of_one():
    assert smallest_share([]) == 1.0
    assert joint_overruns((Joint('psi'),), (0.0,), (1e9,), 0.1) == []


def clearance(remaining, horizon=0.0):
    return (Clearance('reach', remaining, horizon),)


def test_a_clearance_may_be_used_up_and_not_overdrawn():
    assert clearance_overruns(clearance(0.2), clearance(0.0), 0.1) == []
    (found,) = clearance_overruns(clearance(0.2), clearance(-0.2), 0.1)
    assert found == ('reach', LimitKind.WORKSPACE, -0.2, 0.0, 0.5)


def test_a_clearance_with_a_horizon_shrinks_ever_slower():
    assert clearance_overruns(clearance(0.2, 1.0), clearance(0.18, 1.0), 0.1) == []
    (found,) = clearance_overruns(clearance(0.2, 1.0), clearance(0.1, 1.0), 0.1)
    assert found.allowed == pytest.approx(0.18)
    assert found.share == pytest.approx(0.2)


@pytest.mark.parametrize('horizon', [0.0, 1.0])
def test_outside_a_clearance_only_the_way_back_is_open(horizon):
    outside = clearance(-0.1, horizon)
    (found,) = clearance_overruns(outside, clearance(-0.2, horizon), 0.1)
    assert found.share == 0.0
    assert clearance_overruns(outside, clearance(-0.05, horizon), 0.1) == []
    assert clearance_overruns(outside, outside, 0.1) == []


def test_limits_of_the_joints_and_of_the_whole_wrist_are_found_together(rail):
    class Fenced(rail):
        default_joints = bounded()
        fence = 0.5

    found = overruns(Fenced(), (0.0,), (2.0,), 0.1)
    assert [(limit.joint, limit.share) for limit in found] == [('theta', 0.5), ('fence', 0.25)]
    assert smallest_share(found) == 0.25
    assert overruns(make_wrist('three_gimbal'), (0.0,) * 3, (2.0,) * 3, 0.1) == []
