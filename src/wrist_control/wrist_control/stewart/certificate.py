"""What a Newton-Kantorovich test proves about an answer. docs/equations.md, [Nguyen1991].

The unknowns are the components X = (d, u, v, …) of the platform's position and of its axes, seen
from the base, and the equations are quadratic in them: their second derivative is constant, so the
test is exact and costs two numbers. All lengths here are shares of a characteristic length.
"""

from __future__ import annotations

import math
from typing import NamedTuple

# Makes a named tuple in a third of the time that its class takes: make_tuple(Proof, (…)).
make_tuple = tuple.__new__


class Proof(NamedTuple):
    """What is proved around a trial point: a root within `error`, and no other within `unique`.

    Attributes:
        error: Distance within which there is a root; inf when nothing is proved.
        unique: Distance within which there is no second root; 0 when nothing is proved.
    """

    error: float
    unique: float


# Rounding of one evaluation of E or of six squared lengths, as a share of the largest term. Exact
# fractions show up to 3.6 units in the last place (E, at any height); this is nine times that, and
# the bounds are loose in proportion. (S9)
ROUNDING = 32.0 * 2.0**-52
# A root X₁ is the continuation of a root X₀, while the right sides go straight from one to the
# other, when β₁ ‖X₁ − X₀‖ is at most this: β η ≤ β‖Δ‖ + (β‖Δ‖)² is then at most 1/4.
BRANCH_LIMIT = 0.5 * (math.sqrt(2.0) - 1.0)
NOTHING_PROVED = Proof(math.inf, 0.0)


def kantorovich(beta: float, eta: float) -> Proof:
    """Return what is proved about the roots near a trial point X₀ of H(X) = 0, H quadratic.

    Args:
        beta: A bound on ‖H'(X₀)⁻¹ (ΔXᵀΔX)‖ / ‖ΔX‖²: half the Lipschitz constant of H'(X₀)⁻¹ H'.
        eta: A bound on the Newton step ‖H'(X₀)⁻¹ H(X₀)‖.
    """
    discriminant = 1.0 - 4.0 * beta * eta
    if not discriminant > 0.0:
        return NOTHING_PROVED
    root = 1.0 + math.sqrt(discriminant)
    # The smaller radius as η / (larger radius · β): no digits lost when η is tiny.
    return make_tuple(Proof, (2.0 * eta / root, root / (2.0 * beta)))


def beta_nearby(beta: float, distance: float) -> float:
    """Return a bound like `beta` at a point that lies a distance away from where `beta` holds."""
    left = 1.0 - 2.0 * beta * distance
    return beta / left if left > 0.0 else math.inf
