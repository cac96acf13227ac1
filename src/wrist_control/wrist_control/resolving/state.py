"""What one resolver step hands to the next, and what it tells."""

from __future__ import annotations

from collections.abc import Sequence
from typing import NamedTuple

from wrist_control.resolving.limits import LimitAtWork
from wrist_control.rotations import Pose, rates_between, to_hand
from wrist_control.wrists.wrist import Positions, Rates, SteeringState, Wrist

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
        joint_rates: How fast the joints moved in the step before, rad/s or m/s; empty at rest.
    """

    positions: Positions
    pose: Pose
    steering_state: SteeringState = ()
    time_lost: float = 0.0
    joint_rates: Rates = ()


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


def resting(wrist: Wrist, state: State) -> Step:
    """Return the step in which nothing moves."""
    margin = wrist.margin(state.positions)
    if state.joint_rates:
        state = state._replace(joint_rates=())
    return Step(state, (0.0,) * len(state.positions), 1.0, margin, False, (), ZERO_TWIST)


def increments(before: Positions, after: Positions, dt: float) -> Rates:
    """Return the rates that lead from one set of joint positions to another, rad/s or m/s."""
    return tuple([(new - old) / dt for old, new in zip(before, after, strict=True)])


def step_between(
    before: State,
    after: State,
    dt: float,
    factor: float,
    margin: float,
    singular: bool,
    limits: Sequence[LimitAtWork],
) -> Step:
    """Return the step that leads from one state to another.

    Args:
        before: Where it begins.
        after: Where it ends; time lost and joint rates are filled in.
        dt: Duration of the step, s.
        factor: F.
        margin: How far from singular the wrist was before.
        singular: True when the step was made in the singular region.
        limits: Every limit at work.
    """
    joint_rates = increments(before.positions, after.positions, dt)
    lost = before.time_lost + (1.0 - factor) * dt
    kept = joint_rates if any(joint_rates) else ()
    state = State(after.positions, after.pose, after.steering_state, lost, kept)
    achieved = twist_between(before.pose, after.pose, dt)
    return Step(state, joint_rates, factor, margin, singular, tuple(limits), achieved)


def twist_between(before: Pose, after: Pose, dt: float) -> Twist:
    """Return the constant twist that leads from one pose to another, axes of the first hand."""
    (x0, y0, z0), (x1, y1, z1) = before.position, after.position
    p, q, r = rates_between(before.quaternion, after.quaternion, dt)
    if before.position == after.position:
        return (0.0, 0.0, 0.0, p, q, r)
    travel = ((x1 - x0) / dt, (y1 - y0) / dt, (z1 - z0) / dt)
    vx, vy, vz = to_hand(before.quaternion, travel)
    return (vx, vy, vz, p, q, r)
