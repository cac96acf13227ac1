"""A driven mechanism: late by its delay, within its limits, stuck, and never not a number."""

import math

import numpy as np
import pytest

pytest.importorskip('mujoco', reason='`make setup-physics` gets it')

from wrist_control.errors import UnreachableError, UnstableError
from wrist_control.physics.driven import DrivenMechanism, Drives
from wrist_control.physics.mechanism import Mechanism, Settings
from wrist_control.physics.models import MODELS, build
from wrist_control.wrists import make_wrist

PERIOD = 0.01
G = 9.80665
FALLING = (0.0, 0.0, -G)


def driven(name='three_gimbal', limits=(math.inf,), friction=(0.0,), wrist=None, **given):
    """Return a driven mechanism at home; one limit and one friction for all joints."""
    wrist = wrist or make_wrist(name)
    count = len(wrist.joints)
    drives = Drives(
        given.pop('period', PERIOD),
        given.pop('delay', 0.0),
        tuple(limits) * (count if len(limits) == 1 else 1),
        tuple(friction) * (count if len(friction) == 1 else 1),
        given.pop('by_rates', False),
    )
    start = given.pop('start', tuple(wrist.home))
    return DrivenMechanism(build(wrist, Settings(**given)), wrist.joints, drives, start)


def passed(mechanism, told, seconds):
    return [mechanism.advance(told) for _ in range(round(seconds / PERIOD))]


@pytest.mark.parametrize('wrist', MODELS)
def test_it_stays_where_it_starts_while_nothing_pulls_at_it(wrist):
    mechanism = driven(wrist)
    home = mechanism.reading
    last = passed(mechanism, home.positions, 0.2)[-1]
    np.testing.assert_allclose(last.positions, tuple(make_wrist(wrist).home), atol=1e-9)
    np.testing.assert_allclose(last.hand_pose.position, home.hand_pose.position, atol=1e-9)


def test_a_payload_is_carried_by_the_effort_that_its_weight_needs_and_pulls_the_hand_down():
    mechanism = driven(payload=0.5, gravity=FALLING, balanced=True)
    lever = np.linalg.norm(make_wrist('three_gimbal').probe)
    last = passed(mechanism, (0.0, 0.0, 0.0), 1.0)[-1]
    sag = last.positions[1]
    assert sag > 1e-3
    assert abs(last.efforts[1]) == pytest.approx(0.5 * G * lever * math.cos(sag), rel=1e-6)
    assert abs(last.efforts[0]) < 1e-6


def test_no_servo_does_more_than_its_limit_and_what_it_cannot_carry_falls():
    mechanism = driven(payload=0.5, gravity=FALLING, limits=(9.0, 0.1, 9.0))
    heard = passed(mechanism, (0.0, 0.0, 0.0), 0.5)
    efforts = np.abs([reading.efforts for reading in heard])
    assert efforts.max(axis=0)[1] == pytest.approx(0.1)
    assert heard[-1].positions[1] > 0.1


def test_friction_that_is_stronger_than_the_servo_holds_a_joint():
    free = driven(limits=(0.1,))
    assert abs(passed(free, (0.2, 0.0, 0.0), 0.5)[-1].positions[0]) > 0.1
    held = driven(limits=(0.1,), friction=(0.2, 0.0, 0.0))
    assert abs(passed(held, (0.2, 0.0, 0.0), 0.5)[-1].positions[0]) < 1e-4


@pytest.mark.parametrize('wrist', MODELS)
def test_a_stuck_joint_stays_where_it_is_until_it_is_free_again(wrist):
    mechanism = driven(wrist)
    home = np.array(mechanism.reading.positions)
    joint = make_wrist(wrist).joints[-1]
    told = home.copy()
    told[-1] += 0.02 if joint.kind == 'revolute' else 0.002
    mechanism.stick(joint.name)
    stuck = passed(mechanism, told, 0.3)[-1]
    assert abs(stuck.positions[-1] - home[-1]) < 0.02 * (told[-1] - home[-1])
    mechanism.stick('')
    assert passed(mechanism, told, 0.5)[-1].positions[-1] == pytest.approx(told[-1], rel=1e-3)


def test_a_joint_that_sticks_in_motion_stops_at_once_and_the_others_go_on():
    mechanism = driven()
    for count in range(1, 31):
        moving = mechanism.advance((0.005 * count, 0.005 * count, 0.0))
    mechanism.stick('psi')
    last = passed(mechanism, (0.5, 0.5, 0.0), 0.5)[-1]
    assert abs(last.positions[0] - moving.positions[0]) < 0.002
    assert last.positions[1] == pytest.approx(0.5, abs=1e-6)


