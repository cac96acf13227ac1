"""The command is taken away: a ramp that no clock and no command can change, then another mode."""

import itertools

import numpy as np
import pytest

from wrist_control import InvalidValueError
from wrist_control.resolving.period import Mode
from wrist_control.resolving.report import WristState

ROLL = (0.0, 0.0, 0.0, 0.4, 0.0, 0.0)


def speeds(results):
    return [result.step.joint_rates[2] for result in results]


@pytest.fixture
def rolling(wrist):
    wrist.ticks(0.2, ROLL)
    return wrist


@pytest.mark.parametrize(
    ('then', 'state'),
    [
        (Mode.DISABLED, WristState.DISABLED),
        (Mode.FAULT, WristState.FAULT),
        (Mode.FOLLOWING, WristState.IDLE),
    ],
)
def test_the_hand_comes_to_rest_over_the_stop_time_and_is_given_to_who_is_next(
    rolling, then, state
):
    rolling.supervisor.stop('Enough.', then)
    ramp = rolling.ticks(0.1)
    np.testing.assert_allclose(speeds(ramp), 0.4 * np.arange(9, -1, -1) / 10.0, atol=1e-9)
    on_the_way = WristState.STALE if then is Mode.FOLLOWING else state
    assert {result.wrist_state for result in ramp} == {on_the_way}
    assert {result.message for result in ramp} == {'Enough.'}
    assert all(result.moving_allowed for result in ramp)
    assert not any(ramp[-1].step.joint_rates)
    after = rolling.tick()
    assert after.wrist_state is state
    assert not any(after.step.joint_rates)


def test_commands_that_come_on_the_way_do_not_count_even_afterwards(rolling):
    rolling.supervisor.stop('Enough.', Mode.FOLLOWING)
    ramp = rolling.ticks(0.1, [-x for x in ROLL])
    assert all(b < a for a, b in itertools.pairwise(speeds(ramp)))
    assert rolling.tick().wrist_state is WristState.IDLE
    assert rolling.follow(ROLL).wrist_state is WristState.TRACKING


def test_a_clock_that_stands_still_does_not_hold_the_ramp(rolling):
    rolling.supervisor.stop('Enough.', Mode.DISABLED)
    now = rolling.now
    for _ in range(11):
        last = rolling.supervisor.tick(stamp_time=now, receipt_time=now)
    assert last.wrist_state is WristState.DISABLED


def test_a_hand_at_rest_is_let_go_at_once(wrist):
    assert wrist.tick().moving_allowed
    wrist.supervisor.stop('Enough.', Mode.DISABLED)
    assert not wrist.tick().moving_allowed


def test_a_hand_that_has_come_to_rest_does_not_move_again_when_it_is_stopped_again(rolling):
    rolling.supervisor.stop('Enough.', Mode.FOLLOWING)
    rolling.ticks(0.1)
    assert not rolling.supervisor.stopping
    rolling.supervisor.stop('Enough.', Mode.FOLLOWING)
    assert not any(rolling.tick().step.joint_rates)


def test_what_was_followed_before_a_pause_is_not_ramped_down_after_it(rolling):
    rolling.enable(False)
    rolling.ticks(0.2)
    rolling.enable(True)
    rolling.supervisor.stop('Enough.', Mode.DISABLED)
    assert not any(rolling.tick().step.joint_rates)


def test_a_stop_at_rest_drops_the_command_that_has_not_counted_yet(wrist):
    wrist.command(ROLL)
    wrist.supervisor.stop('The clock.', Mode.FOLLOWING)
    assert wrist.tick().wrist_state is WristState.IDLE


def test_a_stop_on_its_way_goes_on_and_ends_where_the_later_one_says(rolling):
    rolling.supervisor.stop('The clock.', Mode.FOLLOWING)
    rolling.ticks(0.05)
    rolling.supervisor.stop('An error.', Mode.FAULT)
    assert speeds([rolling.tick()]) == pytest.approx([0.16])
    rolling.ticks(0.04)
    after = rolling.tick()
    assert after.wrist_state is WristState.FAULT
    assert after.message.startswith('An error. Call ~/enable')


def test_a_lighter_reason_does_not_end_a_fault_that_is_coming(rolling):
    rolling.supervisor.stop('An error.', Mode.FAULT)
    rolling.supervisor.stop('The clock.', Mode.FOLLOWING)
    rolling.ticks(0.1)
    assert rolling.tick().wrist_state is WristState.FAULT


def test_a_disabled_wrist_can_still_have_a_fault_but_not_begin_to_follow(wrist):
    wrist.enable(False)
    wrist.supervisor.stop('The clock.', Mode.FOLLOWING)
    assert wrist.tick().wrist_state is WristState.DISABLED
    wrist.supervisor.stop('An error.', Mode.FAULT)
    assert wrist.tick().wrist_state is WristState.FAULT


def test_nobody_can_enable_or_reset_a_hand_that_is_coming_to_a_stop(rolling):
    rolling.supervisor.stop('Enough.', Mode.FAULT)
    with pytest.raises(InvalidValueError, match='coming to a stop'):
        rolling.enable(True)
    with pytest.raises(InvalidValueError, match='coming to a stop'):
        rolling.supervisor.reset()
    rolling.ticks(0.12)
    rolling.enable(True)
    assert rolling.follow(ROLL).wrist_state is WristState.TRACKING


def test_disabling_does_not_hide_a_fault_that_is_coming(rolling):
    rolling.supervisor.stop('Enough.', Mode.FAULT)
    rolling.enable(False)
    assert rolling.ticks(0.2)[-1].wrist_state is WristState.FAULT


def test_a_reset_is_ramped_down_on_its_way(rolling):
    rolling.ticks(1.0, ROLL)
    rolling.supervisor.reset()
    full = rolling.ticks(0.05)[-1].step.joint_rates[2]
    assert full == pytest.approx(-0.5)
    rolling.supervisor.stop('Enough.', Mode.DISABLED)
    ramp = rolling.ticks(0.1)
    np.testing.assert_allclose(speeds(ramp), full * np.arange(9, -1, -1) / 10.0, atol=1e-9)
    assert rolling.tick().wrist_state is WristState.DISABLED
