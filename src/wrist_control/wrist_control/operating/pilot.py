"""The operator who flies a maneuver: watches the hand, and waits for it."""

from __future__ import annotations

import math

from wrist_control.operating.maneuvers import EARLY, Maneuver, Order
from wrist_control.rotations import Vector


class ManeuverClock:
    """A maneuver's own time, which stands still while its operator waits for the hand.

    Attributes:
        maneuver: What is flown.
        time: Its own time since its start, s.
    """

    def __init__(self, maneuver: Maneuver, period: float) -> None:
        """Start at 0.

        Args:
            maneuver: What is flown.
            period: How long each order is held, s.
        """
        self.maneuver = maneuver
        self.time = 0.0
        self._period = period
        self._held_back = 0.0

    @property
    def done(self) -> bool:
        """True once the hand has done all of the maneuver."""
        return self.time >= self.maneuver.duration - EARLY

    def order(self, elapsed: float, time_lost: float) -> Order:
        """Return what to ask for now.

        Args:
            elapsed: Time since the start, s.
            time_lost: Time that the hand has lost since then, s.
        """
        waited = self._held_back + time_lost if self.maneuver.waits else 0.0
        self.time = elapsed - waited
        return self.maneuver.order(self.time, self._period)

    def follow(self, order: Order, duration: float) -> None:
        """Note for how long, s, the hand follows an order: a slow one holds the clock back."""
        self._held_back += (1.0 - order.share) * duration


class Pilot:
    """Flies a maneuver tick by tick, told of the hand one tick late.

    Attributes:
        maneuver: What is flown.
        began: When it began, s; None before.
    """

    def __init__(self, maneuver: Maneuver, period: float) -> None:
        """Prepare to fly.

        Args:
            maneuver: What to fly.
            period: How long each command is held, s.
        """
        self.maneuver = maneuver
        self.began: float | None = None
        self._clock = ManeuverClock(maneuver, period)
        self._period = period
        self._lost_before = self._lost = 0.0
        self._share = 1.0

    @property
    def done(self) -> bool:
        """True once the hand has done all of the maneuver."""
        return self.began is not None and self._clock.done

    def rates(self, stamp_time: float, time_lost: float) -> Vector:
        """Return p, q, r to ask for now, rad/s; the first call begins the maneuver.

        Args:
            stamp_time: Now, s.
            time_lost: The time that the hand has lost so far, s; from any beginning.
        """
        if self.began is None:
            self.began = stamp_time
            self._lost_before = self._lost = time_lost
        lost = max(0.0, time_lost - self._lost_before)
        order = self._clock.order(stamp_time - self.began, lost)
        self._clock.follow(order, self._followed(order.share, time_lost))
        return order.rates

    def _followed(self, share: float, time_lost: float) -> float:
        """Return for how long the hand will follow an order, as far as is known by now, s.

        A hand that was held to a speed is held to the same speed when less is asked for.
        """
        factor = max(0.0, 1.0 - max(0.0, time_lost - self._lost) / self._period)
        ceiling = factor * self._share if factor < 1.0 - EARLY else math.inf
        self._lost, self._share = time_lost, share
        return self._period * min(1.0, ceiling / share)
