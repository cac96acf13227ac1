"""One resolver step: scaling, limits, lock, and what a start may be."""

import math

import numpy as np
import pytest
from hypothesis import assume, given
from hypothesis import strategies as st

from wrist_control import InvalidValueError, UnreachableError, make_wrist
from wrist_control.operating.maneuvers import BARKER_SPEED
from wrist_control.resolving import LimitKind, State, start, step
from wrist_control.resolving.step import ZERO_TWIST, resting
from wrist_control.wrists import Clearance, Joint, Wrist

WRIST = make_wrist('three_gimbal')
LOCKED = 0.5 * math.pi
H = 1.0 / 32.0
EPSILON = 0.001  # Barker's ε0
YAW = (0.0, 0.0, BARKER_SPEED)

angles = st.floats(-4.0, 4.0)
near_lock = st.builds(
    lambda side, off: side * LOCKED + off, st.sampled_from([-1.0, 1.0]), st.floats(-3e-3, 3e-3)
)
gimbals = st.tuples(angles, st.one_of(angles, near_lock), angles)
twists = st.tuples(*(st.floats(-5.0, 5.0),) * 3)
rate_limits = st.lists(st.one_of(st.floats(0.05, 5.0), st.just(math.inf)), min_size=3, max_size=3)
durations = st.floats(1e-3, 0.1)


def at(wrist, positions):
    """Return the state at rest at any positions, lock included."""
    return State(tuple(positions), wrist.forward(positions))


def steps(wrist, state, twist, count, dt=H):
    """Yield the steps of a command that is held."""
    for _ in range(count):
        made = step(wrist, state, twist, dt)
        yield made
        state = made.state


@given(gimbals, twists, rate_limits, durations)
def test_no_increment_ever_exceeds_a_rate_limit(positions, twist, rates, dt):
    wrist = WRIST.with_limits(rates=rates)
    for made in steps(wrist, at(wrist, positions), twist, 5, dt):
        for joint, rate in zip(wrist.joints, made.joint_rates, strict=True):
            assert abs(rate) <= joint.rate_limit * (1.0 + 2e-9)
        assert 0.0 <= made.scale_factor <= 1.0


@given(gimbals, twists, rate_limits, durations)
def test_away_from_lock_the_hand_keeps_the_commanded_direction(positions, twist, rates, dt):
    wrist = WRIST.with_limits(rates=rates)
    made = step(wrist, at(wrist, positions), twist, dt)
    assume(not made.singular)
    asked = made.scale_factor * np.array(twist)
    np.testing.assert_allclose(made.achieved, (0.0, 0.0, 0.0, *asked), atol=1e-10 / dt)


@given(st.tuples(angles, st.floats(-1.2, 1.2), angles), twists, rate_limits)
def test_away_from_lock_the_hand_is_no_slower_than_its_limits_ask(positions, twist, rates):
    wrist = WRIST.with_limits(rates=rates)
    made = step(wrist, at(wrist, positions), twist, 1e-6)
    if made.scale_factor < 1.0:
        loads = np.abs(made.joint_rates) / [joint.rate_limit for joint in wrist.joints]
        assert max(loads) == pytest.approx(1.0, rel=1e-3)
        assert made.limits
    else:
        assert made.limits == ()


@given(gimbals, twists, rate_limits, durations)
def test_the_pose_is_always_the_one_of_the_joints(positions, twist, rates, dt):
    wrist = WRIST.with_limits(rates=rates)
    before = at(wrist, positions)
    made = step(wrist, before, twist, dt)
    assert made.state.pose == wrist.forward(made.state.positions)
    moved = np.subtract(made.state.positions, before.positions) / dt
    np.testing.assert_allclose(made.joint_rates, moved, atol=1e-12)


@given(gimbals, twists, durations)
def test_the_reported_twist_is_the_one_that_joints_and_jacobian_make(positions, twist, dt):
    wrist = WRIST.with_limits(rates=1e-3 / dt)
    made = step(wrist, at(wrist, positions), twist, dt)
    middle = np.array(positions) + 0.5 * dt * np.array(made.joint_rates)
    made_by_joints = WRIST.jacobian(middle) @ made.joint_rates
    np.testing.assert_allclose(made.achieved[3:], made_by_joints, atol=1e-5 / dt * 1e-3)


