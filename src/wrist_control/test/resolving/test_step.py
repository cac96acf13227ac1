"""One resolver step: scaling, limits, and the wrist's own part in it."""

import math

import numpy as np
import pytest
from hypothesis import assume, given
from hypothesis import strategies as st

from wrist_control import InvalidValueError, make_wrist
from wrist_control.resolving import LimitKind, start, step
from wrist_control.resolving.state import ZERO_TWIST, resting

WRIST = make_wrist('three_gimbal')
LOCKED = 0.5 * math.pi
H = 1.0 / 32.0

angles = st.floats(-4.0, 4.0)
near_lock = st.builds(
    lambda side, off: side * LOCKED + off, st.sampled_from([-1.0, 1.0]), st.floats(-3e-3, 3e-3)
)
gimbals = st.tuples(angles, st.one_of(angles, near_lock), angles)
twists = st.tuples(*(st.floats(-5.0, 5.0),) * 3)
rate_limits = st.lists(st.one_of(st.floats(0.05, 5.0), st.just(math.inf)), min_size=3, max_size=3)
durations = st.floats(1e-3, 0.1)


@given(gimbals, twists, rate_limits, durations)
def test_no_increment_ever_exceeds_a_rate_limit(at, steps, positions, twist, rates, dt):
    wrist = WRIST.with_limits(rates=rates)
    for made in steps(wrist, at(wrist, positions), twist, 5, dt):
        for joint, rate in zip(wrist.joints, made.joint_rates, strict=True):
            assert abs(rate) <= joint.rate_limit * (1.0 + 2e-9)
        assert 0.0 <= made.scale_factor <= 1.0


@given(gimbals, twists, rate_limits, durations)
def test_away_from_lock_the_hand_keeps_the_commanded_direction(at, positions, twist, rates, dt):
    wrist = WRIST.with_limits(rates=rates)
    made = step(wrist, at(wrist, positions), twist, dt)
    assume(not made.singular)
    asked = made.scale_factor * np.array(twist)
    np.testing.assert_allclose(made.achieved, (0.0, 0.0, 0.0, *asked), atol=1e-10 / dt)


@given(st.tuples(angles, st.floats(-1.2, 1.2), angles), twists, rate_limits)
def test_away_from_lock_the_hand_is_no_slower_than_its_limits_ask(at, positions, twist, rates):
    wrist = WRIST.with_limits(rates=rates)
    made = step(wrist, at(wrist, positions), twist, 1e-6)
    if made.scale_factor < 1.0:
        loads = np.abs(made.joint_rates) / [joint.rate_limit for joint in wrist.joints]
        assert max(loads) == pytest.approx(1.0, rel=1e-3)
        assert made.limits
    else:
        assert made.limits == ()


@given(gimbals, twists, rate_limits, durations)
def test_the_pose_is_always_the_one_of_the_joints(at, positions, twist, rates, dt):
    wrist = WRIST.with_limits(rates=rates)
    before = at(wrist, positions)
    made = step(wrist, before, twist, dt)
    assert made.state.pose == wrist.forward(made.state.positions)
    moved = np.subtract(made.state.positions, before.positions) / dt
    np.testing.assert_allclose(made.joint_rates, moved, atol=1e-12)


@given(gimbals, twists, durations)
def test_the_reported_twist_is_the_one_that_joints_and_jacobian_make(at, positions, twist, dt):
    wrist = WRIST.with_limits(rates=1e-3 / dt)
    made = step(wrist, at(wrist, positions), twist, dt)
    middle = np.array(positions) + 0.5 * dt * np.array(made.joint_rates)
    made_by_joints = WRIST.jacobian(middle) @ made.joint_rates
    np.testing.assert_allclose(made.achieved[3:], made_by_joints, atol=1e-5 / dt * 1e-3)


def test_time_lost_is_the_integral_of_one_minus_f(steps):
    wrist = WRIST.with_limits(rates=(0.3, 0.2, 0.5))
    factors, state = [], start(wrist, (0.1, 1.2, 0.3))
    for made in steps(wrist, state, (0.4, 0.5, -0.6), 100):
        factors.append(made.scale_factor)
    assert min(factors) < 0.9
    assert made.state.time_lost == pytest.approx(H * sum(1.0 - f for f in factors))


@given(gimbals)
def test_no_command_leaves_the_state_itself(at, positions):
    state = at(WRIST, positions)
    for nothing in ((0.0, 0.0, 0.0), (-0.0, 0.0, -0.0)):
        made = step(WRIST, state, nothing, H)
        assert made.state is state
        assert made == resting(WRIST, state)
        assert (made.scale_factor, made.achieved, made.limits) == (1.0, ZERO_TWIST, ())


