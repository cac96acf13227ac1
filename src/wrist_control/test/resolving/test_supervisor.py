"""A supervisor that follows: which command counts, in whose axes, and until when."""

import math

import numpy as np
import pytest

from wrist_control import InvalidValueError, make_wrist
from wrist_control.resolving.commands import Command
from wrist_control.resolving.report import WristState
from wrist_control.resolving.state import ZERO_TWIST
from wrist_control.rotations import to_hand

PITCH = (0.0, 0.0, 0.0, 0.0, 0.3, 0.0)


# Following


def test_it_starts_at_rest_at_the_initial_positions(wrist):
    outcome = wrist.tick()
    assert wrist.positions == wrist.initial
    assert (outcome.wrist_state, outcome.commanded) == (WristState.IDLE, ZERO_TWIST)
    assert outcome.moving_allowed


def test_a_start_that_cannot_be_used_is_refused(clocked):
    with pytest.raises(InvalidValueError, match='initial_positions'):
        clocked(initial=(0.0, 2.5, 0.0))


def test_a_command_is_followed_and_held_between_commands(wrist):
    wrist.command(PITCH)
    outcomes = wrist.ticks(0.2)
    assert {outcome.wrist_state for outcome in outcomes} == {WristState.TRACKING}
    assert {outcome.commanded for outcome in outcomes} == {PITCH}
    np.testing.assert_allclose([one.step.achieved for one in outcomes], [PITCH] * 20, atol=1e-12)


def test_the_newest_command_counts(wrist):
    wrist.command(PITCH)
    wrist.command((0.0, 0.0, 0.0, 0.2, 0.0, 0.0))
    assert wrist.tick().commanded[3] == 0.2


def test_a_stamped_command_counts_from_the_first_step_after_its_stamp(wrist):
    wrist.supervisor.take_command(Command(PITCH, False, 1.5 * wrist.dt, 0.0))
    assert [one.commanded for one in wrist.ticks(2 * wrist.dt)] == [ZERO_TWIST, PITCH]


def test_a_scaled_command_says_so_and_loses_time(wrist):
    outcome = wrist.ticks(0.1, (0.0, 0.0, 0.0, 1.0, 0.0, 0.0))[-1]
    assert outcome.wrist_state == WristState.SCALED
    assert outcome.step.scale_factor == pytest.approx(0.5)
    assert wrist.supervisor.state.time_lost == pytest.approx(0.05)


def test_a_command_in_forearm_axes_turns_the_hand_about_the_forearms_axes(wrist):
    start = wrist.supervisor.state.pose
    for _ in range(50):
        wrist.command((0.0, 0.0, 0.0, 0.0, 0.0, 0.3), in_forearm=True)
        asked = to_hand(wrist.supervisor.state.pose.quaternion, (0.0, 0.0, 0.3))
        assert wrist.tick().commanded == pytest.approx((0.0, 0.0, 0.0, *asked))
    turn = math.cos(0.15), math.sin(0.15)
    about_z = [[turn[0], turn[1], 0.0], [-turn[1], turn[0], 0.0], [0.0, 0.0, 1.0]]
    expected = start.rotation @ about_z  # the forearm's z is the outermost gimbal
    np.testing.assert_allclose(wrist.supervisor.state.pose.rotation, expected, atol=1e-12)
    assert wrist.positions == pytest.approx((wrist.initial[0] + 0.15, *wrist.initial[1:]))


def test_a_command_in_hand_axes_turns_the_hand_about_its_own(wrist):
    wrist.ticks(0.5, (0.0, 0.0, 0.0, 0.3, 0.0, 0.0))
    assert wrist.positions == pytest.approx((*wrist.initial[:2], wrist.initial[2] + 0.15))


def test_linear_rates_do_not_move_a_wrist_that_only_turns(wrist):
    outcome = wrist.follow((1.0, 1.0, 1.0, 0.0, 0.0, 0.0))
    assert outcome.wrist_state == WristState.LIMITED
    assert outcome.message == (
        'Nothing of this command can be done: the wrist turns the hand about its own x, y and z '
        'axes, and no more; command those rates.'
    )
    assert wrist.positions == wrist.initial


def test_linear_rates_beside_others_are_told_to_be_missing(wrist):
    outcome = wrist.follow((1.0, 0.0, 0.0, 0.3, 0.0, 0.0))
    assert outcome.wrist_state == WristState.TRACKING
    assert 'the rest is missing' in outcome.message


def test_linear_rates_move_a_wrist_that_takes_them(clocked):
    legs = make_wrist('stewart')
    wrist = clocked(legs, legs.home)
    before = wrist.supervisor.state.pose.position
    wrist.ticks(0.1, (0.0, 0.0, 0.01, 0.0, 0.0, 0.0))
    moved = np.subtract(wrist.supervisor.state.pose.position, before)
    np.testing.assert_allclose(moved, (0.0, 0.0, 0.001), atol=1e-9)


def test_new_limits_count_from_the_next_step(wrist):
    wrist.ticks(0.05, PITCH)
    wrist.supervisor.wrist = wrist.supervisor.wrist.with_limits(rates=0.1)
    outcome = wrist.follow(PITCH)
    assert np.abs(outcome.step.joint_rates).max() == pytest.approx(0.1, rel=1e-3)


# Commands that stop


def test_when_commands_stop_the_hand_is_ramped_to_a_stop_and_held(wrist):
    wrist.command(PITCH)
    outcomes = wrist.ticks(0.6)
    q = np.array([outcome.commanded[4] for outcome in outcomes])
    ages = wrist.dt * np.arange(1, 61)
    expected = 0.3 * np.clip(1.0 - (ages - 0.25) / 0.1, 0.0, 1.0)
    np.testing.assert_allclose(q, expected, atol=1e-9)
    stale = [one.wrist_state == WristState.STALE for one in outcomes]
    assert stale.index(True) == 25
    assert all(stale[25:])
    assert outcomes[-1].step.joint_rates == (0.0, 0.0, 0.0)
    assert outcomes[-1].message.startswith('No fresh command: ramped to a stop')
    assert outcomes[-1].moving_allowed


def test_a_fresh_command_ends_the_stop(wrist):
    wrist.command(PITCH)
    wrist.ticks(0.6)
    outcome = wrist.follow(PITCH)
    assert (outcome.wrist_state, outcome.commanded) == (WristState.TRACKING, PITCH)


def test_standing_still_is_not_stale_however_old_the_command(wrist):
    wrist.command(ZERO_TWIST)
    assert {one.wrist_state for one in wrist.ticks(1.0)} == {WristState.IDLE}
