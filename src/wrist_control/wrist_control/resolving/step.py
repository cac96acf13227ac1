"""One resolver step: the hand follows the command as fast as every limit allows.

[Barker1986], figures 2 and 3, for any wrist. State in, state out: nothing is remembered here.
"""

from __future__ import annotations

import math
from collections.abc import Sequence
from typing import NamedTuple

from wrist_control.errors import InvalidValueError, UnreachableError
from wrist_control.resolving.limits import (
    LimitAtWork,
    LimitKind,
    overruns,
    rate_overruns,
    smallest_share,
)
from wrist_control.rotations import Pose, rates_between, to_hand
from wrist_control.wrists.wrist import Configuration, Positions, Rates, SteeringState, Wrist

# Barker's ε0: below this margin instantaneous rates say nothing and average rates are used.
SINGULAR_MARGIN = 0.001
# A step that has not fitted after this many reductions is not made at all.
MOST_REDUCTIONS = 60
# One reduction keeps at least this: a joint resting on its limit can be led away from it and back
# over it within one step, so only shorter steps show whether the command leads away.
SMALLEST_SHARE = 0.1
# Of what the rate limits allow, less than this is no motion.
SMALLEST_FACTOR = 1e-6

Twist = tuple[float, float, float, float, float, float]
ZERO_TWIST: Twist = (0.0, 0.0, 0.0, 0.0, 0.0, 0.0)


class State(NamedTuple):
    """All that one step hands to the next.

    Attributes:
        positions: Joint positions, rad or m; a `Configuration` of a wrist that needs the pose to
            tell its assemblies apart.
        pose: The hand's pose in the forearm frame.
        steering_state: The wrist's own, from `Wrist.choose_branch_reference`.
        time_lost: The integral of 1 − F so far, s.
    """

    positions: Positions
    pose: Pose
    steering_state: SteeringState = ()
    time_lost: float = 0.0


class Step(NamedTuple):
    """What one step did, and why.

    Attributes:
        state: Where everything is afterwards.
        joint_rates: The real increments over dt, rad/s or m/s.
        scale_factor: Barker's F, the share of the command that was followed, 0 to 1.
        margin: How far from singular the wrist was before the step.
        singular: True when the step was made in the singular region.
        limits: Every limit at work.
        achieved: The twist really made, (vx, vy, vz, p, q, r) in hand axes.
    """

    state: State
    joint_rates: Rates
    scale_factor: float
    margin: float
    singular: bool
    limits: tuple[LimitAtWork, ...]
    achieved: Twist


def start(wrist: Wrist, positions: Sequence[float] | None = None) -> State:
    """Return the state of a wrist at rest.

    Args:
        wrist: The mechanism.
        positions: Joint positions to start from, rad or m; the wrist's home when not given.

    Raises:
        InvalidValueError: Wrong number of positions, a value that is not finite or outside its
            limits, a mechanism outside its workspace, or a start at lock.
    """
    names = [joint.name for joint in wrist.joints]
    chosen = wrist.home if positions is None else _settled(positions)
    if len(chosen) != len(names):
        raise InvalidValueError(
            f'initial_positions has {len(chosen)} values; give one for each of {", ".join(names)}.'
        )
    for joint, position in zip(wrist.joints, chosen, strict=True):
        if not joint.lower - 1e-9 <= position <= joint.upper + 1e-9 or math.isinf(position):
            raise InvalidValueError(
                f'initial_positions has {position:g} for {joint.name}; valid is '
                f'{joint.lower:g} to {joint.upper:g}, and finite.'
            )
    try:
        pose = wrist.forward(chosen)
        crossed = [limit.name for limit in wrist.clearances(chosen) if limit.remaining < -1e-9]
    except UnreachableError as error:
        raise InvalidValueError(f'{_start(chosen)} cannot be taken: {error}') from error
    if crossed:
        raise InvalidValueError(
            f'{_start(chosen)} lie outside: {", ".join(crossed)}; start further inside.'
        )
    if wrist.margin(chosen) < SINGULAR_MARGIN:
        raise InvalidValueError(
            f'{_start(chosen)} are at lock (margin {wrist.margin(chosen):.2g}); start '
            f'where the margin is at least {SINGULAR_MARGIN:g}.'
        )
    return State(chosen, pose)


def _settled(positions: Sequence[float]) -> Positions:
    return positions if isinstance(positions, Configuration) else tuple(map(float, positions))


def _start(positions: Positions) -> str:
    return f'initial_positions {tuple(positions)}'


def resting(wrist: Wrist, state: State) -> Step:
    """Return the step in which nothing moves."""
    margin = wrist.margin(state.positions)
    return Step(state, (0.0,) * len(state.positions), 1.0, margin, False, (), ZERO_TWIST)


