"""The way back to the start: joint by joint at the rate limits, never by a jump."""

from __future__ import annotations

import math
from collections.abc import Sequence

from wrist_control.errors import InvalidValueError, UnreachableError
from wrist_control.resolving.easing import brought_to_rest, eased
from wrist_control.resolving.feasible import (
    Target,
    overruns_on_the_way_to_rest,
    within_limits,
)
from wrist_control.resolving.limits import LimitAtWork, joint_overruns, smallest_share
from wrist_control.resolving.rate_windows import stopping_time
from wrist_control.resolving.search import largest_share
from wrist_control.resolving.state import State, Step, increments, step_between
from wrist_control.wrists.joint import Joint
from wrist_control.wrists.wrist import Wrist

# Speeds for joints without a rate limit of their own: rad/s, m/s.
CALM = {'revolute': 0.5, 'prismatic': 0.02}
# A way home is looked at in so many places.
PARTS = 100


def step_home(
    wrist: Wrist, state: State, goal: Sequence[float], dt: float, share: float = 1.0
) -> Step:
    """Return a step straight towards joint positions, all arriving together and at rest.

    Args:
        wrist: The mechanism, with the limits to keep.
        state: Where it is.
        goal: Joint positions to go to, rad or m.
        dt: Duration of the step, s.
        share: How fast, 0 to 1: on the way to a stop it is less than as fast as they may.
    """
    if share > 0.0:
        after = _towards(wrist, state, goal, dt, share)
    else:
        after = brought_to_rest(wrist, state, dt)
    return step_between(state, after, dt, 1.0, wrist.margin(state.positions), False, ())


def _towards(wrist: Wrist, state: State, goal: Sequence[float], dt: float, share: float) -> State:
    joints = [_calm(joint) for joint in wrist.joints]
    whole = increments(state.positions, tuple(goal), dt)

    def target(part: float) -> Target:
        if part > 1.0:
            raise UnreachableError('The goal is nearer.', 'goal')
        way = zip(state.positions, goal, strict=True)
        moved = [old + part * (new - old) for old, new in way]
        return wrist.resolve_assembly(moved, state.pose), ()

    # The rates are chosen below, and of an edge it only counts whether it is crossed.
    inside = within_limits(wrist, state, target, math.inf)

    def attempt(part: float) -> tuple[State | None, Sequence[LimitAtWork]]:
        made, broken = inside(part)
        if made is not None:
            broken = overruns_on_the_way_to_rest(wrist, state, made, dt)
        return (None, broken) if broken else (made, broken)

    reach = smallest_share(joint_overruns(joints, state.positions, tuple(goal), share * dt))
    part = min(reach, _largest_part_to_stop_after(stopping_time(wrist.joints, whole) / dt))
    return eased(wrist, state, attempt, largest_share(attempt, part), dt)[1]


def check_way_home(wrist: Wrist, state: State, goal: Sequence[float]) -> None:
    """See that the straight way to joint positions stays inside every limit.

    Args:
        wrist: The mechanism, with the limits to keep.
        state: Where it is.
        goal: Joint positions to go to, rad or m.

    Raises:
        InvalidValueError: It leads over an edge of the workspace.
    """
    begin, near = [*state.positions], state.pose
    for part in range(1, PARTS + 1):
        way = zip(begin, goal, strict=True)
        moved = [old + part / PARTS * (new - old) for old, new in way]
        try:
            positions = wrist.resolve_assembly(moved, near)
            near = wrist.forward(positions)
            crossed = [limit.name for limit in wrist.clearances(positions) if limit.remaining < 0]
        except UnreachableError as error:
            crossed = [error.limit]
        if crossed:
            raise InvalidValueError(
                f'Cannot reset: the straight way back crosses {", ".join(crossed)}; lead the hand '
                'nearer to initial_positions, and call ~/reset again there.'
            )


def _largest_part_to_stop_after(time: float) -> float:
    """Return the part x of the way that leaves space to stop in: x + x² time / 2 = 1.

    Args:
        time: How long stopping would take after all of the way in one step, in steps.
    """
    return 2.0 / (1.0 + math.sqrt(1.0 + 2.0 * time))


def speed_of(wrist: Wrist, taken: Step) -> float:
    """Return how fast a step home was, as a share of how fast it may be, 0 to 1."""
    joints = [_calm(joint) for joint in wrist.joints]
    shares = zip(taken.joint_rates, joints, strict=True)
    return min(1.0, max(abs(rate) / joint.rate_limit for rate, joint in shares))


def has_reached(state: State, goal: Sequence[float]) -> bool:
    """Return whether the joints are where they should be."""
    return max(abs(old - new) for old, new in zip(state.positions, goal, strict=True)) < 1e-9


def _calm(joint: Joint) -> Joint:
    if math.isfinite(joint.rate_limit):
        return joint
    return joint._replace(rate_limit=CALM[joint.kind])
