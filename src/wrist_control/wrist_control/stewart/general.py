"""One step of the forward kinematics of any platform, six legs at a time, with its proof.

Newton steps on the pose itself, each one 6×6 solve. The proof is that of the quadratic equations
H in the twelve unknowns X = [d u v w]: six squared lengths, and six products of the axes. What of
it does not depend on the base anchors is settled once: those of horns move with every reading.
docs/equations.md, (S12) and (S14), [Nguyen1991].
"""

from __future__ import annotations

import math
from collections.abc import Sequence
from typing import NamedTuple

import numpy as np

from wrist_control.rotations import Pose, Vector, product, to_forearm, unit
from wrist_control.stewart.certificate import (
    BRANCH_LIMIT,
    ROUNDING,
    Proof,
    beta_nearby,
    kantorovich,
    make_tuple,
)
from wrist_control.stewart.geometry import Anchors, legs
from wrist_control.stewart.quadratics import Six
from wrist_control.stewart.stages import (
    MOST_CORRECTIONS,
    Tangent,
    Track,
    Unknowns,
    pose_of,
    unknowns,
)

# A step by the platform's own size, or by 1 rad, is far beyond where a proof can hold: stages are
# the way there. Larger ones are harmless, and smaller ones cost stages.
LARGEST_STEP = 1.0
# From so little left of H, the step to its rounding can mostly be proved without another look.
SHARP = 1e-6
# With more than this left, squares of lengths are no longer as good as lengths: a search by them
# finds one pose in ten less.
FAR_OFF = 0.1
# An inverse serves again while what is left falls by this from look to look; a new one costs as
# much as two looks.
FALLS = 0.1
ROOT = math.sqrt(2.0)
# Entries of a symmetric matrix in the order of its weights: 1 on the diagonal, √2 beside it.
PAIRS = ((0, 0), (1, 1), (2, 2), (0, 1), (0, 2), (1, 2))


class Platforms(NamedTuple):
    """Anchors as shares of the characteristic length, and what follows from the platform's alone.

    Attributes:
        platform: Anchors in platform axes.
        base: Anchors in base axes.
        size: The characteristic length, m.
        per_leg: Takes a leg y of anchor p to (y, p × y, −T): its row of (S14) for a twist, and
            what it has of products of the axes, shape (6, 3, 16).
        constant: What is added to that, shape (6, 16).
    """

    platform: Anchors
    base: Anchors
    size: float
    per_leg: np.ndarray
    constant: np.ndarray


class Linearisation(NamedTuple):
    """Where a platform was linearised.

    Attributes:
        inverse: Twist per half of what squared lengths miss, shape (6, 6).
        beta: β for `certificate.kantorovich`.
        norm: A bound on ‖H'⁻¹‖.
    """

    inverse: np.ndarray
    beta: float
    norm: float


def scaled(platform: Anchors, base: Anchors, size: float) -> Platforms:
    """Return anchors as shares of the characteristic length."""
    points = _scaled(platform, size)
    per_leg, constant = np.zeros((6, 3, 16)), np.zeros((6, 16))
    for leg, (x, y, z) in enumerate(points):
        p = np.array((x, y, z))
        per_leg[leg, :, :3] = np.eye(3)
        per_leg[leg, :, 3:6] = [[0.0, z, -y], [-z, 0.0, x], [y, -x, 0.0]]
        constant[leg, 6:10] = 1.0, ROOT * x, ROOT * y, ROOT * z
        for column, (i, j) in enumerate(PAIRS, start=10):
            weight = 0.5 if i == j else 0.5 * ROOT
            per_leg[leg, i, column] -= weight * p[j]
            per_leg[leg, j, column] -= weight * p[i]
            constant[leg, column] = 2.0 * weight * p[i] * p[j]
    return Platforms(points, _scaled(base, size), size, per_leg, constant)


def moved(known: Platforms, base: Anchors) -> Platforms:
    """Return the same platform on other base anchors, m."""
    platform, _, size, per_leg, constant = known
    return make_tuple(Platforms, (platform, _scaled(base, size), size, per_leg, constant))


def _scaled(points: Anchors, size: float) -> Anchors:
    a, b, c, d, e, f = [(x / size, y / size, z / size) for x, y, z in points]
    return (a, b, c, d, e, f)


def squares(known: Platforms, lengths: Sequence[float]) -> Six[float]:
    """Return the goal of six lengths, m: their squares as shares of the size's."""
    a, b, c, d, e, f = [(x / known.size) ** 2 for x in lengths]
    return (a, b, c, d, e, f)


def squares_at(known: Platforms, at: Unknowns) -> Six[float]:
    """Return the goal that the lengths at an assembled pose are."""
    vectors = legs(known.platform, known.base, pose_of(at, 1.0))
    a, b, c, d, e, f = [x * x + y * y + z * z for x, y, z in vectors]
    return (a, b, c, d, e, f)


