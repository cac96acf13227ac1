"""A supervisor that finds something wrong: nothing moves, and it says why."""

import math
import re

import pytest

from wrist_control import InvalidValueError, UnreachableError, make_wrist
from wrist_control.resolving.period import Mode
from wrist_control.resolving.report import WristState

PITCH = (0.0, 0.0, 0.0, 0.0, 0.3, 0.0)
LAG = 0.1  # rad, that a joint may be behind its command
LAG_TIME = 0.25  # s, and for this long


def test_a_joint_that_lags_too_long_is_a_ramp_and_a_fault(wrist):
    psi, theta, phi = wrist.initial
    wrist.follow(PITCH)
    wrist.measure((psi, theta + LAG + 0.1, phi))
    while wrist.now <= wrist.dt + LAG_TIME:
        outcome = wrist.tick()
        wrist.measure((psi, theta + LAG + 0.1, phi))
        assert outcome.wrist_state != WristState.FAULT
    outcome = wrist.tick()
    assert (outcome.wrist_state, outcome.moving_allowed) == (WristState.FAULT, True)
    outcome = wrist.ticks(0.2)[-1]
    assert (outcome.wrist_state, outcome.moving_allowed) == (WristState.FAULT, False)
    assert re.match(
        r'theta is at 0\.400 but was told 0\.2\d\d: it does not follow\. ', outcome.message
    )
    assert '~/enable' in outcome.message


def test_a_lag_that_is_caught_up_in_time_is_no_fault(wrist):
    wrist.follow(PITCH)
    far = (wrist.initial[0] + LAG + 0.1, *wrist.initial[1:])
    for seen in (far, wrist.initial, far, wrist.initial, far):
        wrist.measure(seen)
        wrist.ticks(0.4)
    assert wrist.supervisor.mode is Mode.FOLLOWING


def test_a_small_lag_is_no_fault(wrist):
    wrist.follow(PITCH)
    for _ in range(200):
        wrist.measure((wrist.initial[0] + 0.9 * LAG, *wrist.initial[1:]))
        outcome = wrist.tick()
    assert outcome.wrist_state == WristState.STALE


def test_a_fault_is_cleared_by_enabling_from_the_measured_pose(wrist):
    wrist.follow(PITCH)
    there = (wrist.initial[0] + 1.0, *wrist.initial[1:])
    for _ in range(60):
        wrist.measure(there)
        outcome = wrist.tick()
    assert outcome.wrist_state == WristState.FAULT
    with pytest.raises(InvalidValueError, match='nobody: a fault is in charge'):
        wrist.supervisor.reset()
    assert wrist.ticks(0.1, PITCH)[-1].wrist_state == WristState.FAULT
    wrist.enable(True)
    assert wrist.positions == there
    assert wrist.tick().wrist_state == WristState.IDLE
    wrist.measure(there)
    assert wrist.ticks(0.6, PITCH)[-1].wrist_state == WristState.TRACKING


def test_a_lag_during_a_reset_is_a_fault_too(wrist):
    wrist.ticks(2.0, (0.0, 0.0, 0.0, 0.4, 0.0, 0.0))
    stuck = wrist.positions
    wrist.supervisor.reset()
    for _ in range(200):
        outcome = wrist.tick()
        wrist.measure(stuck)
    assert outcome.wrist_state == WristState.FAULT
    assert 'phi is at' in outcome.message


def test_joints_that_lead_nowhere_stay_and_say_so(clocked, nowhere):
    wrist = clocked(nowhere, (0.0,))
    outcome = wrist.follow((0.0, 0.0, 0.0, 0.1, 0.0, 0.0))
    assert outcome.wrist_state == WristState.LIMITED
    assert 'no way on' in outcome.message
    assert wrist.positions == (0.0,)


def test_a_wrist_that_cannot_say_where_it_is_is_a_fault(clocked, rail):
    class Lost(rail):
        def rates(self, positions, twist):
            if positions[0] > 0.0:
                raise UnreachableError('The rail is lost.', 'lost')
            return twist[:1]

    wrist = clocked(Lost(), (0.0,))
    wrist.follow((0.0, 0.0, 0.0, 0.1, 0.0, 0.0))
    there = wrist.positions
    outcome = wrist.tick()
    assert (outcome.wrist_state, outcome.moving_allowed) == (WristState.FAULT, False)
    assert outcome.message.startswith('The rail is lost. Call ~/enable')
    assert wrist.positions == there


def test_a_command_that_slipped_through_unfit_is_a_fault_and_moves_nothing(wrist):
    wrist.command((0.0, 0.0, 0.0, math.nan, 0.0, 0.0))
    assert wrist.tick().wrist_state == WristState.FAULT
    assert wrist.positions == wrist.initial


def test_a_step_whose_arithmetic_fails_is_a_fault_and_not_a_crash(clocked, rail):
    class Dividing(rail):
        def rates(self, positions, twist):
            return (twist[0] / positions[0],)

    wrist = clocked(Dividing(), (0.0,))
    outcome = wrist.follow((0.0, 0.0, 0.0, 0.1, 0.0, 0.0))
    assert (outcome.wrist_state, outcome.moving_allowed) == (WristState.FAULT, False)
    assert re.match(r'The step could not be computed \(.*\); nothing moves\. ', outcome.message)
    assert wrist.positions == (0.0,)
    wrist.rest((0.5,), ('phi',))
    wrist.enable(True)
    outcome = wrist.follow((0.0, 0.0, 0.0, 0.1, 0.0, 0.0))
    assert outcome.wrist_state == WristState.TRACKING


@pytest.mark.parametrize('twist', [PITCH, (0.0, 0.0, 0.0, 0.0, 0.0, 0.3)])
def test_a_joint_too_near_zero_to_divide_by_it_is_no_fault(clocked, twist):
    limited = make_wrist('four_gimbal').with_limits(rates=0.5, lower=-1.0, upper=1.0)
    wrist = clocked(limited, (0.0, 5e-324, 0.0, 0.0))
    outcomes = wrist.ticks(0.1, twist)
    assert {outcome.wrist_state for outcome in outcomes} == {WristState.TRACKING}
