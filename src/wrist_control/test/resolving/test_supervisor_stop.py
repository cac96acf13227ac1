"""Stopped from outside: by a message on stop, or because the hand may not move now."""

import itertools

import numpy as np
import pytest

from wrist_control.errors import WristError
from wrist_control.resolving.report import WristState
from wrist_control.resolving.step import ZERO_TWIST

PITCH = (0.0, 0.0, 0.0, 0.0, 0.3, 0.0)
RELEASED = 'Stopped: the dead-man switch is released; press it to move.'


def followed(outcomes):
    return np.array([one.commanded[4] for one in outcomes])


def held_back(wrist, seconds, withheld):
    """Return the periods in which a command comes and is withheld."""
    outcomes = []
    for _ in range(round(seconds / wrist.dt)):
        wrist.command(PITCH)
        wrist.count += 1
        outcomes.append(
            wrist.supervisor.tick(stamp_time=wrist.now, receipt_time=wrist.now, withheld=withheld)
        )
    return outcomes


def test_a_message_on_stop_ramps_down_in_the_stop_time_and_disables(wrist):
    wrist.ticks(0.3, PITCH)
    wrist.supervisor.stop()
    outcomes = wrist.ticks(0.3, PITCH)
    expected = np.concatenate((0.3 * (1.0 - np.arange(10) / 10), np.zeros(20)))
    np.testing.assert_allclose(followed(outcomes), expected, atol=1e-9)
    assert outcomes[5].wrist_state == WristState.STALE
    assert outcomes[5].message.startswith('Stopping: somebody sent a message on stop')
    assert outcomes[-1].wrist_state == WristState.DISABLED
    assert not outcomes[-1].moving_allowed
    assert 'on stop; call ~/enable' in outcomes[-1].message


def test_after_a_stop_it_moves_only_when_enabled_again(wrist):
    wrist.ticks(0.1, PITCH)
    wrist.supervisor.stop()
    wrist.ticks(0.5, PITCH)
    assert wrist.follow(PITCH).wrist_state == WristState.DISABLED
    wrist.supervisor.enable(True)
    assert wrist.follow(PITCH).wrist_state == WristState.TRACKING


def test_it_cannot_be_enabled_while_it_still_stops(wrist):
    wrist.ticks(0.1, PITCH)
    wrist.supervisor.stop()
    wrist.ticks(0.05, PITCH)
    with pytest.raises(WristError, match='when it stands still'):
        wrist.supervisor.enable(True)
    assert wrist.ticks(0.1, PITCH)[-1].wrist_state == WristState.DISABLED


def test_a_stop_while_disabled_is_not_remembered(wrist):
    wrist.supervisor.enable(False)
    wrist.supervisor.stop()
    assert wrist.tick().message.startswith('Disabled: call')
    wrist.supervisor.enable(True)
    assert wrist.follow(PITCH).wrist_state == WristState.TRACKING


def test_a_stop_ends_a_reset_as_well(wrist):
    wrist.ticks(0.5, PITCH)
    wrist.supervisor.reset()
    wrist.ticks(0.05)
    wrist.supervisor.stop()
    outcomes = wrist.ticks(0.2)
    speeds = [max(map(abs, one.step.joint_rates)) for one in outcomes]
    assert speeds[0] == pytest.approx(0.5)
    assert all(before >= after for before, after in itertools.pairwise(speeds))
    assert outcomes[-1].wrist_state == WristState.DISABLED
    assert wrist.positions != wrist.initial


def test_what_is_withheld_is_ramped_to_a_stop_and_the_message_says_why(wrist):
    wrist.ticks(0.3, PITCH)
    outcomes = held_back(wrist, 0.2, RELEASED)
    expected = 0.3 * np.clip(1.0 - np.arange(20) / 10, 0.0, 1.0)
    np.testing.assert_allclose(followed(outcomes), expected, atol=1e-9)
    assert {(one.wrist_state, one.message) for one in outcomes} == {(WristState.STALE, RELEASED)}
    assert wrist.follow(PITCH).commanded == PITCH


def test_what_is_withheld_from_the_start_never_moves(clocked):
    wrist = clocked()
    outcomes = held_back(wrist, 0.2, RELEASED)
    assert {one.commanded for one in outcomes} == {ZERO_TWIST}
    assert wrist.positions == wrist.initial


def test_a_reset_waits_while_motion_is_withheld(wrist):
    wrist.ticks(0.5, PITCH)
    wrist.supervisor.reset()
    held_back(wrist, 0.2, RELEASED)
    where = wrist.positions
    held_back(wrist, 0.2, RELEASED)
    assert wrist.positions == where
    wrist.ticks(2.0)
    assert wrist.positions == pytest.approx(wrist.initial)
