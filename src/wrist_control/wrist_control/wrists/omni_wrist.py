"""Rosheim's Omni-Wrist: a double Hooke joint bent by two gear drives. [McKinney1988], fig. 8."""

from __future__ import annotations

import math
from collections.abc import Sequence
from dataclasses import dataclass
from typing import ClassVar

import numpy as np

from wrist_control.errors import UnreachableError
from wrist_control.rotations import (
    Pose,
    Vector,
    about_x,
    about_y,
    about_z,
    conjugate,
    cross,
    nearest_turn,
    product,
    to_hand,
)
from wrist_control.wrists import body
from wrist_control.wrists.body import Arc, Body, Pin, Rod, Shape
from wrist_control.wrists.double_hooke import LOCK, DoubleHooke, nearest_half_turn, shaft_length
from wrist_control.wrists.joint import Joint
from wrist_control.wrists.single_hooke import cone, cone_half_angle
from wrist_control.wrists.wrist import Clearance, Positions, Rates, Wrist

# Radii of the slotted bows that the drives are drawn as, as shares of the shaft's length, and half
# the width of their slots, m.
THETA_BOW, PSI_BOW, SLOT = 0.5, 0.6, 0.007


@dataclass(frozen=True)
class OmniWrist(Wrist):
    """φ rolls the driver shaft; θa and ψa turn the gear drives about the forearm's y and z.

    The gear drives do not roll with φ, so each turns about an axis that stands still. The shaft
    between the joints rides square to both drives, and the hand follows as in the double Hooke
    wrist. Locks where either drive is at ±90°, outside its cone.

    Choose it where the double Hooke wrist would do and its drives shall stand still in a roll.
    """

    cone_half_angle: float = cone_half_angle()
    shaft_length: float = shaft_length()

    default_joints: ClassVar[tuple[Joint, ...]] = (Joint('phi'), Joint('theta_a'), Joint('psi_a'))

    def forward(self, positions: Sequence[float]) -> Pose:
        """Return the hand's pose: X(φ) after the turn that takes the forearm's x beyond the shaft.

        [McKinney1988], eqs. (15), (30) and (31).

        Raises:
            UnreachableError: Both drives are at ±90°, where they hold no shaft.
        """
        x, y, z = shaft(positions)
        length = self.shaft_length
        bent = (x, y, -z, 0.0)
        return Pose(product(bent, about_x(positions[0])), (length * x, length * y, length * z))

    def inverse(self, pose: Pose, near: Sequence[float]) -> Positions:
        """Return φ, θa, ψa of an orientation nearest to `near`, also outside the cone.

        The position follows from the orientation, so that of the pose is not asked for. A drive
        turned by half a turn reverses the shaft and leaves the hand's orientation.
        [McKinney1988], eqs. (35) and (36).
        """
        a1, _, _, a4 = pose.quaternion
        phi, theta_a, psi_a = near
        if math.hypot(a1, a4) > LOCK:
            phi = nearest_turn(2.0 * math.atan2(a4, a1), phi)
        x, y, minus_z, _ = product(pose.quaternion, conjugate(about_x(phi)))
        if math.hypot(x, minus_z) > LOCK:
            theta_a = nearest_half_turn(math.atan2(minus_z, x), theta_a)
        if math.hypot(x, y) > LOCK:
            psi_a = nearest_half_turn(math.atan2(y, x), psi_a)
        return (phi, theta_a, psi_a)

    def jacobian(self, positions: Sequence[float]) -> np.ndarray:
        """Return (p, q, r) per (φ̇, θ̇a, ψ̇a), shape (3, 3): the inverse of `rates`."""
        phi, theta_a, psi_a = positions
        u, v = math.tan(psi_a), math.tan(theta_a)
        n = 1.0 + u * u + v * v
        y_rate, z_rate = 2.0 * (1.0 + v * v) / n, 2.0 * (1.0 + u * u) / n
        s, c = math.sin(phi), math.cos(phi)
        return np.array(
            [
                [1.0, u * y_rate, -v * z_rate],
                [0.0, c * y_rate, s * z_rate],
                [0.0, -s * y_rate, c * z_rate],
            ]
        )

    def origin_jacobian(self, positions: Sequence[float]) -> np.ndarray:
        """Return the velocity of the hand's origin per (φ̇, θ̇a, ψ̇a), shape (3, 3).

        Forearm axes, m/s per rad/s: the time derivative of l times eq. (30) of [McKinney1988].
        """
        _, theta_a, psi_a = positions
        x, y, z = (self.shaft_length * component for component in shaft(positions))
        u, v = math.tan(psi_a), math.tan(theta_a)
        n = 1.0 + u * u + v * v
        du, dv = (1.0 + u * u) / n, (1.0 + v * v) / n
        return np.array(
            [
                [0.0, -x * v * dv, -x * u * du],
                [0.0, -y * v * dv, x * du * (1.0 + v * v)],
                [0.0, -x * dv * (1.0 + u * u), -z * u * du],
            ]
        )

    def rates(self, positions: Sequence[float], twist: Sequence[float]) -> Rates:
        """Return φ̇, θ̇a, ψ̇a, which the paper does not give; docs/equations.md derives them.

        In a pure roll both drives stand still.
        """
        phi, theta_a, psi_a = positions
        p, q, r = twist
        s, c = math.sin(phi), math.cos(phi)
        u, v = math.tan(psi_a), math.tan(theta_a)
        half = 0.5 * (1.0 + u * u + v * v)
        y_rate, z_rate = q * c - r * s, q * s + r * c
        return (
            p - u * y_rate + v * z_rate,
            half * y_rate / (1.0 + v * v),
            half * z_rate / (1.0 + u * u),
        )

    def margin(self, positions: Sequence[float]) -> float:
        """Return |cos β|, as for the double Hooke wrist."""
        return abs(shaft(positions)[0])

    def clearances(self, positions: Sequence[float]) -> tuple[Clearance, ...]:
        """Return what is left inside the cone of the intermediate shaft."""
        return (cone(shaft(positions)[0], self.cone_half_angle),)

    def bodies(self, positions: Sequence[float]) -> tuple[Body, ...]:
        """Return the double Hooke wrist's bodies, and two slotted bows that hold its shaft."""
        phi, theta_a, psi_a = positions
        x, y, z = to_hand(about_x(phi), shaft(positions))
        inside = DoubleHooke(shaft_length=self.shaft_length)
        forearm, *moving = inside.bodies((phi, math.atan2(-z, x), math.asin(y)))
        pitch = Pin('theta_a', (0.0, THETA_BOW * self.shaft_length, 0.0), body.Y)
        yaw = Pin('psi_a', (0.0, 0.0, PSI_BOW * self.shaft_length), body.Z)
        bearings = (body.yoke(pitch.point, body.BACK), body.yoke(yaw.point, body.BACK))
        return (
            forearm._replace(
                shapes=(*forearm.shapes, *bearings), pins=(*forearm.pins, pitch, yaw)
            ),
            Body(
                'theta_drive', Pose(about_y(theta_a)), slotted_bow(pitch.point, body.Z), (pitch,)
            ),
            Body('psi_drive', Pose(about_z(psi_a)), slotted_bow(yaw.point, body.Y), (yaw,)),
            *moving,
        )


