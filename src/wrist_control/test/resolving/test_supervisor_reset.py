"""A supervisor on its way home: at the rate limits, and nobody else in charge."""

import math
from itertools import pairwise

import numpy as np
import pytest

from wrist_control import InvalidValueError, UnreachableError, make_wrist
from wrist_control.resolving import start
from wrist_control.resolving.homing import check_way_home
from wrist_control.resolving.period import Mode
from wrist_control.resolving.report import WristState
from wrist_control.resolving.state import ZERO_TWIST

PITCH = (0.0, 0.0, 0.0, 0.0, 0.3, 0.0)
WRIST = make_wrist('three_gimbal')


@pytest.mark.parametrize('rates', [0.5, (0.2, math.inf, 0.7), math.inf])
def test_reset_goes_home_at_the_rate_limits_and_never_jumps(clocked, rates):
    wrist = clocked(WRIST.with_limits(rates=rates))
    allowed = [0.5 if math.isinf(rate) else rate for rate in np.broadcast_to(rates, 3)]
    wrist.ticks(1.5, (0.0, 0.0, 0.0, 0.4, 0.2, -0.4))
    wrist.supervisor.reset()
    path = [wrist.positions]
    while wrist.supervisor.mode is Mode.HOMING:
        outcome = wrist.tick()
        assert outcome.message.startswith('Resetting')
        assert outcome.moving_allowed
        path.append(outcome.step.state.positions)
        moved = np.subtract(path[-1], path[-2])
        np.testing.assert_allclose(outcome.step.joint_rates, moved / wrist.dt, atol=1e-9)
    assert (np.abs(np.diff(path, axis=0)) <= wrist.dt * np.array(allowed) * (1.0 + 1e-8)).all()
    assert len(path) > 50
    assert wrist.positions == wrist.initial


def test_after_a_reset_time_lost_starts_again_from_zero(wrist):
    wrist.ticks(0.5, (0.0, 0.0, 0.0, 2.0, 0.0, 0.0))
    assert wrist.supervisor.state.time_lost > 0.3
    assert 'time lost starts again from zero' in wrist.supervisor.reset()
    wrist.ticks(3.0)
    assert wrist.supervisor.state.time_lost == 0.0
    assert wrist.supervisor.mode is Mode.FOLLOWING


def test_commands_during_a_reset_do_not_count_neither_then_nor_after(wrist):
    wrist.ticks(0.5, PITCH)
    wrist.supervisor.reset()
    while wrist.supervisor.mode is Mode.HOMING:
        wrist.command(PITCH)
        assert wrist.tick().commanded == ZERO_TWIST
    assert wrist.tick().wrist_state == WristState.IDLE
    assert wrist.positions == wrist.initial
    assert wrist.follow(PITCH).wrist_state == WristState.TRACKING


def test_a_reset_at_home_is_done_at_once(wrist):
    wrist.supervisor.reset()
    wrist.tick()
    assert wrist.supervisor.mode is Mode.FOLLOWING


def test_a_reset_needs_somebody_who_may_move(wrist):
    wrist.enable(False)
    with pytest.raises(
        InvalidValueError, match=r'Cannot reset: nobody: disabled .* ~/enable first'
    ):
        wrist.supervisor.reset()
    assert wrist.supervisor.mode is Mode.DISABLED


def test_a_reset_can_be_broken_off_by_disabling(wrist):
    wrist.ticks(0.5, PITCH)
    wrist.supervisor.reset()
    wrist.ticks(0.1)
    wrist.enable(False)
    before = wrist.positions
    ramp = wrist.ticks(0.2)
    rates = [max(map(abs, outcome.step.joint_rates)) for outcome in ramp]
    assert all(one >= other for one, other in pairwise(rates))
    assert max(rates[0], -min(np.diff(rates))) < 0.5
    assert rates[-1] == 0.0
    stopped = wrist.positions
    assert np.abs(np.subtract(stopped, before)).max() < 0.5 * 0.1
    wrist.ticks(0.5)
    assert wrist.positions == stopped != wrist.initial


@pytest.mark.parametrize('resets', [0, 1])
def test_a_reset_of_a_hand_whose_permission_is_running_out_begins_no_motion(wrist, resets):
    """As when the dead-man's switch was released a moment before: half of nothing is nothing."""
    for _ in range(resets):
        wrist.ticks(0.5, PITCH)
        wrist.supervisor.reset()
        wrist.ticks(3.0)
    wrist.ticks(0.5, PITCH)
    wrist.ticks(1.0)
    stopped = wrist.positions
    for period in range(100):
        wrist.count += 1
        if period == 4:
            wrist.supervisor.reset()
        wrist.supervisor.tick(
            stamp_time=wrist.now, receipt_time=wrist.now, withheld='The switch was released.'
        )
    assert wrist.positions == stopped != wrist.initial


def test_a_reset_to_where_new_limits_forbid_to_be_is_refused(wrist):
    wrist.ticks(0.5, (0.0, 0.0, 0.0, -0.4, 0.0, 0.0))
    wrist.supervisor.wrist = wrist.supervisor.wrist.with_limits(upper=(2.0, 2.0, 0.2))
    with pytest.raises(InvalidValueError, match=r'initial_positions has 0\.3 for phi'):
        wrist.supervisor.reset()
    assert wrist.supervisor.mode is Mode.FOLLOWING


@pytest.fixture
def gapped(rail):
    class Gapped(rail):
        gap = (0.4, 0.6)

    return Gapped()


def test_a_reset_that_the_mechanism_cannot_make_is_refused(clocked, gapped):
    wrist = clocked(gapped, (0.0,))
    wrist.rest((1.0,), ('phi',))
    with pytest.raises(InvalidValueError, match=r'Cannot reset: the straight way back crosses'):
        wrist.supervisor.reset()
    assert wrist.supervisor.mode is Mode.FOLLOWING


def test_a_reset_that_cannot_go_on_is_a_fault_and_not_a_crash(clocked, rail, gapped):
    wrist = clocked(rail(), (0.0,))
    wrist.rest((1.0,), ('phi',))
    wrist.supervisor.reset()
    wrist.supervisor.wrist = gapped
    states = [one.wrist_state for one in wrist.ticks(2.0)]
    assert states[-1] == WristState.FAULT
    assert 'cannot go on' in wrist.tick().message
    assert 0.6 <= wrist.positions[0] <= 0.61


def test_a_reset_over_an_edge_is_refused_and_names_it(clocked):
    """Between two places inside the carpal wrist's edges the straight way may lead outside."""
    carpal = make_wrist('carpal')
    ways = np.random.default_rng(4)
    crossing = 0
    for _ in range(400):
        ends = [carpal.home + ways.uniform(-1.2, 1.2, 3) for _ in range(2)]
        try:
            inside = [min(c.remaining for c in carpal.clearances(tuple(end))) for end in ends]
            states = [start(carpal, tuple(end)) for end in ends]
        except (InvalidValueError, UnreachableError):
            continue
        lowest = min(
            min(c.remaining for c in carpal.clearances(tuple(ends[0] + s * (ends[1] - ends[0]))))
            for s in np.linspace(0.0, 1.0, 101)
        )
        if lowest < 0.0 < min(inside):
            crossing += 1
            with pytest.raises(InvalidValueError, match='crosses'):
                check_way_home(carpal, states[0], tuple(ends[1]))
        elif lowest > 0.0:
            check_way_home(carpal, states[0], tuple(ends[1]))
    assert crossing > 0
