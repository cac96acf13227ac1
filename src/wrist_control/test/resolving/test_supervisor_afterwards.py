"""After a pause, a fault or a reset: nothing of the time before moves the hand, or stops it."""

import pytest

from wrist_control import make_wrist
from wrist_control.resolving.period import Mode
from wrist_control.resolving.report import WristState
from wrist_control.resolving.state import ZERO_TWIST

DT = 0.01
LONG = 10.0  # s: no command runs out here
WRIST = make_wrist('three_gimbal')
START = (0.1, 0.2, 0.3)
ROLL = (0.0, 0.0, 0.0, 0.3, 0.0, 0.0)
FAST = (0.0, 0.0, 0.0, 60.0, 0.0, 0.0)  # 0.6 rad in one step: more than a joint may lag


@pytest.fixture
def timed(clocked):
    """A wrist without limits to its positions, and commands that never run out."""
    return clocked(WRIST.with_limits(rates=0.5), command_timeout=LONG)


def test_a_command_from_before_a_pause_does_not_move_the_hand_after_it(timed):
    timed.command(ROLL)
    timed.ticks(0.1)
    timed.enable(False)
    timed.command(ROLL)  # also one that comes while nothing may move
    timed.ticks(0.2)
    paused = timed.positions
    timed.enable(True)
    result = timed.ticks(0.1)[-1]
    assert (result.wrist_state, result.commanded) == (WristState.IDLE, ZERO_TWIST)
    assert timed.positions == paused


def test_enabling_what_is_enabled_does_not_stop_the_hand(timed):
    timed.command(ROLL)
    timed.ticks(0.1)
    assert timed.enable(True).startswith('Enabled')
    assert timed.tick().commanded == ROLL


def stuck(timed, periods):
    """Return the mode after each period in which the joints stay at the start."""
    modes = []
    for _ in range(periods):
        timed.measure(START)
        timed.tick()
        modes.append(timed.supervisor.mode)
    return modes


def test_a_lag_from_before_a_fault_does_not_count_after_it(clocked):
    timed = clocked(WRIST, command_timeout=LONG)
    timed.rest(START)
    timed.command(FAST)
    timed.tick()
    stuck(timed, 45)
    assert timed.supervisor.mode is Mode.FAULT
    timed.rest(START)
    timed.enable(True)
    timed.command(FAST)
    timed.tick()
    assert set(stuck(timed, 20)) == {Mode.FOLLOWING}
    stuck(timed, 25)
    assert timed.supervisor.mode is Mode.FAULT


@pytest.mark.parametrize('name', ['three_gimbal', 'stewart'])
@pytest.mark.parametrize('share', [0.98, 1.02])
def test_a_joint_may_lag_as_far_and_as_long_as_it_was_told(clocked, name, share):
    most = {'three_gimbal': 0.2, 'stewart': 0.01}[name]
    wrist = make_wrist(name)
    tolerance = (most,) * len(wrist.joints)
    timed = clocked(wrist, wrist.home, tracking_tolerance=tolerance, tracking_time=0.5)
    names = [joint.name for joint in wrist.joints]
    timed.measure(wrist.home, names)
    timed.follow((0.0, 0.0, 1e-6, 1e-6, 0.0, 0.0))
    behind = [wrist.home[0] - share * most, *tuple(wrist.home)[1:]]
    modes = []
    for now in (1.0, 1.49, 1.51):
        timed.count = round(now / DT)
        timed.tick()
        timed.measure(behind, names)
        modes.append(timed.supervisor.mode)
    assert modes == [Mode.FOLLOWING] * 2 + [Mode.FAULT if share > 1.0 else Mode.FOLLOWING]


def test_a_lag_that_ends_in_between_is_forgotten(timed):
    timed.measure(START)
    timed.follow(ROLL)
    timed.ticks(0.1, ZERO_TWIST)
    behind = (START[0] - 0.2, *START[1:])
    for now, positions in ((1.0, behind), (1.15, START), (1.2, behind), (1.4, behind)):
        timed.count = round(now / DT)
        timed.measure(positions)
    assert timed.supervisor.mode is Mode.FOLLOWING
    timed.count = 146
    timed.measure(behind)
    assert timed.supervisor.mode is Mode.FAULT


def test_a_command_from_before_a_reset_or_during_it_does_not_move_the_hand_after_it(timed):
    timed.command(ROLL)
    timed.ticks(0.3)
    timed.supervisor.reset()
    timed.tick()
    timed.command(ROLL)
    timed.ticks(2.0)
    assert timed.supervisor.mode is Mode.FOLLOWING
    assert timed.positions == START


def test_joints_that_are_heard_after_a_reset_do_not_count_as_a_start(timed):
    timed.measure(START)
    timed.supervisor.state = timed.supervisor.state._replace(time_lost=1.0)
    timed.supervisor.reset()
    timed.tick()
    assert timed.supervisor.state.time_lost == 0.0
    timed.measure((0.2, 0.3, 0.4))
    assert timed.positions == START
