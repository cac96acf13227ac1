"""The equations of a planar platform: nine numbers of the pose, and six quadratics.

With both sets of anchors in their planes z = 0, l² is linear in nine numbers of the pose: s = d·d,
m = d·u, n = d·v, x, y, u₁, v₁, u₂, v₂, where d = (x, y, z) is the position and u, v are the
platform's x and y axes, all in base axes. Six lengths make six of the nine, (x, y, v₁, s, m, n),
linear functions of the other three, t = (u₁, u₂, v₂). With the heights h = (z, u₃, v₃), the pose
is where six quadratics vanish, the entries of the symmetric matrix

    E = [[s, m, n], [m, 1, 0], [n, 0, 1]] − Xᵀ X,    X = [d u v].

The first row of E gives h, and the other three entries are solved for t by Newton steps, each one
3×3 solve without trigonometry. docs/equations.md, [Nguyen1991].

The arithmetic here takes floats, or arrays of one shape. Lengths are shares of a characteristic
length.
"""

from __future__ import annotations

import math
from collections.abc import Sequence
from typing import NamedTuple, TypeVar

import numpy as np

from wrist_control.stewart.geometry import Anchors

# Solving for (x, y, v₁, s, m, n) may magnify rounding by no more than this.
LARGEST_CONDITION = 1e4

Number = TypeVar('Number', float, np.ndarray)
Three = tuple[Number, Number, Number]
Six = tuple[Number, Number, Number, Number, Number, Number]
Nine = tuple[
    Number, Number, Number, Number, Number, Number, Number, Number, Number
]  # x, y, u1, v1, u2, v2, z, u3, v3
Triple = tuple[float, float, float]
Rows = tuple[Three[Number], Three[Number], Three[Number]]
# Change of x, y, v1, s, m, n per t: six rows.
Free = tuple[Triple, Triple, Triple, Triple, Triple, Triple]


class Coefficients(NamedTuple):
    """The nine numbers of the pose as linear functions of squared lengths, m², and t.

    Attributes:
        squares: Of (x, y, v₁, s, m, n) per squared length, six rows of six.
        offset: Of the same where lengths and t are zero.
        free: Of the same per t.
        flat_norm: The largest ‖(Δx, Δy, Δu₁, Δv₁, Δu₂, Δv₂)‖ per ‖Δt‖.
        s_norm: The largest ‖(Δs, √2 Δm, √2 Δn)‖ per ‖Δt‖.
    """

    squares: tuple[tuple[float, ...], ...]
    offset: tuple[float, ...]
    free: Free
    flat_norm: float
    s_norm: float


def coefficients(platform: Anchors, base: Anchors, size: float) -> Coefficients | None:
    """Return the coefficients of a platform; None where these six numbers cannot be solved for.

    Six times [Nguyen1991], eq. (16), with anchors in the planes z = 0.
    """
    p, b = np.array(platform) / size, np.array(base) / size
    if np.abs(p[:, 2]).max() > 0.0 or np.abs(b[:, 2]).max() > 0.0:
        return None
    px, py, bx, by = p[:, 0], p[:, 1], b[:, 0], b[:, 1]
    solved = np.stack([-2 * bx, -2 * by, -2 * bx * py, np.ones(6), 2 * px, 2 * py], axis=1)
    if np.linalg.cond(solved) > LARGEST_CONDITION:
        return None
    inverse = np.linalg.inv(solved)
    free = inverse @ (2.0 * np.stack([bx * px, by * px, by * py], axis=1))
    weight = np.array([[1.0], [math.sqrt(2.0)], [math.sqrt(2.0)]])
    r1, r2, r3, r4, r5, r6 = ((float(a), float(b), float(c)) for a, b, c in free)
    return Coefficients(
        squares=tuple(tuple(float(x) for x in row) for row in inverse / size**2),
        offset=tuple(float(x) for x in -inverse @ ((p * p).sum(axis=1) + (b * b).sum(axis=1))),
        free=(r1, r2, r3, r4, r5, r6),
        flat_norm=float(np.linalg.norm(np.vstack([free[:3], np.eye(3)]), 2)),
        s_norm=float(np.linalg.norm(weight * free[3:], 2)),
    )


