"""Three turns about any axes, one after another: which turns make a rotation, and which none.

Nothing but the directions of the axes counts. With the angle α between the first two and β
between the last two, the third axis can be turned to between |α − β| and α + β from the first;
where α + β is more than half a turn, to between |α − β| and 2π − α − β. At both ends the three
lie in a plane: that is lock. Only where an end is at 0 or π nothing lies beyond it, as with every
wrist whose axes are square to each other. [Paden1986], [Murray1994] ch. 3, subproblems 1 and 4.
"""

from __future__ import annotations

import math
from collections.abc import Sequence
from dataclasses import dataclass
from functools import cached_property
from typing import NamedTuple

from wrist_control.errors import UnreachableError
from wrist_control.rotations import (
    Quaternion,
    Vector,
    about,
    cross,
    dot,
    nearest_turn,
    product,
    to_forearm,
    to_hand,
)

Turns = tuple[float, float, float]

# Closer to lock than this the quotient that gives the third turn is round-off: it is kept.
LOCK = 1e-9
# Two branches that differ by less than this are a tie, won by the first.
TIE = 1e-6
# Beyond an end no more than this, rad, is passed like a lock, with the hand as far off: axes are
# never square to the last digit, neither in a file nor in a robot.
SEAM = 2e-3
# An orientation this little beyond an end, as a square of what is left, is round-off.
ROUNDOFF = 1e-14
# How the two ends are called.
ALONG = 'unreachable region along the first axis'
AGAINST = 'unreachable region against the first axis'


class End(NamedTuple):
    """Where the third axis comes nearest to the first, or to its opposite.

    Attributes:
        name: What the operator knows it by.
        beyond: Half the angle of the cone that cannot be reached, rad.
    """

    name: str
    beyond: float

    @property
    def is_open(self) -> bool:
        """Whether the hand can go on through it, as through any lock."""
        return self.beyond <= SEAM


@dataclass(frozen=True)
class ThreeAxes:
    """Three axes in series, as unit vectors in the same axes, all turns at 0."""

    first: Vector
    second: Vector
    third: Vector

    @cached_property
    def angles(self) -> tuple[float, float]:
        """Angle of the first two axes and of the last two, α and β, rad."""
        return angle_between(self.first, self.second), angle_between(self.second, self.third)

    @cached_property
    def amplitude(self) -> float:
        """The largest triple product of the axes, sin α sin β."""
        alpha, beta = self.angles
        return math.sin(alpha) * math.sin(beta)

    @cached_property
    def lock(self) -> float:
        """The second turn with which the third axis is nearest to the first, rad."""
        level = dot(self.first, self.second) * dot(self.second, self.third)
        return math.atan2(
            dot(self.first, cross(self.second, self.third)), dot(self.first, self.third) - level
        )

    @cached_property
    def ends(self) -> tuple[End, End]:
        """Nearest to the first axis, and nearest to its opposite."""
        alpha, beta = self.angles
        return End(ALONG, abs(alpha - beta)), End(AGAINST, abs(math.pi - alpha - beta))

    def cosine_of(self, product: float) -> float:
        """Return how the second joint is turned on from lock: the cosine, beyond ±1 nowhere.

        Args:
            product: Scalar product of the first and the third axis.
        """
        return (
            product - dot(self.first, self.second) * dot(self.second, self.third)
        ) / self.amplitude

    def distances(self, second: float) -> list[tuple[str, float]]:
        """Return how far each end is that nothing can go through, by name: 0 there, 1 at most."""
        half = 0.5 * (second - self.lock)
        sizes = (abs(math.sin(half)), abs(math.cos(half)))
        return [
            (end.name, size) for end, size in zip(self.ends, sizes, strict=True) if not end.is_open
        ]

    def turns(self, rotation: Quaternion, near: Sequence[float]) -> Turns:
        """Return the three turns of a rotation nearest to others, rad.

        Every rotation has two sets of them, and at lock infinitely many; there the third stays
        and the first takes the whole turn.

        Raises:
            UnreachableError: It lies beyond an end.
        """
        return min_way(
            [self._with_third(rotation, x, near) for x in self._thirds(rotation, near)], near
        )

    def _thirds(self, rotation: Quaternion, near: Sequence[float]) -> list[float]:
        """Return the third turns with which the second axis has its angle to the first."""
        seen = to_hand(rotation, self.first)
        along = dot(seen, self.third)
        cosine, other = dot(self.first, self.second), dot(self.second, self.third)
        x = dot(seen, self.second) - along * other
        y = dot(seen, cross(self.second, self.third))
        level = cosine - along * other
        size = math.hypot(x, y)
        end = self.ends[0 if along > cosine * other else 1]
        if size < max(LOCK, 2.0 * end.beyond if end.is_open else 0.0):
            return [near[2]]
        left = (size - level) * (size + level)
        if left < 0.0:
            if not end.is_open and left < -ROUNDOFF:
                raise UnreachableError(
                    'No turns of the three joints hold the hand there: their axes are not square '
                    f'to each other, and that leaves a cone of {math.degrees(end.beyond):.3g}° '
                    'out; aim beside it.',
                    end.name,
                )
            left = 0.0
        middle, half = math.atan2(y, x), math.atan2(math.sqrt(left), level)
        return [middle + half, middle - half]

    def _with_third(self, rotation: Quaternion, third: float, near: Sequence[float]) -> Turns:
        third = nearest_turn(third, near[2])
        two = product(rotation, about(self.third, -third))
        second = turn_about(self.second, to_hand(two, self.first), self.first)
        first = turn_about(self.first, self.second, to_forearm(two, self.second))
        return (nearest_turn(first, near[0]), nearest_turn(second, near[1]), third)


def min_way(branches: Sequence[Turns], near: Sequence[float]) -> Turns:
    """Return the branch nearest to others; of two that are as near, the first."""
    ways = [sum(abs(a - b) for a, b in zip(branch, near, strict=True)) for branch in branches]
    return branches[ways.index(min(ways))] if min(ways) < ways[0] - TIE else branches[0]


def turn_about(axis: Vector, before: Vector, after: Vector) -> float:
    """Return the turn about an axis that takes one vector to another, as well as it can, rad."""
    sine = dot(axis, cross(before, after))
    return math.atan2(sine, dot(before, after) - dot(axis, before) * dot(axis, after))


def angle_between(a: Vector, b: Vector) -> float:
    """Return the angle between two vectors, rad, right to the last digit for small ones too."""
    return math.atan2(math.hypot(*cross(a, b)), dot(a, b))
