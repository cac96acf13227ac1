"""The conventional industrial wrist: roll, pitch, roll. [McKinney1988], figs. 1 and 2."""

from __future__ import annotations

import math
from collections.abc import Sequence
from dataclasses import dataclass
from typing import ClassVar

import numpy as np

from wrist_control.rotations import Pose, about_x, about_y, product
from wrist_control.wrists import body
from wrist_control.wrists.body import Body, Pin, Rod
from wrist_control.wrists.joint import Joint
from wrist_control.wrists.three_gimbal import ThreeGimbal
from wrist_control.wrists.wrist import Positions, Rates, Wrist

# The same three joints as a three-gimbal wrist whose forearm is bent by this, rad: a roll about
# the forearm's x axis is a roll about the z axis that is bent there.
BENT = ThreeGimbal()
BEND = -0.5 * math.pi
TO_BENT = about_y(BEND)
# It is drawn with a fork this long and half as wide, m.
FORK = 0.06


@dataclass(frozen=True)
class RollPitchRoll(Wrist):
    """θ4 about the forearm's x, θ5 about y, θ6 about the hand's x: locks at θ5 = 0 and ±180°.

    θ5 = 0, where hand and forearm are in line, is the middle of its workspace.

    Choose it because the arm has it already, and keep the work to one side: bent by 30° and more
    it is as good as any, around the middle it loses more time than all others.
    """

    default_joints: ClassVar[tuple[Joint, ...]] = (
        Joint('theta_4'),
        Joint('theta_5'),
        Joint('theta_6'),
    )

    @property
    def home(self) -> Positions:
        """The hand pitched by 30°: as nearly forward as leaves half of the margin."""
        return (0.0, math.radians(30.0), 0.0)

    def forward(self, positions: Sequence[float]) -> Pose:
        """Return the hand's pose: C = X(θ6) Y(θ5) X(θ4)."""
        first, second, third = positions
        return Pose(product(product(about_x(first), about_y(second)), about_x(third)))

    def inverse(self, pose: Pose, near: Sequence[float]) -> Positions:
        """Return θ4, θ5, θ6 of a pose nearest to `near`.

        Every orientation has two branches, (θ4, θ5, θ6) and (θ4 + π, −θ5, θ6 + π), and at lock
        infinitely many; there θ6 stays and θ4 takes the whole turn.
        """
        first, second, third = near
        bent = Pose(product(TO_BENT, pose.quaternion))
        psi, theta, phi = BENT.inverse(bent, (first, second + BEND, third))
        return (psi, theta - BEND, phi)

    def jacobian(self, positions: Sequence[float]) -> np.ndarray:
        """Return (p, q, r) per (θ̇4, θ̇5, θ̇6), shape (3, 3)."""
        _, second, third = positions
        s5, c5 = math.sin(second), math.cos(second)
        s6, c6 = math.sin(third), math.cos(third)
        return np.array([[c5, 0.0, 1.0], [s5 * s6, c6, 0.0], [s5 * c6, -s6, 0.0]])

    def rates(self, positions: Sequence[float], twist: Sequence[float]) -> Rates:
        """Return θ̇4, θ̇5, θ̇6."""
        _, second, third = positions
        p, q, r = twist
        s6, c6 = math.sin(third), math.cos(third)
        first_rate = (q * s6 + r * c6) / math.sin(second)
        return (first_rate, q * c6 - r * s6, p - first_rate * math.cos(second))

    def margin(self, positions: Sequence[float]) -> float:
        """Return |sin θ5|."""
        return abs(math.sin(positions[1]))

    def bodies(self, positions: Sequence[float]) -> tuple[Body, ...]:
        """Return a forearm, a fork, a knuckle in it, and the hand."""
        first, second, _ = positions
        rolled = about_x(first)
        pitched = product(rolled, about_y(second))
        side = 0.5 * FORK
        theta_4, theta_5 = (
            Pin('theta_4', (-2.0 * FORK, 0.0, 0.0), body.X),
            Pin('theta_5', (0.0, side, 0.0), body.Y),
        )
        theta_6 = Pin('theta_6', (side, 0.0, 0.0), body.X)
        arm = Rod((-4.0 * FORK, 0.0, 0.0), theta_4.point, 0.018)
        fork = (
            Rod(theta_4.point, (-FORK, 0.0, 0.0), 0.012),
            Rod((-FORK, -side, 0.0), (-FORK, side, 0.0)),
            Rod((-FORK, -side, 0.0), (0.0, -side, 0.0)),
            Rod((-FORK, side, 0.0), theta_5.point),
        )
        knuckle = (
            Rod((0.0, -side, 0.0), theta_5.point, 0.006),
            Rod((0.0, 0.0, 0.0), theta_6.point, 0.008),
        )
        return (
            Body('forearm', body.AT_REST, (arm,), (theta_4,)),
            Body('fork', Pose(rolled), fork, (theta_4, theta_5)),
            Body('knuckle', Pose(pitched), knuckle, (theta_5, theta_6)),
            body.hand(self.forward(positions), (theta_6,), palm=side),
        )
