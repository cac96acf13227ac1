"""The spherical five-bar pointer, its two actuated axes perpendicular. [Canfield1997], fig. 4.7.

Link 1 turns about the forearm's y by θ1, link 2 about -x by θ2; all four links span 90°. Hence
the pointing direction N is perpendicular to both moving joints: N ∝ (tan θ1, tan θ2, 1), where
the paper has (sin θ1, sin θ2, ·): docs/errata.md. The hand is bolted to the link after link 1,
which makes it the pitch-yaw pointer's hand, its pitch driven through the second chain.
"""

from __future__ import annotations

import math
from collections.abc import Sequence
from dataclasses import dataclass
from typing import ClassVar

import numpy as np

from wrist_control.errors import UnreachableError
from wrist_control.rotations import Pose, direction_cosines, nearest_turn
from wrist_control.wrists.joint import Joint
from wrist_control.wrists.pitch_yaw import PitchYaw
from wrist_control.wrists.wrist import Clearance, Positions, Rates, Wrist, soft_edge

SERIAL = PitchYaw()
# Nearer than this to both joints at 90° the direction of N is round-off.
LOOSE = 1e-9
EQUATOR = 'equator'


@dataclass(frozen=True)
class FiveBar(Wrist):
    """Points the hand's z axis over a hemisphere with two joints, both on the forearm.

    p and q are followed; the hand's roll is what the mechanism forces.
    """

    default_joints: ClassVar[tuple[Joint, ...]] = (Joint('theta_1'), Joint('theta_2'))
    followed_axes: ClassVar[tuple[int, ...]] = (0, 1)

    def forward(self, positions: Sequence[float]) -> Pose:
        """Return the hand's pose, z along (s1 c2, c1 s2, c1 c2), x along the joint after link 1.

        Raises:
            UnreachableError: Both joints at 90°: the hand is loose.
        """
        return SERIAL.forward(self._serial(positions))

    def inverse(self, pose: Pose, near: Sequence[float]) -> Positions:
        """Return θ1 and θ2 of a pose; the pose itself tells its branches apart."""
        pitch, theta_1 = SERIAL.inverse(pose, (0.0, near[0]))
        c1 = math.cos(theta_1)
        side = math.copysign(1.0, c1)
        theta_2 = math.atan2(-side * math.sin(pitch), side * c1 * math.cos(pitch))
        return (theta_1, nearest_turn(theta_2, near[1]))

    def jacobian(self, positions: Sequence[float]) -> np.ndarray:
        """Return (p, q, r) per (θ̇1, θ̇2), shape (3, 2)."""
        by_theta_1, by_theta_2 = self._pitch_slopes(positions)
        serial = SERIAL.jacobian(self._serial(positions))
        found: np.ndarray = serial @ np.array([[by_theta_1, by_theta_2], [1.0, 0.0]])
        return found

    def rates(self, positions: Sequence[float], twist: Sequence[float]) -> Rates:
        """Return θ̇1 and θ̇2 that make p and q; r is not free."""
        by_theta_1, by_theta_2 = self._pitch_slopes(positions)
        pitch_rate, theta_1_rate = SERIAL.rates(self._serial(positions), twist)
        return (theta_1_rate, (pitch_rate - by_theta_1 * theta_1_rate) / by_theta_2)

    def margin(self, positions: Sequence[float]) -> float:
        """Return |N_z|, the sine of the angle between the hand's z axis and the equator."""
        pitch, theta_1 = self._serial(positions)
        return abs(math.cos(theta_1) * math.cos(pitch))

    def clearances(self, positions: Sequence[float]) -> tuple[Clearance, ...]:
        """Return what is left to the equator, the edge of the workspace.

        On it a joint stands still, or the two moving joints align and the hand is loose.
        """
        return (soft_edge(EQUATOR, self.margin(positions)),)

    def target_pose(self, pose: Pose, twist: Sequence[float], dt: float) -> Pose:
        """Return the pose after p and q for a time: the same hand as the pitch-yaw pointer's.

        Raises:
            UnreachableError: The hand would cross the equator.
        """
        after = SERIAL.target_pose(pose, twist, dt)
        if _height(pose) * _height(after) <= 0.0:
            raise UnreachableError('The hand cannot cross the equator; turn it back.', EQUATOR)
        return after

    @staticmethod
    def _serial(positions: Sequence[float]) -> tuple[float, float]:
        """Return the pitch-yaw pointer's θ1 and θ2 for the same pose."""
        theta_1, theta_2 = positions
        s, c = math.cos(theta_1) * math.sin(theta_2), math.cos(theta_2)
        if math.hypot(s, c) < LOOSE:
            raise UnreachableError(
                'With both joints at 90 deg the hand is loose; turn one of them back.', EQUATOR
            )
        return (math.atan2(-s, c), theta_1)

    @staticmethod
    def _pitch_slopes(positions: Sequence[float]) -> tuple[float, float]:
        """Return ∂θ1/∂θ1 and ∂θ1/∂θ2 of the pitch-yaw pointer's θ1 by the five-bar's joints."""
        s1, c1 = math.sin(positions[0]), math.cos(positions[0])
        s2, c2 = math.sin(positions[1]), math.cos(positions[1])
        square = c2 * c2 + s2 * s2 * c1 * c1
        return (s1 * s2 * c2 / square, -c1 / square)


def _height(pose: Pose) -> float:
    """Return N_z, the hand's z axis along the forearm's."""
    return direction_cosines(pose.quaternion)[2][2]
