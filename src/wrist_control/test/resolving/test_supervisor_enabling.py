"""A supervisor that is disabled, enabled, or told where the joints are: never a jump."""

import math
from itertools import pairwise

import numpy as np
import pytest

from wrist_control import InvalidValueError, UnreachableError, make_wrist
from wrist_control.errors import RefusedError
from wrist_control.resolving.period import Mode
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


def test_enabled_again_it_says_that_commands_are_followed(wrist):
    wrist.enable(False)
    assert wrist.enable(True) == 'Enabled: following commands.'
    assert wrist.enable(True) == 'Enabled: following commands.'


def test_disabled_while_it_moves_it_ramps_to_a_stop_that_is_sent_and_then_nothing_is(wrist):
    full = wrist.ticks(0.1, PITCH)[-1].step.joint_rates[1]
    wrist.enable(False)
    before = wrist.positions
    ramp = wrist.ticks(0.11, PITCH)
    speeds = [outcome.step.joint_rates[1] for outcome in ramp]
    assert all(one >= other for one, other in pairwise([full, *speeds]))
    assert max(-np.diff([full, *speeds])) < 1.05 * full * wrist.dt / 0.1
    zero = speeds.index(0.0)
    assert ramp[zero].moving_allowed
    assert {outcome.wrist_state for outcome in ramp} == {WristState.DISABLED}
    assert wrist.positions[1] - before[1] == pytest.approx(0.3 * 0.05, abs=0.3 * wrist.dt)
    for outcome in wrist.ticks(0.1, PITCH):
        assert (outcome.wrist_state, outcome.moving_allowed) == (WristState.DISABLED, False)
        assert outcome.step.joint_rates == (0.0, 0.0, 0.0)
        assert '~/enable' in outcome.message


def test_disabled_at_rest_nothing_may_be_sent_at_once(wrist):
    wrist.ticks(0.1)
    wrist.enable(False)
    assert not wrist.tick().moving_allowed


def test_enabled_before_it_has_stopped_is_refused(wrist):
    wrist.ticks(0.1, PITCH)
    wrist.enable(False)
    wrist.tick()
    with pytest.raises(InvalidValueError, match='coming to a stop'):
        wrist.enable(True)
    wrist.ticks(0.2)
    wrist.enable(True)


def test_disabled_the_pose_follows_the_joints(wrist):
    wrist.enable(False)
    wrist.measure((0.5, 0.1, 0.2))
    outcome = wrist.tick()
    assert outcome.step.state.positions == (0.5, 0.1, 0.2)
    assert outcome.step.state.pose == WRIST.forward((0.5, 0.1, 0.2))
    assert not outcome.moving_allowed


def test_enabled_again_it_goes_on_from_the_measured_pose_and_waits_for_a_new_command(wrist):
    wrist.ticks(0.1, (0.0, 0.0, 0.0, 1.0, 0.0, 0.0))
    wrist.enable(False)
    wrist.ticks(0.2)
    lost = wrist.supervisor.state.time_lost
    wrist.command(PITCH)
    wrist.rest((0.7, -0.4, 1.2))
    wrist.enable(True)
    assert wrist.positions == (0.7, -0.4, 1.2)
    assert wrist.supervisor.state.time_lost == lost > 0.0
    assert wrist.tick().wrist_state == WristState.IDLE
    wrist.follow(PITCH)
    assert np.abs(np.subtract(wrist.positions, (0.7, -0.4, 1.2))).max() <= 0.5 * wrist.dt * 1.001


def test_enabled_without_ever_having_measured_it_goes_on_from_where_it_was(wrist):
    wrist.ticks(0.1, PITCH)
    wrist.enable(False)
    wrist.ticks(0.2)
    before = wrist.positions
    wrist.enable(True)
    assert wrist.positions == before
    assert wrist.tick().wrist_state == WristState.IDLE


def test_enabling_what_is_enabled_changes_nothing(wrist):
    wrist.ticks(0.1, PITCH)
    wrist.measure((0.1, 0.2, 0.25))
    before = wrist.supervisor.state
    wrist.enable(True)
    assert wrist.supervisor.state is before
    assert wrist.tick().commanded == PITCH


@pytest.mark.parametrize(('age', 'taken'), [(0.24, True), (0.26, False), (5.5, False)])
def test_enabled_it_takes_over_from_fresh_joint_states_only(wrist, age, taken):
    wrist.enable(False)
    wrist.rest((0.7, -0.4, 1.2))
    wrist.count += round(age / wrist.dt)
    if taken:
        wrist.enable(True)
        assert wrist.supervisor.mode is Mode.FOLLOWING
        return
    with pytest.raises(InvalidValueError, match=rf'psi, theta, phi came {age:.2f} s ago; start'):
        wrist.enable(True)
    assert wrist.supervisor.mode is Mode.DISABLED


def test_enabled_while_the_joints_move_is_refused(wrist):
    wrist.enable(False)
    for step in range(5):
        wrist.measure((0.01 * step, 0.0, 0.0))
    with pytest.raises(InvalidValueError, match='the joints do not rest'):
        wrist.enable(True)
    assert wrist.supervisor.mode is Mode.DISABLED


def test_enabled_where_the_joints_cannot_be_is_refused_and_stays_as_it_was(broken):
    broken.follow((0.0, 0.0, 0.0, 0.1, 0.0, 0.0))
    broken.enable(False)
    broken.ticks(0.2)
    broken.rest((2.0,), ('phi',))
    with pytest.raises(UnreachableError, match='cannot be assembled'):
        broken.enable(True)
    assert broken.tick().wrist_state == WristState.DISABLED
    broken.rest((0.5,), ('phi',))
    broken.enable(True)
    assert broken.positions == (0.5,)
    assert broken.tick().wrist_state == WristState.IDLE


def test_a_fault_stays_one_when_it_is_disabled(wrist):
    wrist.command((0.0, 0.0, 0.0, math.nan, 0.0, 0.0))
    assert wrist.tick().wrist_state == WristState.FAULT
    wrist.enable(False)
    assert wrist.tick().wrist_state == WristState.FAULT


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
        (NAMES, (1.0, math.nan, 1.0), 'not finite', r'joint states \(1\.0, nan, 1\.0\)'),
        (NAMES, (1.0, 1.0, -math.inf), 'not finite', r'must be finite'),
        (NAMES, (1.0, 1e308, 1.0), 'not finite', r'at most 10000 rad'),
    ],
)
def test_joint_states_that_make_no_sense_are_refused_and_change_nothing(
    wrist, names, positions, reason, sentence
):
    wrist.rest((0.4, 0.5, 0.6))
    before = wrist.supervisor.state
    with pytest.raises(RefusedError, match=sentence) as refused:
        wrist.measure(positions, names)
    assert refused.value.reason == reason
    assert wrist.supervisor.state is before
    wrist.enable(False)
    wrist.enable(True)
    assert wrist.positions == (0.4, 0.5, 0.6)
