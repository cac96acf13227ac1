"""The search for the poses that one set of lengths can hold: a Stewart platform has up to 40."""

from __future__ import annotations

import math
from collections.abc import Sequence

import numpy as np

from wrist_control.rotations import Pose, Poses, about_z, product, turned
from wrist_control.stewart.stages import Track

# Seeds this close find what 80 yaws or directions find, but for one pose in fifteen, in a tenth of
# the time: the search takes 25 ms. More are harmless but slow. Tilts, rad, go beyond a quarter
# turn, where legs have crossed.
TILTS = (0.0, 0.5, 1.0, 1.5, 2.2)
TILT_DIRECTIONS = 8
YAWS = 8
# Shares of the home height. A planar platform takes its height from the lengths, on the seed's
# side of the base; for any other, one height alone misses a pose in six.
HEIGHTS = (0.4, 0.8, 1.2)


def seeds(home: Pose) -> Poses:
    """Return poses all over the workspace to search from.

    Every combination of tilt, direction of tilt, turn about the platform's normal, and height.
    """
    x, y, z = home.position
    quaternions, positions = [], []
    for height in HEIGHTS:
        for tilt in TILTS:
            for direction in range(TILT_DIRECTIONS if tilt else 1):
                angle = math.tau * direction / TILT_DIRECTIONS
                axis = (tilt * math.cos(angle), tilt * math.sin(angle), 0.0)
                tilted = turned(home.quaternion, axis, 1.0)
                for yaw in range(YAWS):
                    quaternions.append(product(about_z(math.tau * yaw / YAWS), tilted))
                    positions.append((x, y, height * z))
    return Poses(np.array(quaternions), np.array(positions))


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
