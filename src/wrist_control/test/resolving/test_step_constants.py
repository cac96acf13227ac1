"""The numbers of a step where they decide: how little is motion, and how near is lock."""

import math

import pytest

from wrist_control import make_wrist
from wrist_control.resolving import LimitKind, start, step
from wrist_control.resolving.report import sentence

WRIST = make_wrist('three_gimbal')


@pytest.mark.parametrize('left', [0.5, 0.05, 1e-3, 1e-5])
@pytest.mark.parametrize('side', [-1.0, 1.0])
def test_a_joint_goes_all_the_way_to_its_limit_however_small_a_part_of_a_step_is_left(left, side):
    speed, dt = 0.5, 0.02
    wrist = WRIST.with_limits(lower=-0.3, upper=0.3)
    state = start(wrist, (0.0, 0.0, side * (0.3 - left * speed * dt)))
    made = step(wrist, state, (side * speed, 0.0, 0.0), dt)
    assert made.state.positions[2] == pytest.approx(side * 0.3, abs=2e-9)
    assert made.scale_factor == pytest.approx(left, abs=2e-7)
    assert [(limit.joint, limit.kind) for limit in made.limits] == [('phi', LimitKind.POSITION)]


def test_a_joint_that_a_command_leads_away_from_its_limit_and_back_in_one_step_moves():
    """Yaw by a whole radian: θ falls at first, and would end above the limit that it rests on."""
    limit, phi = -0.5, 0.02
    wrist = WRIST.with_limits(upper=(9.0, limit, 9.0))
    state = start(wrist, (0.0, limit, phi))
    sine = [
        math.cos(a) * math.sin(limit) - math.sin(a) * math.cos(limit) * math.sin(phi)
        for a in (0.01, 1.0)
    ]
    assert sine[0] < math.sin(limit) < sine[1]  # what the hand's x axis does, in closed form
    made = step(wrist, state, (0.0, 0.0, 10.0), 0.1)
    assert made.scale_factor > 1e-3
    assert made.achieved[5] > 0.01
    assert made.state.positions[1] < limit


@pytest.mark.parametrize(('margin', 'singular'), [(0.0008, True), (0.0012, False)])
def test_the_singular_region_is_barkers(margin, singular):
    state = start(WRIST, (0.0, 1.0, 0.0))
    positions = (0.0, math.acos(margin), 0.0)
    state = state._replace(positions=positions, pose=WRIST.forward(positions))
    assert step(WRIST, state, (0.1, 0.0, 0.0), 0.01).singular is singular


@pytest.mark.parametrize(('missing', 'told'), [(2e-3, True), (0.5e-3, False)])
@pytest.mark.parametrize('side', [-1.0, 1.0])
def test_a_thousandth_of_a_radian_per_second_that_is_left_out_is_told(missing, told, side):
    wrist = make_wrist('pitch_yaw')
    command = (0.2, 0.0, side * missing)  # at home the pointer cannot roll
    made = step(wrist, start(wrist), command, 0.01)
    assert ('is missing' in sentence(wrist, made, command)) is told


def test_held_at_a_limit_in_lock_it_is_still_said_to_be_in_lock():
    theta = 0.5 * math.pi - 1e-5
    wrist = WRIST.with_limits(upper=(9.0, theta, 9.0))
    positions = (0.0, theta, 0.0)
    state = start(WRIST)._replace(positions=positions, pose=WRIST.forward(positions))
    made = step(wrist, state, (0.0, 0.2, 0.0), 0.01)
    assert (made.singular, made.scale_factor, made.state.positions) == (True, 0.0, positions)
    assert [(limit.joint, limit.kind) for limit in made.limits] == [('theta', LimitKind.POSITION)]
    assert made.state.time_lost == pytest.approx(0.01)


@pytest.mark.parametrize('side', [-1.0, 1.0])
def test_at_its_limit_nothing_moves_and_all_of_the_time_is_lost(side):
    wrist = WRIST.with_limits(lower=-0.3, upper=0.3)
    state = start(wrist, (0.0, 0.0, side * 0.3))
    made = step(wrist, state, (side * 0.5, 0.0, 0.0), 0.02)
    assert (made.scale_factor, made.joint_rates) == (0.0, (0.0, 0.0, 0.0))
    assert made.state == state._replace(time_lost=0.02)
