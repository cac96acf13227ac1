"""Whether a step can be made: inside every limit, and with space left to stop in."""

from __future__ import annotations

import math
from collections.abc import Callable, Iterator
from itertools import chain
from typing import TypeAlias

from wrist_control.errors import UnreachableError
from wrist_control.resolving.limits import LimitAtWork, LimitKind, overruns
from wrist_control.resolving.rate_windows import stopping_time
from wrist_control.resolving.search import Attempt
from wrist_control.resolving.state import State, increments
from wrist_control.wrists.wrist import Positions, SteeringState, Wrist

# Joint positions, and the steering state that leads to them.
Target: TypeAlias = 'tuple[Positions, SteeringState]'


def within_limits(
    wrist: Wrist, state: State, target: Callable[[float], Target], dt: float
) -> Attempt[State]:
    """Return what makes the state at a share's target, or tells the limits that it would break.

    Args:
        wrist: The mechanism, with the limits to keep.
        state: Where it is.
        target: What a share of the step leads to.
        dt: Duration of the step, s.
    """

    def attempt(share: float) -> tuple[State | None, list[LimitAtWork]]:
        try:
            positions, steering_state = target(share)
            if not math.isfinite(sum(positions)):
                raise UnreachableError('The command leads nowhere.', 'no way on')
            broken = overruns(wrist, state.positions, positions, dt)
            if broken:
                return None, broken
            after = State(positions, wrist.forward(positions), steering_state)
            broken = overruns_on_the_way_to_rest(wrist, state, after, dt)
            return (None, broken) if broken else (after, [])
        except UnreachableError as error:
            return None, [edge(error)]

    return attempt


def edge(error: UnreachableError) -> LimitAtWork:
    """Return the limit behind which nothing can be reached."""
    return LimitAtWork(error.limit, LimitKind.WORKSPACE, 0.0, 0.0, 0.0)


def overruns_on_the_way_to_rest(
    wrist: Wrist, before: State, after: State, dt: float
) -> list[LimitAtWork]:
    """Return the limits that joints would overrun that stop after a step as quickly as they may.

    They stop on a straight line, after half the stopping time T at the rates of the step; at once
    where one step is enough. Of a share s of it, s dt + s² T / 2 are used of dt + T / 2. Beside
    an edge that bends every step of the way counts: it may lead over the edge and back.

    Raises:
        UnreachableError: They would come to where the mechanism cannot be.
    """
    if not wrist.limits_acceleration:
        return []
    rates = increments(before.positions, after.positions, dt)
    time = stopping_time(wrist.joints, rates)
    if time <= dt:
        return []

    def at(travel: float) -> Positions:
        way = zip(after.positions, rates, strict=True)
        return wrist.resolve_assembly([old + travel * rate for old, rate in way], after.pose)

    half = 0.5 * time
    for travel in chain((half,), _travels(wrist, at, half, time / dt, dt)):
        broken = overruns(wrist, before.positions, at(travel), math.inf)
        if broken:
            return [
                limit._replace(share=_share(limit.share * (dt + travel), dt, half))
                for limit in broken
            ]
    return []


def _travels(
    wrist: Wrist, at: Callable[[float], Positions], half: float, steps: float, dt: float
) -> Iterator[float]:
    """Yield how far joints have come after each step of slowing down, as times at full rate, s.

    Nothing where the way is far from every edge: further than the edges bend on it.
    """
    begin = wrist.clearances(at(0.0))
    if not begin:
        return
    middle, end = wrist.clearances(at(0.5 * half)), wrist.clearances(at(half))
    bends = (
        min(a.remaining, b.remaining, c.remaining)
        < abs(a.remaining - 2.0 * b.remaining + c.remaining)
        for a, b, c in zip(begin, middle, end, strict=True)
    )
    if any(bends):
        for step in range(1, math.ceil(steps)):
            yield dt * (step - 0.5 * step * (step + 1) / steps)


def _share(used: float, dt: float, half: float) -> float:
    """Return the s of s dt + s² T / 2 = used."""
    return 2.0 * used / (dt + math.sqrt(dt * dt + 4.0 * half * max(0.0, used)))
