"""A supervisor that hears where the joints are: once, at rest, inside every limit."""

import math

import numpy as np
import pytest

from wrist_control import InvalidValueError, UnreachableError, make_wrist
from wrist_control.resolving.period import Mode
from wrist_control.resolving.report import WristState

PITCH = (0.0, 0.0, 0.0, 0.0, 0.3, 0.0)
WRIST = make_wrist('three_gimbal')
NAMES = ('psi', 'theta', 'phi')
ELSEWHERE = (0.9, -0.4, 0.2)


@pytest.fixture
def waiting(clocked):
    """A wrist that waits for its joints, held to 0.5 rad/s and ±2 rad."""
    return clocked(require_joint_states=True)


@pytest.fixture
def heard(waiting):
    """The same once it has heard them, away from its initial positions."""
    waiting.rest(ELSEWHERE)
    return waiting


def test_nothing_is_commanded_before_the_joints_were_heard(waiting):
    for outcome in waiting.ticks(2.0, PITCH):
        assert (outcome.wrist_state, outcome.moving_allowed) == (WristState.WAITING, False)
        assert outcome.message == (
            'Waiting: no joint_states of psi, theta, phi were heard; start the joints, or set '
            'require_joint_states to false to go on without.'
        )


def test_it_starts_from_where_they_rest_and_holds(heard):
    outcome = heard.tick()
    assert (outcome.wrist_state, outcome.moving_allowed) == (WristState.IDLE, True)
    assert outcome.step.state.positions == ELSEWHERE
    assert outcome.step.state.pose == WRIST.forward(ELSEWHERE)
    assert not any(outcome.step.joint_rates)


def test_commands_from_before_do_not_move_it(waiting):
    waiting.ticks(0.3, PITCH)
    waiting.rest(ELSEWHERE)
    assert waiting.ticks(0.5)[-1].step.state.positions[0] == ELSEWHERE[0]


@pytest.mark.parametrize('required', [True, False])
def test_joints_that_rest_beside_their_setpoint_do_not_make_it_creep(clocked, required):
    """A servo settles 2 mrad below what it is told, wherever that is."""
    wrist = clocked(require_joint_states=required)
    wrist.rest(ELSEWHERE)
    for _ in range(2000):
        outcome = wrist.tick()
        wrist.measure(np.subtract(outcome.step.state.positions, 0.002).tolist())
    assert wrist.positions == ELSEWHERE
    wrist.enable(False)
    wrist.measure(np.subtract(ELSEWHERE, 0.002).tolist())
    wrist.enable(True)
    taken = wrist.positions
    for _ in range(500):
        outcome = wrist.tick()
        wrist.measure(np.subtract(outcome.step.state.positions, 0.002).tolist())
    assert wrist.positions == taken


@pytest.mark.parametrize('period', [0.5, 0.1, 0.002])
def test_however_seldom_they_come_three_are_enough(waiting, period):
    for count in range(3):
        assert waiting.supervisor.mode is Mode.WAITING
        waiting.count = round(count * period / waiting.dt)
        waiting.measure(ELSEWHERE)
    assert waiting.supervisor.mode is Mode.FOLLOWING


def test_joints_that_move_are_waited_for(waiting):
    for count in range(50):
        waiting.tick()
        waiting.measure((0.006 * count, 0.0, 0.0))
    outcome = waiting.tick()
    assert outcome.wrist_state == WristState.WAITING
    assert outcome.message == 'Waiting for the joints to rest.'


def test_joints_outside_their_limits_are_not_commanded(waiting):
    with pytest.raises(
        InvalidValueError, match=r'psi is at 2\.500, outside its limits of -2 to 2'
    ):
        waiting.rest((2.5, 0.0, 0.0))
    outcome = waiting.tick()
    assert (outcome.wrist_state, outcome.moving_allowed) == (WristState.WAITING, False)
    assert outcome.message.startswith('Waiting: psi is at 2.500, outside its limits')
    waiting.rest(ELSEWHERE)
    assert waiting.tick().wrist_state == WristState.IDLE


@pytest.mark.parametrize(('beyond', 'taken'), [(0.019, True), (0.021, False)])
def test_a_joint_a_little_outside_may_only_move_inward(waiting, beyond, taken):
    start = (2.0 + beyond, 0.2, 0.0)
    if not taken:
        with pytest.raises(InvalidValueError):
            waiting.rest(start)
        return
    waiting.rest(start)
    assert waiting.tick().step.state.positions == start
    for direction in (1.0, -1.0):
        for _ in range(20):
            outcome = waiting.follow((0.0, 0.0, 0.0, 0.0, 0.0, 0.3 * direction))
            waiting.measure(outcome.step.state.positions)
            assert outcome.step.state.positions[0] <= start[0] + 1e-9
    assert waiting.positions[0] < start[0] - 0.01


