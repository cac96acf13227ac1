"""Pictures of a mechanism: its bodies as shaded triangles, seen from one side.

`Wrist.bodies` says what there is to see; here it becomes a picture, without perspective.
"""

from __future__ import annotations

import math
from collections.abc import Sequence
from typing import NamedTuple

import numpy as np
from matplotlib.axes import Axes
from matplotlib.collections import PolyCollection
from matplotlib.colors import to_rgb

from wrist_control.rotations import Pose
from wrist_control.wrists.body import HAND, Arc, Ball, Body, Plate, Rod, Shape, colours

# Sides of a bar; and how much longer than thick the pieces of one are at most, so that the far
# ones are drawn before the near ones.
SIDES, LONGEST = 10, 4.0
# Pieces of a whole ring.
PIECES = 48
# From where the picture is seen and lit: azimuth and elevation, rad.
CAMERA = (math.radians(-55.0), math.radians(24.0))
LIGHT = (math.radians(-95.0), math.radians(55.0))
AMBIENT = 0.45


class Window(NamedTuple):
    """A part of the plane of a picture, m."""

    left: float
    right: float
    bottom: float
    top: float


def triangles(shape: Shape) -> np.ndarray:
    """Return a shape's surface as triangles, outside anticlockwise, shape (n, 3, 3), m."""
    if isinstance(shape, Ball):
        return _ball(np.array(shape.centre), shape.radius)
    if isinstance(shape, Plate):
        return _plate(np.array(shape.corners), shape.thickness)
    if isinstance(shape, Rod):
        return _rod(np.array(shape.begin), np.array(shape.end), shape.radius)
    return _arc(shape)


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
    pieces = max(1, math.ceil(PIECES * arc.angle / math.tau))
    angles = np.linspace(0.0, arc.angle, pieces + 1)[:, None]
    begin, axis = np.array(arc.begin), np.array(arc.axis)
    spokes = np.cos(angles) * begin + np.sin(angles) * np.cross(axis, begin)
    outward = spokes / np.linalg.norm(begin)
    frames = np.stack([np.broadcast_to(axis, outward.shape), outward], axis=1)
    return _tube(np.array(arc.centre) + spokes, frames, arc.radius)


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


def placed(points: np.ndarray, pose: Pose) -> np.ndarray:
    """Return points given in the axes of a pose in forearm axes, shape (…, 3), m."""
    return points @ pose.rotation + np.array(pose.position)


def seen(points: np.ndarray) -> np.ndarray:
    """Return where points are in the picture, and how near: to the right, up, and towards us."""
    azimuth, elevation = CAMERA
    sa, ca, se, ce = math.sin(azimuth), math.cos(azimuth), math.sin(elevation), math.cos(elevation)
    return points @ np.array([[-sa, -se * ca, ce * ca], [ca, -se * sa, ce * sa], [0.0, ce, se]])


def window(scenes: Sequence[Sequence[Body]]) -> Window:
    """Return the square of the picture that all of some scenes fit into."""
    corners = np.concatenate(
        [
            seen(placed(triangles(shape), body.pose)).reshape(-1, 3)[:, :2]
            for bodies in scenes
            for body in bodies
            for shape in body.shapes
        ]
    )
    low, high = corners.min(axis=0), corners.max(axis=0)
    x, y = (0.5 * (low + high)).tolist()
    half = 0.53 * float((high - low).max())
    return Window(x - half, x + half, y - half, y + half)


def draw(axes: Axes, bodies: Sequence[Body], trail: np.ndarray | None = None) -> PolyCollection:
    """Draw a mechanism; the nearest of its triangles last.

    Args:
        axes: A plain pair of axes; they lose their frame.
        bodies: What `Wrist.bodies` returned.
        trail: Points that the probe's tip has come by, forearm axes, m, shape (n, 3).
    """
    surfaces, paints = [], []
    for body, colour in zip(bodies, colours(bodies), strict=True):
        surface = np.concatenate([triangles(shape) for shape in body.shapes])
        surfaces.append(placed(surface, body.pose))
        paints.append(np.broadcast_to(to_rgb(colour), (len(surface), 3)))
    surface, paint = seen(np.concatenate(surfaces)), np.concatenate(paints)
    normals = np.cross(surface[:, 1] - surface[:, 0], surface[:, 2] - surface[:, 0])
    visible = normals[:, 2] > 0.0
    surface, paint, normals = surface[visible], paint[visible], normals[visible]
    normals /= np.linalg.norm(normals, axis=1)[:, None]
    azimuth, elevation = LIGHT
    light = seen(
        np.array(
            [
                math.cos(elevation) * math.cos(azimuth),
                math.cos(elevation) * math.sin(azimuth),
                math.sin(elevation),
            ]
        )
    )
    bright = AMBIENT + (1.0 - AMBIENT) * np.clip(normals @ light, 0.0, 1.0)
    order = surface[:, :, 2].mean(axis=1).argsort()
    shaded = (paint * bright[:, None])[order]
    drawn = PolyCollection(
        list(surface[order][:, :, :2]), facecolors=shaded, edgecolors=shaded, linewidths=0.3
    )
    axes.add_collection(drawn)
    if trail is not None and len(trail):
        x, y, _ = seen(np.asarray(trail)).T
        axes.plot(x, y, color=HAND, linewidth=1.2, alpha=0.6)
    axes.set_aspect('equal')
    axes.set_axis_off()
    return drawn
