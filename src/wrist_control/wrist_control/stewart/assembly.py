"""The search for the poses that one set of lengths can hold: a Stewart platform has up to 40."""

from __future__ import annotations

import math
from collections.abc import Sequence

import numpy as np

from wrist_control.rotations import Pose, about_z, product, turned
from wrist_control.stewart.stages import Track

# Values of each of u₁, u₂, v₂ to search from, for a planar platform. Of the poses that twice as
# many find, in seven times the time, these find 99 in a hundred; a third as many find 94.
GRID = 24
# What that misses is low and overturned, where the quadratics divide by a small height. Seeds
# there, for six legs at a time, find more than half of it: a share of the home height, of which a
# tenth would do as well, and rad.
LOW_HEIGHTS = (0.06,)
OVERTURNED = (1.85,)
# Seeds of any other platform: twice as many of each find one pose in fifteen more. Tilts, rad, go
# beyond a quarter turn, where legs have crossed; of the shares of the home height, one alone
# misses a pose in six.
TILTS = (0.0, 0.5, 1.0, 1.5, 2.2)
HEIGHTS = (0.4, 0.8, 1.2)
TILT_DIRECTIONS = 8
YAWS = 8


def planar_seeds() -> np.ndarray:
    """Return unknowns above the base to search from, shape (9, n), for a planar platform.

    Only u₁, u₂, v₂ and the side are set: `batch` takes the rest from the lengths. (u₁, u₂) and
    (u₂, v₂) are parts of unit vectors, which leaves a part of the cube. They stand closer at its
    faces, where a small turn changes them least.
    """
    values = np.sin(0.5 * math.pi * (2.0 * np.arange(GRID) + 1.0 - GRID) / GRID)
    u1, u2, v2 = (grid.ravel() for grid in np.meshgrid(values, values, values, indexing='ij'))
    held = (u1 * u1 + u2 * u2 <= 1.0) & (u2 * u2 + v2 * v2 <= 1.0)
    starts = np.zeros((9, np.count_nonzero(held)))
    starts[2], starts[4], starts[5], starts[6] = u1[held], u2[held], v2[held], 1.0
    return starts


def seeds(
    home: Pose, heights: Sequence[float] = HEIGHTS, tilts: Sequence[float] = TILTS
) -> list[Pose]:
    """Return poses all over the workspace to search from, six legs at a time.

    Every combination of height, tilt, direction of tilt, and turn about the base's normal.

    Args:
        home: The pose that is tilted and turned.
        heights: Shares of its height.
        tilts: rad.
    """
    x, y, z = home.position
    found = []
    for tilt in tilts:
        for direction in range(TILT_DIRECTIONS if tilt else 1):
            angle = math.tau * direction / TILT_DIRECTIONS
            axis = (tilt * math.cos(angle), tilt * math.sin(angle), 0.0)
            tilted = turned(home.quaternion, axis, 1.0)
            for yaw in range(YAWS):
                quaternion = product(about_z(math.tau * yaw / YAWS), tilted)
                found += [Pose(quaternion, (x, y, height * z)) for height in heights]
    return found


def different(tracks: Sequence[Track]) -> list[Track]:
    """Return the tracks whose roots are proved to be different from each other, once each."""
    kept: list[Track] = []
    for track in sorted(tracks, key=lambda track: track.proof.error):
        if all(math.dist(track.at, other.at) > _same(track, other) for other in kept):
            kept.append(track)
    return kept


def _same(one: Track, other: Track) -> float:
    """Return the distance up to which two answers may be the same root."""
    return one.proof.error + other.proof.error
