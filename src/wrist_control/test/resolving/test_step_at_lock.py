"""One resolver step at lock: through it, late, and never faster than the joints may move."""

import math
from itertools import pairwise

import numpy as np
import pytest
from hypothesis import assume, given
from hypothesis import strategies as st

from wrist_control import make_wrist
from wrist_control.operating.maneuvers import BARKER_SPEED
from wrist_control.resolving import LimitKind, step
from wrist_control.resolving.report import WristState, sentence, state_of

WRIST = make_wrist('three_gimbal')
LOCKED = 0.5 * math.pi
H = 1.0 / 32.0
EPSILON = 0.001  # Barker's ε0
YAW = (0.0, 0.0, BARKER_SPEED)

twists = st.tuples(*(st.floats(-5.0, 5.0),) * 3)


@pytest.fixture(scope='module')
def locked(at):
    """Make the state of a wrist with its middle gimbal at, or near, lock."""
    return lambda wrist, theta=LOCKED: at(wrist, (0.0, theta, 0.0))


def test_without_rate_limits_lock_is_left_in_one_step_and_nothing_is_lost(locked):
    made = step(WRIST, locked(WRIST), YAW, H)
    assert (made.singular, made.scale_factor, made.limits) == (True, 1.0, ())
    np.testing.assert_allclose(np.degrees(made.joint_rates), (90 / H, -32, 90 / H), rtol=1e-9)
    np.testing.assert_allclose(made.achieved[3:], YAW, atol=1e-12)


def test_in_lock_the_joints_move_at_their_limit_and_little_of_the_command_is_followed(
    steps, locked
):
    wrist = WRIST.with_limits(rates=BARKER_SPEED)
    for made in steps(wrist, locked(wrist), YAW, 4):
        assert made.singular
        assert made.scale_factor < 0.02
        assert max(map(abs, made.joint_rates)) == pytest.approx(BARKER_SPEED)
        assert {limit.kind for limit in made.limits} == {LimitKind.RATE}


@given(st.floats(-0.999e-3, 0.999e-3), twists, st.floats(0.05, 5.0))
def test_lock_can_always_be_left(locked, off, twist, limit):
    assume(max(map(abs, twist)) > 0.1)
    wrist = WRIST.with_limits(rates=limit)
    made = step(wrist, locked(wrist, LOCKED + off), twist, H)
    assert made.singular
    assert made.scale_factor > 0.0
    assert any(made.joint_rates)


@given(st.floats(0.0, 0.999e-3), st.floats(0.1, 2.0), st.floats(-3.0, 3.0))
def test_in_lock_the_probe_strays_by_no_more_than_the_margin(steps, locked, off, speed, direction):
    wrist = WRIST.with_limits(rates=BARKER_SPEED)
    twist = (0.0, speed * math.sin(direction), speed * math.cos(direction))
    before = locked(wrist, LOCKED - off)
    probe = before.pose.rotation[0]
    strayed = 0.0
    for made in steps(wrist, before, twist, 200):
        if made.margin >= EPSILON:
            break
        strayed = max(strayed, math.asin(min(1.0, math.hypot(*made.state.pose.rotation[0, :2]))))
    assert np.linalg.norm(probe - (0.0, 0.0, -1.0)) < EPSILON
    one_step = speed * H
    assert strayed <= EPSILON + one_step


def test_a_position_limit_is_named_beside_the_rate_limits_that_are_at_work_with_it(steps, locked):
    wrist = WRIST.with_limits(rates=BARKER_SPEED, lower=-1.7, upper=(1.0, 1.7, 1.2))
    *_, last = steps(wrist, locked(wrist), YAW, 100)
    assert last.state.positions[0] == pytest.approx(1.0, abs=1e-6)
    assert last.scale_factor < 1e-6
    kinds = [(limit.joint, limit.kind) for limit in last.limits]
    assert ('psi', LimitKind.POSITION) in kinds
    assert ('psi', LimitKind.RATE) in kinds
    assert len(kinds) == len(set(kinds))
    back = step(wrist, last.state, tuple(-x for x in YAW), H)
    assert any(back.joint_rates)


POINTER = make_wrist('pitch_yaw').with_limits(rates=BARKER_SPEED)
near_lock = st.floats(-0.999e-3, 0.999e-3)


