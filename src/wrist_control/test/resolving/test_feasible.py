"""What a step may do: no limit broken, and none on the straight way to rest after it."""

import math

import pytest

from wrist_control import UnreachableError
from wrist_control.resolving import LimitKind, State
from wrist_control.resolving.feasible import edge, overruns_on_the_way_to_rest, within_limits
from wrist_control.wrists import Clearance

DT, DECELERATION = 0.01, 5.0


@pytest.fixture(scope='module')
def fenced(rail):
    """A rail that ends at a fence, and stops as quickly as 5 rad/s²."""

    class Fenced(rail):
        fence = 1.0

    return Fenced().with_limits(decelerations=DECELERATION)


def moved(wrist, position, rate):
    """Return the state at a position and the one a step later."""
    before = State((position,), wrist.forward((position,)))
    after = (position + rate * DT,)
    return before, State(after, wrist.forward(after))


@pytest.mark.parametrize('rate', [0.2, 1.0, 3.0])
def test_a_step_must_leave_half_the_rates_square_by_the_deceleration(fenced, rate):
    needed = rate * DT + rate * rate / (2.0 * DECELERATION)
    enough = moved(fenced, 1.0 - needed - 1e-6, rate)
    assert overruns_on_the_way_to_rest(fenced, *enough, DT) == []
    (limit,) = overruns_on_the_way_to_rest(fenced, *moved(fenced, 1.0 - needed + 1e-6, rate), DT)
    assert (limit.joint, limit.kind) == ('fence', LimitKind.WORKSPACE)
    assert 1.0 - 1e-3 < limit.share < 1.0


@pytest.mark.parametrize('rate', [0.6, 1.0, 3.0])
def test_the_share_that_is_told_leaves_just_the_space_that_it_needs(fenced, rate):
    space = 0.03
    (limit,) = overruns_on_the_way_to_rest(fenced, *moved(fenced, 1.0 - space, rate), DT)
    part = limit.share * rate
    assert part * DT + part * part / (2.0 * DECELERATION) == pytest.approx(space)


def test_joints_that_stop_in_one_step_need_no_space(fenced):
    rate = DECELERATION * DT
    assert overruns_on_the_way_to_rest(fenced, *moved(fenced, 1.0 - rate * DT, rate), DT) == []


def test_joints_that_stop_at_once_need_no_space(rail):
    class Fenced(rail):
        fence = 1.0

    assert overruns_on_the_way_to_rest(Fenced(), *moved(Fenced(), 0.9, 10.0), DT) == []


def test_a_joint_limit_is_kept_on_the_way_to_rest_too(rail):
    wrist = rail().with_limits(upper=0.5, decelerations=DECELERATION)
    (limit,) = overruns_on_the_way_to_rest(wrist, *moved(wrist, 0.4, 2.0), DT)
    assert (limit.joint, limit.kind) == ('phi', LimitKind.POSITION)
    assert limit.asked == pytest.approx(0.4 + 2.0 * DT + 4.0 / (2.0 * DECELERATION))


@pytest.mark.parametrize('width', [0.01, 0.03])
def test_an_edge_that_is_crossed_and_left_again_on_the_way_to_rest_counts(rail, width):
    """The joints would stop beyond a narrow place where they may not be."""

    class Narrow(rail):
        def clearances(self, positions):
            away = positions[0] - 0.5
            return (Clearance('narrow', away * away - width * width),)

    wrist = Narrow().with_limits(decelerations=DECELERATION)
    before, after = moved(wrist, 0.4, 1.5)  # to rest at 0.64
    assert wrist.clearances((0.64,))[0].remaining > 0.0
    (limit,) = overruns_on_the_way_to_rest(wrist, before, after, DT)
    assert limit.joint == 'narrow'


def test_where_the_joints_would_stop_in_a_gap_the_step_is_not_made(rail):
    class Gap(rail):
        gap = (0.5, 0.6)

        def resolve_assembly(self, positions, near):
            self.forward(positions)
            return tuple(positions)

    wrist = Gap().with_limits(decelerations=DECELERATION)
    before, _ = moved(wrist, 0.4, 0.0)
    attempt = within_limits(wrist, before, lambda share: ((0.4 + share * 0.01,), ()), DT)
    made, (limit,) = attempt(1.0)
    assert made is None
    assert limit.kind == LimitKind.WORKSPACE


def test_what_is_made_is_the_target_of_the_share(rail):
    wrist = rail()
    before, _ = moved(wrist, 0.4, 0.0)
    made, broken = within_limits(wrist, before, lambda s: ((0.4 + s * 0.01,), (s,)), DT)(0.5)
    assert broken == []
    assert made.positions == pytest.approx((0.405,))
    assert made.steering_state == (0.5,)
    assert made.pose == wrist.forward(made.positions)


def test_a_target_that_is_no_number_or_out_of_reach_is_an_edge(rail):
    before, _ = moved(rail(), 0.4, 0.0)
    made, (limit,) = within_limits(rail(), before, lambda share: ((math.nan,), ()), DT)(1.0)
    assert made is None
    assert limit.joint == 'no way on'
    assert edge(UnreachableError('Too far.', 'the end')) == (
        'the end',
        LimitKind.WORKSPACE,
        0.0,
        0.0,
        0.0,
    )
