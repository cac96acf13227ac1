"""One step of the forward kinematics of a planar platform, in plain floats, with its proof."""

from __future__ import annotations

import math

from wrist_control.stewart.certificate import BRANCH, NOTHING, kantorovich, moved, new
from wrist_control.stewart.quadratics import (
    Coefficients,
    Rows,
    Six,
    beta,
    inverse,
    point,
)
from wrist_control.stewart.stages import Tangent, Track, Unknowns

# Where the platform is lower than this share of its size, or steeper, z cannot lead.
LOW = 0.15
# Rounding of one evaluation of E, as a share of its largest term: generous.
ROUNDING = 32.0 * 2.0**-52
# From so little left of E, one or two steps with a new inverse end at rounding.
SHARP = 1e-6
MOST_CORRECTIONS = 12


def solve(
    known: Coefficients, right: Six[float], start: Unknowns, tangent: Tangent | None = None
) -> Track | None:
    """Correct until rounding is all that is left, and prove where that is.

    An inverse costs twice as much as a look at what is left: one serves again where that gets
    below SHARP, and is renewed there once, for the last step and for the proof.

    Args:
        known: The platform.
        right: What the lengths say.
        start: An assembled pose.
        tangent: A linearisation near the start, where there is one: it saves an inverse, and no
            proof rests on it unless the start is the answer already.
    """
    if not leads(start):
        return None
    _, _, u1, _, u2, v2, z, _, _ = start
    side = 1.0 if z > 0.0 else -1.0
    free, sqrt = known.free, math.sqrt
    floor = ROUNDING * (1.0 + abs(right[3]))
    origin, rows = tangent or (start, None)
    last = math.inf
    try:
        for count in range(MOST_CORRECTIONS):
            at, e22, e23, e33 = point(right, free, u1, u2, v2, side)
            left = sqrt(e22 * e22 + 2.0 * e23 * e23 + e33 * e33)
            if left <= 0.125 * floor or floor > left > 0.5 * last:
                if rows is None:
                    origin, rows = at, inverse(free, at)
                return _proved(known, at, start, count, origin, rows, left + floor)
            # The inverse of the last step would leave about left² / last now.
            if rows is None or left <= SHARP < last or left * left > SHARP * last:
                origin, rows = at, inverse(free, at)
            (a1, a2, a3), (b1, b2, b3), (c1, c2, c3) = rows
            u1 -= a1 * e22 + a2 * e23 + a3 * e33
            u2 -= b1 * e22 + b2 * e23 + b3 * e33
            v2 -= c1 * e22 + c2 * e23 + c3 * e33
            last = left
    except (ArithmeticError, TypeError):  # a lock, or no room for the height: it is complex
        pass
    return None


def _proved(
    known: Coefficients,
    at: Unknowns,
    start: Unknowns,
    count: int,
    origin: Unknowns,
    rows: Rows[float],
    left: float,
) -> Track:
    bound = moved(beta(known, origin, rows), math.dist(origin, at))
    proof = kantorovich(bound, bound * left) if bound < math.inf else NOTHING
    followed = bound * (math.dist(start, at) + proof.error) <= BRANCH
    return new(Track, (at, count, proof, followed, new(Tangent, (origin, rows))))


def leads(at: Unknowns) -> bool:
    """Return whether the height z is large enough to divide by."""
    _, _, _, _, _, _, z, u3, v3 = at
    z = abs(z)
    return z > LOW and z > LOW * abs(u3) and z > LOW * abs(v3)
