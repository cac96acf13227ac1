"""Where the twelve anchors are, and what the legs do at a pose. [Nguyen1991], section 3.

The base is the forearm and the platform is the hand. The paper's R has the platform's axes as its
columns, so it is the transpose of Barker's C: components go from base axes to platform axes by C.
"""

from __future__ import annotations

import math
from collections.abc import Sequence

import numpy as np

from wrist_control.errors import InvalidValueError
from wrist_control.rotations import Pose, Vector, direction_cosines

Anchors = tuple[Vector, Vector, Vector, Vector, Vector, Vector]
# Points as they are given, m: shape (n, 3), or the same numbers in a row.
Points = Sequence[Sequence[float]] | Sequence[float]
# A leg's part in holding the platform: its unit direction and moment, in platform axes.
Line = tuple[float, float, float, float, float, float]
# Rounding of coordinates turns a leg of this share of the platform's size by some 1e-9 rad: ten
# times shorter, and rates would no longer be right to nine digits. No real leg comes near.
SHORTEST = 1e-6


def ring(radius: float, angle: float) -> Anchors:
    """Return six anchors on a circle in the plane z = 0, m. [Nguyen1991], eqs. (1)-(4).

    Args:
        radius: Radius of the circle, m.
        angle: Angle between the anchors 1 and 2, and so 3 and 4, 5 and 6, rad.
    """
    directions = [
        math.radians(60.0 * leg) - 0.5 * angle if leg % 2 else
        math.radians(60.0 * (leg - 1)) + 0.5 * angle
        for leg in range(1, 7)
    ]  # fmt: skip
    a, b, c, d, e, f = ((radius * math.cos(x), radius * math.sin(x), 0.0) for x in directions)
    return (a, b, c, d, e, f)


def anchors(name: str, given: Points | None, radius: float, angle: float) -> Anchors:
    """Return the points that are given (`checked_anchors`), or those of a ring."""
    return ring(radius, angle) if given is None else checked_anchors(name, given)


def checked_anchors(name: str, given: Points) -> Anchors:
    """Return six anchor points as tuples.

    Args:
        name: What to call them in an error.
        given: Points in m, shape (6, 3), or the same 18 numbers in a row.

    Raises:
        InvalidValueError: Not 18 numbers, or some that are not finite.
    """
    points = np.asarray(given, dtype=float)
    if points.size != 18 or not np.isfinite(points).all():
        raise InvalidValueError(
            f'{name} has {points.size} numbers; give six points of three finite numbers, m.'
        )
    a, b, c, d, e, f = ((float(x), float(y), float(z)) for x, y, z in points.reshape(6, 3))
    return (a, b, c, d, e, f)


def legs(platform: Anchors, base: Anchors, pose: Pose) -> list[Vector]:
    """Return the vectors from base anchor to platform anchor, platform axes, m.

    [Nguyen1991], eqs. (5)-(9), turned into platform axes: q = C d + p − C b.
    """
    (c11, c12, c13), (c21, c22, c23), (c31, c32, c33) = direction_cosines(pose.quaternion)
    x, y, z = pose.position
    found = []
    for (px, py, pz), (bx, by, bz) in zip(platform, base, strict=True):
        dx, dy, dz = x - bx, y - by, z - bz
        found.append(
            (
                c11 * dx + c12 * dy + c13 * dz + px,
                c21 * dx + c22 * dy + c23 * dz + py,
                c31 * dx + c32 * dy + c33 * dz + pz,
            )
        )
    return found


def length(leg: Vector) -> float:
    """Return the length of a leg, m. [Nguyen1991], eq. (10)."""
    x, y, z = leg
    return math.sqrt(x * x + y * y + z * z)


def line(leg: Vector, reach: float, anchor: Vector) -> Line:
    """Return how fast a leg grows per hand twist: its unit direction n and moment p × n.

    One row of the geometric inverse Jacobian, platform axes: l̇ = n·v + (p × n)·ω. It is
    [Nguyen1991], eq. (38), with the body's turning rate in place of angle rates, so that no
    attitude is special.

    Args:
        leg: Vector from base anchor to platform anchor, platform axes, m.
        reach: Its length, m, above 0.
        anchor: Platform anchor p, platform axes, m.
    """
    nx, ny, nz = leg[0] / reach, leg[1] / reach, leg[2] / reach
    px, py, pz = anchor
    return (nx, ny, nz, py * nz - pz * ny, pz * nx - px * nz, px * ny - py * nx)


def hadamard_ratio(lines: Sequence[Line], size: float) -> float:
    """Return how well the legs hold the platform: −1 to 1, and 0 at lock, where the sign changes.

    The determinant of the six lines (n, p × n / size) over the product of their lengths, which is
    Hadamard's bound on it: a volume without a unit.

    Args:
        lines: Direction and moment of each leg, platform axes.
        size: Characteristic length that makes moments comparable with directions, m.
    """
    scaled = [(nx, ny, nz, mx / size, my / size, mz / size) for nx, ny, nz, mx, my, mz in lines]
    bound = math.prod(math.sqrt(1.0 + x * x + y * y + z * z) for _, _, _, x, y, z in scaled)
    return float(np.linalg.det(scaled)) / bound


def hadamard_ratio_at(platform: Anchors, base: Anchors, size: float, pose: Pose) -> float:
    """Return `hadamard_ratio` at a pose, of anchors in m."""
    vectors = legs(platform, base, pose)
    lines = [line(v, length(v), p) for v, p in zip(vectors, platform, strict=True)]
    return hadamard_ratio(lines, size)
