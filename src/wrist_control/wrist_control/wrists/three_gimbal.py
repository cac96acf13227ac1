"""Barker's three-gimbal wrist: ψ about z, then θ about y, then φ about x. [Barker1986], fig. 1."""

from __future__ import annotations

import math
from collections.abc import Sequence
from dataclasses import dataclass
from typing import ClassVar

import numpy as np

from wrist_control.rotations import (
    Pose,
    about_x,
    about_y,
    about_z,
    direction_cosines,
    nearest_turn,
    product,
)
from wrist_control.wrists import body
from wrist_control.wrists.body import Body, Pin, Rod
from wrist_control.wrists.joint import Joint
from wrist_control.wrists.wrist import Positions, Rates, Wrist

# Below this |cos θ| the quotient c23 / c33 is round-off: φ is kept instead of flipping by 180°.
LOCK = 1e-9
# Two branches that differ by less than this are a tie, won by the one with cos θ > 0.
TIE = 1e-6
# It is drawn with a fork, an outer and an inner ring of these radii, m.
FORK, OUTER, INNER = 0.084, 0.072, 0.058


@dataclass(frozen=True)
class ThreeGimbal(Wrist):
    """Three gimbals whose axes meet in one point; locks at θ = ±90°, where ψ and φ align.

    Choose it where the hand works around its middle and every orientation must be within reach:
    it is the simplest wrist, no joint needs to be faster than the hand, and what lock costs is a
    wait while ψ turns.
    """

    default_joints: ClassVar[tuple[Joint, ...]] = (Joint('psi'), Joint('theta'), Joint('phi'))

    def forward(self, positions: Sequence[float]) -> Pose:
        """Return the hand's pose: C = X(φ) Y(θ) Z(ψ). [Barker1986], fig. 2(b)."""
        psi, theta, phi = positions
        return Pose(product(product(about_z(psi), about_y(theta)), about_x(phi)))

    def inverse(self, pose: Pose, near: Sequence[float]) -> Positions:
        """Return ψ, θ, φ of a pose nearest to `near`. [Barker1986], fig. 2(f).

        Every orientation has two branches, (ψ, θ, φ) and (ψ + π, π − θ, φ + π), and at lock
        infinitely many; there φ stays and ψ takes the whole turn.
        """
        c = direction_cosines(pose.quaternion)
        psi_near, theta_near, phi_near = near
        phi = self._phi(c[1][2], c[2][2], phi_near)
        s, k = math.sin(phi), math.cos(phi)
        psi = math.atan2(c[2][0] * s - c[1][0] * k, c[1][1] * k - c[2][1] * s)
        theta = math.atan2(-c[0][2], c[1][2] * s + c[2][2] * k)
        return (nearest_turn(psi, psi_near), nearest_turn(theta, theta_near), phi)

    @staticmethod
    def _phi(c23: float, c33: float, near: float) -> float:
        if math.hypot(c23, c33) < LOCK:
            return near
        phi = nearest_turn(math.atan2(c23, c33), near)
        if abs(phi - near) <= 0.5 * math.pi + TIE:
            return phi
        return phi - math.copysign(math.pi, phi - near)

    def jacobian(self, positions: Sequence[float]) -> np.ndarray:
        """Return (p, q, r) per (ψ̇, θ̇, φ̇), shape (3, 3)."""
        _, theta, phi = positions
        s, c = math.sin(theta), math.cos(theta)
        sp, cp = math.sin(phi), math.cos(phi)
        return np.array([[-s, 0.0, 1.0], [c * sp, cp, 0.0], [c * cp, -sp, 0.0]])

    def rates(self, positions: Sequence[float], twist: Sequence[float]) -> Rates:
        """Return ψ̇, θ̇, φ̇. [Barker1986], figs. 1(b) and 2(g)."""
        _, theta, phi = positions
        p, q, r = twist
        s, c = math.sin(phi), math.cos(phi)
        psi_rate = (r * c + q * s) / math.cos(theta)
        return (psi_rate, q * c - r * s, p + psi_rate * math.sin(theta))

    def margin(self, positions: Sequence[float]) -> float:
        """Return |cos θ|: Barker's measure of the distance to lock."""
        return abs(math.cos(positions[1]))

    def bodies(self, positions: Sequence[float]) -> tuple[Body, ...]:
        """Return a forearm with a fork, two rings and the hand."""
        psi, theta, _ = positions
        turned_by_psi = about_z(psi)
        turned_by_theta = product(turned_by_psi, about_y(theta))
        first, second = (
            Pin('psi', (0.0, 0.0, FORK), body.Z),
            Pin('theta', (0.0, OUTER, 0.0), body.Y),
        )
        third = Pin('phi', (INNER, 0.0, 0.0), body.X)
        fork = (
            body.yoke(first.point, body.BACK),
            Rod((-2.0 * FORK, 0.0, 0.0), (-FORK, 0.0, 0.0), 0.006),
        )
        outer = body.gimbal(body.ring(body.X, (0.0, 0.0, OUTER)), body.Z, FORK)
        inner = body.gimbal(body.ring(body.Z, (0.0, INNER, 0.0)), body.Y, OUTER)
        axle = Rod((-INNER, 0.0, 0.0), third.point)
        return (
            Body('forearm', body.AT_REST, fork, (first,)),
            Body('outer_gimbal', Pose(turned_by_psi), outer, (first, second)),
            Body('inner_gimbal', Pose(turned_by_theta), inner, (second, third)),
            body.hand(self.forward(positions), (third,), axle),
        )
