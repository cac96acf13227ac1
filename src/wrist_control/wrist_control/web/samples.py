"""What a page draws of a wrist over time, and how far the hand is off the commanded path."""

from __future__ import annotations

import math
from typing import NamedTuple

from wrist_control.rotations import IDENTITY, Quaternion, Vector, rates_between, turned
from wrist_control.wrists import Wrist


class Sample(NamedTuple):
    """One step of a resolver, as its status and its joint command say.

    Attributes:
        time: When it was received, s, on a clock that never jumps.
        commanded: p, q, r that were asked for, rad/s.
        achieved: p, q, r that the hand made, rad/s.
        scale_factor: F.
        margin: 0 at lock.
        joint_rates: rad/s or m/s, in joint order.
    """

    time: float
    commanded: Vector
    achieved: Vector
    scale_factor: float
    margin: float
    joint_rates: tuple[float, ...]


class OffPath:
    """How far the hand is off the way that was commanded, if it may be late but not astray.

    What a wrist follows of a command is F of it: from there on both rotations are known. About an
    axis that it does not follow the hand turns as the mechanism forces it, and that is no fault.

    Attributes:
        angle: How far, rad.
    """

    def __init__(self, wrist: Wrist) -> None:
        """Begin on the path.

        Args:
            wrist: For the axes that it follows.
        """
        self._followed = wrist.followed_axes
        self.clear()

    def clear(self) -> None:
        """Begin on the path again."""
        self.angle = 0.0
        self._meant: Quaternion = IDENTITY
        self._made: Quaternion = IDENTITY

    def follow(self, commanded: Vector, achieved: Vector, scale_factor: float, dt: float) -> None:
        """Go one step on.

        Args:
            commanded: p, q, r, rad/s.
            achieved: p, q, r, rad/s.
            scale_factor: F.
            dt: How long the step was, s.
        """
        if not any(commanded):
            return  # a hand that comes to rest is on the way that it was on
        p, q, r = (
            scale_factor * asked if axis in self._followed else made
            for axis, (asked, made) in enumerate(zip(commanded, achieved, strict=True))
        )
        self._meant = turned(self._meant, (p, q, r), dt)
        self._made = turned(self._made, achieved, dt)
        self.angle = math.hypot(*rates_between(self._meant, self._made, 1.0))
