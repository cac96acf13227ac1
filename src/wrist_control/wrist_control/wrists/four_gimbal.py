"""Barker's four-gimbal wrist: ψ about z, θ about y, φ about x, α about z. [Barker1986], fig. 4."""

from __future__ import annotations

import math
from collections.abc import Sequence
from dataclasses import dataclass
from typing import ClassVar

import numpy as np

from wrist_control.rotations import Pose, Vector, about_y, about_z, product
from wrist_control.wrists import body
from wrist_control.wrists.body import Body, Pin, Rod
from wrist_control.wrists.dimension import dimension
from wrist_control.wrists.joint import Joint
from wrist_control.wrists.spare_joint import increment, share_of_space
from wrist_control.wrists.three_gimbal import ThreeGimbal
from wrist_control.wrists.wrist import Positions, Rates, SteeringState, Wrist

# The gimbals under the fourth one.
INNER = ThreeGimbal()
# sgn(sin φ) is +1 from here up: sgn 0 must choose a side, and round-off must not choose it.
SIDE = -1e-9
# It is drawn with a fork, a ring, and two forks inside it of these radii, m: forks that are open
# to the front leave the hand room to turn.
FORK, OUTER, MIDDLE, INMOST = 0.096, 0.084, 0.072, 0.058


@dataclass(frozen=True)
class FourGimbal(Wrist):
    """Three gimbals, and a fourth that turns the hand so that θ stays away from ±90°.

    α̇ depends on where the gimbals are alone, so the other three must do all that the command
    still needs, and they lock where those of the three-gimbal wrist do.

    Choose it where the hand must go on turning without a wait, and joints up to 1.8 times as fast
    as the hand, seldom up to 4.9 times, can be had.
    """

    gain: float = dimension(
        0.8, 'gain K of the fourth gimbal; above the fastest hand rate', 'rad/s', 0.001, 10.0
    )

    default_joints: ClassVar[tuple[Joint, ...]] = (
        Joint('psi'),
        Joint('theta'),
        Joint('phi'),
        Joint('alpha'),
    )

    def forward(self, positions: Sequence[float]) -> Pose:
        """Return the hand's pose: C = Z(α) X(φ) Y(θ) Z(ψ). [Barker1986], fig. 5(c)."""
        inner = INNER.forward(positions[:3])
        return Pose(product(inner.quaternion, about_z(positions[3])))

    def inverse(self, pose: Pose, near: Sequence[float]) -> Positions:
        """Return ψ, θ, φ nearest to `near` for the α of `near`. [Barker1986], fig. 5(b)."""
        alpha = near[3]
        inner = Pose(product(pose.quaternion, about_z(-alpha)))
        return (*INNER.inverse(inner, near[:3]), alpha)

    def jacobian(self, positions: Sequence[float]) -> np.ndarray:
        """Return (p, q, r) per (ψ̇, θ̇, φ̇, α̇), shape (3, 4)."""
        s, c = math.sin(positions[3]), math.cos(positions[3])
        to_hand = np.array([[c, s, 0.0], [-s, c, 0.0], [0.0, 0.0, 1.0]])
        return np.column_stack([to_hand @ INNER.jacobian(positions[:3]), (0.0, 0.0, 1.0)])

    def rates(self, positions: Sequence[float], twist: Sequence[float]) -> Rates:
        """Return ψ̇, θ̇, φ̇, α̇; all zero for a zero twist. [Barker1986], figs. 4(b) and 5(d)."""
        p, q, r = twist
        if p == q == r == 0.0:
            return (0.0, 0.0, 0.0, 0.0)
        s, c = math.sin(positions[3]), math.cos(positions[3])
        law, share = self._alpha_rate(positions)
        inner = (p * c - q * s, p * s + q * c, r - share * law)
        return (*INNER.rates(positions[:3], inner), share * law)

    def margin(self, positions: Sequence[float]) -> float:
        """Return |cos θ|, with which `rates` grow out of bounds.

        The four joints together keep all three rotations at θ = ±90° as long as φ is not ±90°,
        but α̇ is not free to help: its law has already spent it.
        """
        return INNER.margin(positions[:3])

    def choose_branch_reference(
        self, positions: Positions, factor: float, dt: float, steering_state: SteeringState
    ) -> tuple[Positions, SteeringState]:
        """Return α after the step. [Barker1986], fig. 5(a).

        A pause changes nothing: the gimbals stood still too.
        """
        law, share = self._alpha_rate(positions)
        way, remembered = increment(law, share, factor * dt, steering_state)
        return (*positions[:3], positions[3] + way), remembered

    def lost_axis(self, positions: Sequence[float]) -> Vector:
        """Return the rotation that ψ, θ and φ find hardest to make, in hand axes."""
        return self.hardest_rotation(self.jacobian(positions)[:, :3])

    def bodies(self, positions: Sequence[float]) -> tuple[Body, ...]:
        """Return a forearm with a fork, a ring, two forks inside it, and the hand."""
        psi, theta, _, _ = positions
        turned_by_psi = about_z(psi)
        turned_by_theta = product(turned_by_psi, about_y(theta))
        first = Pin('psi', (0.0, 0.0, FORK), body.Z)
        second = Pin('theta', (0.0, OUTER, 0.0), body.Y)
        third = Pin('phi', (-MIDDLE, 0.0, 0.0), body.X)
        fourth = Pin('alpha', (0.0, 0.0, INMOST), body.Z)
        stem = Rod((-2.0 * FORK, 0.0, 0.0), (-FORK, 0.0, 0.0), 0.006)
        fork = (body.yoke(first.point, body.BACK), stem)
        outer = body.gimbal(body.ring(body.X, (0.0, 0.0, OUTER)), body.Z, FORK)
        middle = body.gimbal(body.yoke((0.0, MIDDLE, 0.0), body.BACK), body.Y, OUTER)
        inner = (body.yoke(fourth.point, body.BACK), Rod(third.point, (-INMOST, 0.0, 0.0)))
        axle = Rod((0.0, 0.0, -INMOST), fourth.point)
        return (
            Body('forearm', body.AT_REST, fork, (first,)),
            Body('outer_gimbal', Pose(turned_by_psi), outer, (first, second)),
            Body('middle_gimbal', Pose(turned_by_theta), middle, (second, third)),
            Body('inner_gimbal', INNER.forward(positions[:3]), inner, (third, fourth)),
            body.hand(self.forward(positions), (fourth,), axle),
        )

    def _alpha_rate(self, positions: Sequence[float]) -> tuple[float, float]:
        """Return α̇ by Barker's law, rad/s, and the share of it that the joints have space for."""
        _, theta, phi, _ = positions
        law = -self.gain * math.sin(theta)  # [Barker1986], eq. (1)
        s, c = math.sin(phi), math.cos(phi)
        cosine = math.cos(theta)
        if math.copysign(1.0, cosine) * s < SIDE:
            law = -law
        # cos θ times the joints' rates for α̇ = 1 and a hand at rest: no division at lock.
        moves = (-c, s * cosine, -c * math.sin(theta), cosine)
        return law, share_of_space(self.joints, positions, moves, cosine, law)
