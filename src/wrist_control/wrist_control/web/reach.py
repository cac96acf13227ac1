"""Where the probe can point no further: the edge that a page draws around the hand."""

from __future__ import annotations

import functools
import math

from wrist_control.dexterity import sweep
from wrist_control.rotations import Vector
from wrist_control.wrists import Wrist

# Directions that are looked into, and how closely, rad.
HEADINGS = 48
ANGLES = tuple(math.radians(3.0 * step) for step in range(60))


@functools.lru_cache(maxsize=8)
def edge_of_reach(wrist: Wrist) -> tuple[Vector, ...]:
    """Return where the probe's tip is when it points as far as it can, m, forearm frame.

    The hand turns from home about axes square to its probe. Where nothing ends its way, no point
    is returned.
    """
    tips = []
    along = max(range(3), key=lambda axis: abs(wrist.probe[axis]))
    first, second = (axis for axis in range(3) if axis != along)
    for heading in (math.tau * step / HEADINGS for step in range(HEADINGS)):
        axis = [0.0, 0.0, 0.0]
        axis[first], axis[second] = math.cos(heading), math.sin(heading)
        way = sweep(wrist, axis, ANGLES)
        if 0 < len(way) < len(ANGLES):
            tips.append(wrist.forward(way[-1]).point(wrist.probe))
    return tuple(tips)
