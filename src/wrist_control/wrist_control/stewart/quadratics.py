"""The equations of a planar platform: nine numbers of the pose, and six quadratics.

With both sets of anchors in their planes z = 0, l² is linear in nine numbers of the pose: s = d·d,
m = d·u, n = d·v, x, y, u₁, v₁, u₂, v₂, where d = (x, y, z) is the position and u, v are the
platform's x and y axes, all in base axes. Six lengths make six of the nine, (x, y, v₁, s, m, n),
linear functions of the other three, t = (u₁, u₂, v₂). With the heights h = (z, u₃, v₃), the pose
is where six quadratics vanish, the entries of the symmetric matrix

    E = [[s, m, n], [m, 1, 0], [n, 0, 1]] − Xᵀ X,    X = [d u v].

The first row of E gives h, and the other three entries are solved for t by Newton steps, each one
3×3 solve without trigonometry. Equations (S1) to (S8) of docs/equations.md, [Nguyen1991].

The arithmetic here takes floats, or arrays of one shape. Lengths are shares of a characteristic
length. Names, the same in every function:

    x_u1, x_u2, x_v2      change of x per u₁, u₂, v₂, and so for each of the six
    x_q1 … x_q6, x_0      change of x per squared length, and x where these and t are zero
    e22, e23, e33         entries of E, counted from 1
    u1_22, u1_23, u1_33   change of u₁ per entry of E, and so for each of t: the rows of M⁻¹
    alpha, gamma          u₃ / z and v₃ / z, in a = (−α, 1, 0) and b = (−γ, 0, 1)
    ax, ay, bx, by        x and y of X a = u − α d and of X b = v − γ d; their z is 0
    aa_u1, ab_u1, bb_u1   change of aᵀE a / 2, aᵀE b and bᵀE b / 2 per u₁, and so per each of t
"""

from __future__ import annotations

import math
from collections.abc import Sequence
from typing import NamedTuple, TypeVar

import numpy as np

from wrist_control.stewart.geometry import Anchors

# c₁ and c₂ of (S7) grow with the condition of the six equations, and the radius that is proved
# unique shrinks with them. Up to here it stays above NEAR_LOCK in nine poses of ten around home;
# from 300 on a platform that its legs hold well would be called NEAR_SINGULAR for that alone.
LARGEST_CONDITION = 100.0

Number = TypeVar('Number', float, np.ndarray)
Three = tuple[Number, Number, Number]
Six = tuple[Number, Number, Number, Number, Number, Number]
Nine = tuple[
    Number, Number, Number, Number, Number, Number, Number, Number, Number
]  # x, y, u1, v1, u2, v2, z, u3, v3
Triple = tuple[float, float, float]
Matrix = tuple[Three[Number], Three[Number], Three[Number]]  # row by row
# Change of x, y, v1, s, m, n per u1, u2, v2: six rows.
PerT = tuple[Triple, Triple, Triple, Triple, Triple, Triple]


class Coefficients(NamedTuple):
    """(x, y, v₁, s, m, n) as linear functions of squared lengths, m², and t.

    Attributes:
        per_square: Change per squared length, six rows of six.
        constant: What they are where lengths and t are zero.
        per_t: Change per t.
        flat_norm: c₁ of (S7), the largest ‖(Δx, Δy, Δu₁, Δv₁, Δu₂, Δv₂)‖ per ‖Δt‖.
        s_norm: c₂ of (S7), the largest ‖(Δs, √2 Δm, √2 Δn)‖ per ‖Δt‖.
    """

    per_square: tuple[tuple[float, ...], ...]
    constant: tuple[float, ...]
    per_t: PerT
    flat_norm: float
    s_norm: float


