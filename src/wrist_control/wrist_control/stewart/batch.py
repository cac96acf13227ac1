"""Many forward-kinematics solves of a planar platform at once, with the same proof for each."""

from __future__ import annotations

import math
from collections.abc import Iterator
from typing import NamedTuple

import numpy as np

from wrist_control.errors import InvalidValueError
from wrist_control.rotations import Pose, Poses, quaternion_of
from wrist_control.stewart.certificate import BRANCH_LIMIT, ROUNDING, Proof
from wrist_control.stewart.quadratics import (
    Coefficients,
    Matrix,
    Nine,
    kantorovich_beta,
    newton_inverse,
    unknowns_and_residual,
)
from wrist_control.stewart.stages import MOST_CORRECTIONS, SMALLEST_TRACE, Track, unknowns
from wrist_control.stewart.tracking import LOW, SHARP

# So many rows at a time stay in the processor's cache; nothing but speed hangs on it.
CHUNK = 8192

Array = np.ndarray


class Tracks(NamedTuple):
    """`stages.Track` as arrays; lengths are shares of the characteristic length.

    Attributes:
        at: The unknowns, shape (9, n).
        iterations: Shape (n,).
        error: Shape (n,); inf where nothing is proved.
        unique: Shape (n,); 0 where nothing is proved.
        followed: Shape (n,).
    """

    at: Array
    iterations: Array
    error: Array
    unique: Array
    followed: Array


class Roots(NamedTuple):
    """Where Newton's steps ended, and the last linearisation, before anything is proved."""

    at: Nine[Array]
    left: Array
    iterations: Array
    origin: Nine[Array]
    M_inverse: Matrix[Array]


def checked_lengths(lengths: Array) -> Array:
    """Return lengths as an array of shape (n, 6).

    Raises:
        InvalidValueError: Not of that shape, or a length that is not finite and above 0.
    """
    lengths = np.asarray(lengths, dtype=float)
    if lengths.ndim != 2 or lengths.shape[1] != 6:
        raise InvalidValueError(f'lengths has the shape {lengths.shape}; give (n, 6), m.')
    bad = ~(np.isfinite(lengths) & (lengths > 0.0))
    if bad.any():
        row, leg = np.argwhere(bad)[0]
        raise InvalidValueError(
            f'The length of leg_{leg + 1} in row {row} is {lengths[row, leg]}; it must be finite '
            'and above 0 m.'
        )
    return lengths


def checked_near(near: Pose | Poses, n: int) -> Poses:
    """Return the poses before n answers: one row for all, or one for each.

    Raises:
        InvalidValueError: Another number of poses, or shapes that are none.
    """
    shapes = np.shape(near.quaternion), np.shape(near.position)
    if shapes in (((4,), (3,)), ((n, 4), (n, 3))):
        return Poses(np.atleast_2d(near.quaternion), np.atleast_2d(near.position))
    raise InvalidValueError(
        f'near has quaternions of shape {shapes[0]} and positions of shape {shapes[1]}; give one '
        f'pose, or one for each of the {n} rows.'
    )


def unknowns_of(poses: Poses, size: float, part: slice = slice(None)) -> Array:
    """Return the unknowns at one pose, shape (9, 1), or at part of many, shape (9, n)."""
    quaternions, positions = poses
    if len(quaternions) > 1:
        quaternions, positions = quaternions[part], positions[part]
    (a1, a2, a3, a4), (x, y, z) = quaternions.T, positions.T
    return np.stack(unknowns(((a1, a2, a3, a4), (x, y, z)), size))


def chunks(n: int) -> Iterator[slice]:
    """Return the parts to solve one after another, so that each stays in the cache."""
    return (slice(first, min(first + CHUNK, n)) for first in range(0, n, CHUNK))


def right_sides(known: Coefficients, lengths: Array) -> Array:
    """Return what lengths, m, shape (n, 6), say, shape (6, n)."""
    offset = np.array(known.constant)[:, None]
    right: Array = np.array(known.per_square) @ (lengths * lengths).T + offset
    return right


def solve_rows(known: Coefficients, lengths: Array, start: Array) -> Tracks:
    """Solve each row of lengths from its start, and prove what was found.

    Args:
        known: The platform.
        lengths: m, shape (n, 6).
        start: Unknowns, shape (9, 1) or (9, n).
    """
    start = np.broadcast_to(start, (9, len(lengths)))
    with np.errstate(all='ignore'):
        roots = newton(known, right_sides(known, lengths), start)
        proofs = prove(known, roots, start)
    return Tracks(np.stack(roots.at), roots.iterations, *proofs)


