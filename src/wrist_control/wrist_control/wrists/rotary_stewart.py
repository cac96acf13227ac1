"""A rotary Stewart platform: six servos turn six horns, and six rods carry the hand.

A horn's tip goes round a circle about its servo's axis, and a rod of constant length joins it to
the platform. Once the servos stand, the tips are the base anchors of a Stewart platform and the
rods its legs, and the forward kinematics are those of `stewart/`, proof and all.
docs/equations.md derives what is used here. The dimensions are those of [ReachyMini].
"""

from __future__ import annotations

import math
from collections.abc import Sequence
from dataclasses import dataclass
from functools import cached_property
from typing import ClassVar, Literal

import numpy as np

from wrist_control.errors import UnreachableError
from wrist_control.rotations import Pose, Vector, to_hand
from wrist_control.stewart.forward_kinematics import ForwardKinematics
from wrist_control.stewart.geometry import Anchors, Points, checked_anchors
from wrist_control.wrists import body
from wrist_control.wrists.body import Ball, Body, Pin, Rod
from wrist_control.wrists.dimension import dimension, point_list
from wrist_control.wrists.horn import Horn, horn, in_pairs, six
from wrist_control.wrists.joint import Joint
from wrist_control.wrists.platform import Assembly, Platform, Rods, turn_of
from wrist_control.wrists.wrist import Clearance, Rates, soft_edge

# A horn counts as no straighter with its rod than this, as a sine: rounding alone is left of it.
STRAIGHT = 1e-15