@pytest.mark.parametrize('bad', [math.nan, math.inf, -math.inf])
@pytest.mark.parametrize('axis', [0, 1, 2])
def test_a_command_that_is_not_finite_is_refused_in_a_sentence(bad, axis):
    twist = [0.1, 0.1, 0.1]
    twist[axis] = bad
    with pytest.raises(InvalidValueError, match=r'command .* is not finite; nothing moves\.'):
        step(WRIST, start(WRIST), twist, H)
    with pytest.raises(InvalidValueError, match='not finite'):
        step(WRIST, start(WRIST), (math.inf, -math.inf, 0.0), H)


@given(gimbals, twists, st.sampled_from([1e-300, 1e-20, 1e20, 1e200]), rate_limits)
def test_a_command_of_any_size_is_followed_within_the_limits(at, positions, twist, size, rates):
    wrist = WRIST.with_limits(rates=rates)
    made = step(wrist, at(wrist, positions), tuple(size * x for x in twist), 0.01)
    for joint, rate in zip(wrist.joints, made.joint_rates, strict=True):
        assert abs(rate) <= joint.rate_limit * (1.0 + 2e-9)
        assert math.isfinite(rate)


# Position limits


@pytest.mark.parametrize('joint', [0, 1, 2])
@pytest.mark.parametrize('side', [1.0, -1.0])
def test_a_position_limit_is_reached_without_overshoot_and_left_freely(steps, joint, side):
    wrist = WRIST.with_limits(lower=-0.5, upper=0.5, rates=2.0)
    twist = [0.0, 0.0, 0.0]
    twist[(2, 1, 0)[joint]] = side * 0.7
    made = list(steps(wrist, start(wrist), twist, 40))
    path = side * np.array([one.state.positions[joint] for one in made])
    assert path.max() <= 0.5 + 1e-9
    assert path[-1] == pytest.approx(0.5, abs=1e-6)
    assert (np.diff(path) >= -1e-12).all()
    assert made[-1].scale_factor < 1e-6
    assert made[-1].limits[0][:2] == (wrist.joints[joint].name, LimitKind.POSITION)
    back = step(wrist, made[-1].state, [-x for x in twist], H)
    assert (back.scale_factor, back.limits) == (1.0, ())


@given(twists, st.lists(st.floats(0.2, 1.2), min_size=3, max_size=3), rate_limits)
def test_at_any_limit_the_opposite_command_moves(steps, twist, reach, rates):
    assume(max(map(abs, twist)) > 0.01)
    wrist = WRIST.with_limits(lower=np.negative(reach), upper=reach, rates=rates)
    *_, last = steps(wrist, start(wrist), twist, 60, 0.05)
    assert all(abs(x) <= most + 2e-9 for x, most in zip(last.state.positions, reach, strict=True))
    back = step(wrist, last.state, [-x for x in twist], 0.05)
    assert back.scale_factor > 0.0
    assert any(back.joint_rates)


@given(gimbals, twists)
def test_a_hand_outside_its_limits_never_goes_further_out(at, positions, twist):
    wrist = WRIST.with_limits(lower=-0.2, upper=0.2, rates=1.0)
    before = at(wrist, positions)
    after = step(wrist, before, twist, H).state
    for old, new in zip(before.positions, after.positions, strict=True):
        assert abs(new) <= max(abs(old), 0.2) + 2e-9


# The wrist's own part


def test_a_pose_out_of_reach_is_approached_by_shorter_steps_and_named(rail, steps):
    class Ending(rail):
        reach = 1.0

    *_, last = steps(Ending(), start(Ending()), (1.0, 0.0, 0.0), 100)
    assert last.state.positions[0] == pytest.approx(1.0, abs=1e-5)
    assert last.state.positions[0] <= 1.0
    (limit,) = last.limits
    assert (limit.kind, limit.joint) == (LimitKind.WORKSPACE, 'end of the rail')
    assert step(Ending(), last.state, (-1.0, 0.0, 0.0), H).scale_factor == 1.0


def test_the_wrist_is_told_the_factor_and_keeps_its_steering_state(rail, steps):
    class Counting(rail):
        def choose_branch_reference(self, positions, factor, dt, steering_state):
            return positions, ((steering_state or (0.0,))[0] + factor,)

    wrist = Counting().with_limits(rates=0.5)
    first, second = steps(wrist, start(wrist), (1.0, 0.0, 0.0), 2)
    assert first.state.steering_state == (0.5,)
    assert second.state.steering_state == (1.0,)


def test_joints_that_lead_nowhere_are_no_motion(nowhere):
    made = step(nowhere, start(nowhere), (1.0, 0.0, 0.0), H)
    assert (made.state.positions, made.scale_factor) == ((0.0,), 0.0)
    assert made.limits[0][:2] == ('no way on', LimitKind.WORKSPACE)