@given(near_lock, st.floats(-3.0, 3.0), st.floats(-2.0, 2.0))
def test_a_pointer_in_lock_leaves_the_lost_axis_out_and_stays_calm(at, off, spin, q):
    """It would spin about its own z, and q with it: no motion of the joints brings q back."""
    assume(abs(q) > 1e-3)
    state = at(POINTER, (LOCKED + off, spin))
    made = step(POINTER, state, (0.0, q, 0.0), H)
    assert made.state.positions == state.positions
    assert (made.scale_factor, made.singular, any(made.achieved)) == (0.0, True, False)
    (lost,) = made.limits
    assert lost[:4] == ('lock', LimitKind.SINGULARITY, made.margin, EPSILON)
    assert made.state.time_lost == H


@given(near_lock, st.floats(-3.0, 3.0), st.floats(-0.5, 0.5), st.floats(-2.0, 2.0))
def test_a_pointer_in_lock_does_what_it_can_do(at, off, spin, p, q):
    assume(abs(p) > 1e-3)
    made = step(POINTER, at(POINTER, (LOCKED + off, spin)), (p, q, 0.3), H)
    assert made.scale_factor == 1.0
    np.testing.assert_allclose(made.joint_rates, (p, 0.0), atol=1e-6)
    np.testing.assert_allclose(made.achieved[3:], (p, 0.0, 0.0), atol=1e-6)
    assert 'lock' in [limit.joint for limit in made.limits]


@pytest.mark.parametrize('ratio', [0.0, 0.2, 0.3, 0.5, 1.0])
@pytest.mark.parametrize('rate', [10.0, 100.0, 500.0])
def test_a_pointer_that_is_driven_into_lock_turns_back_once_for_each_passage(at, ratio, rate):
    state = at(POINTER, (math.radians(60.0) if ratio else LOCKED, 0.0))
    made = []
    for _ in range(round(40.0 * rate)):
        made.append(step(POINTER, state, (0.3 * ratio, 0.3, 0.0), 1.0 / rate))
        state = made[-1].state
    full = [one.joint_rates[1] for one in made if abs(one.joint_rates[1]) > 0.9 * BARKER_SPEED]
    passages = math.floor(made[-1].state.positions[0] / math.pi + 0.5)
    assert sum(one * other < 0.0 for one, other in pairwise(full)) <= passages
    if ratio == 0.0:
        assert not full
    elif ratio >= 0.5:
        assert made[-1].state.positions[0] > LOCKED + 0.1


# Nearer to lock than 1e-9 it is lock itself for the gimbals; at that, rounding decides.
@given(st.floats(0.0, 0.99e-9), st.floats(0.01, 1.0))
def test_exactly_at_lock_psi_takes_the_turn_that_phi_may_not_make(locked, off, p):
    """There φ stays and ψ takes all: the two turn the hand about the same axis."""
    wrist = WRIST.with_limits(rates=BARKER_SPEED, upper=(9.0, 9.0, 0.0))
    made = step(wrist, locked(wrist, LOCKED - off), (p, 0.0, 0.0), H)
    assert made.state.positions[2] == 0.0
    assert made.scale_factor == pytest.approx(min(1.0, BARKER_SPEED / p))
    assert made.achieved[3] == pytest.approx(min(p, BARKER_SPEED))


@given(st.floats(1.01e-9, 0.999e-3), st.floats(0.01, 1.0))
def test_a_position_limit_at_lock_is_named_and_the_way_back_is_open(locked, off, p):
    wrist = WRIST.with_limits(rates=BARKER_SPEED, upper=(9.0, 9.0, 0.0))
    state = locked(wrist, LOCKED - off)
    made = step(wrist, state, (p, 0.0, 0.0), H)
    assert made.scale_factor < 1e-5
    assert max(map(abs, made.joint_rates)) * H <= 1e-9
    assert state_of(made, (p, 0.0, 0.0)) == WristState.LIMITED
    assert sentence(wrist, made, (p, 0.0, 0.0)) == (
        'phi is at its limit of 0.000 rad; move the other way.'
    )
    assert any(step(wrist, state, (-p, 0.0, 0.0), H).joint_rates)
