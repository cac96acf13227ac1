"""What a person sees of a mechanism: rigid bodies, what they look like, and what joins them.

Every shape and every pin is given in its body's own axes, so that only a body's pose changes when
the joints move. All that draws a wrist (markers, pictures, pages) draws this.
"""

from __future__ import annotations

import math
from collections.abc import Sequence
from typing import NamedTuple, TypeAlias

from wrist_control.rotations import IDENTITY, Pose, Quaternion, Vector, about_x, cross, unit
from wrist_control.units import INCH

# Radius of the bars that a wrist without dimensions of its own is drawn with, m.
BAR = 0.003
# Pieces that a whole ring is drawn with.
PIECES = 48
# [Barker1986]: the hand holds a probe of 6 in.
PROBE_LENGTH = 6.0 * INCH
ALONG_X: Vector = (PROBE_LENGTH, 0.0, 0.0)
ALONG_Z: Vector = (0.0, 0.0, PROBE_LENGTH)

# How bodies are coloured: the forearm, the hand, and those between from the forearm on.
FOREARM, HAND = '#5b6470', '#d55e00'
BETWEEN = ('#0072b2', '#56b4e9', '#009e73', '#94a3b8', '#cc79a7', '#e69f00')

X: Vector = (1.0, 0.0, 0.0)
Y: Vector = (0.0, 1.0, 0.0)
Z: Vector = (0.0, 0.0, 1.0)
BACK: Vector = (-1.0, 0.0, 0.0)
RIGHT: Vector = (0.0, -1.0, 0.0)
DOWN: Vector = (0.0, 0.0, -1.0)
ORIGIN: Vector = (0.0, 0.0, 0.0)
AT_REST = Pose(IDENTITY)


class Rod(NamedTuple):
    """A round bar from one point to another, m; a short thick one is a disc."""

    begin: Vector
    end: Vector
    radius: float = BAR


class Arc(NamedTuple):
    """A round bar bent to a part of a circle, or to a whole ring.

    Attributes:
        centre: Centre of the circle, m.
        begin: From the centre to where the bar begins, m.
        axis: Unit vector about which the bar runs on from there.
        angle: How far it runs, rad; 2π is a ring.
        radius: Radius of the bar, m.
    """

    centre: Vector
    begin: Vector
    axis: Vector
    angle: float
    radius: float = BAR

    def points(self) -> list[Vector]:
        """Return points along its middle, as many as a curve needs that looks smooth, m."""
        pieces = max(1, math.ceil(PIECES * self.angle / math.tau))
        across = cross(self.axis, self.begin)
        points: list[Vector] = []
        for piece in range(pieces + 1):
            turn = self.angle * piece / pieces
            x, y, z = scaled(self.begin, math.cos(turn))
            ax, ay, az = scaled(across, math.sin(turn))
            cx, cy, cz = self.centre
            points.append((cx + x + ax, cy + y + ay, cz + z + az))
        return points


class Ball(NamedTuple):
    """A ball, m."""

    centre: Vector
    radius: float


class Plate(NamedTuple):
    """A flat plate: its corners in order around it, and its thickness, m."""

    corners: tuple[Vector, ...]
    thickness: float


Shape: TypeAlias = Rod | Arc | Ball | Plate


class Pin(NamedTuple):
    """Where a body is joined to the one other body that has a pin of the same name.

    The pins of both bodies are at the same place and have the same axis, whatever the joints do.
    A pin that is named like a driven joint moves by that joint's position.

    Attributes:
        name: Names the pair.
        point: Where it is, body axes, m.
        axis: Unit vector that both bodies turn about, body axes; None for a ball joint.
        slides: The bodies do not turn but slide along the axis.
    """

    name: str
    point: Vector
    axis: Vector | None = None
    slides: bool = False


class Body(NamedTuple):
    """One rigid body of a mechanism.

    Attributes:
        name: What it is called, lower case with underscores.
        pose: Where it is in the forearm frame.
        shapes: What it looks like, body axes.
        pins: What joins it to others, body axes.
    """

    name: str
    pose: Pose
    shapes: tuple[Shape, ...]
    pins: tuple[Pin, ...] = ()


def colours(bodies: Sequence[Body]) -> list[str]:
    """Return a colour for each body: the forearm's, the hand's, and others in a row between.

    Bodies that end in the same number belong to one leg and have one colour.
    """
    rows: dict[str, str] = {}
    for body in bodies[1:-1]:
        rows.setdefault(_leg_of(body), BETWEEN[len(rows) % len(BETWEEN)])
    return [FOREARM, *(rows[_leg_of(body)] for body in bodies[1:-1]), HAND]