def test_joints_outside_the_workspace_are_not_commanded(clocked):
    wrist = clocked(make_wrist('single_hooke'), (0.0,) * 3, require_joint_states=True)
    with pytest.raises(InvalidValueError, match='outside: cone'):
        wrist.rest((0.0, 0.8, 0.5), ('phi', 'theta', 'psi'))
    assert wrist.supervisor.mode is Mode.WAITING


@pytest.mark.parametrize('required', [True, False])
def test_joints_that_cannot_be_assembled_are_not_commanded(clocked, rail, required):
    class Broken(rail):
        gap = (1.0, math.inf)

    wrist = clocked(Broken(), (0.0,), require_joint_states=required)
    with pytest.raises(UnreachableError):
        wrist.rest((2.0,), ('phi',))
    outcome = wrist.tick()
    assert outcome.wrist_state == (WristState.WAITING if required else WristState.FAULT)
    assert not outcome.moving_allowed
    assert wrist.positions == (0.0,)


def test_without_waiting_it_holds_its_initial_positions_until_it_hears_the_joints(wrist):
    assert wrist.tick().step.state.positions == wrist.initial
    wrist.rest(ELSEWHERE)
    assert wrist.positions == ELSEWHERE


def test_after_the_first_motion_the_joints_are_told_and_not_asked(wrist):
    wrist.follow(PITCH)
    wrist.rest((0.15, 0.2, 0.3))
    assert wrist.positions[0] < 0.11


def test_joints_may_come_in_any_order(wrist):
    wrist.rest((0.6, 0.4, 0.5), ('phi', 'psi', 'theta'))
    assert wrist.positions == (0.4, 0.5, 0.6)


def test_waiting_it_can_be_disabled_and_enabled_and_waits_again(waiting):
    waiting.enable(False)
    assert waiting.tick().wrist_state == WristState.DISABLED
    assert 'once the joints were heard' in waiting.enable(True)
    assert waiting.tick().wrist_state == WristState.WAITING


def test_waiting_it_cannot_be_reset(waiting):
    with pytest.raises(InvalidValueError, match='no joint states yet'):
        waiting.supervisor.reset()


# Joints that fall silent


@pytest.mark.parametrize('homing', [True, False])
def test_joints_that_fall_silent_while_moving_are_a_ramp_and_a_fault(heard, homing):
    for _ in range(30):
        heard.measure(heard.follow(PITCH).step.state.positions)
    if homing:
        heard.supervisor.reset()
        heard.measure(heard.tick().step.state.positions)
    silent = heard.ticks(0.4, PITCH)
    rates = [max(map(abs, outcome.step.joint_rates)) for outcome in silent]
    full = rates[0]
    assert rates[24] == pytest.approx(full, rel=0.02)
    assert max(-np.diff(rates)) < 1.2 * full * heard.dt / 0.1
    assert rates[-1] == 0.0
    last = silent[-1]
    assert (last.wrist_state, last.moving_allowed) == (WristState.FAULT, False)
    assert last.message.startswith(
        'Stopped, since the last joint_states of psi, theta, phi came 0.2'
    )
    zero = next(i for i, rate in enumerate(rates) if rate == 0.0)
    assert silent[zero].moving_allowed


def test_joints_that_fell_silent_at_rest_are_waited_for_and_nothing_moves(heard):
    heard.ticks(1.0)
    for outcome in heard.ticks(0.3, PITCH):
        assert outcome.wrist_state == WristState.WAITING
        assert not any(outcome.step.joint_rates)
    assert 'nothing moves without them' in outcome.message
    heard.measure(ELSEWHERE)
    assert heard.follow(PITCH).wrist_state == WristState.TRACKING


def test_without_waiting_silence_is_no_fault(wrist):
    wrist.rest(wrist.initial)
    assert wrist.ticks(2.0, PITCH)[-1].wrist_state == WristState.TRACKING


def test_a_fault_is_cleared_only_when_the_joints_speak_again(heard):
    for _ in range(10):
        heard.measure(heard.follow(PITCH).step.state.positions)
    heard.ticks(0.5, PITCH)
    with pytest.raises(InvalidValueError, match='start the joints first'):
        heard.enable(True)
    assert heard.tick().wrist_state == WristState.FAULT
    heard.rest(ELSEWHERE)
    heard.enable(True)
    assert heard.tick().wrist_state == WristState.IDLE
