"""One step of the forward kinematics of any platform, six legs at a time, with its proof.

Newton steps on the pose itself, each one 6×6 solve. The proof is that of the quadratic equations
H in the twelve unknowns X = [d u v w]: six squared lengths, and six products of the axes.
docs/equations.md, [Nguyen1991].
"""

from __future__ import annotations

import math
from collections.abc import Sequence
from typing import NamedTuple

import numpy as np

from wrist_control.rotations import Pose, to_forearm, turned
from wrist_control.stewart.certificate import BRANCH_LIMIT, NOTHING_PROVED, ROUNDING, kantorovich
from wrist_control.stewart.geometry import SHORTEST, Anchors, legs, length, line
from wrist_control.stewart.quadratics import Six
from wrist_control.stewart.stages import MOST_CORRECTIONS, Track, Unknowns, pose_of, unknowns

# A step by the platform's own size, or by 1 rad, is far beyond where a proof can hold: stages are
# the way there. Larger ones are harmless, and smaller ones cost stages.
LARGEST_STEP = 1.0


class Platforms(NamedTuple):
    """Anchors as shares of the characteristic length, m."""

    platform: Anchors
    base: Anchors
    size: float


def scaled(platform: Anchors, base: Anchors, size: float) -> Platforms:
    """Return anchors as shares of the characteristic length."""
    return Platforms(_scaled(platform, size), _scaled(base, size), size)


def _scaled(points: Anchors, size: float) -> Anchors:
    a, b, c, d, e, f = ((x / size, y / size, z / size) for x, y, z in points)
    return (a, b, c, d, e, f)


def squares(known: Platforms, lengths: Sequence[float]) -> Six[float]:
    """Return the goal of six lengths, m: their squares as shares of the size's."""
    a, b, c, d, e, f = ((x / known.size) ** 2 for x in lengths)
    return (a, b, c, d, e, f)


def squares_at(known: Platforms, at: Unknowns) -> Six[float]:
    """Return the goal that the lengths at an assembled pose are."""
    a, b, c, d, e, f = (length(leg) ** 2 for leg in legs(*known[:2], pose_of(at, 1.0)))
    return (a, b, c, d, e, f)


def solve_general(known: Platforms, goal: Six[float], start: Unknowns) -> Track | None:
    """Correct until rounding is all that is left, and prove where that is."""
    if not min(goal) > 0.0:
        return None
    wanted = [math.sqrt(x) for x in goal]
    floor = ROUNDING * (1.0 + max(goal))
    pose, last = pose_of(start, 1.0), math.inf
    for count in range(MOST_CORRECTIONS):
        vectors = legs(known.platform, known.base, pose)
        lengths = [length(vector) for vector in vectors]
        left = math.sqrt(sum((a * a - b) ** 2 for a, b in zip(lengths, goal, strict=True)))
        if left <= 0.125 * floor or floor > left > 0.5 * last:
            return _proved(known, pose, start, count, left + floor)
        if not min(lengths) > SHORTEST:
            return None
        lines = [line(*leg) for leg in zip(vectors, lengths, known.platform, strict=True)]
        try:
            twist = np.linalg.solve(lines, np.subtract(wanted, lengths))
        except np.linalg.LinAlgError:
            return None
        if not np.abs(twist).max() < LARGEST_STEP:
            return None
        pose = _moved(pose, *(float(x) for x in twist))
        last = left
    return None


def _moved(pose: Pose, vx: float, vy: float, vz: float, p: float, q: float, r: float) -> Pose:
    dx, dy, dz = to_forearm(pose.quaternion, (vx, vy, vz))
    x, y, z = pose.position
    return Pose(turned(pose.quaternion, (p, q, r), 1.0), (x + dx, y + dy, z + dz))


def _proved(known: Platforms, pose: Pose, start: Unknowns, count: int, left: float) -> Track:
    at = unknowns(pose, 1.0)
    size, legs_size = bounds(known, pose)
    proof = kantorovich(size, legs_size * left) if math.isfinite(size) else NOTHING_PROVED
    followed = size * (_distance(start, at) + proof.error) <= BRANCH_LIMIT
    return Track(at, count, proof, followed)


def bounds(known: Platforms, pose: Pose) -> tuple[float, float]:
    """Return β for `certificate.kantorovich`, and the norm of the inverse of H' itself.

    With H'⁻¹ = A, β = ‖A T‖, where T gives the second-order part of H, T·ΔXᵀΔX: 1 for Δd·Δd,
    2 p for Δd·(Δu, Δv, Δw) in the six legs, and 1 for the products of the axes.
    """
    d, rotation = np.array(pose.position), pose.rotation.T
    p, b = np.array(known.platform), np.array(known.base)
    derivative = np.zeros((12, 12))
    derivative[:6, :3] = 2.0 * (d + p @ rotation.T - b)
    for axis in range(3):
        derivative[:6, 3 + 3 * axis : 6 + 3 * axis] = 2.0 * (d - b) * p[:, axis : axis + 1]
        derivative[6 + axis, 3 + 3 * axis : 6 + 3 * axis] = 2.0 * rotation[:, axis]
    root = math.sqrt(2.0)
    for row, (one, other) in enumerate(((0, 1), (0, 2), (1, 2)), start=9):
        derivative[row, 3 + 3 * one : 6 + 3 * one] = root * rotation[:, other]
        derivative[row, 3 + 3 * other : 6 + 3 * other] = root * rotation[:, one]
    second = np.eye(12, 10, -2)
    second[:6] = 0.0
    second[:6, :4] = np.column_stack([np.ones(6), root * p])
    try:
        inverse = np.linalg.inv(derivative)
    except np.linalg.LinAlgError:
        return math.inf, math.inf
    return float(np.linalg.norm(inverse @ second, 2)), float(np.linalg.norm(inverse, 2))


def _distance(one: Unknowns, other: Unknowns) -> float:
    """Return the distance of all twelve unknowns: the third axes count as well."""
    w = [_third(at) for at in (one, other)]
    return math.hypot(math.dist(one, other), math.dist(*w))


def _third(at: Unknowns) -> tuple[float, float, float]:
    _, _, u1, v1, u2, v2, _, u3, v3 = at
    return (u2 * v3 - u3 * v2, u3 * v1 - u1 * v3, u1 * v2 - u2 * v1)
