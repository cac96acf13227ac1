"""The serial pitch-yaw pointer: θ2 about the forearm's y, then θ1 about x. [Canfield1997]."""

from __future__ import annotations

import math
from collections.abc import Sequence
from dataclasses import dataclass
from typing import ClassVar

import numpy as np

from wrist_control.errors import UnreachableError
from wrist_control.rotations import (
    Pose,
    Quaternion,
    Vector,
    about_x,
    about_y,
    direction_cosines,
    nearest_turn,
    product,
    rates_between,
    to_forearm,
    turned,
)
from wrist_control.wrists import body
from wrist_control.wrists.body import Body, Pin, Rod
from wrist_control.wrists.joint import Joint
from wrist_control.wrists.wrist import Positions, Rates, Wrist

# Orientations this far from the mechanism's own, rad, still count as its own: far beyond
# round-off, and far below what a person would call a roll.
TOLERANCE = 1e-6
# It is drawn with a fork and a ring of these radii, m.
FORK, RING = 0.072, 0.058


@dataclass(frozen=True)
class PitchYaw(Wrist):
    """Points the hand's z axis with two joints; locks at θ1 = ±90°, where z lies along θ2's axis.

    p and q are followed; the hand's roll is what the mechanism forces.

    Choose it to point a camera or a light around its middle: two joints, and nothing in the way;
    beyond 80° it has little to turn with, and at 90° no way to go on sideways.
    """

    default_joints: ClassVar[tuple[Joint, ...]] = (Joint('theta_1'), Joint('theta_2'))
    followed_axes: ClassVar[tuple[int, ...]] = (0, 1)
    probe: ClassVar[Vector] = body.ALONG_Z

    def forward(self, positions: Sequence[float]) -> Pose:
        """Return the hand's pose, C = X(θ1) Y(θ2): its z axis is N of [Canfield1997], (4.30)."""
        theta_1, theta_2 = positions
        return Pose(product(about_y(theta_2), about_x(theta_1)))

    def inverse(self, pose: Pose, near: Sequence[float]) -> Positions:
        """Return θ1 and θ2 of a pose; whole turns apart there is only one branch."""
        (c11, c12, c13), (_, c22, _), (_, c32, _) = direction_cosines(pose.quaternion)
        if abs(c12) > TOLERANCE:
            raise UnreachableError(
                'The hand can only point, with the roll that follows; aim for such a pose.',
                'roll that is not free',
            )
        theta_1, theta_2 = math.atan2(-c32, c22), math.atan2(-c13, c11)
        return (nearest_turn(theta_1, near[0]), nearest_turn(theta_2, near[1]))

    def jacobian(self, positions: Sequence[float]) -> np.ndarray:
        """Return (p, q, r) per (θ̇1, θ̇2), shape (3, 2)."""
        s, c = math.sin(positions[0]), math.cos(positions[0])
        return np.array([[1.0, 0.0], [0.0, c], [0.0, -s]])

    def rates(self, positions: Sequence[float], twist: Sequence[float]) -> Rates:
        """Return θ̇1 and θ̇2 that make p and q; r = -q tan θ1 is not free."""
        return (twist[0], twist[1] / math.cos(positions[0]))

    def margin(self, positions: Sequence[float]) -> float:
        """Return |cos θ1|, 0 at lock."""
        return abs(math.cos(positions[0]))

    def target_pose(self, pose: Pose, twist: Sequence[float], dt: float) -> Pose:
        """Return the pose after p and q for a time, right to second order.

        The roll that the mechanism forces turns p and q as well: it is found first, then used.
        Neither pass divides by anything, so both go through lock.
        """
        p, q = twist[0], twist[1]
        found = self._pointed(pose, turned(pose.quaternion, (p, q, 0.0), dt))
        roll = rates_between(pose.quaternion, found.quaternion, dt)[2]
        return self._pointed(pose, turned(pose.quaternion, (p, q, roll), dt))

    def bodies(self, positions: Sequence[float]) -> tuple[Body, ...]:
        """Return a forearm with a fork, a ring and the hand, which points along z."""
        _, theta_2 = positions
        first, second = (
            Pin('theta_2', (0.0, FORK, 0.0), body.Y),
            Pin('theta_1', (RING, 0.0, 0.0), body.X),
        )
        fork = (
            body.yoke(first.point, body.DOWN),
            Rod((0.0, 0.0, -2.0 * FORK), (0.0, 0.0, -FORK), 0.006),
        )
        held = body.gimbal(body.ring(body.Z, (0.0, RING, 0.0)), body.Y, FORK)
        axle = Rod((-RING, 0.0, 0.0), second.point)
        return (
            Body('forearm', body.AT_REST, fork, (first,)),
            Body('ring', Pose(about_y(theta_2)), held, (first, second)),
            body.hand(self.forward(positions), (second,), axle, probe=self.probe),
        )

    def _pointed(self, pose: Pose, aim: Quaternion) -> Pose:
        """Return the pose nearest to another, of the two that point as the aim does."""
        x, y, z = to_forearm(aim, (0.0, 0.0, 1.0))
        before = self.inverse(pose, (0.0, 0.0))
        theta_1, theta_2 = math.atan2(-y, math.hypot(x, z)), math.atan2(x, z)
        branches = ((theta_1, theta_2), (math.pi - theta_1, theta_2 + math.pi))
        return self.forward(min(branches, key=lambda branch: _way(before, branch)))


def _way(before: Sequence[float], after: Sequence[float]) -> float:
    return sum(abs(nearest_turn(b, a) - a) for a, b in zip(before, after, strict=True))