def step(wrist: Wrist, state: State, twist: Sequence[float], dt: float) -> Step:
    """Return what one step with a commanded hand twist does.

    Args:
        wrist: The mechanism, with the limits to keep.
        state: What the step before left.
        twist: Commanded twist in hand axes, `wrist.twist_size` values, rad/s and m/s.
        dt: Duration of the step, s.

    Raises:
        InvalidValueError: A command that is not finite; nothing has moved.
    """
    if not math.isfinite(math.hypot(*twist)):
        raise InvalidValueError(f'The command {tuple(twist)} is not finite; nothing moves.')
    if not any(twist):
        return resting(wrist, state)
    margin = wrist.margin(state.positions)
    if margin < SINGULAR_MARGIN:
        return _step_through_lock(wrist, state, twist, dt, margin)
    return _step_along_command(wrist, state, twist, dt, margin)


def _step_along_command(
    wrist: Wrist, state: State, twist: Sequence[float], dt: float, margin: float
) -> Step:
    """Scale the command, never its direction. [Barker1986], fig. 3(a)."""
    limits = rate_overruns(wrist.joints, wrist.rates(state.positions, twist))
    factor = smallest_share(limits)
    smallest = SMALLEST_FACTOR * factor
    for _ in range(MOST_REDUCTIONS):
        try:
            positions, steering_state = _target_positions(wrist, state, twist, factor, dt)
        except UnreachableError as error:
            limits = [_edge(error)]
            factor *= 0.5
            continue
        found = overruns(wrist, state.positions, positions, dt)
        if not found:
            after = State(positions, wrist.forward(positions), steering_state, state.time_lost)
            return _step_between(state, after, dt, factor, margin, False, limits)
        limits = _joined(limits, found)
        factor *= max(SMALLEST_SHARE, smallest_share(found))
        if factor < smallest:
            break
    return _step_between(state, state, dt, 0.0, margin, False, limits)


def _step_through_lock(
    wrist: Wrist, state: State, twist: Sequence[float], dt: float, margin: float
) -> Step:
    """Scale the joints' way to where the command leads. [Barker1986], fig. 3(b)."""
    reach, limits = 1.0, []
    goal, steering_state = state.positions, state.steering_state
    for _ in range(MOST_REDUCTIONS):
        try:
            goal, steering_state = _target_positions(wrist, state, twist, reach, dt)
            break
        except UnreachableError as error:
            limits = [_edge(error)]
            reach *= 0.5
    share = 1.0
    for _ in range(MOST_REDUCTIONS):
        positions = tuple(
            old + share * (new - old) for old, new in zip(state.positions, goal, strict=True)
        )
        found = overruns(wrist, state.positions, positions, dt)
        if not found:
            after = State(positions, wrist.forward(positions), steering_state, state.time_lost)
            return _step_between(state, after, dt, reach * share, margin, True, limits)
        limits = _joined(limits, found)
        share *= smallest_share(found)
        if share == 0.0:
            break
    return _step_between(state, state, dt, 0.0, margin, True, limits)


def _target_positions(
    wrist: Wrist, state: State, twist: Sequence[float], factor: float, dt: float
) -> tuple[Positions, SteeringState]:
    """Return the joint positions that the scaled command leads to, and the steering state."""
    near, steering_state = wrist.choose_branch_reference(
        state.positions, factor, dt, state.steering_state
    )
    pose = wrist.target_pose(state.pose, [factor * x for x in twist], dt)
    return wrist.inverse(pose, near), steering_state


def _step_between(
    before: State,
    after: State,
    dt: float,
    factor: float,
    margin: float,
    singular: bool,
    limits: Sequence[LimitAtWork],
) -> Step:
    joint_rates = tuple(
        [(new - old) / dt for old, new in zip(before.positions, after.positions, strict=True)]
    )
    if not math.isfinite(sum(joint_rates)):
        raise UnreachableError(
            f'The step from {tuple(before.positions)} led nowhere; nothing moves.', 'no way on'
        )
    lost = before.time_lost + (1.0 - factor) * dt
    state = State(after.positions, after.pose, after.steering_state, lost)
    achieved = _twist_between(before.pose, after.pose, dt)
    return Step(state, joint_rates, factor, margin, singular, tuple(limits), achieved)


def _twist_between(before: Pose, after: Pose, dt: float) -> Twist:
    (x0, y0, z0), (x1, y1, z1) = before.position, after.position
    p, q, r = rates_between(before.quaternion, after.quaternion, dt)
    if before.position == after.position:
        return (0.0, 0.0, 0.0, p, q, r)
    travel = ((x1 - x0) / dt, (y1 - y0) / dt, (z1 - z0) / dt)
    vx, vy, vz = to_hand(before.quaternion, travel)
    return (vx, vy, vz, p, q, r)


def _joined(limits: list[LimitAtWork], found: list[LimitAtWork]) -> list[LimitAtWork]:
    """Return all limits, each kind once for a joint: as the whole command asked for it."""
    known = {(limit.joint, limit.kind) for limit in limits}
    return limits + [limit for limit in found if (limit.joint, limit.kind) not in known]


def _edge(error: UnreachableError) -> LimitAtWork:
    return LimitAtWork(error.limit, LimitKind.WORKSPACE, 0.0, 0.0, 0.0)
