"""Nguyen's Stewart platform: six legs that move the hand in all six directions. [Nguyen1991]."""

from __future__ import annotations

import math
from collections.abc import Sequence
from dataclasses import dataclass
from functools import cached_property
from typing import ClassVar, Literal

import numpy as np

from wrist_control.rotations import Pose, Vector
from wrist_control.stewart.forward_kinematics import ForwardKinematics
from wrist_control.stewart.geometry import Anchors, Points, anchors, length
from wrist_control.units import INCH
from wrist_control.wrists import body
from wrist_control.wrists.body import Body, Pin, Rod
from wrist_control.wrists.dimension import dimension, point_list
from wrist_control.wrists.joint import Joint
from wrist_control.wrists.platform import Assembly, Platform, Rods, turn_of
from wrist_control.wrists.wrist import Clearance, Rates


@dataclass(frozen=True)
class Stewart(Platform):
    """Two platforms joined by six legs whose lengths are driven; locks at a quarter turn of yaw.

    Choose it where the hand must also move along, or carry much, and small tilts are enough.

    Its joint positions come as an `Assembly`; where plain numbers are given, they are taken to
    belong to the assembly that the home pose belongs to, and cost a forward-kinematics solve.

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
    # What a fast leg (0.5 m/s) moves in four readings at 100 Hz: no leg that is followed waits for
    # the slow search, and lengths that mislead on home's side of lock lie further from home.
    far: ClassVar[float] = 0.02
    rods: ClassVar[str] = 'leg'
    drive: ClassVar[str] = 'leg'
    measured: ClassVar[Literal['length', 'angle']] = 'length'
    unit: ClassVar[Literal['m', 'rad']] = 'm'
    reach: ClassVar[float] = 1.0

    @cached_property
    def base(self) -> Anchors:
        """The base's anchors b, base axes, m."""
        return anchors('base_anchors', self.base_anchors, self.base_radius, self.base_angle)

    @cached_property
    def forward_kinematics(self) -> ForwardKinematics:
        """What takes lengths to poses, and proves them."""
        return ForwardKinematics(self.platform, self.base, self.size, self.home_pose)

    def kinematics_at(self, positions: Sequence[float]) -> tuple[ForwardKinematics, Rods]:
        """Return what takes lengths to poses, and the lengths, m."""
        a, b, c, d, e, f = positions
        return self.forward_kinematics, (a, b, c, d, e, f)

    def inverse(self, pose: Pose, near: Sequence[float]) -> Assembly:
        """Return the leg lengths of a pose; there is one set only, and `near` is not needed.

        [Nguyen1991], eq. (11).

        Raises:
            UnreachableError: An anchor of the platform would lie on its anchor of the base.
        """
        vectors = self.vectors(self.base, pose)
        lengths = tuple([length(vector) for vector in vectors])
        return Assembly(lengths, pose, self.lines_along(vectors), self.size)

    def held(self, positions: Sequence[float], pose: Pose) -> Assembly:
        """Return the lengths that a pose has: no search ends nearer to those it was found for."""
        return self.inverse(pose, positions)

    def rates(self, positions: Sequence[float], twist: Sequence[float]) -> Rates:
        """Return the leg rates of a hand twist, m/s; all of them finite at every pose."""
        vx, vy, vz, p, q, r = twist
        return tuple(
            nx * vx + ny * vy + nz * vz + mx * p + my * q + mz * r
            for nx, ny, nz, mx, my, mz in self.assembled(positions).lines
        )

    def margin(self, positions: Sequence[float]) -> float:
        """Return how well the legs hold the platform, 0 at lock, at most 1.

        The size of `geometry.hadamard_ratio`, made free of units by `size`.
        """
        return abs(self.assembled(positions).hadamard_ratio)

    def clearances(self, positions: Sequence[float]) -> tuple[Clearance, ...]:
        """Return what is left before lock, on home's side of it: the hand never crosses."""
        return (self.lock_clearance(self.assembled(positions)),)

    def lost_axis(self, positions: Sequence[float]) -> Vector:
        """Return the turn that the legs hold least, a unit vector in platform axes."""
        lines = np.array(self.assembled(positions).lines)
        lines[:, 3:] /= self.size
        return turn_of(np.linalg.svd(lines)[2][-1])

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
        return (
            Body('forearm', body.AT_REST, under, tuple(base)),
            *links,
            body.hand(pose, tuple(top), *self.carried(top, bar), probe=self.probe),
        )
