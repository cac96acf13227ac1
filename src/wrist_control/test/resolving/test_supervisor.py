"""Who is in charge between steps: following, stopping, disabled, resetting, faults."""

import math
import re

import numpy as np
import pytest

from wrist_control import InvalidValueError, UnreachableError, make_wrist
from wrist_control.errors import RefusedError
from wrist_control.resolving.commands import Command
from wrist_control.resolving.report import WristState
from wrist_control.resolving.step import ZERO_TWIST
from wrist_control.resolving.supervisor import Mode, Supervisor, SupervisorSettings
from wrist_control.rotations import to_hand
from wrist_control.wrists import Joint, Wrist

DT = 0.01
TIMEOUT = 0.25
STOP = 0.1
LIMIT = 0.5
LAG = 0.35  # rad, that a joint may be behind its command
LAG_TIME = 0.5  # s, and for this long
NAMES = ('psi', 'theta', 'phi')
START = (0.1, 0.2, 0.3)
PITCH = (0.0, 0.0, 0.0, 0.0, 0.3, 0.0)
WRIST = make_wrist('three_gimbal')


class Clocked:
    """A supervisor with a clock that advances by one period at each tick."""

    def __init__(self, wrist=None, initial=START):
        wrist = wrist or WRIST.with_limits(rates=LIMIT, lower=-2.0, upper=2.0)
        self.supervisor = Supervisor(wrist, SupervisorSettings(DT, TIMEOUT, STOP, initial))
        self.count = 0

    @property
    def now(self):
        return DT * self.count

    def command(self, twist, in_forearm=False):
        self.supervisor.take_command(Command(tuple(twist), in_forearm, None, self.now))

    def measure(self, positions, names=NAMES):
        self.supervisor.take_measured(names, positions, self.now)

    def tick(self):
        self.count += 1
        return self.supervisor.tick(stamp_time=self.now, receipt_time=self.now)

    def ticks(self, seconds, twist=None):
        """Return what each period brings, a command being sent before each if there is one."""
        outcomes = []
        for _ in range(round(seconds / DT)):
            if twist is not None:
                self.command(twist)
            outcomes.append(self.tick())
        return outcomes

    @property
    def positions(self):
        return self.supervisor.state.positions


@pytest.fixture
def wrist():
    return Clocked()


# Following


def test_it_starts_at_rest_at_the_initial_positions(wrist):
    outcome = wrist.tick()
    assert wrist.positions == START
    assert (outcome.wrist_state, outcome.commanded) == (WristState.IDLE, ZERO_TWIST)
    assert outcome.moving_allowed


def test_a_start_that_cannot_be_used_is_refused():
    with pytest.raises(InvalidValueError, match='initial_positions'):
        Clocked(initial=(0.0, 2.5, 0.0))


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
    wrist.supervisor.take_command(Command(PITCH, False, 1.5 * DT, 0.0))
    assert [one.commanded for one in wrist.ticks(2 * DT)] == [ZERO_TWIST, PITCH]


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
    assert wrist.positions == pytest.approx((START[0] + 0.15, *START[1:]))


def test_a_command_in_hand_axes_turns_the_hand_about_its_own(wrist):
    wrist.ticks(0.5, (0.0, 0.0, 0.0, 0.3, 0.0, 0.0))
    assert wrist.positions == pytest.approx((*START[:2], START[2] + 0.15))


def test_linear_rates_do_not_move_a_wrist_that_only_turns(wrist):
    (outcome,) = wrist.ticks(DT, (1.0, 1.0, 1.0, 0.0, 0.0, 0.0))
    assert outcome.wrist_state == WristState.IDLE
    assert wrist.positions == START


def test_linear_rates_move_a_wrist_that_takes_them():
    legs = make_wrist('stewart')
    wrist = Clocked(legs, legs.home)
    before = wrist.supervisor.state.pose.position
    wrist.ticks(0.1, (0.0, 0.0, 0.01, 0.0, 0.0, 0.0))
    moved = np.subtract(wrist.supervisor.state.pose.position, before)
    np.testing.assert_allclose(moved, (0.0, 0.0, 0.001), atol=1e-9)


def test_new_limits_count_from_the_next_step(wrist):
    wrist.ticks(0.05, PITCH)
    wrist.supervisor.wrist = wrist.supervisor.wrist.with_limits(rates=0.1)
    (outcome,) = wrist.ticks(DT, PITCH)
    assert np.abs(outcome.step.joint_rates).max() == pytest.approx(0.1, rel=1e-3)


# Commands that stop


def test_when_commands_stop_the_hand_is_ramped_to_a_stop_and_held(wrist):
    wrist.command(PITCH)
    outcomes = wrist.ticks(0.6)
    q = np.array([outcome.commanded[4] for outcome in outcomes])
    ages = DT * np.arange(1, 61)
    expected = 0.3 * np.clip(1.0 - (ages - TIMEOUT) / STOP, 0.0, 1.0)
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
    (outcome,) = wrist.ticks(DT, PITCH)
    assert (outcome.wrist_state, outcome.commanded) == (WristState.TRACKING, PITCH)


