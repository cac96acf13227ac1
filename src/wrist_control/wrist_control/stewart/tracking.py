"""One step of the forward kinematics of a planar platform, in plain floats, with its proof."""

from __future__ import annotations

import math

from wrist_control.stewart.certificate import BRANCH, NOTHING, kantorovich, moved
from wrist_control.stewart.quadratics import (
    Coefficients,
    Six,
    Three,
    beta,
    inverse,
    point,
)
from wrist_control.stewart.stages import Track, Unknowns

# Where the platform is lower than this share of its size, or steeper, z cannot lead.
LOW = 0.15
# Rounding of one evaluation of E, as a share of its largest term: generous.
ROUNDING = 32.0 * 2.0**-52
# An inverse serves again once what is left of E is this small.
SHARP = 1e-6
MOST_CORRECTIONS = 12

Rows = tuple[Three[float], Three[float], Three[float]]


def solve(known: Coefficients, right: Six[float], start: Unknowns) -> Track | None:
    """Correct until rounding is all that is left, and prove where that is.

    An inverse is kept while it still gains three digits a step, or when one more step with it
    reaches rounding.
    """
    if not leads(start):
        return None
    _, _, u1, _, u2, v2, z, _, _ = start
    side = math.copysign(1.0, z)
    free = known.free
    floor = ROUNDING * (1.0 + abs(right[3]))
    origin, rows, last = start, None, math.inf
    try:
        for count in range(MOST_CORRECTIONS):
            at, e22, e23, e33 = point(right, free, u1, u2, v2, side)
            left = math.sqrt(e22 * e22 + 2.0 * e23 * e23 + e33 * e33)
            if left <= 0.125 * floor or (floor > left > 0.5 * last):
                if rows is None:
                    origin, rows = at, inverse(free, at)
                return _proved(known, at, start, count, origin, rows, left + floor)
            if rows is None or (left > SHARP and left > 1e-3 * last):
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
    rows: Rows,
    left: float,
) -> Track:
    bound = moved(beta(known, origin, rows), math.dist(origin, at))
    proof = kantorovich(bound, bound * left) if bound < math.inf else NOTHING
    return Track(at, count, proof, bound * (math.dist(start, at) + proof.error) <= BRANCH)


def leads(at: Unknowns) -> bool:
    """Return whether the height z is large enough to divide by."""
    z = abs(at[6])
    return z > LOW and z > LOW * abs(at[7]) and z > LOW * abs(at[8])