@dataclass(frozen=True)
class RotaryStewart(Platform):
    """Six horns turned by servos, six rods, one platform: the head of a Reachy Mini.

    It ends where a horn lies straight with its rod, and locks where the rods no longer hold it.

    Choose it where the hand must move in all six directions, and fast servos are what there is.

    Its joint positions come as an `Assembly`; where plain numbers are given, they are taken to
    belong to the assembly that the home pose belongs to, and cost a forward-kinematics solve.

    Attributes:
        hinge_radius: The servos stand in three pairs around the base, their axes radial: how far
            the circles of the horns' tips are from the base's axis, m.
        hinge_offset: Half the distance between the two servos of a pair, m. At 0 the horns of a
            pair point away from each other, and they rise as the first turns up and the second
            down.
        hinge_centres: Six points in base axes, m, shape (6, 3), for servos that do not stand so;
            hinge_radius and hinge_offset then mean nothing. The same of
        hinge_axes: six directions of any length, shape (6, 3), about which the servos turn, and
        horn_directions: six directions in which the horns point at 0.
        platform_anchors: Six points in platform axes, m, shape (6, 3), for a platform that is not
            a ring; the platform's radius and angle then mean nothing.
        home_height: Height of the platform above the base at home, level and centred, m. The base
            is where the servos' axes are.
    """

    hinge_radius: float = dimension(
        0.0366606, "from the base's axis to the circles of the horns' tips", 'm', 1e-6
    )
    hinge_offset: float = dimension(0.01, 'half the distance between two servos', 'm', 0.0)
    horn_length: float = dimension(0.04, 'from a servo axis to the end of its horn', 'm', 1e-6)
    rod_length: float = dimension(0.085, 'from the end of a horn to the platform', 'm', 1e-6)
    platform_radius: float = dimension(0.03, 'radius of the platform anchors', 'm', 1e-6)
    platform_angle: float = dimension(
        2.0 * math.asin(7.0 / 30.0),
        'angle between the platform anchors 1 and 2',
        'rad',
        0.0,
        2.0944,
    )
    home_height: float = dimension(
        0.1003667, 'height of the platform above the servos at home', 'm', 1e-6
    )
    hinge_centres: Points | None = point_list(
        "x, y, z of the centres of the six circles of the horns' tips, base axes, instead of "
        'hinge_radius and hinge_offset'
    )
    hinge_axes: Points | None = point_list(
        'x, y, z of the directions about which the six servos turn, base axes, of any length'
    )
    horn_directions: Points | None = point_list(
        'x, y, z of the directions in which the six horns point at 0, base axes, of any length'
    )
    platform_anchors: Points | None = point_list(
        'x, y, z of the six platform anchors, platform axes, instead of platform_radius and '
        'platform_angle'
    )

    default_joints: ClassVar[tuple[Joint, ...]] = tuple(
        Joint(f'servo_{number}') for number in range(1, 7)
    )
    probe: ClassVar[Vector] = (0.0, 0.0, 0.06)
    # What a fast servo (6 rad/s) turns in four readings at 100 Hz.
    far: ClassVar[float] = 0.25
    rods: ClassVar[str] = 'rod'
    drive: ClassVar[str] = 'servo'
    measured: ClassVar[Literal['length', 'angle']] = 'angle'
    unit: ClassVar[Literal['m', 'rad']] = 'rad'

    @property
    def reach(self) -> float:
        """How far a servo moves the tip of its horn, m per rad."""
        return self.horn_length

    @cached_property
    def horns(self) -> tuple[Horn, ...]:
        """What the servos turn.

        Raises:
            InvalidValueError: A direction without length, or a horn along its axis.
        """
        pairs = in_pairs(self.hinge_radius, self.hinge_offset)
        places = zip(
            self._given('hinge_centres', pairs[0]),
            self._given('hinge_axes', pairs[1]),
            self._given('horn_directions', pairs[2]),
            strict=True,
        )
        return tuple(
            horn(f'servo_{number}', self.horn_length, *place)
            for number, place in enumerate(places, start=1)
        )

    def _given(self, name: str, otherwise: Anchors) -> Anchors:
        points = getattr(self, name)
        return otherwise if points is None else checked_anchors(name, points)

    def tips(self, positions: Sequence[float]) -> Anchors:
        """Return the tips of the horns, base axes, m."""
        return six([one.tip(angle) for one, angle in zip(self.horns, positions, strict=True)])

    def kinematics_at(self, positions: Sequence[float]) -> tuple[ForwardKinematics, Rods]:
        """Return the forward kinematics with the horns there, and the rods' lengths, m."""
        return self._at_home.moved_to(self.tips(positions)), self._rods

    @cached_property
    def _at_home(self) -> ForwardKinematics:
        tips = self.tips(self.home)
        return ForwardKinematics(self.platform, tips, self.size, self.home_pose)

    @cached_property
    def _rods(self) -> Rods:
        return (self.rod_length,) * 6

    def inverse(self, pose: Pose, near: Sequence[float]) -> Assembly:
        """Return the servos' angles at a pose, each on the branch nearest to `near`.

        Raises:
            UnreachableError: A horn and its rod do not reach the platform.
        """
        found = []
        for number, anchor in enumerate(self.platform):
            end = pose.point(anchor)
            angle = self.horns[number].angle(end, self.rod_length, near[number])
            if angle is None:
                raise UnreachableError(
                    f'The horn of servo_{number + 1} and its rod do not reach the platform there; '
                    'turn the hand back.',
                    _straight(number + 1),
                )
            found.append(angle)
        return self.held(found, pose)

    def held(self, positions: Sequence[float], pose: Pose) -> Assembly:
        """Return servo angles with the pose that they are known to hold."""
        lines = self.lines_along(self.vectors(self.tips(positions), pose))
        levers = []
        for one, angle, (nx, ny, nz, *_) in zip(self.horns, positions, lines, strict=True):
            x, y, z = to_hand(pose.quaternion, one.tip_rate(angle))
            levers.append(nx * x + ny * y + nz * z)
        return Assembly(tuple(positions), pose, lines, self.size, tuple(levers))

    def rates(self, positions: Sequence[float], twist: Sequence[float]) -> Rates:
        """Return the servo rates of a hand twist, rad/s: a rod keeps its length.

        Raises:
            ZeroDivisionError: A horn is exactly straight with its rod.
        """
        vx, vy, vz, p, q, r = twist
        assembly = self.assembled(positions)
        return tuple(
            (nx * vx + ny * vy + nz * vz + mx * p + my * q + mz * r) / lever
            for (nx, ny, nz, mx, my, mz), lever in zip(
                assembly.lines, assembly.levers, strict=True
            )
        )

    def margin(self, positions: Sequence[float]) -> float:
        """Return how far the servos are from useless and from letting go, 0 at lock, at most 1.

        Of servo rates per twist, both without a unit: one over the largest singular value, 0
        where a horn is straight with its rod; or the least, 0 where the rods do not hold the hand.
        """
        gains, _ = self._gains(self.assembled(positions))
        return float(min(1.0 / gains[0], gains[-1]))

    def _gains(self, assembly: Assembly) -> tuple[np.ndarray, np.ndarray]:
        """Return singular values, the largest first, and directions of horn rates per twist."""
        rows = np.array(assembly.lines)
        rows[:, 3:] /= self.size
        levers = np.array(assembly.levers) / self.horn_length
        levers = np.copysign(np.maximum(np.abs(levers), STRAIGHT), levers)
        _, gains, directions = np.linalg.svd(rows / levers[:, None])
        return gains, directions

    def clearances(self, positions: Sequence[float]) -> tuple[Clearance, ...]:
        """Return what is left before lock, and before each horn is straight with its rod."""
        assembly = self.assembled(positions)
        servos = enumerate(zip(assembly.levers, self.home.levers, strict=True), start=1)
        return (
            self.lock_clearance(assembly),
            *(
                soft_edge(_straight(number), math.copysign(1.0, home) * lever / self.horn_length)
                for number, (lever, home) in servos
            ),
        )

    def lost_axis(self, positions: Sequence[float]) -> Vector:
        """Return the turn that the rods hold least, or that needs the fastest servo."""
        gains, directions = self._gains(self.assembled(positions))
        return turn_of(directions[-1 if gains[0] * gains[-1] < 1.0 else 0])

    def bodies(self, positions: Sequence[float]) -> tuple[Body, ...]:
        """Return the base with its servos, six horns and rods, and the hand: the platform."""
        pose = self.forward(positions)
        bar, out = 0.06 * self.size, (self.horn_length, 0.0, 0.0)
        rod_end = (0.0, 0.0, self.rod_length)
        base, links, top = [], [], []
        for number, (one, anchor, angle) in enumerate(
            zip(self.horns, self.platform, positions, strict=True), start=1
        ):
            turning = Pin(f'servo_{number}', one.centre, one.axis)
            tip, head = Pin(f'tip_{number}', out), Pin(f'platform_{number}', anchor)
            base.append(turning)
            top.append(head)
            own = turning._replace(point=body.ORIGIN, axis=body.Z)
            shapes = (Rod(body.ORIGIN, out, 1.4 * bar), Ball(out, 2.0 * bar))
            links.append(Body(f'horn_{number}', one.pose(angle), shapes, (own, tip)))
            ends = (tip._replace(point=body.ORIGIN), head._replace(point=rod_end))
            along = tuple(np.subtract(pose.point(anchor), one.tip(angle)).tolist())
            there = Pose(body.turn_of_z(along), one.tip(angle))
            links.append(Body(f'rod_{number}', there, (Rod(body.ORIGIN, rod_end, bar),), ends))
        return (
            Body('forearm', body.AT_REST, self._stand(bar), tuple(base)),
            *links,
            body.hand(pose, tuple(top), *self.carried(top, bar), probe=self.probe),
        )

    def _stand(self, bar: float) -> tuple[body.Shape, ...]:
        """Return what the servos are drawn as: six drums, held by a foot."""
        centres = [one.centre for one in self.horns]
        drums = [
            Rod(
                body.moved(one.centre, one.axis, -2.0 * bar),
                body.moved(one.centre, one.axis, 2.0 * bar),
                3.0 * bar,
            )
            for one in self.horns
        ]
        foot = Rod((0.0, 0.0, -self.home_height), body.ORIGIN, 2.0 * bar)
        spokes = body.rods_between([(foot.end, centre) for centre in centres], bar)
        return (foot, *spokes, *drums)


def _straight(number: int) -> str:
    return f'servo_{number} straight with its rod'
