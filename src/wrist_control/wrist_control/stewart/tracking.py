"""One step of the forward kinematics of a planar platform, in plain floats, with its proof."""

from __future__ import annotations

import math

from wrist_control.stewart.certificate import (
    BRANCH_LIMIT,
    NOTHING_PROVED,
    ROUNDING,
    beta_nearby,
    kantorovich,
    make_tuple,
)
from wrist_control.stewart.quadratics import (
    Coefficients,
    Matrix,
    Six,
    kantorovich_beta,
    newton_inverse,
    unknowns_and_residual,
)
from wrist_control.stewart.stages import MOST_CORRECTIONS, Tangent, Track, Unknowns

# (S3) divides by z, and β of (S7) grows with 1 / z²: lower than this share of the size z cannot
# lead, since what it proves unique falls below NEAR_LOCK. Six legs at a time are slower, no less
# right, so higher than need be costs time alone.
LOW = 0.15
# From so little left of E, one or two steps with a new inverse end at rounding: 1e-12, then 1e-24.
# Speed alone hangs on it, and ten times more or less costs no more than one step.
SHARP = 1e-6


def solve_planar(
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
    if not is_high_enough(start):
        return None
    _, _, u1, _, u2, v2, z, _, _ = start
    side = 1.0 if z > 0.0 else -1.0
    per_t, sqrt = known.per_t, math.sqrt
    floor = ROUNDING * (1.0 + abs(right[3]))
    origin, M_inverse = tangent or (start, None)
    last = math.inf
    try:
        for count in range(MOST_CORRECTIONS):
            at, e22, e23, e33 = unknowns_and_residual(right, per_t, u1, u2, v2, side)
            left = sqrt(e22 * e22 + 2.0 * e23 * e23 + e33 * e33)
            # Four units in the last place are rounding; below the floor, so is standing still.
            if left <= 0.125 * floor or floor > left > 0.5 * last:
                if M_inverse is None:
                    origin, M_inverse = at, newton_inverse(per_t, at)
                return _proved(known, at, start, count, origin, M_inverse, left + floor)
            # The inverse of the last step would leave about left² / last now.
            if M_inverse is None or left <= SHARP < last or left * left > SHARP * last:
                origin, M_inverse = at, newton_inverse(per_t, at)
            (u1_22, u1_23, u1_33), (u2_22, u2_23, u2_33), (v2_22, v2_23, v2_33) = M_inverse
            u1 -= u1_22 * e22 + u1_23 * e23 + u1_33 * e33
            u2 -= u2_22 * e22 + u2_23 * e23 + u2_33 * e33
            v2 -= v2_22 * e22 + v2_23 * e23 + v2_33 * e33
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
    M_inverse: Matrix[float],
    left: float,
) -> Track:
    bound = beta_nearby(kantorovich_beta(known, origin, M_inverse), math.dist(origin, at))
    proof = kantorovich(bound, bound * left) if bound < math.inf else NOTHING_PROVED
    followed = bound * (math.dist(start, at) + proof.error) <= BRANCH_LIMIT
    return make_tuple(
        Track, (at, count, proof, followed, make_tuple(Tangent, (origin, M_inverse)))
    )


def is_high_enough(at: Unknowns) -> bool:
    """Return whether the height z is large enough to divide by."""
    return abs(at[6]) > LOW
