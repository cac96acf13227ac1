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
    SHORTEST,
    Anchors,
    Line,
    checked_anchors,
    hadamard_ratio,
    legs,
    length,
    line,
    ring,
)
from wrist_control.units import INCH
from wrist_control.wrists import body
from wrist_control.wrists.body import Body, Pin, Rod
from wrist_control.wrists.dimension import dimension, point_list
from wrist_control.wrists.joint import Joint
from wrist_control.wrists.wrist import Clearance, Configuration, Rates, Wrist, soft_edge

# The hand stops at this margin, 2.5° of yaw before lock. Ten times closer its pose cannot be told
# from its twin beyond lock (NEAR_SINGULAR), and Barker's singular region begins; ten times further
# off, a fifth of the yaw would be lost.
EDGE = 0.01
# The edge is neared over this long, s: a yaw of 1 rad/s slows by 1.8 rad/s². Over a tenth of it
# the hand would stop ten times as hard, and over ten times as much it would brake harder too, all
# at once, since the braking begins where the margin falls fastest.
HORIZON = 0.5
# Lengths this much further on than a pose belong to it only if a search finds no other that they
# fit, and lengths this close to home's belong to home, m. It is what a fast leg (0.5 m/s) moves in
# four readings at 100 Hz: no leg that is followed waits for the slow search, and lengths that
# mislead on home's side of lock lie further from home.
FAR = 0.02

Points = Sequence[Sequence[float]] | Sequence[float]


@dataclass(frozen=True)
class LegConfiguration(Configuration):
    """Six leg lengths, m, and the pose they hold: lengths alone can fit several poses.

    Attributes:
        lines: Direction and moment of each leg, platform axes.
        size: Characteristic length that makes moments comparable with directions, m.
    """

    lines: tuple[Line, ...]
    size: float

    @cached_property
    def hadamard_ratio(self) -> float:
        """How well the legs hold the platform: `geometry.hadamard_ratio`."""
        return hadamard_ratio(self.lines, self.size)


