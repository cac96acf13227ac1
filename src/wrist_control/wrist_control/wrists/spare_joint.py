"""A joint that a wrist has to spare, and how it keeps the others away from lock. [Barker1986]."""

from __future__ import annotations

import math
from collections.abc import Sequence

from wrist_control.wrists.joint import Joint
from wrist_control.wrists.wrist import SteeringState

# The spare joint alone may not use up the rest of any joint's range in less than this, s.
CUSHION = 0.25


def share_of_space(
    joints: Sequence[Joint],
    positions: Sequence[float],
    moves: Sequence[float],
    determinant: float,
    law: float,
) -> float:
    """Return the share of the spare joint's rate that the joints have space for, 0 to 1.

    Turning it turns the others even when the hand stands still. Without the share they would be
    held against a position limit, or it against its own, whatever is commanded.

    Args:
        joints: All joints, with their limits.
        positions: Where they are, rad.
        moves: The determinant times their rates for a spare joint that turns at 1 rad/s and a
            hand at rest: no division at lock.
        determinant: What the rates are divided by; 0 at lock.
        law: The rate that is wanted of the spare joint, rad/s.
    """
    share = 1.0
    for joint, position, move in zip(joints, positions, moves, strict=True):
        speed = move * law
        bound = joint.upper if speed * determinant > 0.0 else joint.lower
        if math.isfinite(bound):
            space = (bound - position) * math.copysign(determinant, speed * determinant)
            fastest = CUSHION * abs(speed)
            if 0.0 < fastest > space:
                share = min(share, max(0.0, space) / fastest)
    return share


def increment(
    law: float, share: float, way: float, steering_state: SteeringState
) -> tuple[float, SteeringState]:
    """Return how far the spare joint goes in a step, rad, by second-order Adams-Bashforth.

    Remembered is the rate at the start of the last step that moved, unscaled, so that the joint
    stands still as F goes to 0. Without one, and near a position limit, Euler's rule is used.
    [Barker1986], fig. 5(a).

    Args:
        law: The rate that is wanted, rad/s.
        share: The share of it that there is space for.
        way: F times the duration of the step, s.
        steering_state: What the step before left.
    """
    rate = share * law
    mean = 1.5 * rate - 0.5 * steering_state[0] if steering_state and share == 1.0 else rate
    return way * mean, (rate,)