def point(
    right: Six[Number], free: Free, u1: Number, u2: Number, v2: Number, side: Number
) -> tuple[Nine[Number], Number, Number, Number]:
    """Return all unknowns at some t, with E's first row zero, and its entries 22, 23 and 33.

    Where the lengths leave no room for the height, a float's answer is complex, an array's nan.

    Args:
        right: What the lengths say: x, y, v₁, s, m, n where t is zero.
        free: The change of the same per t.
        u1: Of the three unknowns t, the first;
        u2: the second;
        v2: and the third.
        side: 1 above the base, −1 below.
    """
    x, y, v1, s, m, n = right
    (a1, a2, a3), (b1, b2, b3), (c1, c2, c3), (d1, d2, d3), (e1, e2, e3), (f1, f2, f3) = free
    x = x + a1 * u1 + a2 * u2 + a3 * v2
    y = y + b1 * u1 + b2 * u2 + b3 * v2
    v1 = v1 + c1 * u1 + c2 * u2 + c3 * v2
    z = side * (s + d1 * u1 + d2 * u2 + d3 * v2 - x * x - y * y) ** 0.5
    u3 = (m + e1 * u1 + e2 * u2 + e3 * v2 - x * u1 - y * u2) / z
    v3 = (n + f1 * u1 + f2 * u2 + f3 * v2 - x * v1 - y * v2) / z
    return (
        (x, y, u1, v1, u2, v2, z, u3, v3),
        1.0 - u1 * u1 - u2 * u2 - u3 * u3,
        -u1 * v1 - u2 * v2 - u3 * v3,
        1.0 - v1 * v1 - v2 * v2 - v3 * v3,
    )


def inverse(free: Free, at: Nine[Number]) -> Rows[Number]:
    """Return the change of t per entry 22, 23, 33 of E while its first row stays zero, rows.

    The inverse of the change of (aa/2, ab, bb/2) of E per t, where a = (−u₃/z, 1, 0) and
    b = (−v₃/z, 0, 1) are orthogonal to h, so that a change of h does not count. With g and f per
    t, the three are al g − …, ga g + al f − … and ga f − …

    Raises:
        ZeroDivisionError: The equations lock here; arrays hold inf or nan instead.
    """
    x, y, u1, v1, u2, v2, z, u3, v3 = at
    (x1, x2, x3), (y1, y2, y3), (w1, w2, w3), (s1, s2, s3), (m1, m2, m3), (n1, n2, n3) = free
    al, ga = u3 / z, v3 / z
    ua, ub, va, vb = u1 - al * x, u2 - al * y, v1 - ga * x, v2 - ga * y
    h = 0.5 * al
    g1 = h * s1 - m1 + ua * x1 + ub * y1
    g2 = h * s2 - m2 + ua * x2 + ub * y2
    g3 = h * s3 - m3 + ua * x3 + ub * y3
    h = 0.5 * ga
    f1 = h * s1 - n1 + va * x1 + vb * y1
    f2 = h * s2 - n2 + va * x2 + vb * y2
    f3 = h * s3 - n3 + va * x3 + vb * y3
    a1, a2, a3 = al * g1 - ua, al * g2 - ub, al * g3
    b1 = ga * g1 + al * f1 - ua * w1 - va
    b2 = ga * g2 + al * f2 - ua * w2 - vb
    b3 = ga * g3 + al * f3 - ua * w3 - ub
    c1, c2, c3 = ga * f1 - va * w1, ga * f2 - va * w2, ga * f3 - va * w3 - vb
    r1, r2, r3 = b2 * c3 - b3 * c2, a3 * c2 - a2 * c3, a2 * b3 - a3 * b2
    k = 1.0 / (a1 * r1 + b1 * r2 + c1 * r3)
    h = 0.5 * k
    return (
        (r1 * h, r2 * k, r3 * h),
        ((b3 * c1 - b1 * c3) * h, (a1 * c3 - a3 * c1) * k, (a3 * b1 - a1 * b3) * h),
        ((b1 * c2 - b2 * c1) * h, (a2 * c1 - a1 * c2) * k, (a1 * b2 - a2 * b1) * h),
    )


