"""A rotary Stewart platform: six driven horns, and rods between balls. [ReachyMini]."""

from __future__ import annotations

import math

from wrist_control.physics.linkage import ORIGIN, Linkage, X, Y, Z
from wrist_control.physics.mechanism import Mechanism, Settings
from wrist_control.rotations import IDENTITY, Vector, between, quaternion_of
from wrist_control.wrists.body import turn_of_z
from wrist_control.wrists.horn import Horn
from wrist_control.wrists.rotary_stewart import RotaryStewart

# Horns are drawn where their rods fit, found by halving the angle from zero to a straight one.
HALVINGS = 60


def rotary_stewart(wrist: RotaryStewart, settings: Settings) -> Mechanism:
    """Return a platform that floats above its servos, but for six rods on their horns."""
    linkage = Linkage(wrist.size, settings)
    hand = linkage.link(linkage.forearm, 'hand', (0.0, 0.0, wrist.home_height))
    hand.add_freejoint()
    names = [joint.name for joint in wrist.joints]
    for name, horn, head in zip(names, wrist.horns, wrist.platform, strict=True):
        x, y, z = head
        top = (x, y, z + wrist.home_height)
        drawn = _angle(horn, top, wrist.rod_length)
        tip, along = _tip(horn, drawn), quaternion_of((horn.along, horn.aside, horn.axis))
        servo = linkage.link(linkage.forearm, f'{name} mount', horn.centre, along)
        turned = (math.cos(0.5 * drawn), math.sin(0.5 * drawn), 0.0, 0.0)
        arm = linkage.link(servo, f'{name} horn', ORIGIN, turned)
        linkage.hinge(arm, name, Z, driven=True, home=drawn)
        ring = linkage.link(hand, f'{name} ring', head, turn_of_z(between(top, tip)))
        linkage.hinge(ring, f'{name} across', X)
        rod = linkage.link(ring, f'{name} rod', ORIGIN, IDENTITY)
        linkage.hinge(rod, f'{name} aside', Y)
        end = (0.0, 0.0, wrist.rod_length)
        linkage.ball(f'{name} tip', arm, (horn.length, 0.0, 0.0), rod, end)
    return linkage.finished(hand, wrist.probe, names)


def _tip(horn: Horn, angle: float) -> Vector:
    u, v = horn.length * math.cos(angle), horn.length * math.sin(angle)
    (x, y, z), (ax, ay, az), (bx, by, bz) = horn.centre, horn.along, horn.aside
    return (x + u * ax + v * bx, y + u * ay + v * by, z + u * az + v * bz)


def _angle(horn: Horn, top: Vector, rod: float) -> float:
    """Return the angle nearest to zero at which a rod reaches from the tip to a point, rad."""
    across = between(horn.centre, top)
    u, v = (sum(a * b for a, b in zip(across, way, strict=True)) for way in horn[2:4])
    # The tip is nearest to the point where the horn points at it, and furthest where it points
    # away: on the way from zero to one of them the rod fits.
    straight = math.atan2(v, u)
    if math.dist(_tip(horn, 0.0), top) < rod:
        straight -= math.copysign(math.pi, straight)
    fits, too_far = 0.0, straight
    longer = math.dist(_tip(horn, fits), top) > rod
    for _ in range(HALVINGS):
        middle = 0.5 * (fits + too_far)
        if (math.dist(_tip(horn, middle), top) > rod) == longer:
            fits = middle
        else:
            too_far = middle
    return fits