def coefficients(platform: Anchors, base: Anchors, size: float) -> Coefficients | None:
    """Return the coefficients of a platform; None where these six numbers cannot be solved for.

    (S1), which is six times [Nguyen1991], eq. (16), with anchors in the planes z = 0.
    """
    p, b = np.array(platform) / size, np.array(base) / size
    if np.abs(p[:, 2]).max() > 0.0 or np.abs(b[:, 2]).max() > 0.0:
        return None
    px, py, bx, by = p[:, 0], p[:, 1], b[:, 0], b[:, 1]
    squares_per_six = np.stack(
        [-2 * bx, -2 * by, -2 * bx * py, np.ones(6), 2 * px, 2 * py], axis=1
    )
    if np.linalg.cond(squares_per_six) > LARGEST_CONDITION:
        return None
    six_per_square = np.linalg.inv(squares_per_six)
    six_per_t = six_per_square @ (2.0 * np.stack([bx * px, by * px, by * py], axis=1))
    weight = np.array([[1.0], [math.sqrt(2.0)], [math.sqrt(2.0)]])
    x, y, v1, s, m, n = ((float(u1), float(u2), float(v2)) for u1, u2, v2 in six_per_t)
    radii = (p * p).sum(axis=1) + (b * b).sum(axis=1)
    return Coefficients(
        per_square=tuple(tuple(float(x) for x in row) for row in six_per_square / size**2),
        constant=tuple(float(x) for x in -six_per_square @ radii),
        per_t=(x, y, v1, s, m, n),
        flat_norm=float(np.linalg.norm(np.vstack([six_per_t[:3], np.eye(3)]), 2)),
        s_norm=float(np.linalg.norm(weight * six_per_t[3:], 2)),
    )


def right_side(known: Coefficients, lengths: Sequence[float]) -> Six[float]:
    """Return what six lengths, m, say: x, y, v₁, s, m, n where t is zero. (S1), solved."""
    l1, l2, l3, l4, l5, l6 = lengths
    q1, q2, q3, q4, q5, q6 = l1 * l1, l2 * l2, l3 * l3, l4 * l4, l5 * l5, l6 * l6
    x_0, y_0, v1_0, s_0, m_0, n_0 = known.constant
    (
        (x_q1, x_q2, x_q3, x_q4, x_q5, x_q6),
        (y_q1, y_q2, y_q3, y_q4, y_q5, y_q6),
        (v1_q1, v1_q2, v1_q3, v1_q4, v1_q5, v1_q6),
        (s_q1, s_q2, s_q3, s_q4, s_q5, s_q6),
        (m_q1, m_q2, m_q3, m_q4, m_q5, m_q6),
        (n_q1, n_q2, n_q3, n_q4, n_q5, n_q6),
    ) = known.per_square
    return (
        x_q1 * q1 + x_q2 * q2 + x_q3 * q3 + x_q4 * q4 + x_q5 * q5 + x_q6 * q6 + x_0,
        y_q1 * q1 + y_q2 * q2 + y_q3 * q3 + y_q4 * q4 + y_q5 * q5 + y_q6 * q6 + y_0,
        v1_q1 * q1 + v1_q2 * q2 + v1_q3 * q3 + v1_q4 * q4 + v1_q5 * q5 + v1_q6 * q6 + v1_0,
        s_q1 * q1 + s_q2 * q2 + s_q3 * q3 + s_q4 * q4 + s_q5 * q5 + s_q6 * q6 + s_0,
        m_q1 * q1 + m_q2 * q2 + m_q3 * q3 + m_q4 * q4 + m_q5 * q5 + m_q6 * q6 + m_0,
        n_q1 * q1 + n_q2 * q2 + n_q3 * q3 + n_q4 * q4 + n_q5 * q5 + n_q6 * q6 + n_0,
    )


def right_side_at(known: Coefficients, at: Nine[float]) -> Six[float]:
    """Return what the lengths at an assembled pose say."""
    x, y, u1, v1, u2, v2, z, u3, v3 = at
    s, m, n = x * x + y * y + z * z, x * u1 + y * u2 + z * u3, x * v1 + y * v2 + z * v3
    x_0, y_0, v1_0, s_0, m_0, n_0 = (
        number - per_u1 * u1 - per_u2 * u2 - per_v2 * v2
        for number, (per_u1, per_u2, per_v2) in zip((x, y, v1, s, m, n), known.per_t, strict=True)
    )
    return (x_0, y_0, v1_0, s_0, m_0, n_0)