@dataclass(frozen=True)
class Stewart(Wrist):
    """Two platforms joined by six legs whose lengths are driven; locks at a quarter turn of yaw.

    Choose it where the hand must also move along, or carry much, and small tilts are enough.

    Its joint positions come as a `LegConfiguration`; where plain numbers are given, they are taken
    to belong to the assembly that the home pose belongs to, and cost a forward-kinematics solve.

    Attributes:
        platform_anchors: Six points in platform axes, m, shape (6, 3), for a platform that is not
            a ring; the platform's radius and angle then mean nothing.
        base_anchors: Six points in base axes, m, shape (6, 3), likewise.
        home_height: Height of the platform above the base at home, level and centred, m.
    """

    platform_radius: float = dimension(10.441 * INCH, 'platform radius r_P', 'm', 1e-6)
    base_radius: float = dimension(13.838 * INCH, 'base radius r_B', 'm', 1e-6)
    platform_angle: float = dimension(
        math.radians(99.20), 'angle θ_P between the platform anchors 1 and 2', 'rad', 0.0, 2.0944
    )
    base_angle: float = dimension(
        math.radians(16.0), 'angle θ_B between the base anchors 1 and 2', 'rad', 0.0, 2.0944
    )
    home_height: float = dimension(17.0 * INCH, 'height z of the platform at home', 'm', 1e-6)
    platform_anchors: Points | None = point_list(
        'x, y, z of the six platform anchors, platform axes, instead of platform_radius and '
        'platform_angle'
    )
    base_anchors: Points | None = point_list(
        'x, y, z of the six base anchors, base axes, instead of base_radius and base_angle'
    )

    default_joints: ClassVar[tuple[Joint, ...]] = tuple(
        Joint(f'leg_{leg}', 'prismatic', lower=0.0) for leg in range(1, 7)
    )
    twist_size: ClassVar[Literal[3, 6]] = 6
    probe: ClassVar[Vector] = body.ALONG_Z

    def __post_init__(self) -> None:
        """Settle the anchors, and refuse legs that hold the platform at no pose."""
        super().__post_init__()
        for name in ('platform_anchors', 'base_anchors'):
            given = getattr(self, name)
            if given is not None:
                object.__setattr__(self, name, checked_anchors(name, given))
        if abs(self.home.hadamard_ratio) < EDGE:
            margin = self.home.hadamard_ratio
            raise InvalidValueError(
                f'These anchors do not hold the platform at home (margin {margin:.2g}); choose '
                f'others, or a home_height where the margin is above {EDGE:g}.'
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
    def home(self) -> LegConfiguration:  # type: ignore[override]
        """Leg lengths that hold the platform level at the home height, m."""
        return self.assembly_at(Pose(IDENTITY, (0.0, 0.0, self.home_height)))

    def assembly_at(self, pose: Pose) -> LegConfiguration:
        """Return the leg lengths that hold the platform at a pose. [Nguyen1991], eq. (11).

        Raises:
            UnreachableError: An anchor of the platform would lie on its anchor of the base.
        """
        vectors = legs(self.platform, self.base, pose)
        lengths = tuple([length(vector) for vector in vectors])
        shortest = min(lengths)
        if not shortest > SHORTEST * self.size:
            leg = lengths.index(shortest) + 1
            raise UnreachableError(
                f'leg_{leg} would have no length; keep the platform off the base.',
                f'leg_{leg} without length',
            )
        lines = [
            line(vector, reach, anchor)
            for vector, reach, anchor in zip(vectors, lengths, self.platform, strict=True)
        ]
        return LegConfiguration(lengths, pose, tuple(lines), self.size)

    def inverse(self, pose: Pose, near: Sequence[float]) -> LegConfiguration:
        """Return the leg lengths of a pose; there is one set only, and `near` is not needed."""
        return self.assembly_at(pose)

    def jacobian(self, positions: Sequence[float]) -> np.ndarray:
        """Return (vx, vy, vz, p, q, r) per leg rate, shape (6, 6), platform axes."""
        return np.linalg.inv(np.array(self._assembled(positions).lines))

    def rates(self, positions: Sequence[float], twist: Sequence[float]) -> Rates:
        """Return the leg rates of a hand twist, m/s; all of them finite at every pose."""
        vx, vy, vz, p, q, r = twist
        return tuple(
            nx * vx + ny * vy + nz * vz + mx * p + my * q + mz * r
            for nx, ny, nz, mx, my, mz in self._assembled(positions).lines
        )

    def margin(self, positions: Sequence[float]) -> float:
        """Return how well the legs hold the platform, 0 at lock, at most 1.

        The size of `geometry.hadamard_ratio`, made free of units by `size`.
        """
        return abs(self._assembled(positions).hadamard_ratio)

    def clearances(self, positions: Sequence[float]) -> tuple[Clearance, ...]:
        """Return what is left before lock, on home's side of it: the hand never crosses."""
        side = math.copysign(1.0, self.home.hadamard_ratio)
        distance = side * self._assembled(positions).hadamard_ratio
        return (soft_edge('the legs near lock', distance, EDGE, HORIZON),)

    def target_pose(self, pose: Pose, twist: Sequence[float], dt: float) -> Pose:
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

    def bodies(self, positions: Sequence[float]) -> tuple[Body, ...]:
        """Return the base, a cylinder and a rod for each leg, and the hand: the platform."""
        pose = self.forward(positions)
        bar = 0.03 * self.size
        base, links, top = [], [], []
        for leg, (b, p, home) in enumerate(zip(self.base, self.platform, self.home, strict=True)):
            foot, slide, head = (f'{name}_{leg + 1}' for name in ('base', 'leg', 'platform'))
            end = pose.point(p)
            turn = body.turn_of_z((end[0] - b[0], end[1] - b[1], end[2] - b[2]))
            sliding = Pin(slide, body.ORIGIN, body.Z, slides=True)
            base.append(Pin(foot, b))
            top.append(Pin(head, p))
            for name, at, joint, tip, radius in (
                (f'cylinder_{leg + 1}', b, foot, 0.62 * home, bar),
                (f'rod_{leg + 1}', end, head, -0.92 * home, 0.5 * bar),
            ):
                tube = Rod(body.ORIGIN, (0.0, 0.0, tip), radius)
                links.append(
                    Body(name, Pose(turn, at), (tube,), (Pin(joint, body.ORIGIN), sliding))
                )
        under = body.frame([pin.point for pin in base], bar)
        over = body.frame([pin.point for pin in top], bar)
        spokes = body.rods_between([(body.ORIGIN, pin.point) for pin in top], 0.5 * bar)
        return (
            Body('forearm', body.AT_REST, under, tuple(base)),
            *links,
            body.hand(pose, tuple(top), *over, *spokes, probe=self.probe),
        )

    def _assembled(self, positions: Sequence[float]) -> LegConfiguration:
        if isinstance(positions, LegConfiguration):
            return positions
        return self.assembly_at(self.forward(positions))

    def forward(self, positions: Sequence[float]) -> Pose:
        """Return the pose that the legs hold.

        Raises:
            UnreachableError: No pose could be proved to be the one that these lengths hold.
        """
        if isinstance(positions, LegConfiguration):
            return positions.pose
        return self._proved(positions, self.home.pose, 'home')

    def resolve_assembly(self, positions: Sequence[float], near: Pose) -> LegConfiguration:
        """Return the lengths with the pose that the legs hold, continued from a pose before.

        Raises:
            UnreachableError: No pose could be proved to be the one that `near` leads to; or the
                lengths are far from there, and are found to fit another pose as well.
        """
        pose = self._proved(positions, near, 'the pose before')
        travel = max(abs(x - y) for x, y in zip(positions, self.assembly_at(near), strict=True))
        if travel > FAR and self.forward_kinematics.cold_start(positions).others:
            raise UnreachableError(
                f'The lengths {tuple(positions)} m fit more than one pose; set initial_positions '
                f'within {FAR:g} m of them, or drive the legs home.',
                'more than one assembly',
            )
        return self.assembly_at(pose)

    def _proved(self, positions: Sequence[float], near: Pose, name: str) -> Pose:
        solution = self.forward_kinematics.solve(positions, near)
        if solution.pose is None or solution.status != Status.CONVERGED:
            raise UnreachableError(
                f'The lengths {tuple(positions)} m have no pose that {name} is proved to lead to '
                f'({solution.status.name}); check the leg readings.',
                'no proved assembly',
            )
        return solution.pose
