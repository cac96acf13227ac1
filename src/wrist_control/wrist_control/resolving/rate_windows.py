"""Which rates joints can have one step later, when no rate may change at once."""

from __future__ import annotations

import math
from collections.abc import Sequence
from itertools import pairwise
from typing import NamedTuple

from wrist_control.wrists.joint import Joint
from wrist_control.wrists.wrist import Rates


class Window(NamedTuple):
    """The lowest and the highest rate of one joint, rad/s or m/s."""

    low: float
    high: float

    def nearest(self, rate: float) -> float:
        """Return the rate inside that is nearest to another."""
        return min(max(rate, self.low), self.high)


def rate_windows(joints: Sequence[Joint], rates: Rates, dt: float) -> tuple[Window, ...]:
    """Return the window of each joint after a step.

    Args:
        joints: The joints, with their limits.
        rates: Their rates in the step before, rad/s or m/s; empty at rest.
        dt: Duration of the step, s.
    """
    before = rates or (0.0,) * len(joints)
    return tuple([_window(joint, rate, dt) for joint, rate in zip(joints, before, strict=True)])


def _window(joint: Joint, rate: float, dt: float) -> Window:
    if rate < 0.0:
        low, high = _window(joint, -rate, dt)
        return Window(-high, -low)
    speeding_up, slowing_down = joint.acceleration_limit * dt, joint.deceleration_limit * dt
    # Through 0 the joint slows down first, and speeds up for the rest of the step.
    slowest = (
        rate - slowing_down if rate >= slowing_down else -speeding_up * (1.0 - rate / slowing_down)
    )
    # A rate limit that was lowered is gone down to as quickly as the joint may slow down.
    high = max(min(rate + speeding_up, joint.rate_limit), slowest)
    return Window(max(slowest, -joint.rate_limit), high)


def stopping_time(joints: Sequence[Joint], rates: Rates) -> float:
    """Return how long joints need that slow down together, on a straight line, s."""
    return max(
        [abs(rate) / joint.deceleration_limit for joint, rate in zip(joints, rates, strict=True)]
    )


def common_factors(rates: Rates, windows: Sequence[Window]) -> tuple[float, float]:
    """Return the smallest and the largest factor that bring all rates inside their windows.

    Where there is none, the smallest is larger than the largest.
    """
    smallest, largest = 0.0, math.inf
    for rate, (low, high) in zip(rates, windows, strict=True):
        if rate < 0.0:
            smallest, largest = max(smallest, high / rate), min(largest, low / rate)
        elif rate > 0.0:
            smallest, largest = max(smallest, low / rate), min(largest, high / rate)
        elif not low <= 0.0 <= high:
            return math.inf, 0.0
    return smallest, largest


def nearest_factor(rates: Rates, windows: Sequence[Window]) -> float:
    """Return the factor with which rates come nearest to their windows; of several that next to 1.

    The squared distance is a convex function of the factor, in pieces of second degree: its slope
    is a straight line between two factors at which a rate enters or leaves its window.
    """

    def slope(factor: float) -> float:
        moved = [factor * rate for rate in rates]
        return sum(
            rate * (there - window.nearest(there))
            for rate, there, window in zip(rates, moved, windows, strict=True)
        )

    too_much = slope(1.0) > 0.0
    least = 0.0 if too_much else 1.0
    ends = [
        end / rate for rate, window in zip(rates, windows, strict=True) if rate for end in window
    ]
    knots = [least, *sorted(knot for knot in ends if least < knot < math.inf)]
    for left, right in pairwise(knots):
        below, above = slope(left), slope(right)
        if above > 0.0 or (above == 0.0 and not too_much):
            return left if below >= 0.0 else left + (right - left) * below / (below - above)
    return knots[-1]
