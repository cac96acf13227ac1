"""Laws that hold for every registered wrist, whatever its joints, freedoms and limits."""

import math

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from wrist_control import WRISTS, make_wrist
from wrist_control.resolving import start, step
from wrist_control.rotations import rates_between

DT = 0.05
# How far the joints may go from home, and how fast, by kind of joint: rad and m.
RANGE = {'revolute': 0.6, 'prismatic': 0.03}
SPEED = {'revolute': 1.0, 'prismatic': 0.05}
REACH = 0.1  # m, so that random linear rates fit random angular ones

every_wrist = pytest.mark.parametrize('wrist', [make_wrist(name) for name in WRISTS], ids=WRISTS)
few = settings(max_examples=15)
commands = st.lists(st.tuples(*(st.floats(-1.5, 1.5),) * 6), min_size=1, max_size=8)


def twist_of(wrist, command):
    """Return a command of six numbers as a twist for the wrist, at least 0.01 rad/s."""
    if max(map(abs, command[3:])) < 0.01:
        command = (0.0, 0.0, 0.0, 0.3, 0.2, 0.1)
    linear = tuple(REACH * x for x in command[:3])
    return (*linear, *command[3:])[-wrist.twist_size :]


def walk(wrist, commands, steps=6):
    """Yield the state before, the twist and the step of a flight under random commands."""
    state = start(wrist)
    for command in commands:
        twist = twist_of(wrist, command)
        for _ in range(steps):
            made = step(wrist, state, twist, DT)
            yield state, twist, made
            state = made.state


def end_of(wrist, commands):
    """Return a random state that the wrist can reach from home, away from lock."""
    regular = start(wrist)
    for _, _, made in walk(wrist, commands):
        if wrist.margin(made.state.positions) > 0.05:
            regular = made.state
    return regular


def confined(wrist):
    """Return the wrist with rate limits, and position limits around its home."""
    spread = np.array([RANGE[joint.kind] for joint in wrist.joints])
    return wrist.with_limits(
        rates=[SPEED[joint.kind] for joint in wrist.joints],
        lower=np.array(wrist.home) - spread,
        upper=np.array(wrist.home) + 0.7 * spread,
    )


def twist_between(wrist, before, after, dt):
    angular = rates_between(before.quaternion, after.quaternion, dt)
    travel = (np.array(after.position) - before.position) / dt
    linear = before.rotation @ travel
    return np.array([*linear, *angular])[-wrist.twist_size :]


@every_wrist
def test_home_is_a_place_to_start_from(wrist):
    state = start(wrist)
    assert wrist.margin(state.positions) > 0.01
    assert all(clearance.remaining >= 0.0 for clearance in wrist.clearances(state.positions))


@every_wrist
@few
@given(commands)
def test_jacobian_is_the_finite_difference_of_forward(wrist, commands):
    positions = end_of(wrist, commands).positions
    middle = wrist.forward(positions)
    h = 1e-6
    columns = []
    for step_along_joint in h * np.eye(len(positions)):
        ahead = wrist.forward(tuple(np.array(positions) + step_along_joint))
        behind = wrist.forward(tuple(np.array(positions) - step_along_joint))
        forth = twist_between(wrist, middle, ahead, h)
        back = twist_between(wrist, middle, behind, h)
        columns.append((forth - back) / 2.0)
    jacobian = wrist.jacobian(positions)
    assert jacobian.shape == (wrist.twist_size, len(positions))
    np.testing.assert_allclose(jacobian, np.array(columns).T, atol=1e-6 * np.abs(jacobian).max())


@every_wrist
@few
@given(commands, st.lists(st.floats(-1.0, 1.0), min_size=6, max_size=6))
def test_rates_make_every_twist_that_the_joints_can_make(wrist, commands, speeds):
    positions = end_of(wrist, commands).positions
    jacobian = wrist.jacobian(positions)
    possible = jacobian @ speeds[: len(positions)]
    made = jacobian @ wrist.rates(positions, tuple(possible))
    np.testing.assert_allclose(made, possible, atol=1e-9 * (1.0 + np.abs(possible).max()))


@every_wrist
@few
@given(commands)
def test_inverse_of_forward_gives_the_joints_back(wrist, commands):
    state = end_of(wrist, commands)
    found = wrist.inverse(wrist.forward(state.positions), state.positions)
    np.testing.assert_allclose(found, state.positions, atol=1e-9)


@every_wrist
@few
@given(commands)
def test_margin_and_lost_axis_are_what_they_say(wrist, commands):
    positions = end_of(wrist, commands).positions
    assert 0.0 < wrist.margin(positions) <= 1.0 + 1e-12
    assert math.hypot(*wrist.lost_axis(positions)) == pytest.approx(1.0)


@every_wrist
@few
@given(commands)
def test_no_step_ever_breaks_a_limit(wrist, commands):
    wrist = confined(wrist)
    for before, _, made in walk(wrist, commands):
        after = made.state
        for joint, position, rate in zip(
            wrist.joints, after.positions, made.joint_rates, strict=True
        ):
            assert abs(rate) <= joint.rate_limit * (1.0 + 1e-6)
            assert joint.lower - 2e-9 <= position <= joint.upper + 2e-9
        assert all(clearance.remaining >= -2e-9 for clearance in wrist.clearances(after.positions))
        assert 0.0 <= made.scale_factor <= 1.0
        assert after.time_lost >= before.time_lost
        assert math.isfinite(sum(after.positions) + sum(made.achieved) + made.margin)


@every_wrist
@few
@given(commands)
def test_hand_slows_but_keeps_its_direction(wrist, commands):
    wrist = confined(wrist)
    follows = np.linalg.matrix_rank(wrist.jacobian(wrist.home)) == wrist.twist_size
    for _, twist, made in walk(wrist, commands):
        if not follows or made.singular:
            continue
        achieved = np.array(made.achieved[-wrist.twist_size :])
        np.testing.assert_allclose(achieved, made.scale_factor * np.array(twist), atol=1e-7)


@every_wrist
@few
@given(commands)
def test_no_command_leaves_everything_as_it_is(wrist, commands):
    state = end_of(wrist, commands)
    made = step(wrist, state, (0.0,) * wrist.twist_size, DT)
    assert made.state == state
    assert made.scale_factor == 1.0
    assert not any(made.joint_rates)


@every_wrist
@few
@given(commands)
def test_a_hand_that_runs_into_a_limit_can_back_out(wrist, commands):
    """Only the way back is promised: in a corner of two limits other ways may be closed."""
    wrist = confined(wrist)
    came_by = None
    for _, twist, made in walk(wrist, commands):
        if made.scale_factor < 1e-3 and twist == came_by:
            for share in (1.0, 0.1):
                back = step(wrist, made.state, tuple(-share * x for x in twist), DT)
                assert back.scale_factor > 0.0
                assert any(back.joint_rates)
        came_by = twist if made.scale_factor > 0.05 else None
