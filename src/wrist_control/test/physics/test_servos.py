"""A mechanism's servos: told where to go, they go there; what is pushed gives way."""

import math

import numpy as np
import pytest

pytest.importorskip('mujoco', reason='the extra physics is not installed')

from wrist_control import UnreachableError, make_wrist
from wrist_control.errors import UnstableError
from wrist_control.physics.mechanism import Settings
from wrist_control.physics.models import MODELS, build

AIM = (0.2, -0.3, 0.4)


def gimbals(**settings):
    return build(make_wrist('three_gimbal'), Settings(**settings))


@pytest.mark.parametrize('name', MODELS)
def test_a_mechanism_starts_where_it_is_told_without_a_kick(name):
    wrist = make_wrist(name)
    mechanism = build(wrist)
    begin = np.array(tuple(wrist.home)) + 0.02
    mechanism.start_at(begin)
    assert mechanism.positions == pytest.approx(begin, abs=1e-12)
    hand = mechanism.hand_pose
    mechanism.advance(0.2)
    assert mechanism.positions == pytest.approx(begin, abs=1e-9)
    assert np.max(np.abs(mechanism.rates)) < 1e-9
    assert mechanism.hand_pose.position == pytest.approx(hand.position, abs=1e-9)


def test_where_a_loop_cannot_be_closed_it_is_said():
    with pytest.raises(UnreachableError, match='cannot be assembled'):
        build(make_wrist('stewart')).start_at([0.1] * 6)


@pytest.mark.parametrize('bandwidth', [20.0, 100.0])
def test_a_servo_is_as_quick_as_its_bandwidth(bandwidth):
    """Critically damped: 1 - (1 + ωt) exp(-ωt) of the way after t."""
    mechanism = gimbals(bandwidth=bandwidth, step=1e-4)
    mechanism.command((0.0, 0.0, 0.1))
    mechanism.advance(2.0 / bandwidth)
    gone = mechanism.positions[2] / 0.1
    assert gone == pytest.approx(1.0 - 3.0 * math.exp(-2.0), abs=0.01)


def test_less_damping_overshoots():
    mechanism = gimbals(damping_ratio=0.3)
    mechanism.command(AIM)
    mechanism.advance(0.04)
    assert abs(mechanism.positions[2]) > 1.1 * abs(AIM[2])


def test_a_target_that_moves_on_is_followed_without_lag():
    rates = np.array([0.3, -0.2, 0.1])
    mechanism = gimbals()
    mechanism.command_rates(rates)
    mechanism.advance(0.5)
    assert mechanism.rates == pytest.approx(rates, abs=1e-3)
    assert mechanism.target == pytest.approx(0.5 * rates, abs=1e-12)
    assert mechanism.positions == pytest.approx(0.5 * rates, abs=1e-4)
    mechanism.command(mechanism.target)
    assert mechanism.settle()
    assert mechanism.positions == pytest.approx(0.5 * rates, abs=1e-9)


def test_a_servo_does_no_more_than_its_limit():
    mechanism = gimbals(effort_limit=0.5)
    mechanism.command((0.0, 0.0, 1.0))
    mechanism.advance(0.01)
    assert mechanism.efforts == pytest.approx((0.0, 0.0, 0.5), abs=1e-6)


def test_friction_holds_a_joint_that_is_pulled_by_less():
    mechanism = gimbals(friction=2.0, effort_limit=1.0)
    mechanism.command((0.0, 0.0, 1.0))
    mechanism.advance(0.5)
    assert abs(mechanism.positions[2]) < 1e-3
    free = gimbals(effort_limit=1.0)
    free.command((0.0, 0.0, 1.0))
    free.advance(0.5)
    assert free.positions[2] > 0.5


def test_a_push_is_held_by_the_servos():
    mechanism = gimbals()
    mechanism.push((0.0, 0.0, 0.0), (0.01, 0.02, 0.03))
    assert mechanism.settle()
    # At zero the axes are the forearm's z, y, x.
    assert mechanism.efforts == pytest.approx((-0.03, -0.02, -0.01), rel=1e-3)


def test_short_calls_and_long_ones_pass_the_same_time():
    short, long = gimbals(), gimbals()
    for mechanism in (short, long):
        mechanism.command(AIM)
    for _ in range(100):
        short.advance(0.0007)
    long.advance(0.07)
    assert short.data.time == pytest.approx(0.07, abs=1e-9)
    assert short.positions.tolist() == long.positions.tolist()


def test_time_passes_as_told_after_rest_and_after_a_new_start():
    mechanism = gimbals()
    for tenth in range(1, 11):
        mechanism.advance(0.1)
        assert mechanism.data.time == pytest.approx(0.1 * tenth, abs=1e-9)
    mechanism.command(AIM)
    assert mechanism.settle()
    rested = mechanism.data.time
    mechanism.advance(0.1)
    assert mechanism.data.time == pytest.approx(rested + 0.1, abs=1e-9)
    mechanism.start_at(AIM)
    mechanism.advance(0.1)
    assert mechanism.data.time == pytest.approx(0.1, abs=1e-9)


@pytest.mark.parametrize('name', ['omni_wrist', 'carpal', 'five_bar', 'stewart'])
def test_physics_is_the_same_in_every_run(name):
    ends = []
    for _ in range(2):
        mechanism = build(make_wrist(name))
        mechanism.command(mechanism.positions + 0.02)
        mechanism.advance(0.05)
        ends.append(
            (mechanism.positions.tolist(), mechanism.hand_pose, mechanism.hand_twist.tolist())
        )
    assert ends[0] == ends[1]


@pytest.mark.parametrize('name', MODELS)
def test_the_hand_twist_is_how_the_hand_moves(name):
    wrist = make_wrist(name)
    mechanism = build(wrist, Settings(step=1e-4))
    mechanism.start_at(np.array(tuple(wrist.home)) + 0.02)
    mechanism.command_rates([0.1] * len(wrist.joints))
    mechanism.advance(0.1)
    poses = []
    for _ in range(3):
        poses.append((mechanism.hand_pose, mechanism.hand_twist))
        mechanism.advance(1e-4)
    (before, _), (here, twist), (after, _) = poses
    way = np.subtract(after.position, before.position) / 2e-4
    assert here.rotation @ way == pytest.approx(twist[:3], abs=1e-4)
    spin = (after.rotation - before.rotation) @ here.rotation.T / 2e-4
    assert (spin[1, 2], spin[2, 0], spin[0, 1]) == pytest.approx(twist[3:], abs=1e-4)
    assert np.max(np.abs(twist)) > 0.01


def test_what_does_not_come_to_rest_is_said():
    mechanism = gimbals()
    mechanism.command_rates((0.1, 0.0, 0.0))
    assert not mechanism.settle(longest=0.2)


def test_physics_that_is_torn_apart_is_said(tmp_path, monkeypatch):
    monkeypatch.chdir(tmp_path)
    mechanism = build(make_wrist('omni_wrist'), Settings(step=0.005, bandwidth=400.0))
    mechanism.command((3.0, 1.0, -1.0))
    with pytest.raises(UnstableError, match=r'steps of 0\.005 s; choose shorter ones'):
        mechanism.advance(5.0)
    assert list(tmp_path.iterdir()) == []


def test_what_goes_out_of_bounds_is_not_put_back_at_home_in_silence(tmp_path, monkeypatch):
    monkeypatch.chdir(tmp_path)  # where MuJoCo writes a log of it
    mechanism = gimbals()
    mechanism.data.qvel[0] = 1e12
    mechanism.refresh()
    with pytest.raises(UnstableError):
        mechanism.advance(0.01)