def test_standing_still_is_not_stale_however_old_the_command(wrist):
    wrist.command(ZERO_TWIST)
    assert {one.wrist_state for one in wrist.ticks(1.0)} == {WristState.IDLE}


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
    wrist.ticks(DT, PITCH)
    assert np.abs(np.subtract(wrist.positions, (0.7, -0.4, 1.2))).max() <= LIMIT * DT * 1.001


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
    wrist.ticks(DT, PITCH)
    before = wrist.supervisor.state
    wrist.measure(START)
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


class Rail(Wrist):
    """One joint that turns the hand about x and can be assembled where `gap` is not."""

    default_joints = (Joint('phi'),)
    gap = (1.0, 9.0)

    def forward(self, positions):
        if self.gap[0] < positions[0] < self.gap[1]:
            raise UnreachableError('There the rail cannot be assembled.')
        return WRIST.forward((0.0, 0.0, positions[0]))

    def inverse(self, pose, near):
        return WRIST.inverse(pose, (0.0, 0.0, near[0]))[2:]

    def jacobian(self, positions):
        return np.array([[1.0], [0.0], [0.0]])

    def rates(self, positions, twist):
        return (twist[0],)

    def margin(self, positions):
        return 1.0


def test_joints_measured_where_they_cannot_be_are_refused_and_change_nothing():
    wrist = Clocked(Rail(), (0.0,))
    wrist.measure((0.5,), ('phi',))
    with pytest.raises(UnreachableError):
        wrist.measure((2.0,), ('phi',))
    assert wrist.positions == (0.5,)
    wrist.supervisor.enable(False)
    wrist.supervisor.enable(True)
    assert wrist.positions == (0.5,)


def test_enabled_where_the_joints_cannot_be_it_is_a_fault_and_not_a_crash():
    wrist = Clocked(Rail(), (0.0,))
    wrist.ticks(DT, (0.0, 0.0, 0.0, 0.1, 0.0, 0.0))
    wrist.supervisor.enable(False)
    wrist.measure((2.0,), ('phi',))
    with pytest.raises(UnreachableError, match='cannot be assembled'):
        wrist.supervisor.enable(True)
    outcome = wrist.tick()
    assert (outcome.wrist_state, outcome.moving_allowed) == (WristState.FAULT, False)
    wrist.measure((0.5,), ('phi',))
    wrist.supervisor.enable(True)
    assert wrist.positions == (0.5,)
    assert wrist.tick().wrist_state == WristState.IDLE


# Reset


@pytest.mark.parametrize('rates', [LIMIT, (0.2, math.inf, 0.7), math.inf])
def test_reset_goes_home_at_the_rate_limits_and_never_jumps(rates):
    wrist = Clocked(WRIST.with_limits(rates=rates))
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
        np.testing.assert_allclose(outcome.step.joint_rates, moved / DT, atol=1e-9)
    assert (np.abs(np.diff(path, axis=0)) <= DT * np.array(allowed) * (1.0 + 1e-8)).all()
    assert len(path) > 50
    assert wrist.positions == START


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
    assert wrist.positions == START
    assert wrist.ticks(DT, PITCH)[0].wrist_state == WristState.TRACKING


def test_a_reset_at_home_is_done_at_once(wrist):
    wrist.supervisor.reset()
    wrist.tick()
    assert wrist.supervisor.mode is Mode.FOLLOWING


def test_a_reset_needs_somebody_who_may_move(wrist):
    wrist.supervisor.enable(False)
    with pytest.raises(InvalidValueError, match=r'Cannot reset: nobody: disabled .* ~/enable'):
        wrist.supervisor.reset()
    assert wrist.supervisor.mode is Mode.DISABLED


def test_a_reset_can_be_broken_off_by_disabling(wrist):
    wrist.ticks(0.5, PITCH)
    wrist.supervisor.reset()
    wrist.ticks(0.1)
    wrist.supervisor.enable(False)
    before = wrist.positions
    wrist.ticks(0.5)
    assert wrist.positions == before != START


def test_a_reset_to_where_new_limits_forbid_to_be_is_refused(wrist):
    wrist.ticks(0.5, (0.0, 0.0, 0.0, -0.4, 0.0, 0.0))
    wrist.supervisor.wrist = wrist.supervisor.wrist.with_limits(upper=(2.0, 2.0, 0.2))
    with pytest.raises(InvalidValueError, match=r'initial_positions has 0\.3 for phi'):
        wrist.supervisor.reset()
    assert wrist.supervisor.mode is Mode.FOLLOWING


