"""How well a wrist can turn the hand: measures of its Jacobian, and sweeps of its workspace.

[Canfield1997], sections 4.2, 4.5 and 4.6. The measures take one Jacobian or a stack of them,
shape (..., rows, joints), and give one value each; NaN, outside the workspace, stays NaN.
"""

from __future__ import annotations

import math
from collections.abc import Sequence
from typing import NamedTuple

import numpy as np

from wrist_control.errors import InvalidValueError, UnreachableError
from wrist_control.rotations import Pose
from wrist_control.wrists.wrist import Positions, SteeringState, Wrist

# Table 4.1 in numbers: [Canfield1997], 4.6.1, and a ratio where a joint is ten times too fast.
LEAST_DETERMINANT = 0.5
LARGEST_RATIO = 10.0


def principal(jacobian: np.ndarray) -> np.ndarray:
    """Return the principal dexterities, largest first, shape (..., min(rows, joints)).

    These are the singular values: D of (4.3) along the principal directions.
    """
    values = np.full((*jacobian.shape[:-2], min(jacobian.shape[-2:])), np.nan)
    inside = np.isfinite(jacobian).all(axis=(-2, -1))
    values[inside] = np.linalg.svd(jacobian[inside], compute_uv=False)
    return values


def determinant(jacobian: np.ndarray) -> np.ndarray:
    """Return |det J|, or √det(JᵀJ) for a tall and √det(JJᵀ) for a short one: one measure."""
    volume: np.ndarray = principal(jacobian).prod(axis=-1)
    return volume


def singular_ratio(jacobian: np.ndarray) -> np.ndarray:
    """Return σ_max / σ_min, 1 at best and infinite at a singular position."""
    values = principal(jacobian)
    with np.errstate(divide='ignore', invalid='ignore'):
        ratio: np.ndarray = values[..., 0] / values[..., -1]
    return ratio


def dexterity(jacobian: np.ndarray, velocity: np.ndarray) -> np.ndarray:
    """Return D = |v| / |ω| for a hand velocity that the joints can make, (4.3).

    ω is the smallest joint velocity that makes v. That is (4.4) for a square Jacobian, (4.5) for
    a tall one and (4.6) for a short one.

    Args:
        jacobian: Shape (..., rows, joints).
        velocity: v, shape (..., rows), not 0.
    """
    joint_velocity = np.linalg.pinv(jacobian) @ velocity[..., None]
    ratio: np.ndarray = np.linalg.norm(velocity, axis=-1) / np.linalg.norm(
        joint_velocity[..., 0], axis=-1
    )
    return ratio


def is_dexterous(
    jacobian: np.ndarray,
    least_determinant: float = LEAST_DETERMINANT,
    largest_ratio: float = LARGEST_RATIO,
) -> np.ndarray:
    """Return where both measures agree on high dexterity: Table 4.1."""
    large = determinant(jacobian) >= least_determinant
    even: np.ndarray = large & (singular_ratio(jacobian) <= largest_ratio)
    return even


class Uniformity(NamedTuple):
    """How uniform a dexterity is over a workspace, [Canfield1997], 4.6.2.

    Attributes:
        least: Smallest value.
        largest: Largest value.
        mean: Mean.
        deviation: Standard deviation: the paper's dexterous measure, smaller is better.
    """

    least: float
    largest: float
    mean: float
    deviation: float

    @property
    def relative(self) -> float:
        """Deviation over mean: the dexterous measure that no gearing can change."""
        return self.deviation / self.mean


def dexterous_measure(values: np.ndarray, weights: np.ndarray | None = None) -> Uniformity:
    """Return how uniform a dexterity is; values that are not finite lie outside and are skipped.

    Args:
        values: Dexterity at each place, any shape.
        weights: How much of the workspace each place stands for, the same shape; equal when not
            given, and then the deviation has n - 1 below it, as in Table 4.3.
    """
    inside = np.isfinite(values)
    if np.count_nonzero(inside) < 2:
        raise InvalidValueError('A dexterous measure needs at least two finite values.')
    kept = values[inside]
    share = np.ones_like(kept) if weights is None else weights[inside]
    total = share.sum()
    mean = float((kept * share).sum() / total)
    square = float((share * (kept - mean) ** 2).sum())
    divisor = total - 1.0 if weights is None else total
    return Uniformity(float(kept.min()), float(kept.max()), mean, math.sqrt(square / divisor))


def jacobians(wrist: Wrist, positions: Sequence[Positions]) -> np.ndarray:
    """Return the rates about the hand's followed axes per joint rate, shape (n, axes, joints).

    Args:
        wrist: The mechanism.
        positions: Joint positions as the wrist gave them, rad or m.
    """
    rows = [axis - 3 for axis in wrist.followed_axes]
    found = np.empty((len(positions), len(rows), len(wrist.joints)))
    for place, position in enumerate(positions):
        found[place] = wrist.jacobian(position)[rows]
    return found


def sweep(wrist: Wrist, axis: Sequence[float], angles: Sequence[float]) -> list[Positions]:
    """Return the joint positions while the hand turns from home about one of its own axes.

    Args:
        wrist: The mechanism; its position limits and clearances end the sweep.
        axis: Unit vector in hand axes; p, q, r are held in its direction.
        angles: Where to look, rad, growing from 0 on; the hand turns from one to the next at
            once, so a lock narrower than that is stepped over.

    Returns:
        Joint positions, rad or m, one for each angle up to the workspace edge.
    """
    found: list[Positions] = []
    twist = (*(0.0,) * (wrist.twist_size - 3), *axis)
    place, before = _Place(wrist.home, wrist.forward(wrist.home), ()), 0.0
    for angle in angles:
        try:
            place = _turned_on(wrist, place, twist, angle - before)
        except UnreachableError:
            break
        found.append(place.positions)
        before = angle
    return found


class _Place(NamedTuple):
    """Where a sweep has come to."""

    positions: Positions
    pose: Pose
    steering_state: SteeringState


def _turned_on(wrist: Wrist, place: _Place, twist: Sequence[float], angle: float) -> _Place:
    near, steering_state = wrist.choose_branch_reference(
        place.positions, 1.0, angle, place.steering_state
    )
    pose = wrist.target_pose(place.pose, twist, angle)
    positions = wrist.inverse(pose, near)
    within = all(
        joint.lower <= position <= joint.upper
        for joint, position in zip(wrist.joints, positions, strict=True)
    )
    if not within or any(clearance.remaining < 0.0 for clearance in wrist.clearances(positions)):
        raise UnreachableError('outside the limits')
    return _Place(positions, pose, steering_state)


def disc(
    wrist: Wrist, plane: tuple[int, int], headings: Sequence[float], angles: Sequence[float]
) -> np.ndarray:
    """Return the Jacobians of `jacobians` over turns from home about every axis in a plane.

    Args:
        wrist: The mechanism.
        plane: Two of the hand's axes, 0 to 2; heading 0 is along the first.
        headings: Directions of the turning axis in the plane, rad.
        angles: How far to turn about each, rad, growing from 0 on.

    Returns:
        Shape (headings, angles, axes, joints); NaN outside the workspace.
    """
    shape = (len(headings), len(angles), len(wrist.followed_axes), len(wrist.joints))
    found = np.full(shape, np.nan)
    for row, heading in enumerate(headings):
        axis = [0.0, 0.0, 0.0]
        axis[plane[0]], axis[plane[1]] = math.cos(heading), math.sin(heading)
        inside = jacobians(wrist, sweep(wrist, axis, angles))
        found[row, : len(inside)] = inside
    return found