def slotted_bow(end: Vector, across: Vector) -> tuple[Shape, ...]:
    """Return two bars side by side, from a point over +x to its opposite, joined at their ends.

    Args:
        end: Where the bow begins, m.
        across: Unit vector across its slot.
    """
    length = math.hypot(*end)
    axis = cross(body.scaled(end, 1.0 / length), body.X)
    opposite = body.scaled(end, -1.0)
    return (
        *(Arc(body.scaled(across, side), end, axis, math.pi) for side in (-SLOT, SLOT)),
        *(
            Rod(body.moved(tip, across, -SLOT), body.moved(tip, across, SLOT))
            for tip in (end, opposite)
        ),
    )


def shaft(positions: Sequence[float]) -> Vector:
    """Return the direction of the intermediate shaft, a unit vector in forearm axes.

    [McKinney1988], eq. (30), whose denominator lacks a square root: docs/errata.md.
    """
    _, theta_a, psi_a = positions
    st, ct = math.sin(theta_a), math.cos(theta_a)
    sp, cp = math.sin(psi_a), math.cos(psi_a)
    norm = math.hypot(ct, st * cp)
    if norm < LOCK:
        raise UnreachableError(
            'Both gear drives are at 90 deg, where they hold no shaft; turn one of them back.',
            'both drives at 90 deg',
        )
    return (ct * cp / norm, ct * sp / norm, -st * cp / norm)
