"""Nguyen's Stewart platform: six legs that move the hand in all six directions. [Nguyen1991]."""

from __future__ import annotations

import math
from collections.abc import Sequence
from dataclasses import dataclass
from functools import cached_property
from typing import ClassVar, Literal

import numpy as np

from wrist_control.errors import InvalidValueError, UnreachableError
from wrist_control.rotations import IDENTITY, Pose, Vector, to_forearm, turned
from wrist_control.stewart.forward_kinematics import ForwardKinematics, Status
from wrist_control.stewart.geometry import (
    Anchors,
    Line,
    checked_anchors,
    hold,
    legs,
    length,
    line,
    ring,
)
from wrist_control.wrists.wrist import Clearance, Joint, Positions, Wrist, parameter, points

INCH = 0.0254
# The hand stops at this margin: closer to lock the legs no longer hold it.
EDGE = 0.01
# The room above EDGE may not shrink faster than itself over this time, s.
HORIZON = 0.5
# Lengths this much further on than a pose belong to it only if they fit no other, m.
FAR = 0.02
# A leg shorter than this share of the platform's size has no direction to speak of.
SHORTEST = 1e-6

Points = Sequence[Sequence[float]] | Sequence[float]


class LegLengths(tuple[float, ...]):
    """Six leg lengths, m, that know the pose they hold: lengths alone can fit several poses.

    Attributes:
        pose: The pose of the platform in the base frame.
        lines: Direction and moment of each leg, platform axes.
        size: Characteristic length that makes moments comparable with directions, m.
    """

    pose: Pose
    lines: list[Line]
    size: float

    @cached_property
    def hold(self) -> float:
        """How well the legs hold the platform: `geometry.hold`."""
        return hold(self.lines, self.size)


