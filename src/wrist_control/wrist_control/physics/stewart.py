"""Nguyen's platform: six legs, each with a universal joint, a slide and a ball. [Nguyen1991]."""

from __future__ import annotations

import math

from wrist_control.physics.linkage import ORIGIN, Linkage, X, Y, Z
from wrist_control.physics.mechanism import Mechanism, Settings
from wrist_control.wrists.body import turn_of_z
from wrist_control.wrists.stewart import Stewart


def stewart(wrist: Stewart, settings: Settings) -> Mechanism:
    """Return a platform that floats above the base, but for its six legs."""
    linkage = Linkage(wrist.size, settings)
    hand = linkage.link(linkage.forearm, 'hand', (0.0, 0.0, wrist.home_height))
    hand.add_freejoint()
    names = [joint.name for joint in wrist.joints]
    for name, foot, head in zip(names, wrist.base, wrist.platform, strict=True):
        along = (head[0] - foot[0], head[1] - foot[1], head[2] + wrist.home_height - foot[2])
        length = math.hypot(*along)
        ring = linkage.link(linkage.forearm, f'{name} ring', foot, turn_of_z(along))
        linkage.hinge(ring, f'{name} across', X)
        cylinder = linkage.link(ring, f'{name} cylinder')
        linkage.hinge(cylinder, f'{name} aside', Y)
        rod = linkage.link(cylinder, f'{name} rod', (0.0, 0.0, length))
        linkage.slide(rod, name, Z, driven=True, home=length)
        linkage.ball(f'{name} head', rod, ORIGIN, hand, head)
    return linkage.finished(hand, wrist.probe, names)