def test_a_reset_that_the_mechanism_cannot_make_is_a_fault_and_not_a_crash():
    rail = Rail()
    object.__setattr__(rail, 'gap', (0.4, 0.6))
    wrist = Clocked(rail, (0.0,))
    wrist.measure((1.0,), ('phi',))
    wrist.supervisor.reset()
    states = [one.wrist_state for one in wrist.ticks(2.0)]
    assert states[-1] == WristState.FAULT
    assert 0.6 <= wrist.positions[0] <= 0.61


# Faults


def test_a_joint_that_lags_for_half_a_second_is_a_fault(wrist):
    wrist.ticks(DT, PITCH)
    wrist.measure((START[0], START[1] + LAG + 0.1, START[2]))
    while wrist.now <= DT + LAG_TIME:
        outcome = wrist.tick()
        wrist.measure((START[0], START[1] + LAG + 0.1, START[2]))
        assert outcome.wrist_state != WristState.FAULT
    outcome = wrist.tick()
    assert (outcome.wrist_state, outcome.moving_allowed) == (WristState.FAULT, False)
    assert re.match(
        r'theta is at 0\.650 but was told 0\.2\d\d: it does not follow\. ', outcome.message
    )
    assert '~/enable' in outcome.message


def test_a_lag_that_is_caught_up_in_time_is_no_fault(wrist):
    wrist.ticks(DT, PITCH)
    far = (START[0] + LAG + 0.1, *START[1:])
    for seen in (far, START, far, START, far):
        wrist.measure(seen)
        wrist.ticks(0.4)
    assert wrist.supervisor.mode is Mode.FOLLOWING


def test_a_small_lag_is_no_fault(wrist):
    wrist.ticks(DT, PITCH)
    for _ in range(200):
        wrist.measure((START[0] + 0.9 * LAG, *START[1:]))
        outcome = wrist.tick()
    assert outcome.wrist_state == WristState.STALE


def test_a_fault_is_cleared_by_enabling_from_the_measured_pose(wrist):
    wrist.ticks(DT, PITCH)
    there = (START[0] + 1.0, *START[1:])
    for _ in range(60):
        wrist.measure(there)
        outcome = wrist.tick()
    assert outcome.wrist_state == WristState.FAULT
    with pytest.raises(InvalidValueError, match='nobody: a fault is in charge'):
        wrist.supervisor.reset()
    assert wrist.ticks(0.1, PITCH)[-1].wrist_state == WristState.FAULT
    wrist.supervisor.enable(True)
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


def test_a_step_that_fails_is_a_fault_that_says_why():
    class Broken(Rail):
        def inverse(self, pose, near):
            return (math.nan,)

        def forward(self, positions):
            return WRIST.forward((0.0, 0.0, 0.0))

    wrist = Clocked(Broken(), (0.0,))
    (outcome,) = wrist.ticks(DT, (0.0, 0.0, 0.0, 0.1, 0.0, 0.0))
    assert (outcome.wrist_state, outcome.moving_allowed) == (WristState.FAULT, False)
    assert 'led nowhere' in outcome.message
    assert wrist.positions == (0.0,)


def test_a_command_that_slipped_through_unfit_is_a_fault_and_moves_nothing(wrist):
    wrist.command((0.0, 0.0, 0.0, math.nan, 0.0, 0.0))
    assert wrist.tick().wrist_state == WristState.FAULT
    assert wrist.positions == START


def test_a_step_whose_arithmetic_fails_is_a_fault_and_not_a_crash():
    class Dividing(Rail):
        def rates(self, positions, twist):
            return (twist[0] / positions[0],)

    wrist = Clocked(Dividing(), (0.0,))
    (outcome,) = wrist.ticks(DT, (0.0, 0.0, 0.0, 0.1, 0.0, 0.0))
    assert (outcome.wrist_state, outcome.moving_allowed) == (WristState.FAULT, False)
    assert re.match(r'The step could not be computed \(.*\); nothing moves\. ', outcome.message)
    assert wrist.positions == (0.0,)
    wrist.measure((0.5,), ('phi',))
    wrist.supervisor.enable(True)
    (outcome,) = wrist.ticks(DT, (0.0, 0.0, 0.0, 0.1, 0.0, 0.0))
    assert outcome.wrist_state == WristState.TRACKING


@pytest.mark.parametrize('twist', [PITCH, (0.0, 0.0, 0.0, 0.0, 0.0, 0.3)])
def test_a_joint_too_near_zero_to_divide_by_it_is_no_fault(twist):
    limited = make_wrist('four_gimbal').with_limits(rates=LIMIT, lower=-1.0, upper=1.0)
    wrist = Clocked(limited, (0.0, 5e-324, 0.0, 0.0))
    outcomes = wrist.ticks(0.1, twist)
    assert {outcome.wrist_state for outcome in outcomes} == {WristState.TRACKING}
