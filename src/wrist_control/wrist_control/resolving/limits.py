"""Which limits a step would overrun, and by how much it must shrink to keep them."""

from __future__ import annotations

import math
from collections.abc import Sequence
from enum import IntEnum
from typing import NamedTuple

from wrist_control.wrists.joint import Joint
from wrist_control.wrists.wrist import Clearance, Positions, Rates, Wrist

# A limit counts as kept within this, rad or m: round-off, not motion. Relative for rates.
TOLERANCE = 1e-9
RATE_TOLERANCE = 1.0 + TOLERANCE
# Beyond that a step may go this much further out, so that many steps cannot creep away.
ROUNDOFF = 1e-12


class LimitKind(IntEnum):
    """What kind of limit is at work; the values are those of the LimitAtWork message."""

    RATE = 0
    POSITION = 1
    WORKSPACE = 2
    SINGULARITY = 3
    ACCELERATION = 4


class LimitAtWork(NamedTuple):
    """One limit that holds the hand back.

    Attributes:
        joint: Name of the joint, or of the clearance for a limit of the whole wrist.
        kind: Which kind of limit.
        asked: What the command asked for: a rate, a position, or what is left of a clearance.
        allowed: What the limit allows of the same.
        share: The share of the step, 0 to 1, that keeps this limit.
    """

    joint: str
    kind: LimitKind
    asked: float
    allowed: float
    share: float


def rate_overruns(joints: Sequence[Joint], rates: Rates) -> list[LimitAtWork]:
    """Return the joints that would have to move faster than they may."""
    return [
        _rate_at_work(name, rate, limit)
        for (name, _, _, _, limit, *_), rate in zip(joints, rates, strict=True)
        if abs(rate) > limit * RATE_TOLERANCE
    ]


def joint_overruns(
    joints: Sequence[Joint], before: Positions, after: Positions, dt: float
) -> list[LimitAtWork]:
    """Return the joints that would move too fast, leave their range, or go further outside it."""
    found = []
    for (name, _, lower, upper, limit, *_), old, new in zip(joints, before, after, strict=True):
        if abs(new - old) > limit * dt * RATE_TOLERANCE:
            found.append(_rate_at_work(name, (new - old) / dt, limit))
        if not lower - TOLERANCE <= new <= upper + TOLERANCE:
            bound = max(upper, old) if new > old else min(lower, old)
            if abs(new - old) > abs(bound - old) + ROUNDOFF:
                share = (bound - old) / (new - old)
                found.append(LimitAtWork(name, LimitKind.POSITION, new, bound, share))
    return found


def _rate_at_work(name: str, rate: float, limit: float) -> LimitAtWork:
    return LimitAtWork(name, LimitKind.RATE, rate, math.copysign(limit, rate), limit / abs(rate))


def clearance_overruns(
    before: Sequence[Clearance], after: Sequence[Clearance], dt: float
) -> list[LimitAtWork]:
    """Return the limits of the whole wrist that would be crossed, or approached too fast."""
    found = []
    for old, new in zip(before, after, strict=True):
        remaining = max(old.remaining, 0.0)
        kept = remaining * max(0.0, 1.0 - dt / old.horizon) if old.horizon > 0.0 else 0.0
        if new.remaining < min(kept - TOLERANCE, old.remaining - ROUNDOFF):
            bound = min(kept, old.remaining)
            share = (old.remaining - bound) / (old.remaining - new.remaining)
            found.append(LimitAtWork(old.name, LimitKind.WORKSPACE, new.remaining, bound, share))
    return found


def overruns(wrist: Wrist, before: Positions, after: Positions, dt: float) -> list[LimitAtWork]:
    """Return every limit that a step from one set of joint positions to another would overrun."""
    found = joint_overruns(wrist.joints, before, after, dt)
    clearances = wrist.clearances(after)
    if clearances:
        found += clearance_overruns(wrist.clearances(before), clearances, dt)
    return found


def smallest_share(limits: Sequence[LimitAtWork]) -> float:
    """Return the share of a step that keeps all of these limits, 1 when there are none."""
    return min([limit.share for limit in limits], default=1.0)
