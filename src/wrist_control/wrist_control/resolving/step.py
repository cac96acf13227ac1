"""One resolver step: the hand follows the command as fast as every limit allows.

[Barker1986], figures 2 and 3, for any wrist. State in, state out: nothing is remembered here.
"""

from __future__ import annotations

import math
from collections.abc import Sequence

from wrist_control.errors import InvalidValueError, UnreachableError
from wrist_control.resolving.easing import brought_to_rest, eased
from wrist_control.resolving.feasible import Target, edge, within_limits
from wrist_control.resolving.limits import (
    LimitAtWork,
    LimitKind,
    rate_overruns,
    smallest_share,
)
from wrist_control.resolving.search import largest_share
from wrist_control.resolving.state import State, Step, resting, step_between
from wrist_control.rotations import Vector
from wrist_control.wrists.wrist import Configuration, Positions, Wrist

# Barker's ε0: below this margin instantaneous rates say nothing and average rates are used.
SINGULAR_MARGIN = 0.001
# Of a command at lock, less than this share is round-off.
ROUNDOFF = 1e-9
# The limits at work that are no joint's and no clearance's: what the mechanism cannot do
# anywhere, and what it cannot do at lock.
MECHANISM, LOCK = 'mechanism', 'lock'


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
        return _without_command(wrist, state, dt)
    margin = wrist.margin(state.positions)
    asked = twist[-wrist.twist_size :]
    if not any(map(asked.__getitem__, wrist.followed_components)):
        return _nothing_possible(wrist, state, twist, dt)
    if margin < SINGULAR_MARGIN:
        return _step_at_lock(wrist, state, asked, dt, margin)
    return _step_along_command(wrist, state, asked, dt, margin)


def _without_command(wrist: Wrist, state: State, dt: float) -> Step:
    """Return the step of a hand that nothing is asked of: it stands still, or comes to rest."""
    after = brought_to_rest(wrist, state, dt)
    if after is state:
        return resting(wrist, state)
    return step_between(state, after, dt, 1.0, wrist.margin(state.positions), False, ())


def _nothing_possible(wrist: Wrist, state: State, twist: Sequence[float], dt: float) -> Step:
    """Return the step of a command that the mechanism can do nothing of, here or elsewhere.

    No time is lost: whoever waited for the hand would wait for ever.
    """
    limit = LimitAtWork(MECHANISM, LimitKind.WORKSPACE, math.hypot(*twist), 0.0, 0.0)
    return _without_command(wrist, state, dt)._replace(scale_factor=0.0, limits=(limit,))


def _step_along_command(
    wrist: Wrist, state: State, twist: Sequence[float], dt: float, margin: float
) -> Step:
    """Scale the command, never its direction. [Barker1986], fig. 3(a)."""

    def target(factor: float) -> Target:
        return _target(wrist, state, twist, factor, dt)

    limits = rate_overruns(wrist.joints, wrist.rates(state.positions, twist))
    attempt = within_limits(wrist, state, target, dt)
    found = largest_share(attempt, smallest_share(limits), limits)
    factor, after, limits = eased(wrist, state, attempt, found, dt)
    return step_between(state, after, dt, factor, margin, False, limits)


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
        after = brought_to_rest(wrist, state, dt)
        return step_between(state, after, dt, 0.0, margin, True, [lost])
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
            return None, [edge(error)]

    reach, found, limits = largest_share(aim, 1.0)
    goal, steering_state = found or (state.positions, state.steering_state)

    def part_way(share: float) -> Target:
        way = zip(state.positions, goal, strict=True)
        return tuple([old + share * (new - old) for old, new in way]), steering_state

    attempt = within_limits(wrist, state, part_way, dt)
    part = largest_share(attempt, 1.0, limits)
    share, after, limits = eased(wrist, state, attempt, part, dt)
    return step_between(state, after, dt, reach * share, margin, True, limits)


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