def newton(known: Coefficients, right: Array, start: Array) -> Roots:
    """Make Newton steps until rounding is all that is left in every row that converges."""
    u1, u2, v2, side = start[2], start[4], start[5], np.copysign(1.0, start[6])
    floor = ROUNDING * (1.0 + np.abs(right[3]))
    iterations = np.full(right.shape[1], MOST_CORRECTIONS)
    last: Array | None = None
    for count in range(MOST_CORRECTIONS):
        at, e22, e23, e33 = unknowns_and_residual(tuple(right), known.per_t, u1, u2, v2, side)
        left = np.sqrt(e22 * e22 + 2.0 * e23 * e23 + e33 * e33)
        ended = ~(left > 0.125 * floor)  # rows without a root hold nan, and end as well
        if last is not None:
            ended |= (left < floor) & (left > 0.5 * last)
        iterations = np.where(ended, np.minimum(iterations, count), MOST_CORRECTIONS)
        if last is None or np.any((left > SHARP) & ~ended):
            origin, M_inverse = at, newton_inverse(known.per_t, at)
        if ended.all():
            break
        (u1_22, u1_23, u1_33), (u2_22, u2_23, u2_33), (v2_22, v2_23, v2_33) = M_inverse
        u1 = u1 - (u1_22 * e22 + u1_23 * e23 + u1_33 * e33)
        u2 = u2 - (u2_22 * e22 + u2_23 * e23 + u2_33 * e33)
        v2 = v2 - (v2_22 * e22 + v2_23 * e23 + v2_33 * e33)
        last = left
    return Roots(at, left + floor, iterations, origin, M_inverse)


def prove(known: Coefficients, roots: Roots, start: Array) -> tuple[Array, Array, Array]:
    """Return error, uniqueness, and whether the start leads there, as `tracking` does for one."""
    at, left, iterations, origin, M_inverse = roots
    bound: Array = kantorovich_beta(known, origin, M_inverse)
    away = _distance(origin, at)
    slack = 1.0 - 2.0 * bound * away
    bound = np.where(slack > 0.0, bound / slack, math.inf)
    discriminant = 1.0 - 4.0 * bound * bound * left
    root = 1.0 + np.sqrt(discriminant)
    sound = (discriminant > 0.0) & (iterations < MOST_CORRECTIONS)
    error = np.where(sound, 2.0 * bound * left / root, math.inf)
    unique = np.where(sound, 0.5 * root / bound, 0.0)
    followed = (np.abs(start[6]) > LOW) & (bound * (_distance(start, at) + error) <= BRANCH_LIMIT)
    return error, unique, followed


def _distance(one: Nine[Array] | Array, other: Nine[Array] | Array) -> Array:
    total = np.zeros(1)
    for a, b in zip(one, other, strict=True):
        difference = a - b
        total = total + difference * difference
    distance: Array = np.sqrt(total)
    return distance


def poses_of(at: Array, size: float) -> Poses:
    """Return the poses of unknowns, shape (9, n): `stages.pose_of` for many."""
    x, y, u1, v1, u2, v2, z, u3, v3 = at
    w1, w2, w3 = u2 * v3 - u3 * v2, u3 * v1 - u1 * v3, u1 * v2 - u2 * v1
    trace = 1.0 + u1 + v2 + w3
    quaternion = np.stack([trace, u2 - v1, w1 - u3, v3 - w2], axis=1)
    quaternion /= np.sqrt((quaternion * quaternion).sum(axis=1))[:, None]
    for far in np.flatnonzero(trace <= SMALLEST_TRACE):
        u, v = at[[2, 4, 7], far], at[[3, 5, 8], far]
        quaternion[far] = quaternion_of(np.array([u, v, np.cross(u, v)]))
    return Poses(quaternion, size * np.stack([x, y, z], axis=1))


def pose_in_row(poses: Poses, row: int) -> Pose:
    """Return one pose of many, or the only one."""
    index = row if len(poses.quaternion) > 1 else 0
    a1, a2, a3, a4 = poses.quaternion[index].tolist()
    x, y, z = poses.position[index].tolist()
    return Pose((a1, a2, a3, a4), (x, y, z))


def tracks_of(tracks: Tracks) -> list[Track]:
    """Return the rows that hold a proved root, one by one."""
    return [
        Track(
            tuple(tracks.at[:, i].tolist()),
            int(tracks.iterations[i]),
            Proof(float(tracks.error[i]), float(tracks.unique[i])),
            bool(tracks.followed[i]),
        )
        for i in np.flatnonzero(tracks.unique > 0.0)
    ]
