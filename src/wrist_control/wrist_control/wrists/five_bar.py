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
from wrist_control.rotations import (
    Pose,
    Vector,
    about_x,
    about_y,
    cross,
    direction_cosines,
    nearest_turn,
    quaternion_of,
    to_forearm,
)
from wrist_control.wrists import body
from wrist_control.wrists.body import Arc, Body, Pin, Rod
from wrist_control.wrists.joint import Joint
from wrist_control.wrists.pitch_yaw import PitchYaw
from wrist_control.wrists.wrist import Clearance, Positions, Rates, Wrist, soft_edge

SERIAL = PitchYaw()
# Nearer than this to both joints at 90° the direction of N is round-off.
LOOSE = 1e-9
EQUATOR = 'equator'
# Radius of the sphere that its links are drawn on, m.
SPHERE = 0.07


@dataclass(frozen=True)
class FiveBar(Wrist):
    """Points the hand's z axis over a hemisphere with two joints, both on the forearm.

    p and q are followed; the hand's roll is what the mechanism forces. Locks on the equator.

    Choose it to point something light quickly: neither drive carries the other.
    """

    default_joints: ClassVar[tuple[Joint, ...]] = (Joint('theta_1'), Joint('theta_2'))
    followed_axes: ClassVar[tuple[int, ...]] = (0, 1)
    probe: ClassVar[Vector] = body.ALONG_Z

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

    def bodies(self, positions: Sequence[float]) -> tuple[Body, ...]:
        """Return a forearm with two drives, and four links of 90°; the hand is the third."""
        theta_1, theta_2 = positions
        pose = self.forward(positions)
        second = about_x(-theta_2)
        along, toward = to_forearm(pose.quaternion, body.Z), to_forearm(second, body.Y)
        coupled = Pose(quaternion_of((cross(toward, along), toward, along)))
        left, back = (0.0, -SPHERE, 0.0), (-SPHERE, 0.0, 0.0)
        first_drive, second_drive = Pin('theta_1', left, body.Y), Pin('theta_2', back, body.BACK)
        first_elbow = Pin('first_elbow', (SPHERE, 0.0, 0.0), body.X)
        second_elbow = Pin('second_elbow', (0.0, SPHERE, 0.0), body.Y)
        top = Pin('top', (0.0, 0.0, SPHERE), body.Z)
        drives = (
            _link(left, body.X),
            _link(back, body.RIGHT),
            Rod((0.0, -1.3 * SPHERE, 0.0), left, 0.01),
            Rod((-1.3 * SPHERE, 0.0, 0.0), back, 0.01),
            Rod((0.0, 0.0, -2.0 * SPHERE), (0.0, 0.0, -SPHERE), 0.006),
        )
        return (
            Body('forearm', body.AT_REST, drives, (first_drive, second_drive)),
            Body(
                'link_1',
                Pose(about_y(theta_1)),
                (_link(left, body.Z),),
                (first_drive, first_elbow),
            ),
            Body('link_2', Pose(second), (_link(back, body.DOWN),), (second_drive, second_elbow)),
            Body('link_4', coupled, (_link(second_elbow.point, body.X),), (second_elbow, top)),
            body.hand(
                pose,
                (first_elbow, top),
                _link(first_elbow.point, body.RIGHT),
                probe=self.probe,
                palm=SPHERE,
            ),
        )

    @staticmethod
    def _serial(positions: Sequence[float]) -> tuple[float, float]:
        """Return the pitch-yaw pointer's θ1 and θ2 for the same pose."""
        theta_1, theta_2 = positions
        s, c = math.cos(theta_1) * math.sin(theta_2), math.cos(theta_2)
        if math.hypot(s, c) < LOOSE:
            raise UnreachableError(
                'With both joints at 90 deg the hand is loose; turn one of them back.',
                EQUATOR,
            )
        return (math.atan2(-s, c), theta_1)

    @staticmethod
    def _pitch_slopes(positions: Sequence[float]) -> tuple[float, float]:
        """Return ∂θ1/∂θ1 and ∂θ1/∂θ2 of the pitch-yaw pointer's θ1 by the five-bar's joints."""
        s1, c1 = math.sin(positions[0]), math.cos(positions[0])
        s2, c2 = math.sin(positions[1]), math.cos(positions[1])
        square = c2 * c2 + s2 * s2 * c1 * c1
        return (s1 * s2 * c2 / square, -c1 / square)


def _link(begin: Vector, axis: Vector) -> Arc:
    """Return a link of 90°, from a point on about an axis."""
    return Arc((0.0, 0.0, 0.0), begin, axis, 0.5 * math.pi)


def _height(pose: Pose) -> float:
    """Return N_z, the hand's z axis along the forearm's."""
    return direction_cosines(pose.quaternion)[2][2]