def test_time_lost_is_the_integral_of_one_minus_f():
    wrist = WRIST.with_limits(rates=(0.3, 0.2, 0.5))
    factors, state = [], start(wrist, (0.1, 1.2, 0.3))
    for made in steps(wrist, state, (0.4, 0.5, -0.6), 100):
        factors.append(made.scale_factor)
    assert min(factors) < 0.9
    assert made.state.time_lost == pytest.approx(H * sum(1.0 - f for f in factors))


@given(gimbals)
def test_no_command_leaves_the_state_itself(positions):
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
def test_a_command_of_any_size_is_followed_within_the_limits(positions, twist, size, rates):
    wrist = WRIST.with_limits(rates=rates)
    made = step(wrist, at(wrist, positions), tuple(size * x for x in twist), 0.01)
    for joint, rate in zip(wrist.joints, made.joint_rates, strict=True):
        assert abs(rate) <= joint.rate_limit * (1.0 + 2e-9)
        assert math.isfinite(rate)


# Position limits


@pytest.mark.parametrize('joint', [0, 1, 2])
@pytest.mark.parametrize('side', [1.0, -1.0])
def test_a_position_limit_is_reached_without_overshoot_and_left_freely(joint, side):
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
def test_at_any_limit_the_opposite_command_moves(twist, reach, rates):
    assume(max(map(abs, twist)) > 0.01)
    wrist = WRIST.with_limits(lower=np.negative(reach), upper=reach, rates=rates)
    *_, last = steps(wrist, start(wrist), twist, 60, 0.05)
    assert all(abs(x) <= most + 2e-9 for x, most in zip(last.state.positions, reach, strict=True))
    back = step(wrist, last.state, [-x for x in twist], 0.05)
    assert back.scale_factor > 0.0
    assert any(back.joint_rates)


@given(gimbals, twists)
def test_a_hand_outside_its_limits_never_goes_further_out(positions, twist):
    wrist = WRIST.with_limits(lower=-0.2, upper=0.2, rates=1.0)
    before = at(wrist, positions)
    after = step(wrist, before, twist, H).state
    for old, new in zip(before.positions, after.positions, strict=True):
        assert abs(new) <= max(abs(old), 0.2) + 2e-9


# Lock


def locked(wrist, theta=LOCKED):
    return at(wrist, (0.0, theta, 0.0))


def test_without_rate_limits_lock_is_left_in_one_step_and_nothing_is_lost():
    made = step(WRIST, locked(WRIST), YAW, H)
    assert (made.singular, made.scale_factor, made.limits) == (True, 1.0, ())
    np.testing.assert_allclose(np.degrees(made.joint_rates), (90 / H, -32, 90 / H), rtol=1e-9)
    np.testing.assert_allclose(made.achieved[3:], YAW, atol=1e-12)


def test_in_lock_the_joints_move_at_their_limit_and_little_of_the_command_is_followed():
    wrist = WRIST.with_limits(rates=BARKER_SPEED)
    for made in steps(wrist, locked(wrist), YAW, 4):
        assert made.singular
        assert made.scale_factor < 0.02
        assert max(map(abs, made.joint_rates)) == pytest.approx(BARKER_SPEED)
        assert {limit.kind for limit in made.limits} == {LimitKind.RATE}


@given(st.floats(-0.999e-3, 0.999e-3), twists, st.floats(0.05, 5.0))
def test_lock_can_always_be_left(off, twist, limit):
    assume(max(map(abs, twist)) > 0.1)
    wrist = WRIST.with_limits(rates=limit)
    made = step(wrist, locked(wrist, LOCKED + off), twist, H)
    assert made.singular
    assert made.scale_factor > 0.0
    assert any(made.joint_rates)


@given(st.floats(0.0, 0.999e-3), st.floats(0.1, 2.0), st.floats(-3.0, 3.0))
def test_in_lock_the_probe_strays_by_no_more_than_the_margin(off, speed, direction):
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


def test_a_position_limit_is_named_beside_the_rate_limits_that_are_at_work_with_it():
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


# The wrist's own part