def unknowns_and_residual(
    right: Six[Number], per_t: PerT, u1: Number, u2: Number, v2: Number, side: Number
) -> tuple[Nine[Number], Number, Number, Number]:
    """Return all unknowns at some t, with E's first row zero, and its entries 22, 23 and 33.

    Where the lengths leave no room for the height, a float's answer is complex, an array's nan.

    Args:
        right: What the lengths say: x, y, v₁, s, m, n where t is zero.
        per_t: The change of the same per t.
        u1: Of the three unknowns t, the first;
        u2: the second;
        v2: and the third.
        side: 1 above the base, −1 below.
    """
    x, y, v1, s, m, n = right
    (
        (x_u1, x_u2, x_v2),
        (y_u1, y_u2, y_v2),
        (v1_u1, v1_u2, v1_v2),
        (s_u1, s_u2, s_v2),
        (m_u1, m_u2, m_v2),
        (n_u1, n_u2, n_v2),
    ) = per_t
    # (S1), solved for six of the nine
    x = x + x_u1 * u1 + x_u2 * u2 + x_v2 * v2
    y = y + y_u1 * u1 + y_u2 * u2 + y_v2 * v2
    v1 = v1 + v1_u1 * u1 + v1_u2 * u2 + v1_v2 * v2
    # (S3), the first row of E
    z = side * (s + s_u1 * u1 + s_u2 * u2 + s_v2 * v2 - x * x - y * y) ** 0.5
    u3 = (m + m_u1 * u1 + m_u2 * u2 + m_v2 * v2 - x * u1 - y * u2) / z
    v3 = (n + n_u1 * u1 + n_u2 * u2 + n_v2 * v2 - x * v1 - y * v2) / z
    # (S2), its other entries
    return (
        (x, y, u1, v1, u2, v2, z, u3, v3),
        1.0 - u1 * u1 - u2 * u2 - u3 * u3,
        -u1 * v1 - u2 * v2 - u3 * v3,
        1.0 - v1 * v1 - v2 * v2 - v3 * v3,
    )


def newton_matrix(per_t: PerT, at: Nine[Number]) -> Matrix[Number]:
    """Return the change of aᵀE a / 2, aᵀE b and bᵀE b / 2 per t, row by row: (S5).

    They are entries 22, 23, 33 of E, halved on the diagonal, while its first row stays zero: a and
    b are orthogonal to h, so that a change of h does not count. With D = (x, y) and ′ per t, they
    are α g − (X a)·u′, γ g + α f − (X a)·v′ − (X b)·u′ and γ f − (X b)·v′.
    """
    x, y, u1, v1, u2, v2, z, u3, v3 = at
    (
        (x_u1, x_u2, x_v2),
        (y_u1, y_u2, y_v2),
        (v1_u1, v1_u2, v1_v2),
        (s_u1, s_u2, s_v2),
        (m_u1, m_u2, m_v2),
        (n_u1, n_u2, n_v2),
    ) = per_t
    alpha, gamma = u3 / z, v3 / z
    ax, ay, bx, by = u1 - alpha * x, u2 - alpha * y, v1 - gamma * x, v2 - gamma * y
    # g = α s′ / 2 − m′ + (X a)·D′ and f = γ s′ / 2 − n′ + (X b)·D′
    half = 0.5 * alpha
    g_u1 = half * s_u1 - m_u1 + ax * x_u1 + ay * y_u1
    g_u2 = half * s_u2 - m_u2 + ax * x_u2 + ay * y_u2
    g_v2 = half * s_v2 - m_v2 + ax * x_v2 + ay * y_v2
    half = 0.5 * gamma
    f_u1 = half * s_u1 - n_u1 + bx * x_u1 + by * y_u1
    f_u2 = half * s_u2 - n_u2 + bx * x_u2 + by * y_u2
    f_v2 = half * s_v2 - n_v2 + bx * x_v2 + by * y_v2
    return (
        (alpha * g_u1 - ax, alpha * g_u2 - ay, alpha * g_v2),
        (
            gamma * g_u1 + alpha * f_u1 - ax * v1_u1 - bx,
            gamma * g_u2 + alpha * f_u2 - ax * v1_u2 - by,
            gamma * g_v2 + alpha * f_v2 - ax * v1_v2 - ay,
        ),
        (gamma * f_u1 - bx * v1_u1, gamma * f_u2 - bx * v1_u2, gamma * f_v2 - bx * v1_v2 - by),
    )


