"""A mechanism as RViz and Foxglove draw it: its bodies, its joints, and the way of its probe."""

from __future__ import annotations

import math
from collections import deque
from collections.abc import Sequence
from itertools import pairwise

from geometry_msgs.msg import Point, Vector3
from std_msgs.msg import ColorRGBA, Header
from visualization_msgs.msg import Marker

from wrist_control.ros.convert import fill
from wrist_control.rotations import IDENTITY, Pose, Vector, placed
from wrist_control.wrists import Wrist
from wrist_control.wrists.body import (
    BAR,
    HAND,
    Arc,
    Ball,
    Body,
    Pin,
    Plate,
    Rod,
    Shape,
    colours,
    moved,
    turn_of_z,
)

# As many points of the way of the probe's tip are shown, and so far apart at least, m.
TRAIL, APART = 200, 0.002
IDLE = ColorRGBA(r=0.58, g=0.64, b=0.72, a=1.0)


class MechanismMarkers:
    """The markers of one wrist: made once, and moved with its bodies."""

    def __init__(self, wrist: Wrist) -> None:
        """Make a marker for each shape, for each driven joint that is to be seen, and the trail.

        Args:
            wrist: What is drawn.
        """
        self._wrist = wrist
        self._solids: list[tuple[int, Pose, Marker]] = []
        self._pins: dict[str, tuple[int, Pose, Marker]] = {}
        joints = {joint.name for joint in wrist.joints}
        bodies = wrist.bodies(wrist.home)
        for index, (body, colour) in enumerate(zip(bodies, colours(bodies), strict=True)):
            for number, shape in enumerate(body.shapes):
                marker, local = shape_marker(shape)
                marker.ns, marker.id, marker.color = body.name, number, rgba(colour)
                self._solids.append((index, local, marker))
            for pin in body.pins:
                if pin.name in joints and pin.name not in self._pins:
                    self._pins[pin.name] = (index, *_pin_marker(pin))
        self._trail = Marker(ns='trail', type=Marker.LINE_STRIP, scale=Vector3(x=0.5 * BAR))
        self._trail.color = rgba(HAND)
        self._tips: deque[Vector] = deque(maxlen=TRAIL)

    def at(
        self,
        header: Header,
        bodies: Sequence[Body],
        positions: Sequence[float],
        rates: Sequence[float],
    ) -> list[Marker]:
        """Return the markers of one moment.

        Args:
            header: Stamp and forearm frame.
            bodies: Where the wrist's bodies are.
            positions: Joint positions, rad or m: the joint nearest to a limit is coloured.
            rates: Joint rates, rad/s or m/s.
        """
        self._colour_joints(positions, rates)
        found = [*self._solids, *self._pins.values()]
        for index, local, marker in found:
            marker.header = header
            fill(marker.pose.position, marker.pose.orientation, placed(bodies[index].pose, local))
        markers = [marker for _, _, marker in found]
        self._follow(bodies[-1].pose.point(self._wrist.probe))
        if len(self._tips) > 1:
            self._trail.header = header
            self._trail.points = [_point(tip) for tip in self._tips]
            markers.append(self._trail)
        return markers

    def _colour_joints(self, positions: Sequence[float], rates: Sequence[float]) -> None:
        used = {
            joint.name: joint.used(position, rate)
            for joint, position, rate in zip(self._wrist.joints, positions, rates, strict=True)
        }
        nearest = max(used, key=used.__getitem__)
        for name, (_, _, marker) in self._pins.items():
            near = min(1.0, used[name]) if name == nearest else 0.0
            # Yellow half way to the limit, red at it.
            warning = ColorRGBA(r=0.95, g=0.8 * (1.0 - near), b=0.0, a=1.0)
            marker.color = warning if near > 0.0 else IDLE

    def _follow(self, tip: Vector) -> None:
        if not self._tips or math.dist(tip, self._tips[-1]) >= APART:
            self._tips.append(tip)


def rgba(colour: str) -> ColorRGBA:
    """Return a colour that is written as #rrggbb."""
    red, green, blue = (int(colour[i : i + 2], 16) / 255.0 for i in (1, 3, 5))
    return ColorRGBA(r=red, g=green, b=blue, a=1.0)


def shape_marker(shape: Shape) -> tuple[Marker, Pose]:
    """Return a marker for a shape, and where it stands in its body's axes."""
    if isinstance(shape, Ball):
        size = 2.0 * shape.radius
        scale = Vector3(x=size, y=size, z=size)
        return Marker(type=Marker.SPHERE, scale=scale), Pose(IDENTITY, shape.centre)
    if isinstance(shape, Rod):
        return _cylinder(shape)
    if isinstance(shape, Plate):
        return _plate(shape), Pose(IDENTITY)
    return _arc(shape), Pose(IDENTITY)


def _cylinder(rod: Rod) -> tuple[Marker, Pose]:
    (x, y, z), (ex, ey, ez) = rod.begin, rod.end
    middle = (0.5 * (x + ex), 0.5 * (y + ey), 0.5 * (z + ez))
    size = 2.0 * rod.radius
    scale = Vector3(x=size, y=size, z=math.dist(rod.begin, rod.end))
    turn = turn_of_z((ex - x, ey - y, ez - z))
    return Marker(type=Marker.CYLINDER, scale=scale), Pose(turn, middle)


def _arc(arc: Arc) -> Marker:
    points = [_point(point) for point in arc.points()]
    return Marker(type=Marker.LINE_STRIP, scale=Vector3(x=2.0 * arc.radius), points=points)


def _plate(plate: Plate) -> Marker:
    """Return both faces of a plate; seen from the side it is as thin as a sheet."""
    first, *others = (_point(corner) for corner in plate.corners)
    points = []
    for one, other in pairwise(others):
        points += [first, one, other, first, other, one]
    return Marker(type=Marker.TRIANGLE_LIST, scale=Vector3(x=1.0, y=1.0, z=1.0), points=points)


def _pin_marker(pin: Pin) -> tuple[Pose, Marker]:
    axis = pin.axis or (0.0, 0.0, 1.0)
    half = 3.0 * BAR
    rod = Rod(moved(pin.point, axis, -half), moved(pin.point, axis, half), 2.0 * BAR)
    marker, local = _cylinder(rod)
    marker.ns = f'joint {pin.name}'
    return local, marker


def _point(vector: Vector) -> Point:
    x, y, z = vector
    return Point(x=x, y=y, z=z)
