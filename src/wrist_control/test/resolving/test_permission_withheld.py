"""A hand that may not move now: ramped to a stop, and told why."""

import numpy as np
import pytest

from wrist_control.resolving.report import WristState
from wrist_control.resolving.state import ZERO_TWIST

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
