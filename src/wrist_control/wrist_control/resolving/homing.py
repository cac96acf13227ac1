"""The way back to the start: joint by joint at the rate limits, never by a jump."""

from __future__ import annotations

import math
from collections.abc import Sequence

from wrist_control.resolving.limits import joint_overruns, smallest_share
from wrist_control.resolving.step import State, Step, resting
from wrist_control.wrists.joint import Joint
from wrist_control.wrists.wrist import Wrist

# Speeds for joints without a rate limit of their own: rad/s, m/s.
CALM = {'revolute': 0.5, 'prismatic': 0.02}


def step_towards(wrist: Wrist, state: State, goal: Sequence[float], dt: float) -> State:
    """Return the state after one step straight towards joint positions, all arriving together.

    Args:
        wrist: The mechanism, with the limits to keep.
        state: Where it is.
        goal: Joint positions to go to, rad or m.
        dt: Duration of the step, s.
    """
    joints = [_calm(joint) for joint in wrist.joints]
    share = smallest_share(joint_overruns(joints, state.positions, tuple(goal), dt))
    way = zip(state.positions, goal, strict=True)
    positions = wrist.resolve_assembly([old + share * (new - old) for old, new in way], state.pose)
    return State(positions, wrist.forward(positions), (), state.time_lost)


def step_home(
    wrist: Wrist, state: State, goal: Sequence[float], dt: float, share: float = 1.0
) -> Step:
    """Return a step of `dt` towards joint positions, with the rates that it was made at.

    Args:
        wrist: The mechanism, with the limits to keep.
        state: Where it is.
        goal: Joint positions to go to, rad or m.
        dt: Duration of the step, s.
        share: How much of the step is made, 0 for none: on the way to a stop it is less than all.
    """
    after = step_towards(wrist, state, goal, share * dt) if share > 0.0 else state
    moved = zip(state.positions, after.positions, strict=True)
    rates = tuple((new - old) / dt for old, new in moved)
    return resting(wrist, after)._replace(joint_rates=rates)


def has_reached(state: State, goal: Sequence[float]) -> bool:
    """Return whether the joints are where they should be."""
    return max(abs(old - new) for old, new in zip(state.positions, goal, strict=True)) < 1e-9


def _calm(joint: Joint) -> Joint:
    if math.isfinite(joint.rate_limit):
        return joint
    return joint._replace(rate_limit=CALM[joint.kind])