class Rail(Wrist):
    """A hand that turns about x by one joint, can be assembled up to 1 rad, and counts steps."""

    default_joints = (Joint('phi'),)
    fence = math.inf

    def forward(self, positions):
        if abs(positions[0]) > 2.0:
            raise UnreachableError('phi beyond 2 rad cannot be assembled')
        return WRIST.forward((0.0, 0.0, positions[0]))

    def inverse(self, pose, near):
        phi = WRIST.inverse(pose, (0.0, 0.0, near[0]))[2]
        if abs(phi) > 1.0:
            raise UnreachableError('Beyond 1 rad the rail ends.', 'end of the rail')
        return (phi,)

    def jacobian(self, positions):
        return np.array([[1.0], [0.0], [0.0]])

    def rates(self, positions, twist):
        return (twist[0],)

    def margin(self, positions):
        return 1.0

    def clearances(self, positions):
        return (Clearance('fence', self.fence - positions[0]),)

    def choose_branch_reference(self, positions, factor, dt, steering_state):
        return positions, ((steering_state or (0.0,))[0] + factor,)


def test_a_pose_out_of_reach_is_approached_by_shorter_steps_and_named():
    *_, last = steps(Rail(), start(Rail()), (1.0, 0.0, 0.0), 100)
    assert last.state.positions[0] == pytest.approx(1.0, abs=1e-5)
    assert last.state.positions[0] <= 1.0
    (limit,) = last.limits
    assert (limit.kind, limit.joint) == (LimitKind.WORKSPACE, 'end of the rail')
    assert step(Rail(), last.state, (-1.0, 0.0, 0.0), H).scale_factor == 1.0


def test_the_wrist_is_told_the_factor_and_keeps_its_steering_state():
    wrist = Rail().with_limits(rates=0.5)
    first, second = steps(wrist, start(wrist), (1.0, 0.0, 0.0), 2)
    assert first.state.steering_state == (0.5,)
    assert second.state.steering_state == (1.0,)


def test_joints_that_lead_nowhere_are_an_error_and_not_a_motion():
    class Nowhere(Rail):
        def inverse(self, pose, near):
            return (math.nan,)

        def forward(self, positions):
            return WRIST.forward((0.0, 0.0, 0.0))

    with pytest.raises(UnreachableError, match='led nowhere; nothing moves'):
        step(Nowhere(), start(Nowhere()), (1.0, 0.0, 0.0), H)


# Starts


def test_a_start_is_at_home_unless_told_otherwise():
    assert start(WRIST) == State((0.0, 0.0, 0.0), WRIST.forward((0.0, 0.0, 0.0)), (), 0.0)
    there = start(WRIST, np.array([0.1, 0.2, 0.3]))
    assert there.positions == (0.1, 0.2, 0.3)
    assert there.pose == WRIST.forward((0.1, 0.2, 0.3))


@pytest.mark.parametrize(
    ('positions', 'sentence'),
    [
        ((0.0, 0.0), r'has 2 values; give one for each of psi, theta, phi\.'),
        ((), r'has 0 values; give one for each of psi, theta, phi\.'),
        ((0.0, 0.0, 1.5), r'has 1\.5 for phi; valid is -1 to 1, and finite\.'),
        ((0.0, -1.1, 0.0), r'has -1\.1 for theta; valid is -1 to 1'),
        ((math.nan, 0.0, 0.0), r'has nan for psi; valid is'),
        ((0.0, math.inf, 0.0), r'has inf for theta; valid is'),
    ],
)
def test_a_start_that_cannot_be_used_is_refused_in_a_sentence(positions, sentence):
    with pytest.raises(InvalidValueError, match=f'initial_positions {sentence}'):
        start(WRIST.with_limits(lower=-1.0, upper=1.0), positions)


def test_a_start_must_be_finite_even_without_limits():
    for endless in (math.inf, -math.inf, math.nan):
        with pytest.raises(InvalidValueError, match='and finite'):
            start(WRIST, (endless, 0.0, 0.0))


@pytest.mark.parametrize('theta', [LOCKED, -LOCKED, LOCKED + 0.5e-3, 3.0 * LOCKED])
def test_a_start_at_lock_is_refused_with_the_margin_it_needs(theta):
    with pytest.raises(InvalidValueError, match=r'are at lock \(margin .*\); start .*0\.001'):
        start(WRIST, (0.0, theta, 0.0))
    start(WRIST, (0.0, theta + 2e-3, 0.0))


def test_a_start_outside_what_the_mechanism_can_do_is_refused():
    with pytest.raises(InvalidValueError, match=r'cannot be taken: phi beyond 2 rad'):
        start(Rail(), (2.5,))

    class Fenced(Rail):
        fence = 0.5

    with pytest.raises(InvalidValueError, match='lie outside: fence; start further inside'):
        start(Fenced(), (0.6,))
    assert start(Fenced(), (0.5,)).positions == (0.5,)
