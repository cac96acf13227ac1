"""A supervisor that is disabled, enabled, or told where the joints are: never a jump."""

import math

import numpy as np
import pytest

from wrist_control import UnreachableError, make_wrist
from wrist_control.errors import RefusedError
from wrist_control.resolving.report import WristState

PITCH = (0.0, 0.0, 0.0, 0.0, 0.3, 0.0)
NAMES = ('psi', 'theta', 'phi')
WRIST = make_wrist('three_gimbal')


@pytest.fixture
def broken(clocked, rail):
    """A rail that cannot be assembled from 1 rad on, at its start."""

    class Broken(rail):
        gap = (1.0, math.inf)

    return clocked(Broken(), (0.0,))


# Disabled and enabled


def test_disabled_nothing_moves_and_nothing_may_be_sent(wrist):
    wrist.ticks(0.1, PITCH)
    before = wrist.supervisor.state
    assert wrist.supervisor.enable(False).startswith('Disabled')
    for outcome in wrist.ticks(0.1, PITCH):
        assert (outcome.wrist_state, outcome.moving_allowed) == (WristState.DISABLED, False)
        assert outcome.step.joint_rates == (0.0, 0.0, 0.0)
        assert '~/enable' in outcome.message
    assert wrist.supervisor.state is before


def test_enabled_again_it_goes_on_from_the_measured_pose_and_waits_for_a_new_command(wrist):
    wrist.ticks(0.1, (0.0, 0.0, 0.0, 1.0, 0.0, 0.0))
    lost = wrist.supervisor.state.time_lost
    wrist.supervisor.enable(False)
    wrist.command(PITCH)
    wrist.measure((0.7, -0.4, 1.2))
    assert wrist.positions != (0.7, -0.4, 1.2)
    wrist.supervisor.enable(True)
    assert wrist.positions == (0.7, -0.4, 1.2)
    assert wrist.supervisor.state.pose == WRIST.forward((0.7, -0.4, 1.2))
    assert wrist.supervisor.state.time_lost == lost > 0.0
    assert wrist.tick().wrist_state == WristState.IDLE
    wrist.follow(PITCH)
    assert np.abs(np.subtract(wrist.positions, (0.7, -0.4, 1.2))).max() <= 0.5 * wrist.dt * 1.001


def test_enabled_without_ever_having_measured_it_goes_on_from_where_it_was(wrist):
    wrist.ticks(0.1, PITCH)
    before = wrist.positions
    wrist.supervisor.enable(False)
    wrist.supervisor.enable(True)
    assert wrist.positions == before


def test_enabling_what_is_enabled_changes_nothing(wrist):
    wrist.ticks(0.1, PITCH)
    wrist.measure((0.1, 0.2, 0.25))
    before = wrist.supervisor.state
    wrist.supervisor.enable(True)
    assert wrist.supervisor.state is before
    assert wrist.tick().commanded == PITCH


# Measured joints


def test_before_the_first_motion_it_starts_from_where_the_joints_are(wrist):
    wrist.measure((0.4, 0.5, 0.6))
    wrist.ticks(0.1)
    wrist.measure((0.41, 0.5, 0.6))
    assert wrist.positions == (0.41, 0.5, 0.6)
    assert wrist.supervisor.state.pose == WRIST.forward((0.41, 0.5, 0.6))


def test_after_the_first_motion_the_joints_are_told_and_not_asked(wrist):
    wrist.follow(PITCH)
    before = wrist.supervisor.state
    wrist.measure(wrist.initial)
    assert wrist.supervisor.state is before


def test_joints_may_come_in_any_order(wrist):
    wrist.measure((0.6, 0.4, 0.5), ('phi', 'psi', 'theta'))
    assert wrist.positions == (0.4, 0.5, 0.6)


@pytest.mark.parametrize(
    ('names', 'positions', 'reason', 'sentence'),
    [
        (NAMES, (1.0, 1.0), 'wrong length', r'3 joint names and 2 values; send one value for ea'),
        (
            NAMES[:2],
            (1.0, 1.0),
            'wrong joint names',
            r'phi is named 0 times; name each of psi, theta, phi once',
        ),
        ((), (), 'wrong joint names', r'psi is named 0 times'),
        (('psi', 'theta', 'x'), (1.0,) * 3, 'wrong joint names', r'phi is named 0 times'),
        ((*NAMES, 'psi'), (1.0,) * 4, 'wrong joint names', r'psi is named 2 times'),
        (NAMES, (1.0, math.nan, 1.0), 'not finite', r'not finite: \(1\.0, nan, 1\.0\)'),
        (NAMES, (1.0, 1.0, -math.inf), 'not finite', r'not finite'),
    ],
)
def test_joint_states_that_make_no_sense_are_refused_and_change_nothing(
    wrist, names, positions, reason, sentence
):
    wrist.measure((0.4, 0.5, 0.6))
    before = wrist.supervisor.state
    with pytest.raises(RefusedError, match=sentence) as refused:
        wrist.measure(positions, names)
    assert refused.value.reason == reason
    assert wrist.supervisor.state is before
    wrist.supervisor.enable(False)
    wrist.supervisor.enable(True)
    assert wrist.positions == (0.4, 0.5, 0.6)


def test_joints_measured_where_they_cannot_be_are_refused_and_change_nothing(broken):
    broken.measure((0.5,), ('phi',))
    with pytest.raises(UnreachableError):
        broken.measure((2.0,), ('phi',))
    assert broken.positions == (0.5,)
    broken.supervisor.enable(False)
    broken.supervisor.enable(True)
    assert broken.positions == (0.5,)


def test_enabled_where_the_joints_cannot_be_it_is_a_fault_and_not_a_crash(broken):
    broken.follow((0.0, 0.0, 0.0, 0.1, 0.0, 0.0))
    broken.supervisor.enable(False)
    broken.measure((2.0,), ('phi',))
    with pytest.raises(UnreachableError, match='cannot be assembled'):
        broken.supervisor.enable(True)
    outcome = broken.tick()
    assert (outcome.wrist_state, outcome.moving_allowed) == (WristState.FAULT, False)
    broken.measure((0.5,), ('phi',))
    broken.supervisor.enable(True)
    assert broken.positions == (0.5,)
    assert broken.tick().wrist_state == WristState.IDLE
