"""One resolver step: the hand follows the command as fast as every limit allows.

[Barker1986], figures 2 and 3, for any wrist. State in, state out: nothing is remembered here.
"""

from __future__ import annotations

import math
from collections.abc import Callable, Sequence
from typing import NamedTuple, TypeAlias

from wrist_control.errors import InvalidValueError, UnreachableError
from wrist_control.resolving.limits import (
    LimitAtWork,
    LimitKind,
    overruns,
    rate_overruns,
    smallest_share,
)
from wrist_control.resolving.search import Attempt, largest_share
from wrist_control.rotations import Pose, Vector, rates_between, to_hand
from wrist_control.wrists.wrist import Configuration, Positions, Rates, SteeringState, Wrist

# Barker's ε0: below this margin instantaneous rates say nothing and average rates are used.
SINGULAR_MARGIN = 0.001
# Of a command at lock, less than this share is round-off.
ROUNDOFF = 1e-9
# The limits at work that are no joint's and no clearance's: what the mechanism cannot do
# anywhere, and what it cannot do at lock.
MECHANISM, LOCK = 'mechanism', 'lock'

Twist = tuple[float, float, float, float, float, float]
ZERO_TWIST: Twist = (0.0, 0.0, 0.0, 0.0, 0.0, 0.0)
Target: TypeAlias = 'tuple[Positions, SteeringState]'


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
        twist: Commanded twist in hand axes, `wrist.twist_size` values, rad/s and m/s; or six, of
            which a wrist that does not translate leaves the first three out.
        dt: Duration of the step, s.

    Raises:
        InvalidValueError: A command that is not finite; nothing has moved.
    """
    if not math.isfinite(math.hypot(*twist)):
        raise InvalidValueError(f'The command {tuple(twist)} is not finite; nothing moves.')
    if not any(twist):
        return resting(wrist, state)
    margin = wrist.margin(state.positions)
    asked = twist[-wrist.twist_size :]
    if not any(map(asked.__getitem__, wrist.followed_components)):
        return _nothing_possible(wrist, state, twist)
    if margin < SINGULAR_MARGIN:
        return _step_at_lock(wrist, state, asked, dt, margin)
    return _step_along_command(wrist, state, asked, dt, margin)


def _nothing_possible(wrist: Wrist, state: State, twist: Sequence[float]) -> Step:
    """Return the step of a command that the mechanism can do nothing of, here or elsewhere.

    No time is lost: whoever waited for the hand would wait for ever.
    """
    limit = LimitAtWork(MECHANISM, LimitKind.WORKSPACE, math.hypot(*twist), 0.0, 0.0)
    return resting(wrist, state)._replace(scale_factor=0.0, limits=(limit,))


def _step_along_command(
    wrist: Wrist, state: State, twist: Sequence[float], dt: float, margin: float
) -> Step:
    """Scale the command, never its direction. [Barker1986], fig. 3(a)."""

    def target(factor: float) -> Target:
        return _target(wrist, state, twist, factor, dt)

    limits = rate_overruns(wrist.joints, wrist.rates(state.positions, twist))
    factor, after, limits = largest_share(
        _within_limits(wrist, state, target, dt), smallest_share(limits), limits
    )
    return _step_between(state, after or state, dt, factor, margin, False, limits)


def _step_at_lock(
    wrist: Wrist, state: State, twist: Sequence[float], dt: float, margin: float
) -> Step:
    """Turn the joints into place where that helps; where it does not, leave out what is lost.

    Where all three axes are followed, the joints can turn and leave the hand where it is, until
    the lost axis is regained. Those of a pointer spin the hand, and with it whatever is commanded
    about the hand's own axes: what is lost there stays lost.
    """
    if len(wrist.followed_axes) == 3:
        return _step_through_lock(wrist, state, twist, dt, margin)
    lost = LimitAtWork(LOCK, LimitKind.SINGULARITY, margin, SINGULAR_MARGIN, 0.0)
    rest = _without(wrist.lost_axis(state.positions), twist)
    if math.hypot(*rest) <= ROUNDOFF * math.hypot(*twist):
        return _step_between(state, state, dt, 0.0, margin, True, [lost])
    taken = _step_through_lock(wrist, state, rest, dt, margin)
    return taken._replace(limits=(*taken.limits, lost))


def _step_through_lock(
    wrist: Wrist, state: State, twist: Sequence[float], dt: float, margin: float
) -> Step:
    """Scale the joints' way to where the command leads. [Barker1986], fig. 3(b)."""

    def aim(reach: float) -> tuple[Target | None, list[LimitAtWork]]:
        try:
            return _target(wrist, state, twist, reach, dt), []
        except UnreachableError as error:
            return None, [_edge(error)]

    reach, found, limits = largest_share(aim, 1.0)
    goal, steering_state = found or (state.positions, state.steering_state)

    def part_way(share: float) -> Target:
        way = zip(state.positions, goal, strict=True)
        return tuple([old + share * (new - old) for old, new in way]), steering_state

    share, after, limits = largest_share(_within_limits(wrist, state, part_way, dt), 1.0, limits)
    return _step_between(state, after or state, dt, reach * share, margin, True, limits)


def _without(axis: Vector, twist: Sequence[float]) -> list[float]:
    """Return a twist without its rotation about an axis."""
    *linear, p, q, r = twist
    x, y, z = axis
    about = x * p + y * q + z * r
    return [*linear, p - about * x, q - about * y, r - about * z]


def _target(
    wrist: Wrist, state: State, twist: Sequence[float], factor: float, dt: float
) -> Target:
    """Return the joint positions that the scaled command leads to, and the steering state."""
    near, steering_state = wrist.choose_branch_reference(
        state.positions, factor, dt, state.steering_state
    )
    pose = wrist.target_pose(state.pose, [factor * x for x in twist], dt)
    return wrist.inverse(pose, near), steering_state


def _within_limits(
    wrist: Wrist, state: State, target: Callable[[float], Target], dt: float
) -> Attempt[State]:
    """Return what makes the state at a share's target, or tells the limits that it would break."""

    def attempt(share: float) -> tuple[State | None, list[LimitAtWork]]:
        try:
            positions, steering_state = target(share)
            if not math.isfinite(sum(positions)):
                raise UnreachableError('The command leads nowhere.', 'no way on')
            broken = overruns(wrist, state.positions, positions, dt)
            if broken:
                return None, broken
            return State(positions, wrist.forward(positions), steering_state), []
        except UnreachableError as error:
            return None, [_edge(error)]

    return attempt


def _edge(error: UnreachableError) -> LimitAtWork:
    return LimitAtWork(error.limit, LimitKind.WORKSPACE, 0.0, 0.0, 0.0)


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
