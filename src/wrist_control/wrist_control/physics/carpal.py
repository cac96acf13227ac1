"""Canfield's Carpal wrist: three legs of two links, each hinged at both plates. [Canfield1997].

The links of a leg meet in three hinges whose axes cross in one point: a ball joint. Three driven
hinges, three balls and three passive hinges leave the distal plate no freedom once the drives
stand; nothing here says that it mirrors the base.
"""

from __future__ import annotations

import math

from wrist_control.physics.linkage import Linkage
from wrist_control.physics.mechanism import Mechanism, Settings
from wrist_control.rotations import Vector
from wrist_control.wrists.carpal import Carpal

# Azimuths of the legs, [Canfield1997], fig. 4.1, rad.
AZIMUTHS = (0.0, math.tau / 3.0, -math.tau / 3.0)


def carpal(wrist: Carpal, settings: Settings) -> Mechanism:
    """Return the wrist as drawn at its plunge: plates level, legs outward."""
    linkage = Linkage(wrist.leg_length, settings)
    names = [joint.name for joint in wrist.joints]
    hand = linkage.link(linkage.forearm, 'hand', (0.0, 0.0, 2.0 * wrist.plunge))
    hand.add_freejoint()
    rise = math.asin(wrist.plunge / wrist.leg_length)
    out = wrist.leg_length * math.cos(rise)
    for name, azimuth in zip(names, AZIMUTHS, strict=True):
        x, y = math.cos(azimuth), math.sin(azimuth)
        hinge: Vector = (wrist.base_radius * x, wrist.base_radius * y, 0.0)
        # Square to the leg's plane, so that a leg rises by its drive.
        axis: Vector = (y, -x, 0.0)
        lower = linkage.link(linkage.forearm, f'{name} lower', hinge)
        linkage.hinge(lower, name, axis, driven=True, home=rise)
        upper = linkage.link(hand, f'{name} upper', hinge)
        linkage.hinge(upper, f'{name} distal', axis)
        node, mirrored = (out * x, out * y, wrist.plunge), (out * x, out * y, -wrist.plunge)
        linkage.ball(f'{name} mid', lower, node, upper, mirrored)
    return linkage.finished(hand, wrist.probe, names)
