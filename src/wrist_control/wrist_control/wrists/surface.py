"""The surface of what a person sees of a mechanism, as triangles."""

from __future__ import annotations

import math

import numpy as np

from wrist_control.rotations import Pose
from wrist_control.wrists.body import Arc, Ball, Plate, Rod, Shape

# Sides of a bar; and how much longer than thick the pieces of one are at most, so that the far
# ones are drawn before the near ones.
SIDES, LONGEST = 10, 4.0


def triangles(shape: Shape) -> np.ndarray:
    """Return a shape's surface as triangles, outside anticlockwise, shape (n, 3, 3), m."""
    if isinstance(shape, Ball):
        return _ball(np.array(shape.centre), shape.radius)
    if isinstance(shape, Plate):
        return _plate(np.array(shape.corners), shape.thickness)
    if isinstance(shape, Rod):
        return _rod(np.array(shape.begin), np.array(shape.end), shape.radius)
    return _arc(shape)


def placed(points: np.ndarray, pose: Pose) -> np.ndarray:
    """Return points given in the axes of a pose in forearm axes, shape (…, 3), m."""
    return points @ pose.rotation + np.array(pose.position)


def _rod(begin: np.ndarray, end: np.ndarray, radius: float) -> np.ndarray:
    along = end - begin
    length = float(np.linalg.norm(along))
    normal = np.cross(along, np.eye(3)[np.abs(along).argmin()])
    normal /= np.linalg.norm(normal)
    pieces = max(1, math.ceil(length / (LONGEST * radius)))
    centres = begin + np.linspace(0.0, 1.0, pieces + 1)[:, None] * along
    frames = np.broadcast_to([normal, np.cross(along / length, normal)], (pieces + 1, 2, 3))
    return _tube(centres, frames, radius)


def _arc(arc: Arc) -> np.ndarray:
    centres = np.array(arc.points())
    outward = (centres - arc.centre) / np.linalg.norm(arc.begin)
    frames = np.stack([np.broadcast_to(arc.axis, outward.shape), outward], axis=1)
    return _tube(centres, frames, arc.radius)


def _tube(centres: np.ndarray, frames: np.ndarray, radius: float) -> np.ndarray:
    """Return a closed tube along centres; frames hold two unit vectors across it, (n, 2, 3)."""
    angles = np.linspace(0.0, math.tau, SIDES, endpoint=False)
    circle = radius * np.stack([np.cos(angles), np.sin(angles)], axis=1)
    rings = centres[:, None] + np.einsum('sk,nkx->nsx', circle, frames)
    one, next_ = rings[:-1], rings[1:]
    one_on, next_on = np.roll(one, -1, axis=1), np.roll(next_, -1, axis=1)
    sides = np.stack([one, one_on, next_on, one, next_on, next_], axis=2).reshape(-1, 3, 3)
    caps = [
        np.stack([np.broadcast_to(centre, ring.shape), ring, np.roll(ring, -1, axis=0)], axis=1)
        for centre, ring in ((centres[0], rings[0, ::-1]), (centres[-1], rings[-1]))
    ]
    return np.concatenate([sides, *caps])


def _ball(centre: np.ndarray, radius: float) -> np.ndarray:
    heights = np.linspace(-0.5 * math.pi, 0.5 * math.pi, SIDES // 2 + 1)
    angles = np.linspace(0.0, math.tau, SIDES + 1)
    low, angle = np.meshgrid(heights, angles, indexing='ij')
    points = np.stack(
        [np.cos(low) * np.cos(angle), np.cos(low) * np.sin(angle), np.sin(low)], axis=2
    )
    a, b, c, d = points[:-1, :-1], points[:-1, 1:], points[1:, 1:], points[1:, :-1]
    return centre + radius * np.stack([a, b, c, a, c, d], axis=2).reshape(-1, 3, 3)


def _plate(corners: np.ndarray, thickness: float) -> np.ndarray:
    middle = corners.mean(axis=0)
    normal = np.cross(corners[0] - middle, corners[1] - middle)
    half = 0.5 * thickness * normal / np.linalg.norm(normal)
    on = np.roll(corners, -1, axis=0)
    centres = np.broadcast_to(middle, corners.shape)
    top = np.stack([centres + half, corners + half, on + half], axis=1)
    bottom = np.stack([centres - half, on - half, corners - half], axis=1)
    sides = np.stack(
        [corners - half, on - half, on + half, corners - half, on + half, corners + half], axis=1
    )
    return np.concatenate([top, bottom, sides.reshape(-1, 3, 3)])
