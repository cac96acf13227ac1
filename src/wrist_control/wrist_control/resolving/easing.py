"""Steps of joints whose rates cannot change at once.

Of the factors that keep the change of every joint's rate within its limits, the largest is taken:
the hand keeps the commanded direction. Where there is none, the joints take the rates nearest to
it. Every step leaves space to stop in, so stopping is always possible.
"""

from __future__ import annotations

import math
from collections.abc import Sequence
from typing import TypeAlias

from wrist_control.resolving.feasible import Target, within_limits
from wrist_control.resolving.limits import (
    RATE_TOLERANCE,
    TOLERANCE,
    LimitAtWork,
    LimitKind,
)
from wrist_control.resolving.rate_windows import (
    Window,
    common_factors,
    nearest_factor,
    rate_windows,
    stopping_time,
)
from wrist_control.resolving.search import Attempt, largest_share
from wrist_control.resolving.state import State, increments
from wrist_control.wrists.joint import Joint
from wrist_control.wrists.wrist import Rates, Wrist

# What `largest_share` finds: a share, what it makes, and every limit at work.
Found: TypeAlias = 'tuple[float, State | None, list[LimitAtWork]]'

# The factor is exact after few corrections where the way of a step is nearly straight, and after
# so many beside an edge, where the joints go with a root of the factor.
CORRECTIONS = 8
# Rates that are less than this share of those that there are can be nothing but rest.
ROUNDOFF = 1e-12
# By which powers of the factor a rate goes, at least and at most.
POWERS = (0.25, 4.0)


def eased(
    wrist: Wrist, state: State, attempt: Attempt[State], found: Found, dt: float
) -> tuple[float, State, list[LimitAtWork]]:
    """Return the factor and the state of a step that changes no joint's rate too quickly.

    Args:
        wrist: The mechanism, with the limits to keep.
        state: Where it is, and how fast it was in the step before.
        attempt: Makes the state at a factor.
        found: The largest factor that keeps all other limits, its state, and the limits at work.
        dt: Duration of the step, s.
    """
    factor, wanted, limits = found
    if wanted is None or not wrist.limits_acceleration:
        return factor, wanted or brought_to_rest(wrist, state, dt), limits
    rates = increments(state.positions, wanted.positions, dt)
    if _is_nothing_beside(state.joint_rates, rates):
        return factor, brought_to_rest(wrist, state, dt), limits
    windows = rate_windows(wrist.joints, state.joint_rates, dt)
    held = _held_back(wrist.joints, state.joint_rates, rates, windows, dt)
    if not held:
        return factor, wanted, limits
    limits = [*limits, *held]
    along = _along_command(state, attempt, factor, wanted, windows, dt)
    if along:
        return min(1.0, along[0]), along[1], limits
    share = _nearest_share(rates, windows)
    nearest = [window.nearest(share * rate) for rate, window in zip(rates, windows, strict=True)]
    return min(1.0, share * factor), _near(wrist, state, wanted, nearest, dt), limits


def _is_nothing_beside(before: Rates, wanted: Rates) -> bool:
    """Return whether what is wanted is no motion beside the one that there is."""
    return max(map(abs, wanted)) < ROUNDOFF * max(map(abs, before), default=0.0)


def brought_to_rest(wrist: Wrist, state: State, dt: float) -> State:
    """Return the state after a step of slowing down, all joints together on a straight line.

    What was left to stop in may not be enough any more, when a limit was lowered: then the limit
    is kept, and the joints stop sooner than they should.
    """
    way = _braking(wrist, state.joint_rates, dt)
    if not any(way):
        return state

    def target(share: float) -> Target:
        moved = [at + share * rate * dt for at, rate in zip(state.positions, way, strict=True)]
        return wrist.resolve_assembly(moved, state.pose), state.steering_state

    # In endless time no rate is too fast, and no edge is neared too quickly: only where counts.
    return largest_share(within_limits(wrist, state, target, math.inf), 1.0)[1] or state


def _braking(wrist: Wrist, rates: Rates, dt: float) -> list[float]:
    """Return the rates one step nearer to rest."""
    if not any(rates):
        return []
    time = stopping_time(wrist.joints, rates)
    left = 1.0 - dt / time if time > dt * RATE_TOLERANCE else 0.0
    return [left * rate for rate in rates]


def _along_command(
    state: State,
    attempt: Attempt[State],
    factor: float,
    wanted: State,
    windows: Sequence[Window],
    dt: float,
) -> tuple[float, State] | None:
    """Return the factor that brings all rates inside their windows, and its state, or None."""
    made: State | None = wanted
    power, moved, before, first = 1.0, 0.0, 0.0, factor
    for _ in range(CORRECTIONS):
        if made is None:
            break
        rates = increments(state.positions, made.positions, dt)
        smallest, largest = common_factors(rates, windows)
        if smallest > largest * RATE_TOLERANCE or largest <= 0.0:
            break
        missing = math.log(min(max(1.0, smallest), largest))
        if abs(missing) <= TOLERANCE:
            return factor, made
        if moved:
            least, most = POWERS
            power = min(max((before - missing) / moved, least), most)
        moved, before = missing / power, missing
        factor *= math.exp(moved)
        if factor * ROUNDOFF > first:
            break
        made, _ = attempt(factor)
    return None


def _nearest_share(rates: Rates, windows: Sequence[Window]) -> float:
    smallest, largest = common_factors(rates, windows)
    if smallest <= largest:
        return min(max(1.0, smallest), largest)
    return nearest_factor(rates, windows)


def _near(wrist: Wrist, state: State, wanted: State, rates: Sequence[float], dt: float) -> State:
    """Return the state after joint rates, or as much of the way there from slowing down."""
    slower = _braking(wrist, state.joint_rates, dt) or [0.0] * len(rates)

    def target(share: float) -> Target:
        way = zip(state.positions, slower, rates, strict=True)
        moved = [at + dt * (slow + share * (fast - slow)) for at, slow, fast in way]
        return wrist.resolve_assembly(moved, state.pose), wanted.steering_state

    found = largest_share(within_limits(wrist, state, target, dt), 1.0)[1]
    return found or brought_to_rest(wrist, state, dt)


def _held_back(
    joints: Sequence[Joint],
    before: Rates,
    wanted: Rates,
    windows: Sequence[Window],
    dt: float,
) -> list[LimitAtWork]:
    """Return the joints whose rate would change more quickly than it may."""
    found = []
    for joint, old, new, window in zip(
        joints, before or (0.0,) * len(joints), wanted, windows, strict=True
    ):
        nearest = window.nearest(new)
        if abs(new - nearest) > TOLERANCE * max(abs(new), abs(nearest)):
            share = max(0.0, nearest / new) if new else 0.0
            asked, allowed = (new - old) / dt, (nearest - old) / dt
            found.append(
                LimitAtWork(joint.name, LimitKind.ACCELERATION, asked, allowed, min(1.0, share))
            )
    return found