@pytest.mark.parametrize('delay', [0.01, 0.013, 0.05])
def test_a_delay_shifts_all_that_happens_and_changes_nothing_else(delay):
    period = 0.001  # so that all these delays are whole periods
    late, soon = driven(delay=delay, period=period), driven(period=period)
    shift = round(delay / period)
    heard_late = [late.advance((0.1, 0.0, 0.0)).positions for _ in range(200)]
    heard_soon = [soon.advance((0.1, 0.0, 0.0)).positions for _ in range(200)]
    np.testing.assert_array_equal(heard_late[shift:], heard_soon[: 200 - shift])
    np.testing.assert_allclose(heard_late[:shift], 0.0, atol=1e-15)


def test_a_delay_that_ends_within_a_period_is_between_those_that_do_not():
    reached = [
        passed(driven(delay=delay), (0.1, 0.0, 0.0), 0.05)[-1].positions[0]
        for delay in (0.02, 0.017, 0.013, 0.01)
    ]
    assert np.all(np.diff(reached) > 0.002)


def test_told_rates_it_moves_by_their_integral_and_lags_by_nothing():
    mechanism = driven(by_rates=True)
    heard = passed(mechanism, (0.5, 0.0, -0.5), 1.0)
    assert heard[-1].rates == pytest.approx((0.5, 0.0, -0.5), abs=1e-6)
    last = passed(mechanism, (0.0, 0.0, 0.0), 0.5)[-1]
    assert last.positions == pytest.approx((0.5, 0.0, -0.5), abs=1e-6)


@pytest.mark.parametrize('by_rates', [False, True])
def test_no_servo_is_sent_out_of_the_range_of_its_joint(by_rates):
    wrist = make_wrist('three_gimbal').with_limits(lower=-0.2, upper=0.3)
    mechanism = driven(wrist=wrist, by_rates=by_rates)
    last = passed(mechanism, (1.0, -1.0, 0.0), 1.0)[-1]
    assert last.positions == pytest.approx((0.3, -0.2, 0.0), abs=1e-6)


def shake(mechanism):
    """Tell a mechanism to go to and fro as far and as quickly as nobody would."""
    told = np.array(mechanism.reading.positions)
    for count in range(500):
        reading = mechanism.advance(told + 0.1 * (-1.0) ** count)
        assert np.isfinite([*reading.positions, *reading.rates, *reading.efforts]).all()


@pytest.mark.parametrize('wrist', MODELS)
def test_what_is_torn_apart_is_said_and_never_read(wrist, tmp_path, monkeypatch):
    monkeypatch.chdir(tmp_path)
    mechanism = driven(wrist, step=0.005, bandwidth=1000.0, gravity=FALLING, payload=1.0)
    with pytest.raises(UnstableError, match=r'^The mechanism was torn apart.*; choose'):
        shake(mechanism)
    assert list(tmp_path.iterdir()) == []


def test_loops_that_are_pulled_open_are_said():
    mechanism = driven('stewart')
    with pytest.raises(UnstableError, match=r'its loops are open by 0\.\d+ m'):
        passed(mechanism, (3.0, 0.3, -3.0, 1.0, 2.0, 0.1), 0.5)


@pytest.mark.parametrize('what', ['positions', 'rates', 'efforts'])
def test_a_number_that_is_none_is_no_reading(what, monkeypatch):
    mechanism = driven()
    monkeypatch.setattr(Mechanism, what, np.array([0.0, math.nan, 0.0]))
    with pytest.raises(UnstableError, match='not every number is finite'):
        mechanism.advance((0.0, 0.0, 0.0))


def test_mujoco_itself_writes_neither_a_file_nor_a_word(tmp_path, monkeypatch, capfd):
    monkeypatch.chdir(tmp_path)
    moved = build(make_wrist('carpal'))
    home = tuple(moved.positions)
    mechanism = DrivenMechanism(
        moved, make_wrist('carpal').joints, Drives(PERIOD, 0.0, [1.0] * 3, [0.0] * 3), home
    )
    moved.data.qvel[:] = 1e12
    with pytest.raises(UnstableError):
        mechanism.advance(home)
    assert list(tmp_path.iterdir()) == []
    assert capfd.readouterr() == ('', '')


def test_what_was_torn_apart_stays_so():
    mechanism = driven(step=0.005, bandwidth=1000.0)
    for _ in range(3):
        with pytest.raises(UnstableError):
            passed(mechanism, (0.5, 0.5, 0.5), 2.0)


def test_a_start_where_the_loops_do_not_close_is_refused():
    with pytest.raises(UnreachableError):
        driven('stewart', start=(0.01,) * 6)