def solve_general(
    known: Platforms, goal: Six[float], start: Unknowns, tangent: Tangent | None = None
) -> Track | None:
    """Correct until rounding is all that is left, and prove where that is.

    The last step is made from where the equations were linearised last: (S15) bounds what it
    leaves, and where that is no more than rounding, nothing has to be looked at again.

    Args:
        known: The platform.
        goal: Squares of its lengths.
        start: An assembled pose.
        tangent: A linearisation near the start, where there is one; no proof rests on it.
    """
    if not min(goal) > 0.0:
        return None
    floor = ROUNDING * (1.0 + max(goal))
    pose, last = pose_of(start, 1.0), math.inf
    inverse = None if tangent is None else tangent.inverse
    for count in range(MOST_CORRECTIONS):
        vectors = legs(known.platform, known.base, pose)
        missing = [g - x * x - y * y - z * z for g, (x, y, z) in zip(goal, vectors, strict=True)]
        a, b, c, d, e, f = missing
        left = math.sqrt(a * a + b * b + c * c + d * d + e * e + f * f)
        done = left <= 0.125 * floor or floor > left > 0.5 * last
        if done or left <= SHARP or inverse is None or left > FALLS * last:
            here = linearised(known, vectors)
            if here is None:
                return None
            inverse = here.inverse
            if done or left <= SHARP:
                twist = (inverse @ missing).tolist()
                proof = kantorovich(here.beta, size_of(twist) + here.norm * floor)
                if done or (here.beta + 0.5) * proof.error**2 <= here.norm * floor:
                    away = 0.0 if done else size_of(twist)
                    if not done:
                        proof, pose = after_step(here, proof, away, floor), _moved(pose, twist)
                    beta = beta_nearby(here.beta, away)
                    return _proved(pose, start, count, proof, beta, here.inverse)
        if left > FAR_OFF:
            missing = _by_lengths(goal, missing)
        twist = (inverse @ missing).tolist()
        if not max(twist) < LARGEST_STEP or not min(twist) > -LARGEST_STEP:
            return None
        pose, last = _moved(pose, twist), left
    return None


def _moved(pose: Pose, twist: Sequence[float]) -> Pose:
    vx, vy, vz, p, q, r = twist
    dx, dy, dz = to_forearm(pose.quaternion, (vx, vy, vz))
    x, y, z = pose.position
    # By 2 atan(|ω| / 2): as the turn itself to its second order, and without a sine.
    turn = unit(product(pose.quaternion, (1.0, 0.5 * r, 0.5 * q, 0.5 * p)))
    return make_tuple(Pose, (turn, (x + dx, y + dy, z + dz)))


def size_of(twist: Sequence[float]) -> float:
    """Return how far a small twist moves the twelve unknowns: ‖ΔR‖ = √2 |ω|."""
    vx, vy, vz, p, q, r = twist
    return math.sqrt(vx * vx + vy * vy + vz * vz + 2.0 * (p * p + q * q + r * r))


def _by_lengths(goal: Six[float], missing: Sequence[float]) -> list[float]:
    """Return what squares miss as it is by the lengths: from afar Newton's steps lead further."""
    found = []
    for wanted, part in zip(goal, missing, strict=True):
        length = math.sqrt(wanted - part)
        found.append(2.0 * length * (math.sqrt(wanted) - length))
    return found


def after_step(here: Linearisation, proof: Proof, step: float, floor: float) -> Proof:
    """Return what is proved around the end of a step, of what is proved where it begins: (S15).

    Args:
        here: Where the step begins.
        proof: Of that.
        step: How far it moves the unknowns.
        floor: Rounding of H.
    """
    error = (here.beta + 0.5) * proof.error**2 + (here.norm + 1.0) * floor
    return make_tuple(Proof, (error, max(proof.unique - step, 0.0)))


def _proved(
    pose: Pose, start: Unknowns, count: int, proof: Proof, beta: float, inverse: np.ndarray
) -> Track:
    at = unknowns(pose, 1.0)
    followed = beta * (_distance(start, at) + proof.error) <= BRANCH_LIMIT
    return make_tuple(Track, (at, count, proof, followed, make_tuple(Tangent, (at, inverse))))


def linearised(known: Platforms, vectors: Sequence[Vector]) -> Linearisation | None:
    """Return the inverse at some legs with its bounds, (S14); None at a lock.

    A change of X is one of the platform's place, a turn ω, and a stretch of its axes. The six
    products give the stretch at once; with that known, the legs give place and turn.
    """
    rows = (np.array(vectors)[:, None, :] @ known.per_leg)[:, 0, :] + known.constant
    try:
        inverse = np.linalg.inv(rows[:, :6])
    except np.linalg.LinAlgError:
        return None
    weighted = WEIGHTS * inverse
    second = weighted @ rows[:, 6:]
    gram = second @ second.T
    twice = gram @ gram
    # ‖second‖² is the largest eigenvalue λ of its Gram matrix, and λ⁴ at most the sum of all.
    largest = math.sqrt(math.sqrt(float(np.vdot(twice, twice))))
    beta = 0.5 * math.sqrt(largest + 1.0)
    whole = float(np.vdot(weighted, weighted)) + float(np.vdot(second, second)) + 1.0
    return Linearisation(0.5 * inverse, beta, 0.5 * math.sqrt(whole))


# A turn ω moves the axes by ‖ΔR‖ = √2 |ω|.
WEIGHTS = np.array([[1.0], [1.0], [1.0], [ROOT], [ROOT], [ROOT]])


def _distance(one: Unknowns, other: Unknowns) -> float:
    """Return the distance of all twelve unknowns: the third axes count as well."""
    return math.hypot(math.dist(one, other), math.dist(_third(one), _third(other)))


def _third(at: Unknowns) -> Vector:
    _, _, u1, v1, u2, v2, _, u3, v3 = at
    return (u2 * v3 - u3 * v2, u3 * v1 - u1 * v3, u1 * v2 - u2 * v1)
