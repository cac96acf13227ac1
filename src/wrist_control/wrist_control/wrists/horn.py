"""One servo's horn: where its tip goes, and which angle takes a rod to a point. [ReachyMini].

Everything is in base axes, angles in rad and lengths in m.
"""

from __future__ import annotations

import math
from typing import NamedTuple

from wrist_control.errors import InvalidValueError
from wrist_control.rotations import Pose, Vector, cross, nearest_turn, quaternion_of
from wrist_control.stewart.geometry import Anchors
from wrist_control.wrists.body import scaled

# A direction shorter than this says nothing, nor do an axis and a horn nearer to parallel, rad.
LEAST = 1e-6


class Horn(NamedTuple):
    """Where a servo turns its horn.

    Attributes:
        length: From the axis to the tip.
        centre: Centre of the circle that the tip goes round.
        along: Unit vector along the horn where its servo is at 0.
        aside: Unit vector along the horn where its servo is at a quarter turn.
        axis: Unit vector about which the servo turns.
    """

    length: float
    centre: Vector
    along: Vector
    aside: Vector
    axis: Vector

    def tip(self, angle: float) -> Vector:
        """Return where the tip is."""
        (x, y, z), (ax, ay, az), (bx, by, bz) = self.centre, self.along, self.aside
        u, v = self.length * math.cos(angle), self.length * math.sin(angle)
        return (x + u * ax + v * bx, y + u * ay + v * by, z + u * az + v * bz)

    def tip_rate(self, angle: float) -> Vector:
        """Return how the tip moves, m per rad."""
        (ax, ay, az), (bx, by, bz) = self.along, self.aside
        u, v = -self.length * math.sin(angle), self.length * math.cos(angle)
        return (u * ax + v * bx, u * ay + v * by, u * az + v * bz)

    def pose(self, angle: float) -> Pose:
        """Return where the horn is: x along it, z along its servo's axis."""
        x, y, z = scaled(self.tip_rate(angle), 1.0 / self.length)
        along = cross((x, y, z), self.axis)
        return Pose(quaternion_of((along, (x, y, z), self.axis)), self.centre)

    def angle(self, end: Vector, rod: float, near: float) -> float | None:
        """Return the angle at which a rod from the tip ends at a point, nearest to another.

        With u, v, w from the centre to that point, along, aside and along the axis, and the
        horn's length a: u cos θ + v sin θ = (u² + v² + w² + a² − l²) / 2a, twice or not at all.

        Args:
            end: The point.
            rod: Length l of the rod.
            near: An angle, on whichever turn.
        """
        a, (cx, cy, cz) = self.length, self.centre
        (ax, ay, az), (bx, by, bz) = self.along, self.aside
        x, y, z = end[0] - cx, end[1] - cy, end[2] - cz
        u, v = x * ax + y * ay + z * az, x * bx + y * by + z * bz
        reach = (x * x + y * y + z * z + a * a - rod * rod) / (2.0 * a)
        left = u * u + v * v - reach * reach
        if not left >= 0.0:
            return None
        middle, half = math.atan2(v, u), math.atan2(math.sqrt(left), reach)
        one, other = nearest_turn(middle - half, near), nearest_turn(middle + half, near)
        return one if abs(one - near) <= abs(other - near) else other


def horn(servo: str, length: float, centre: Vector, axis: Vector, direction: Vector) -> Horn:
    """Return a horn.

    Args:
        servo: What to call it in an error.
        length: From the axis to the tip.
        centre: Centre of the circle that the tip goes round.
        axis: Direction about which the servo turns, of any length.
        direction: Where the horn points at 0; of it what is square to the axis counts.

    Raises:
        InvalidValueError: A direction without length, or a horn along its axis.
    """
    around = _unit(axis, f'The axis of {servo}')
    aside = _unit(cross(around, direction), f'The horn of {servo}')
    return Horn(length, centre, cross(aside, around), aside, around)


def _unit(direction: Vector, name: str) -> Vector:
    length = math.hypot(*direction)
    if not length > LEAST:
        raise InvalidValueError(
            f'{name} has no direction, or the horn lies along the axis; give one across it.'
        )
    return scaled(direction, 1.0 / length)


def in_pairs(radius: float, offset: float) -> tuple[Anchors, Anchors, Anchors]:
    """Return centres, axes and directions at 0 of three pairs of horns around the base.

    The axes are radial, and the horns of a pair point away from each other: as servos turn up
    their horns, the angles of the first, third and fifth grow, and the others' fall.

    Args:
        radius: From the base's axis to the circles of the tips.
        offset: Half the distance between the two of a pair.
    """
    centres, axes, directions = [], [], []
    for azimuth in (math.pi / 3.0, math.pi, -math.pi / 3.0):
        c, s = math.cos(azimuth), math.sin(azimuth)
        for side in (-1.0, 1.0):
            across = side * offset
            centres.append((radius * c - across * s, radius * s + across * c, 0.0))
            axes.append((-c, -s, 0.0))
            directions.append((-side * s, side * c, 0.0))
    return six(centres), six(axes), six(directions)


def six(points: list[Vector]) -> Anchors:
    """Return six points as a tuple."""
    a, b, c, d, e, f = points
    return (a, b, c, d, e, f)