def _leg_of(body: Body) -> str:
    _, _, number = body.name.rpartition('_')
    return number if number.isdigit() else body.name


def scaled(vector: Vector, factor: float) -> Vector:
    """Return a vector made longer or shorter."""
    x, y, z = vector
    return (factor * x, factor * y, factor * z)


def moved(point: Vector, along: Vector, distance: float) -> Vector:
    """Return a point moved along a unit vector by a distance, m."""
    x, y, z = scaled(along, distance)
    return (point[0] + x, point[1] + y, point[2] + z)


def ring(normal: Vector, begin: Vector, radius: float = BAR) -> Arc:
    """Return a whole ring around the origin, square to a unit vector, through a point."""
    return Arc(ORIGIN, begin, normal, math.tau, radius)


def yoke(end: Vector, middle: Vector, radius: float = BAR) -> Arc:
    """Return half a ring around the origin, from a point by way of another to its opposite.

    Args:
        end: Where it begins, m.
        middle: Unit vector to its middle, square to `end`.
        radius: Radius of the bar, m.
    """
    length = math.hypot(*end)
    return Arc(ORIGIN, end, cross(scaled(end, 1.0 / length), middle), math.pi, radius)


def gimbal(ring_or_yoke: Arc, axle: Vector, reach: float) -> tuple[Shape, ...]:
    """Return a ring or a yoke with the two stubs that it turns on.

    Args:
        ring_or_yoke: Around the origin, through where the stubs begin.
        axle: Unit vector along the stubs.
        reach: Where the stubs end, m from the origin.
    """
    radius = math.hypot(*ring_or_yoke.begin)
    return (
        ring_or_yoke,
        Rod(scaled(axle, radius), scaled(axle, reach)),
        Rod(scaled(axle, -radius), scaled(axle, -reach)),
    )


def frame(points: Sequence[Vector], radius: float) -> tuple[Shape, ...]:
    """Return a frame of rods around points that lie about the z axis, each with a ball on it.

    Args:
        points: Where the balls are, m, in any order; some may coincide.
        radius: Radius of the rods, m.
    """
    around = sorted(points, key=lambda point: math.atan2(point[1], point[0]))
    pairs = zip(around, [*around[1:], around[0]], strict=True)
    rods = rods_between(list(pairs), radius)
    return (*rods, *(Ball(point, 1.6 * radius) for point in around))


def rods_between(pairs: Sequence[tuple[Vector, Vector]], radius: float) -> list[Rod]:
    """Return a rod between the points of each pair, m, but for those too close for one."""
    return [Rod(a, b, radius) for a, b in pairs if math.dist(a, b) > radius]


def turn_of_z(direction: Vector) -> Quaternion:
    """Return the shortest turn that takes the z axis to a direction of any length."""
    x, y, z = direction
    length = math.hypot(x, y, z)
    w = z + length
    # Straight down there is no shortest one.
    return unit((w, 0.0, x, -y)) if math.hypot(w, x, y) > 1e-9 * length else about_x(math.pi)


def hand(
    pose: Pose, pins: tuple[Pin, ...], *held_by: Shape, probe: Vector = ALONG_X, palm: float = 0.0
) -> Body:
    """Return the hand: a palm, a probe, and a thumb that shows which way it is rolled.

    Args:
        pose: Where it is, forearm frame.
        pins: What joins it to others, hand axes.
        held_by: What else belongs to it, hand axes.
        probe: Where the probe ends, hand axes, m.
        palm: Where along the probe the palm is, m.
    """
    length = math.hypot(*probe)
    along, joint = scaled(probe, 1.0 / length), scaled(probe, 0.6)
    thumb = X if probe[0] == 0.0 else Z
    return Body(
        'hand',
        pose,
        (
            *held_by,
            Rod(scaled(along, palm - BAR), scaled(along, palm + BAR), 6.0 * BAR),
            Rod(scaled(along, palm), probe),
            Rod(joint, moved(joint, thumb, 0.15 * length)),
            Ball(probe, 2.0 * BAR),
        ),
        pins,
    )


def plain_bodies(pose: Pose, probe: Vector) -> tuple[Body, ...]:
    """Return a forearm and a hand alone: a wrist that says no more of itself.

    Args:
        pose: Where the hand is, forearm frame.
        probe: Where its probe ends, hand axes, m.
    """
    forearm = Body('forearm', AT_REST, (Rod((-PROBE_LENGTH, 0.0, 0.0), ORIGIN, 2.0 * BAR),))
    return (forearm, hand(pose, (), probe=probe))
