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

from wrist_control.wrists.body import HAND, Body, colours
from wrist_control.wrists.surface import placed, triangles

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
