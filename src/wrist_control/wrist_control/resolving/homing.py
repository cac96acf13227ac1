"""The way back to the start: joint by joint at the rate limits, never by a jump."""

from __future__ import annotations

import math
from collections.abc import Sequence

from wrist_control.resolving.easing import brought_to_rest, eased
from wrist_control.resolving.limits import LimitAtWork, joint_overruns, smallest_share
from wrist_control.resolving.rate_windows import stopping_time
from wrist_control.resolving.state import State, Step, increments, step_between
from wrist_control.wrists.joint import Joint
from wrist_control.wrists.wrist import Wrist

# Speeds for joints without a rate limit of their own: rad/s, m/s.
CALM = {'revolute': 0.5, 'prismatic': 0.02}


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

    def attempt(part: float) -> tuple[State | None, list[LimitAtWork]]:
        if part > 1.0:
            return None, []
        way = zip(state.positions, goal, strict=True)
        positions = wrist.resolve_assembly(
            [old + part * (new - old) for old, new in way], state.pose
        )
        return State(positions, wrist.forward(positions)), []

    reach = smallest_share(joint_overruns(joints, state.positions, tuple(goal), share * dt))
    part = min(reach, _largest_part_to_stop_after(stopping_time(wrist.joints, whole) / dt))
    return eased(wrist, state, attempt, (part, attempt(part)[0], []), dt)[1]


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