@dataclass(frozen=True)
class Stewart(Wrist):
    """Two platforms joined by six legs whose lengths are driven.

    Its joint positions are `LegLengths`; where plain numbers are given, they are taken to belong
    to the assembly that the home pose belongs to, and cost a forward-kinematics solve.

    Attributes:
        platform_anchors: Six points in platform axes, m, shape (6, 3), for a platform that is not
            a ring; the platform's radius and angle then mean nothing.
        base_anchors: Six points in base axes, m, shape (6, 3), likewise.
        home_height: Height of the platform above the base at home, level and centred, m.
    """

    platform_radius: float = parameter(10.441 * INCH, 'platform radius r_P', 'm', 1e-6)
    base_radius: float = parameter(13.838 * INCH, 'base radius r_B', 'm', 1e-6)
    platform_angle: float = parameter(
        math.radians(99.20), 'angle θ_P between the platform anchors 1 and 2', 'rad', 0.0, 2.0944
    )
    base_angle: float = parameter(
        math.radians(16.0), 'angle θ_B between the base anchors 1 and 2', 'rad', 0.0, 2.0944
    )
    home_height: float = parameter(17.0 * INCH, 'height z of the platform at home', 'm', 1e-6)
    platform_anchors: Points | None = points(
        'x, y, z of the six platform anchors, platform axes, instead of platform_radius and '
        'platform_angle'
    )
    base_anchors: Points | None = points(
        'x, y, z of the six base anchors, base axes, instead of base_radius and base_angle'
    )

    default_joints: ClassVar[tuple[Joint, ...]] = tuple(
        Joint(f'leg_{leg}', 'prismatic', lower=0.0) for leg in range(1, 7)
    )
    twist_size: ClassVar[Literal[3, 6]] = 6

    def __post_init__(self) -> None:
        """Settle the anchors, and refuse legs that hold the platform at no pose."""
        super().__post_init__()
        for name in ('platform_anchors', 'base_anchors'):
            given = getattr(self, name)
            if given is not None:
                object.__setattr__(self, name, checked_anchors(name, given))
        if abs(self.home.hold) < EDGE:
            raise InvalidValueError(
                f'These anchors do not hold the platform at home (margin {self.home.hold:.2g}); '
                f'choose others, or a home_height where the margin is above {EDGE:g}.'
            )

    @cached_property
    def platform(self) -> Anchors:
        """The platform's anchors p, platform axes, m."""
        if self.platform_anchors is None:
            return ring(self.platform_radius, self.platform_angle)
        return checked_anchors('platform_anchors', self.platform_anchors)

    @cached_property
    def base(self) -> Anchors:
        """The base's anchors b, base axes, m."""
        if self.base_anchors is None:
            return ring(self.base_radius, self.base_angle)
        return checked_anchors('base_anchors', self.base_anchors)

    @cached_property
    def size(self) -> float:
        """Characteristic length: the platform anchors' root mean square distance from P, m."""
        return math.sqrt(sum(x * x + y * y + z * z for x, y, z in self.platform) / 6.0)

    @cached_property
    def forward_kinematics(self) -> ForwardKinematics:
        """What takes lengths to poses, and proves them."""
        return ForwardKinematics(self.platform, self.base, self.size, self.home.pose)

    @cached_property
    def home(self) -> LegLengths:  # type: ignore[override]
        """Leg lengths that hold the platform level at the home height, m."""
        return self.held(Pose(IDENTITY, (0.0, 0.0, self.home_height)))

    def held(self, pose: Pose) -> LegLengths:
        """Return the leg lengths that hold the platform at a pose. [Nguyen1991], eq. (11).

        Raises:
            UnreachableError: An anchor of the platform would lie on its anchor of the base.
        """
        vectors = legs(self.platform, self.base, pose)
        lengths = LegLengths(length(vector) for vector in vectors)
        if not min(lengths) > SHORTEST * self.size:
            raise UnreachableError('A leg would have no length; keep the platform off the base.')
        lengths.pose = pose
        lengths.lines = [
            line(vector, reach, anchor)
            for vector, reach, anchor in zip(vectors, lengths, self.platform, strict=True)
        ]
        lengths.size = self.size
        return lengths

    def inverse(self, pose: Pose, near: Sequence[float]) -> Positions:
        """Return the leg lengths of a pose; there is one set only, and `near` is not needed."""
        return self.held(pose)

    def jacobian(self, positions: Sequence[float]) -> np.ndarray:
        """Return (vx, vy, vz, p, q, r) per leg rate, shape (6, 6), platform axes."""
        return np.linalg.inv(np.array(self._assembled(positions).lines))

    def rates(self, positions: Sequence[float], twist: Sequence[float]) -> Positions:
        """Return the leg rates of a hand twist, m/s; all of them finite at every pose."""
        vx, vy, vz, p, q, r = twist
        return tuple(
            nx * vx + ny * vy + nz * vz + mx * p + my * q + mz * r
            for nx, ny, nz, mx, my, mz in self._assembled(positions).lines
        )

    def margin(self, positions: Sequence[float]) -> float:
        """Return how well the legs hold the platform, 0 at lock, at most 1: `LegLengths.hold`.

        The characteristic length that makes it free of units is `size`.
        """
        return abs(self._assembled(positions).hold)

    def clearances(self, positions: Sequence[float]) -> tuple[Clearance, ...]:
        """Return the room before lock, on home's side of it: the hand slows and never crosses."""
        side = math.copysign(1.0, self.home.hold)
        room = side * self._assembled(positions).hold - EDGE
        return (Clearance('the legs near lock', room, HORIZON),)

    def advance(self, pose: Pose, twist: Sequence[float], dt: float) -> Pose:
        """Return the pose after a hand twist for a time: along the axes where it started."""
        vx, vy, vz, p, q, r = twist
        dx, dy, dz = to_forearm(pose.quaternion, (vx * dt, vy * dt, vz * dt))
        x, y, z = pose.position
        return Pose(turned(pose.quaternion, (p, q, r), dt), (x + dx, y + dy, z + dz))

    def lost_axis(self, positions: Sequence[float]) -> Vector:
        """Return the turn that the legs hold least, a unit vector in platform axes."""
        lines = np.array(self._assembled(positions).lines)
        lines[:, 3:] /= self.size
        x, y, z = np.linalg.svd(lines)[2][-1, 3:]
        norm = math.sqrt(x * x + y * y + z * z)
        return (float(x / norm), float(y / norm), float(z / norm)) if norm else (0.0, 0.0, 1.0)

    def _assembled(self, positions: Sequence[float]) -> LegLengths:
        if isinstance(positions, LegLengths):
            return positions
        return self.held(self.forward(positions))

    def forward(self, positions: Sequence[float]) -> Pose:
        """Return the pose that the legs hold.

        Raises:
            UnreachableError: No pose could be proved to be the one that these lengths hold.
        """
        if isinstance(positions, LegLengths):
            return positions.pose
        return self._proved(positions, self.home.pose, 'home')

    def assembled(self, positions: Sequence[float], near: Pose) -> LegLengths:
        """Return the lengths with the pose that the legs hold, continued from a pose before.

        Raises:
            UnreachableError: No pose could be proved to be the one that `near` leads to; or the
                lengths are far from there, and fit another pose as well.
        """
        pose = self._proved(positions, near, 'the pose before')
        travel = max(abs(x - y) for x, y in zip(positions, self.held(near), strict=True))
        if travel > FAR and self.forward_kinematics.cold_start(positions).others:
            raise UnreachableError(
                f'The lengths {tuple(positions)} m fit more than one pose; set initial_positions '
                f'within {FAR:g} m of them, or drive the legs home.'
            )
        return self.held(pose)

    def _proved(self, positions: Sequence[float], near: Pose, name: str) -> Pose:
        solution = self.forward_kinematics.solve(positions, near)
        if solution.pose is None or solution.status != Status.CONVERGED:
            raise UnreachableError(
                f'The lengths {tuple(positions)} m have no pose that {name} is proved to lead to '
                f'({solution.status.name}).'
            )
        return solution.pose
