"""One Hooke universal joint: φ about x, then θ about y, then ψ about z. [McKinney1988], fig. 4."""

from __future__ import annotations

import math
from collections.abc import Sequence
from dataclasses import dataclass
from typing import ClassVar

import numpy as np

from wrist_control.rotations import Pose, about_x, about_y, about_z, conjugate, product
from wrist_control.wrists import body
from wrist_control.wrists.body import Body, Pin, Rod
from wrist_control.wrists.dimension import dimension
from wrist_control.wrists.joint import Joint
from wrist_control.wrists.three_gimbal import ThreeGimbal
from wrist_control.wrists.wrist import Clearance, Positions, Rates, Wrist

# Seen from the hand, a Hooke joint is a three-gimbal wrist that turns the other way.
SEEN_FROM_HAND = ThreeGimbal()
# It is drawn with yokes of this radius, m.
YOKE = 0.04


def cone_half_angle() -> float:
    """Return the dataclass field for the largest bend of a Hooke joint."""
    return dimension(
        math.radians(45.0),
        'largest bend of a Hooke joint, below 90 deg',
        'rad',
        math.radians(1.0),
        math.radians(89.0),
    )


def cone(cos_bend: float, half_angle: float) -> Clearance:
    """Return what is left before a Hooke joint is bent too far: cos β − cos β_max.

    [McKinney1988], eq. (6), with cos β = cos θ cos ψ.
    """
    return Clearance('cone', cos_bend - math.cos(half_angle))


def driven_cross(phi: float, theta: float, radius: float) -> tuple[Body, Body, Body]:
    """Return a forearm, the shaft that rolls in it, and the cross that it drives.

    Args:
        phi: How far the shaft is rolled about x, rad.
        theta: How far the cross is turned in it about y, rad.
        radius: Of the yokes, m; the cross has a pin `psi` for the next one.
    """
    rolled = about_x(phi)
    roll, bend = (
        Pin('phi', (-2.0 * radius, 0.0, 0.0), body.X),
        Pin('theta', (0.0, radius, 0.0), body.Y),
    )
    sleeve = Rod((-4.0 * radius, 0.0, 0.0), roll.point, 0.25 * radius)
    driver = (Rod(roll.point, (-radius, 0.0, 0.0)), body.yoke(bend.point, body.BACK))
    return (
        Body('forearm', body.AT_REST, (sleeve,), (roll,)),
        Body('driver', Pose(rolled), driver, (roll, bend)),
        Body(
            'cross',
            Pose(product(rolled, about_y(theta))),
            cross_rods(radius),
            (bend, Pin('psi', (0.0, 0.0, radius), body.Z)),
        ),
    )


def cross_rods(radius: float) -> tuple[Rod, Rod]:
    """Return the cross of a Hooke joint, along y and z."""
    return (
        Rod((0.0, -radius, 0.0), (0.0, radius, 0.0)),
        Rod((0.0, 0.0, -radius), (0.0, 0.0, radius)),
    )


@dataclass(frozen=True)
class SingleHooke(Wrist):
    """A Hooke joint whose driver shaft rolls; locks at θ = ±90°, well outside its cone.

    Choose it for small bends in little space: nothing locks inside its cone, and a roll, uneven
    by 1 / cos β, passes through it from the forearm.
    """

    cone_half_angle: float = cone_half_angle()

    default_joints: ClassVar[tuple[Joint, ...]] = (Joint('phi'), Joint('theta'), Joint('psi'))

    def forward(self, positions: Sequence[float]) -> Pose:
        """Return the hand's pose: C = Z(ψ) Y(θ) X(φ). [McKinney1988], eq. (4)."""
        phi, theta, psi = positions
        return Pose(product(product(about_x(phi), about_y(theta)), about_z(psi)))

    def inverse(self, pose: Pose, near: Sequence[float]) -> Positions:
        """Return φ, θ, ψ of a pose nearest to `near`, also outside the cone.

        Every orientation has two branches, (φ, θ, ψ) and (φ + π, π − θ, ψ + π), and at lock
        infinitely many; there φ stays and ψ takes the whole turn.
        """
        phi, theta, psi = near
        turned_back = Pose(conjugate(pose.quaternion))
        psi, theta, phi = SEEN_FROM_HAND.inverse(turned_back, (-psi, -theta, -phi))
        return (-phi, -theta, -psi)

    def jacobian(self, positions: Sequence[float]) -> np.ndarray:
        """Return (p, q, r) per (φ̇, θ̇, ψ̇), shape (3, 3). [McKinney1988], eq. (18)."""
        _, theta, psi = positions
        s, c = math.sin(psi), math.cos(psi)
        cosine = math.cos(theta)
        return np.array([[cosine * c, s, 0.0], [-cosine * s, c, 0.0], [math.sin(theta), 0.0, 1.0]])

    def rates(self, positions: Sequence[float], twist: Sequence[float]) -> Rates:
        """Return φ̇, θ̇, ψ̇. [McKinney1988], eqs. (1) to (3)."""
        _, theta, psi = positions
        p, q, r = twist
        s, c = math.sin(psi), math.cos(psi)
        phi_rate = (p * c - q * s) / math.cos(theta)
        return (phi_rate, p * s + q * c, r - phi_rate * math.sin(theta))

    def margin(self, positions: Sequence[float]) -> float:
        """Return |cos θ|."""
        return abs(math.cos(positions[1]))

    def clearances(self, positions: Sequence[float]) -> tuple[Clearance, ...]:
        """Return what is left inside the cone of the driven shaft."""
        _, theta, psi = positions
        return (cone(math.cos(theta) * math.cos(psi), self.cone_half_angle),)

    def bodies(self, positions: Sequence[float]) -> tuple[Body, ...]:
        """Return a forearm, the driver shaft, the cross and the hand."""
        phi, theta, _ = positions
        third = Pin('psi', (0.0, 0.0, YOKE), body.Z)
        return (
            *driven_cross(phi, theta, YOKE),
            body.hand(
                self.forward(positions), (third,), body.yoke(third.point, body.X), palm=YOKE
            ),
        )
