"""Canfield's Carpal wrist: three legs, and a distal plate that mirrors the base. [Canfield1997].

The three mid-nodes span the midplane; the distal plate is the image of the base in it. With the
midplane's unit normal n the hand's quaternion is (n_z, 0, n_x, -n_y): a tilt without torsion, by
twice the angle from z to n. docs/equations.md derives what is used here.
"""

from __future__ import annotations

import math
from collections.abc import Sequence
from dataclasses import dataclass
from typing import ClassVar, NamedTuple

import numpy as np

from wrist_control.errors import InvalidValueError, UnreachableError
from wrist_control.rotations import (
    Pose,
    Vector,
    cross,
    nearest_turn,
    quaternion_of,
    to_forearm,
    turned,
    unit,
)
from wrist_control.wrists import body
from wrist_control.wrists.body import Ball, Body, Pin, Plate, Rod
from wrist_control.wrists.dimension import dimension
from wrist_control.wrists.joint import Joint
from wrist_control.wrists.wrist import Clearance, Positions, Rates, Wrist, soft_edge

# Azimuths of the three legs as (cos, sin), [Canfield1997], fig. 4.1.
AZIMUTHS = ((1.0, 0.0), (-0.5, math.sqrt(0.75)), (-0.5, -math.sqrt(0.75)))
# Poses this far from the mechanism's own, relative to its size, still count as its own: far beyond
# round-off, and far below what a person would call a torsion.
TOLERANCE = 1e-6
# What can end the workspace, in the order of `_distances`.
EDGES = (
    'closure of leg 1',
    'closure of leg 2',
    'closure of leg 3',
    'tilt of a half turn',
    'mid-nodes in one line',
)
# And what ends it before: no drive holds the hand there.
LOOSE = 'the hand near loose'


class _Midplane(NamedTuple):
    """The mid-nodes and the plane through them.

    Attributes:
        nodes: Mid-nodes in forearm axes, m.
        normal: Unit normal n; its sign does not matter to the hand.
        area: Twice the area of the triangle of mid-nodes, m².
        lifts: n · ∂m_i/∂θ_i, m: 0 where leg i folds.
    """

    nodes: tuple[Vector, Vector, Vector]
    normal: Vector
    area: float
    lifts: Vector


