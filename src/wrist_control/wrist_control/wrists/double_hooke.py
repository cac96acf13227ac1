"""Two Hooke joints geared to bend equally: φ about x, then θ, ψ, ψ, θ. [McKinney1988], fig. 7."""

from __future__ import annotations

import math
from collections.abc import Sequence
from dataclasses import dataclass
from typing import ClassVar

import numpy as np

from wrist_control.rotations import (
    Pose,
    Vector,
    about_x,
    about_y,
    about_z,
    conjugate,
    nearest_turn,
    product,
)
from wrist_control.wrists import body
from wrist_control.wrists.body import Arc, Body, Pin, Rod
from wrist_control.wrists.dimension import dimension
from wrist_control.wrists.joint import Joint
from wrist_control.wrists.single_hooke import cone, cone_half_angle, cross_rods, driven_cross
from wrist_control.wrists.wrist import Clearance, Positions, Rates, Wrist

# Below this the two parts of a half-angle are round-off: the joint stays where it is.
LOCK = 1e-9
# Radius of the yokes that it is drawn with, as a share of the shaft's length.
YOKE = 0.3


def shaft_length() -> float:
    """Return the dataclass field for the length of the intermediate shaft."""
    return dimension(0.1, 'length l of the shaft between the two Hooke joints', 'm', 0.001)


