"""A pan-tilt head, as cameras have it: pan about z, then tilt about y; it points along x.

It is the pitch-yaw pointer with its axes renamed: x for y, y for z, z for x.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass
from typing import ClassVar

import numpy as np

from wrist_control.rotations import Pose, about_z
from wrist_control.wrists import Joint, Wrist, body
from wrist_control.wrists.body import Body, Pin
from wrist_control.wrists.pitch_yaw import PitchYaw
from wrist_control.wrists.wrist import Positions, Rates

POINTER = PitchYaw()
# Rows of the pointer's jacobian in our order: its z, x and y are our x, y and z.
ROWS = [2, 0, 1]


def ours(pose: Pose) -> Pose:
    """Return a pose of the pointer with the axes named as here; quaternions are (w, z, y, x)."""
    w, z, y, x = pose.quaternion
    return Pose((w, y, x, z))


def pointers(pose: Pose) -> Pose:
    """Return a pose with the axes named as the pointer's are."""
    w, z, y, x = pose.quaternion
    return Pose((w, x, z, y))


@dataclass(frozen=True)
class PanTilt(Wrist):
    """Pans about the forearm's z, then tilts about y; locks where it points along z.

    Choose it for a camera that looks around the horizon.
    """

    default_joints: ClassVar[tuple[Joint, ...]] = (Joint('pan'), Joint('tilt'))
    followed_axes: ClassVar[tuple[int, ...]] = (1, 2)

    def forward(self, positions: Sequence[float]) -> Pose:
        """Return the head's pose: C = Y(tilt) Z(pan)."""
        pan, tilt = positions
        return ours(POINTER.forward((tilt, pan)))

    def inverse(self, pose: Pose, near: Sequence[float]) -> Positions:
        """Return pan and tilt of a pose, the turns nearest to `near`."""
        tilt, pan = POINTER.inverse(pointers(pose), (near[1], near[0]))
        return (pan, tilt)

    def jacobian(self, positions: Sequence[float]) -> np.ndarray:
        """Return (p, q, r) per rate of pan and tilt, shape (3, 2)."""
        pan, tilt = positions
        found: np.ndarray = POINTER.jacobian((tilt, pan))[ROWS][:, ::-1]
        return found

    def rates(self, positions: Sequence[float], twist: Sequence[float]) -> Rates:
        """Return the rates of pan and tilt that make q and r; p is not free."""
        (pan, tilt), (p, q, r) = positions, twist
        tilt_rate, pan_rate = POINTER.rates((tilt, pan), (q, r, p))
        return (pan_rate, tilt_rate)

    def margin(self, positions: Sequence[float]) -> float:
        """Return |cos tilt|."""
        pan, tilt = positions
        return POINTER.margin((tilt, pan))

    def target_pose(self, pose: Pose, twist: Sequence[float], dt: float) -> Pose:
        """Return the pose after q and r for a time, with the roll that follows."""
        p, q, r = twist
        return ours(POINTER.target_pose(pointers(pose), (q, r, p), dt))

    def bodies(self, positions: Sequence[float]) -> tuple[Body, ...]:
        """Return a foot, a fork that pans, and the head that tilts in it."""
        pan, _ = positions
        first = Pin('pan', (0.0, 0.0, -0.07), body.Z)
        second = Pin('tilt', (0.0, 0.07, 0.0), body.Y)
        foot = body.Rod((0.0, 0.0, -0.12), first.point, 0.02)
        fork = body.yoke(second.point, body.DOWN)
        axle = body.Rod((0.0, -0.07, 0.0), second.point)
        return (
            Body('forearm', body.AT_REST, (foot,), (first,)),
            Body('fork', Pose(about_z(pan)), (fork,), (first, second)),
            body.hand(self.forward(positions), (second,), axle),
        )