def newton_inverse(per_t: PerT, at: Nine[Number]) -> Matrix[Number]:
    """Return M⁻¹ of (S4), the change of t per entry 22, 23, 33 of E, row by row.

    By cofactors, of `newton_matrix`, whose first and last row are half of M's.

    Raises:
        ZeroDivisionError: The equations lock here; arrays hold inf or nan instead.
    """
    (
        (aa_u1, aa_u2, aa_v2),
        (ab_u1, ab_u2, ab_v2),
        (bb_u1, bb_u2, bb_v2),
    ) = newton_matrix(per_t, at)
    u1_aa = ab_u2 * bb_v2 - ab_v2 * bb_u2
    u1_ab = aa_v2 * bb_u2 - aa_u2 * bb_v2
    u1_bb = aa_u2 * ab_v2 - aa_v2 * ab_u2
    k = 1.0 / (aa_u1 * u1_aa + ab_u1 * u1_ab + bb_u1 * u1_bb)
    half = 0.5 * k
    return (
        (u1_aa * half, u1_ab * k, u1_bb * half),
        (
            (ab_v2 * bb_u1 - ab_u1 * bb_v2) * half,
            (aa_u1 * bb_v2 - aa_v2 * bb_u1) * k,
            (aa_v2 * ab_u1 - aa_u1 * ab_v2) * half,
        ),
        (
            (ab_u1 * bb_u2 - ab_u2 * bb_u1) * half,
            (aa_u2 * bb_u1 - aa_u1 * bb_u2) * k,
            (aa_u1 * ab_u2 - aa_u2 * ab_u1) * half,
        ),
    )


def kantorovich_beta(known: Coefficients, at: Nine[Number], M_inverse: Matrix[Number]) -> Number:
    """Return β of (S7), a bound on ‖(Δ of the unknowns)‖ per ‖Δ of E‖ (Frobenius).

    Args:
        known: The platform.
        at: Where the equations were linearised.
        M_inverse: `newton_inverse` there.
    """
    x, y, u1, v1, u2, v2, z, u3, v3 = at
    (u1_22, u1_23, u1_33), (u2_22, u2_23, u2_33), (v2_22, v2_23, v2_33) = M_inverse
    # ‖M⁻¹ diag(1, 1/√2, 1)‖², and τ
    squared = u1_22 * u1_22 + u1_33 * u1_33 + u2_22 * u2_22 + u2_33 * u2_33
    squared = squared + v2_22 * v2_22 + v2_33 * v2_33
    squared = squared + 0.5 * (u1_23 * u1_23 + u2_23 * u2_23 + v2_23 * v2_23)
    heights = z * z + u3 * u3 + v3 * v3
    tau = heights / (z * z) * squared**0.5
    # The flat unknowns' part, and that of the heights
    turn = known.flat_norm * tau
    flat = (x * x + y * y + u1 * u1 + v1 * v1 + u2 * u2 + v2 * v2) ** 0.5
    rise = 1.0 + known.s_norm * tau + 2.0 * flat * turn
    return (turn * turn + 0.5 * rise * rise / heights) ** 0.5