@dataclass(frozen=True)
class DoubleHooke(Wrist):
    """The second joint repeats the bend β of the first: the hand bends by 2β without torsion.

    The hand's origin is the centre of the second joint, so it moves as the wrist bends. Locks at
    θ = ±90° and ψ = ±90°, outside its cone.

    Choose it for a whole hemisphere without lock and without a fast joint, where the arm can take
    back that the hand moves aside by up to 0.71 l.
    """

    cone_half_angle: float = cone_half_angle()
    shaft_length: float = shaft_length()

    default_joints: ClassVar[tuple[Joint, ...]] = (Joint('phi'), Joint('theta'), Joint('psi'))

    def forward(self, positions: Sequence[float]) -> Pose:
        """Return the hand's pose: C = Y(θ) Z(2ψ) Y(θ) X(φ). [McKinney1988], eqs. (13) to (15).

        Y(θ) Z(2ψ) Y(θ) is a turn by 2β about an axis across the shaft, and its quaternion has
        the intermediate shaft for components.
        """
        phi, theta, psi = positions
        x, y, z = _shaft(theta, psi)
        s, c = math.sin(phi), math.cos(phi)
        length = self.shaft_length
        position = (length * x, length * (c * y - s * z), length * (s * y + c * z))
        return Pose(product(about_x(phi), (x, y, -z, 0.0)), position)

    def inverse(self, pose: Pose, near: Sequence[float]) -> Positions:
        """Return φ, θ, ψ of an orientation nearest to `near`, also outside the cone.

        The position follows from the orientation, so that of the pose is not asked for. Every
        orientation has one φ and four branches of θ and ψ, with the shaft in one of two opposite
        directions: (θ, ψ), (θ + π, π − ψ), and (θ, ψ + π), (θ + π, −ψ).
        """
        a1, _, _, a4 = pose.quaternion
        phi, theta, psi = near
        if math.hypot(a1, a4) > LOCK:
            phi = nearest_turn(2.0 * math.atan2(a4, a1), phi)
        x, y, minus_z, _ = product(conjugate(about_x(phi)), pose.quaternion)
        if math.hypot(x, minus_z) > LOCK:
            theta = nearest_half_turn(math.atan2(minus_z, x), theta)
        along = x * math.cos(theta) + minus_z * math.sin(theta)
        return (phi, theta, nearest_half_turn(math.atan2(y, along), psi))

    def jacobian(self, positions: Sequence[float]) -> np.ndarray:
        """Return (p, q, r) per (φ̇, θ̇, ψ̇), shape (3, 3). [McKinney1988], eqs. (22) and (23)."""
        _, theta, psi = positions
        s, c = math.sin(theta), math.cos(theta)
        s2, c2 = math.sin(2.0 * psi), math.cos(2.0 * psi)
        return np.array(
            [
                [c * c * c2 - s * s, c * s2, -2.0 * s],
                [-c * s2, 1.0 + c2, 0.0],
                [s * c * (1.0 + c2), s * s2, 2.0 * c],
            ]
        )

    def origin_jacobian(self, positions: Sequence[float]) -> np.ndarray:
        """Return the velocity of the hand's origin per (φ̇, θ̇, ψ̇), shape (3, 3).

        Forearm axes, m/s per rad/s. [McKinney1988], eqs. (19) and (20).
        """
        phi, theta, psi = positions
        sp, cp = math.sin(phi), math.cos(phi)
        st, ct = math.sin(theta), math.cos(theta)
        ss, cs = math.sin(psi), math.cos(psi)
        return self.shaft_length * np.array(
            [
                [0.0, -st * cs, -ct * ss],
                [cp * st * cs - sp * ss, sp * ct * cs, cp * cs - sp * st * ss],
                [sp * st * cs + cp * ss, -cp * ct * cs, sp * cs + cp * st * ss],
            ]
        )

    def rates(self, positions: Sequence[float], twist: Sequence[float]) -> Rates:
        """Return φ̇, θ̇, ψ̇. [McKinney1988], eqs. (24) to (26)."""
        _, theta, psi = positions
        p, q, r = twist
        s, c = math.sin(theta), math.cos(theta)
        tangent = math.tan(psi)
        across = q * tangent - r * s
        return (
            p - across / c,
            (p * c + r * s) * tangent + 0.5 * q * (1.0 - tangent * tangent),
            0.5 * (across * s / c + r * c) - p * s,
        )

    def margin(self, positions: Sequence[float]) -> float:
        """Return |cos β| = |cos θ cos ψ|, 0 when either Hooke joint locks."""
        _, theta, psi = positions
        return abs(math.cos(theta) * math.cos(psi))

    def clearances(self, positions: Sequence[float]) -> tuple[Clearance, ...]:
        """Return what is left inside the cone of the intermediate shaft."""
        _, theta, psi = positions
        return (cone(math.cos(theta) * math.cos(psi), self.cone_half_angle),)

    def bodies(self, positions: Sequence[float]) -> tuple[Body, ...]:
        """Return a forearm, the driver, a cross, the shaft, another cross, and the hand."""
        phi, theta, psi = positions
        pose = self.forward(positions)
        length, radius = self.shaft_length, YOKE * self.shaft_length
        first = product(about_x(phi), about_y(theta))
        near, far = (
            Pin('psi', (0.0, 0.0, radius), body.Z),
            Pin('psi_2', (length, 0.0, radius), body.Z),
        )
        here, last = Pin('psi_2', near.point, body.Z), Pin('theta_2', (0.0, radius, 0.0), body.Y)
        shaft = (
            body.yoke(near.point, body.X),
            Rod((radius, 0.0, 0.0), (length - radius, 0.0, 0.0)),
            Arc((length, 0.0, 0.0), near.point, body.RIGHT, math.pi),
        )
        return (
            *driven_cross(phi, theta, radius),
            Body('shaft', Pose(product(first, about_z(psi))), shaft, (near, far)),
            Body(
                'second_cross',
                Pose(product(first, about_z(2.0 * psi)), pose.position),
                cross_rods(radius),
                (here, last),
            ),
            body.hand(pose, (last,), body.yoke(last.point, body.X), palm=radius),
        )


def _shaft(theta: float, psi: float) -> Vector:
    """Return the direction of the intermediate shaft in axes that roll with φ."""
    c = math.cos(psi)
    return (math.cos(theta) * c, math.sin(psi), -math.sin(theta) * c)


def nearest_half_turn(angle: float, near: float) -> float:
    """Return the angle plus the half turns that bring it closest to another, rad."""
    return angle - math.pi * round((angle - near) / math.pi)
