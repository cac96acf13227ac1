"""What a person sees of joints in series: a drum along each axis, and rods between them."""

from __future__ import annotations

import math
from collections.abc import Sequence

from wrist_control.rotations import Vector, between, to_hand
from wrist_control.wrists import body
from wrist_control.wrists.body import Body, Pin, Rod, Shape
from wrist_control.wrists.serial_axes import SerialAxes

# Half the length of the outermost joint's drum and its radius, m; each further in is slimmer.
LENGTH, RADIUS = 0.05, 0.02
SLIMMER = 0.8
# What is closer than this, m, needs no rod between.
TOGETHER = 0.002


def serial_bodies(axes: SerialAxes, positions: Sequence[float], probe: Vector) -> tuple[Body, ...]:
    """Return the forearm, a body for each joint but the last, and the hand.

    Args:
        axes: The joints.
        positions: Where they are, rad.
        probe: Where the hand's probe ends, hand axes, m.
    """
    driven = axes.chain.driven
    places = [(0.0, 0.0, 0.0), *(one.origin for one in driven)]
    poses = [body.AT_REST, *axes.poses(positions)]
    names = ['forearm', *(f'{one.joint.name}_link' for one in driven)]
    found = []
    for index, one in enumerate(driven):
        at = between(places[index], one.origin)
        size = SLIMMER**index
        half = body.scaled(one.axis, size * LENGTH)
        drum = Rod(between(half, at), body.moved(at, one.axis, size * LENGTH), size * RADIUS)
        pins: tuple[Pin, ...] = (Pin(one.joint.name, at, one.axis),)
        if index:
            before = driven[index - 1]
            pins = (Pin(before.joint.name, body.ORIGIN, before.axis), *pins)
        found.append(Body(names[index], poses[index], (drum, *_rod(body.ORIGIN, at)), pins))
    tip = axes.chain.tip
    last = driven[-1]
    at = to_hand(tip.quaternion, between(tip.position, last.origin))
    pin = Pin(last.joint.name, at, to_hand(tip.quaternion, last.axis))
    return (*found, body.hand(poses[-1], (pin,), *_rod(at, body.ORIGIN), probe=probe))


def _rod(begin: Vector, end: Vector) -> tuple[Shape, ...]:
    return (Rod(begin, end, 2.0 * body.BAR),) if math.dist(begin, end) > TOGETHER else ()