def beta(known: Coefficients, at: Nine[Number], rows: Rows[Number]) -> Number:
    """Return a bound on ‖(Δ of the unknowns)‖ per ‖Δ of E‖ (Frobenius): docs/equations.md.

    Args:
        known: The platform.
        at: Where the equations were linearised.
        rows: Their inverse there.
    """
    x, y, u1, v1, u2, v2, z, u3, v3 = at
    (a1, a2, a3), (b1, b2, b3), (c1, c2, c3) = rows
    total = a1 * a1 + a3 * a3 + b1 * b1 + b3 * b3 + c1 * c1 + c3 * c3
    total = total + 0.5 * (a2 * a2 + b2 * b2 + c2 * c2)
    heights = z * z + u3 * u3 + v3 * v3
    free = heights / (z * z) * total**0.5
    turn = known.flat_norm * free
    flat = (x * x + y * y + u1 * u1 + v1 * v1 + u2 * u2 + v2 * v2) ** 0.5
    rise = 1.0 + known.s_norm * free + 2.0 * flat * turn
    return (turn * turn + 0.5 * rise * rise / heights) ** 0.5


def right_side(known: Coefficients, lengths: Sequence[float]) -> Six[float]:
    """Return what six lengths, m, say: x, y, v₁, s, m, n where t is zero."""
    l1, l2, l3, l4, l5, l6 = lengths
    l1, l2, l3, l4, l5, l6 = l1 * l1, l2 * l2, l3 * l3, l4 * l4, l5 * l5, l6 * l6
    o1, o2, o3, o4, o5, o6 = known.offset
    (
        (a1, a2, a3, a4, a5, a6),
        (b1, b2, b3, b4, b5, b6),
        (c1, c2, c3, c4, c5, c6),
        (d1, d2, d3, d4, d5, d6),
        (e1, e2, e3, e4, e5, e6),
        (f1, f2, f3, f4, f5, f6),
    ) = known.squares
    return (
        a1 * l1 + a2 * l2 + a3 * l3 + a4 * l4 + a5 * l5 + a6 * l6 + o1,
        b1 * l1 + b2 * l2 + b3 * l3 + b4 * l4 + b5 * l5 + b6 * l6 + o2,
        c1 * l1 + c2 * l2 + c3 * l3 + c4 * l4 + c5 * l5 + c6 * l6 + o3,
        d1 * l1 + d2 * l2 + d3 * l3 + d4 * l4 + d5 * l5 + d6 * l6 + o4,
        e1 * l1 + e2 * l2 + e3 * l3 + e4 * l4 + e5 * l5 + e6 * l6 + o5,
        f1 * l1 + f2 * l2 + f3 * l3 + f4 * l4 + f5 * l5 + f6 * l6 + o6,
    )  # fmt: skip


def own_side(known: Coefficients, at: Nine[float]) -> Six[float]:
    """Return what the lengths at an assembled pose say."""
    x, y, u1, v1, u2, v2, z, u3, v3 = at
    s, m, n = x * x + y * y + z * z, x * u1 + y * u2 + z * u3, x * v1 + y * v2 + z * v3
    a, b, c, d, e, f = (
        number - k1 * u1 - k2 * u2 - k3 * v2
        for number, (k1, k2, k3) in zip((x, y, v1, s, m, n), known.free, strict=True)
    )
    return (a, b, c, d, e, f)
