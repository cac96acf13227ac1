"""The rules that every motion of joints is judged by, in the library and on the topics."""

from __future__ import annotations

import math
from collections.abc import Iterable, Iterator, Sequence

from wrist_control.testing.eased import stopping_time, time_to_change
from wrist_control.wrists import Clearance, Joint

# Rates and the time that their changes need: relative.
SLACK = 1.0 + 1e-6
# Positions, rad or m, and what is left of a clearance: `limits` keeps 1e-9 of each, and many
# steps may each creep out by a thousandth of that.
POSITION_SLACK = 1.5e-9
# What rounding makes of a position of 1 rad or m; divided by a short step it is a rate.
ROUNDING = 4e-15


def are_finite(values: Iterable[float]) -> bool:
    """Return whether all values are finite."""
    return all(map(math.isfinite, values))


def broken_limits(
    joints: Sequence[Joint],
    start: Sequence[float],
    positions: Sequence[float],
    before: Sequence[float],
    rates: Sequence[float],
    dt: float,
) -> Iterator[str]:
    """Yield a sentence for every limit of the joints that a step has broken.

    Args:
        joints: The joints, with their limits.
        start: Where they were at the beginning: who was outside then may be no further outside.
        positions: Where they are after the step, rad or m.
        before: Their rates in the step before, rad/s or m/s.
        rates: Their rates in this step.
        dt: Duration of the step, s.
    """
    for joint, began, at, old, new in zip(joints, start, positions, before, rates, strict=True):
        if not abs(new) <= joint.rate_limit * SLACK:
            yield f'{joint.name} moves at {new!r}, limit {joint.rate_limit!r}'
        lower, upper = min(joint.lower, began), max(joint.upper, began)
        if not lower - POSITION_SLACK <= at <= upper + POSITION_SLACK:
            yield f'{joint.name} is at {at!r}, limits {joint.lower!r} to {joint.upper!r}'
        needed = time_to_change(joint, old, new)
        if not needed <= dt * SLACK:
            least = min(joint.acceleration_limit, joint.deceleration_limit)
            if not needed <= dt * SLACK + ROUNDING * (1.0 + abs(at)) / dt / least:
                yield f'{joint.name} goes from {old!r} to {new!r}, {needed / dt:.6f} steps'


def broken_clearances(start: Sequence[Clearance], after: Sequence[Clearance]) -> Iterator[str]:
    """Yield a sentence for every clearance that is overdrawn, by more than at the beginning."""
    for began, now in zip(start, after, strict=True):
        if not now.remaining >= min(0.0, began.remaining) - POSITION_SLACK:
            yield f'{now.name} is overdrawn: {now.remaining!r} is left'


def speeds_up(before: Sequence[float], rates: Sequence[float], dt: float) -> bool:
    """Return whether a joint is faster than before, or goes the other way: not on a way to rest.

    Args:
        before: The rates in the step before, rad/s or m/s.
        rates: The rates of this step.
        dt: Duration of the step, s.
    """
    return any(
        abs(new) > abs(old) * SLACK + 10.0 * ROUNDING / dt
        or (new * old < 0.0 and abs(new) > 10.0 * ROUNDING / dt)
        for old, new in zip(before, rates, strict=True)
    )


def stopping_steps(joints: Sequence[Joint], rates: Sequence[float], dt: float) -> float:
    """Return within how many steps joints can be at rest that have these rates."""
    return stopping_time(joints, rates) / dt