@dataclass(frozen=True)
class Carpal(Wrist):
    """Tilts the hand about two axes and carries it on a sphere of radius `plunge`.

    p and q are followed, r is what a tilt without torsion forces, and the plunge that the joints
    start with is held. It ends where a leg folds, or where the legs hold the hand no more.

    Choose it to point with a passage through its middle, for cables or a drive shaft that rolls.
    """

    base_radius: float = dimension(0.075, 'from the plate centre to a leg hinge', 'm', 1e-4)
    leg_length: float = dimension(0.1, 'from a leg hinge to its mid-node', 'm', 1e-4)
    plunge: float = dimension(0.07, 'from the base plate to the midplane at home', 'm', 1e-4)

    default_joints: ClassVar[tuple[Joint, ...]] = (
        Joint('theta_1'),
        Joint('theta_2'),
        Joint('theta_3'),
    )
    followed_axes: ClassVar[tuple[int, ...]] = (0, 1)
    probe: ClassVar[Vector] = body.ALONG_Z

    def __post_init__(self) -> None:
        """Check that the legs are long enough for the plunge."""
        super().__post_init__()
        if self.plunge > 0.999 * self.leg_length:
            raise InvalidValueError(
                f'plunge is {self.plunge} m with leg_length {self.leg_length} m; the legs cannot '
                'reach that far, make plunge smaller than leg_length.'
            )

    @property
    def home(self) -> Positions:
        """The hand straight ahead at the plunge, legs outward."""
        return (math.asin(self.plunge / self.leg_length),) * 3

    def forward(self, positions: Sequence[float]) -> Pose:
        """Return the pose of the distal plate, its origin mirrored from the base's."""
        nodes, (x, y, z), _, _ = self._midplane(positions)
        m = nodes[0]
        reach = 2.0 * (x * m[0] + y * m[1] + z * m[2])
        return Pose((z, 0.0, x, -y), (reach * x, reach * y, reach * z))

    def inverse(self, pose: Pose, near: Sequence[float]) -> Positions:
        """Return θ1, θ2, θ3 of a pose, each on the branch nearest to `near`.

        Leg i meets the midplane where A cos θ + B sin θ = C, twice or not at all: eight branches.
        """
        z, torsion, x, minus_y = pose.quaternion
        y = -minus_y
        px, py, pz = pose.position
        reach = x * px + y * py + z * pz
        away = math.dist(pose.position, (reach * x, reach * y, reach * z))
        if abs(torsion) > TOLERANCE or away > TOLERANCE * self.leg_length:
            raise UnreachableError(
                'The hand can only tilt, mirrored, without torsion; aim for such a pose.',
                'tilt without torsion',
            )
        return tuple(
            self._leg_angle(leg, x * cos + y * sin, z, 0.5 * reach, near[leg])
            for leg, (cos, sin) in enumerate(AZIMUTHS)
        )

    def _leg_angle(
        self, leg: int, outward: float, up: float, distance: float, near: float
    ) -> float:
        c = (distance - outward * self.base_radius) / self.leg_length
        discriminant = outward * outward + up * up - c * c
        if discriminant < 0.0:
            raise _at_edge(EDGES[leg])
        middle = math.atan2(up, outward)
        half = math.atan2(math.sqrt(discriminant), c)
        first, second = nearest_turn(middle - half, near), nearest_turn(middle + half, near)
        return first if abs(first - near) <= abs(second - near) else second

    def jacobian(self, positions: Sequence[float]) -> np.ndarray:
        """Return (p, q, r) per (θ̇1, θ̇2, θ̇3), shape (3, 3) and rank 2: the plunge moves too."""
        (a, b, c), _, area, lifts = self._midplane(positions)
        columns = [
            (g * (end[0] - begin[0]), g * (end[1] - begin[1]), g * (begin[2] - end[2]))
            for g, begin, end in (
                (2.0 * lifts[0] / area, b, c),
                (2.0 * lifts[1] / area, c, a),
                (2.0 * lifts[2] / area, a, b),
            )
        ]
        return np.array(columns).T

    def normal_jacobian(self, positions: Sequence[float]) -> np.ndarray:
        """Return (dN̂x/dt, dN̂y/dt, dp_d/dt) per joint rate, shape (3, 3). [Canfield1997], (4.12).

        N̂ is the midplane's upward unit normal and p_d the plunge, m.
        """
        (a, b, c), (x, y, z), area, lifts = self._midplane(positions)
        pivot = (0.0, 0.0, (x * a[0] + y * a[1] + z * a[2]) / z)
        columns = []
        for lift, begin, end in zip(lifts, (b, c, a), (c, a, b), strict=True):
            gain = lift / area
            turning = cross(_from(begin, end), (x, y, z))
            share = cross(_from(pivot, begin), _from(pivot, end))
            plunging = (x * share[0] + y * share[1] + z * share[2]) / z
            upward = gain if z > 0.0 else -gain
            columns.append((upward * turning[0], upward * turning[1], gain * plunging))
        return np.array(columns).T

    def rates(self, positions: Sequence[float], twist: Sequence[float]) -> Rates:
        """Return θ̇1, θ̇2, θ̇3 that make p and q and hold the plunge; r is not free."""
        nodes, (x, y, z), _, lifts = self._midplane(positions)
        p, q = twist[0], twist[1]
        r = (x * p + y * q) / z
        turning = (0.5 * (z * q + y * r), -0.5 * (z * p + x * r), 0.5 * (y * p - x * q))
        m = nodes[0]
        plunge = (x * m[0] + y * m[1] + z * m[2]) / z
        return tuple(
            -(turning[0] * m[0] + turning[1] * m[1] + turning[2] * (m[2] - plunge)) / lift
            for m, lift in zip(nodes, lifts, strict=True)
        )

    def target_pose(self, pose: Pose, twist: Sequence[float], dt: float) -> Pose:
        """Return the pose after p and q for a time, exactly, the plunge held.

        The forced r = (n_x p + n_y q) / n_z does not change while p and q do not.

        Raises:
            UnreachableError: The tilt would reach half a turn.
        """
        z, _, x, minus_y = pose.quaternion
        p, q = twist[0], twist[1]
        a1, _, a3, a4 = turned(pose.quaternion, (p, q, (x * p - minus_y * q) / z), dt)
        if a1 * z <= 0.0:
            raise _at_edge(EDGES[3])
        z1, _, x1, minus_y1 = unit((a1, 0.0, a3, a4))
        px, py, pz = pose.position
        reach = (x * px - minus_y * py + z * pz) * z1 / z
        return Pose((z1, 0.0, x1, minus_y1), (reach * x1, -reach * minus_y1, reach * z1))

    def margin(self, positions: Sequence[float]) -> float:
        """Return the smallest of what is left of the legs, of the tilt and of the midplane."""
        return min(self._distances(self._midplane(positions)))

    def lost_axis(self, positions: Sequence[float]) -> Vector:
        """Return the tilt that needs the fastest joints, the plunge held, in hand axes."""
        about_x, about_y = (self.rates(positions, axis) for axis in ((1.0, 0.0), (0.0, 1.0)))
        x, y = np.linalg.svd(np.array([about_x, about_y]).T)[2][0]
        return (float(x), float(y), 0.0)

    def clearances(self, positions: Sequence[float]) -> tuple[Clearance, ...]:
        """Return what is left to the workspace edge, in sines of angles, and to a loose hand."""
        plane = self._midplane(positions)
        edges = map(soft_edge, EDGES, self._distances(plane))
        return (*edges, soft_edge(LOOSE, _firmness(plane.nodes, positions)))

    def bodies(self, positions: Sequence[float]) -> tuple[Body, ...]:
        """Return the base, three legs of two links, and the hand, which is the base mirrored."""
        pose = self.forward(positions)
        base, legs, distal = [], [], []
        for leg, (theta, (cos, sin)) in enumerate(zip(positions, AZIMUTHS, strict=True), start=1):
            hinge = (self.base_radius * cos, self.base_radius * sin, 0.0)
            out, across = math.cos(theta), (-sin, cos, 0.0)
            lower = _leg(hinge, (out * cos, out * sin, math.sin(theta)), across)
            mid = Pin(f'mid_{leg}', (self.leg_length, 0.0, 0.0))
            top, node = pose.point(hinge), lower.point(mid.point)
            along = body.scaled(_from(top, node), 1.0 / self.leg_length)
            upper = _leg(top, along, to_forearm(pose.quaternion, across))
            axle = Rod((0.0, -4.0 * body.BAR, 0.0), (0.0, 4.0 * body.BAR, 0.0))
            link = (Rod(body.ORIGIN, mid.point), axle, Ball(mid.point, 2.0 * body.BAR))
            driven = Pin(f'theta_{leg}', body.ORIGIN, body.RIGHT)
            passive = Pin(f'distal_{leg}', body.ORIGIN, body.Y)
            base.append(driven._replace(point=hinge, axis=body.scaled(across, -1.0)))
            distal.append(passive._replace(point=hinge, axis=across))
            legs.append(Body(f'lower_leg_{leg}', lower, link, (driven, mid)))
            legs.append(Body(f'upper_leg_{leg}', upper, link, (passive, mid)))
        plate = Plate(tuple(pin.point for pin in base), 2.0 * body.BAR)
        stem = Rod((0.0, 0.0, -self.base_radius), body.ORIGIN, 2.0 * body.BAR)
        forearm = Body('forearm', body.AT_REST, (plate, stem), tuple(base))
        return (forearm, *legs, body.hand(pose, tuple(distal), plate, probe=self.probe))

    def firmness(self, positions: Sequence[float]) -> float:
        """Return how firmly the legs hold the hand while no drive moves, 0 where it is loose.

        There the upper links can turn and leave the mid-nodes where they are: |s12 s23 s31 +
        s21 s32 s13|, s_ij the cosine between m_i − m_j and ∂m_i/∂θ_i. docs/equations.md.
        """
        return _firmness(self._midplane(positions).nodes, positions)

    def _distances(self, plane: _Midplane) -> tuple[float, ...]:
        _, normal, area, lifts = plane
        legs = (abs(lift) / self.leg_length for lift in lifts)
        return (*legs, abs(normal[2]), area / (self.base_radius + self.leg_length) ** 2)

    def _midplane(self, positions: Sequence[float]) -> _Midplane:
        legs = [
            (cos, sin, self.leg_length * math.cos(theta), self.leg_length * math.sin(theta))
            for theta, (cos, sin) in zip(positions, AZIMUTHS, strict=True)
        ]
        a, b, c = (
            ((self.base_radius + out) * cos, (self.base_radius + out) * sin, up)
            for cos, sin, out, up in legs
        )
        x, y, z = cross(_from(a, b), _from(a, c))
        area = math.sqrt(x * x + y * y + z * z)
        if area < TOLERANCE * self.leg_length * self.leg_length:
            raise _at_edge(EDGES[4])
        x, y, z = x / area, y / area, z / area
        l1, l2, l3 = (z * out - up * (x * cos + y * sin) for cos, sin, out, up in legs)
        return _Midplane((a, b, c), (x, y, z), area, (l1, l2, l3))


def _at_edge(edge: str) -> UnreachableError:
    return UnreachableError(f'The hand cannot go beyond its edge, {edge}; turn it back.', edge)


def _leg(hinge: Vector, along: Vector, across: Vector) -> Pose:
    """Return where a link is: x along it, y along its hinge."""
    return Pose(quaternion_of((along, across, cross(along, across))), hinge)


def _firmness(nodes: Sequence[Vector], positions: Sequence[float]) -> float:
    around, back = (
        math.prod(_cosine(_from(nodes[j], nodes[i]), positions[i], *AZIMUTHS[i]) for i, j in pairs)
        for pairs in (((0, 1), (1, 2), (2, 0)), ((1, 0), (2, 1), (0, 2)))
    )
    return abs(around + back)


def _cosine(edge: Vector, theta: float, cos: float, sin: float) -> float:
    """Return the cosine between a vector and the way that a mid-node goes as its leg turns."""
    inward, (x, y, z) = -math.sin(theta), edge
    along = inward * (cos * x + sin * y) + math.cos(theta) * z
    return along / math.sqrt(x * x + y * y + z * z)


def _from(a: Vector, b: Vector) -> Vector:
    return (b[0] - a[0], b[1] - a[1], b[2] - a[2])
