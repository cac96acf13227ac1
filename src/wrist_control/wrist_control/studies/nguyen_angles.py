"""The paper's three angles and its modified Jacobian. [Nguyen1991], eqs. (17)-(38), corrected.

The paper calls the turn about z roll and the one about x yaw; ROS calls them the other way round.
So each angle here is named after its axis and the paper's letter. Nothing else in this package
uses angles: at β = ±90° α and γ turn about the same axis.
"""

from __future__ import annotations

import math
from typing import NamedTuple

import numpy as np

from wrist_control.rotations import Pose, Vector, quaternion_of


class PaperAngles(NamedTuple):
    """Turns about the base's axes, in the order x, y, z, rad."""

    angle_z_alpha: float
    angle_y_beta: float
    angle_x_gamma: float


def rotation_matrix(angles: PaperAngles) -> np.ndarray:
    """Return R = Z(α) Y(β) X(γ), whose columns are the platform's axes. Eq. (17)."""
    (sa, sb, sg), (ca, cb, cg) = np.sin(angles), np.cos(angles)
    return np.array(
        [
            [ca * cb, ca * sb * sg - sa * cg, ca * sb * cg + sa * sg],
            [sa * cb, sa * sb * sg + ca * cg, sa * sb * cg - ca * sg],
            [-sb, cb * sg, cb * cg],
        ]
    )


def pose_of(position: Vector, angles: PaperAngles) -> Pose:
    """Return a pose given by the paper's a = (x, y, z, α, β, γ)."""
    return Pose(quaternion_of(rotation_matrix(angles).T), position)


def angles_of(pose: Pose) -> PaperAngles:
    """Return the angles of a pose, β within ±90°."""
    r = pose.rotation.T
    return PaperAngles(
        math.atan2(r[1, 0], r[0, 0]),
        math.atan2(-r[2, 0], math.hypot(r[0, 0], r[1, 0])),
        math.atan2(r[2, 1], r[2, 2]),
    )


def partial_derivatives(
    platform: np.ndarray, base: np.ndarray, position: Vector, angles: PaperAngles
) -> np.ndarray:
    """Return ∂f_i / ∂(x, y, z, α, β, γ) of f = l² for planar anchors, shape (6, 6).

    Eqs. (24)-(29), with (27) and (28) corrected: docs/errata.md.

    Args:
        platform: Anchors in platform axes, m, shape (6, 3), all with z = 0.
        base: Anchors in base axes, m, shape (6, 3).
        position: The platform's x, y, z, m.
        angles: Its attitude.
    """
    r = rotation_matrix(angles)
    (sa, sb, sg), (ca, cb, _) = np.sin(angles), np.cos(angles)
    xb, yb, zb = (np.asarray(position) - base).T
    u, v, w = (platform @ r.T).T
    px, py = platform[:, 0], platform[:, 1]
    return 2.0 * np.stack(
        [
            xb + u,
            yb + v,
            zb + w,
            -xb * v + yb * u,
            (xb * ca + yb * sa) * w - (px * cb + py * sb * sg) * zb,
            py * (xb * r[0, 2] + yb * r[1, 2] + zb * r[2, 2]),
        ],
        axis=1,
    )


def modified_inverse_jacobian(
    platform: np.ndarray, base: np.ndarray, position: Vector, angles: PaperAngles
) -> np.ndarray:
    """Return ∂l_i / ∂(x, y, z, α, β, γ), the paper's inverse modified Jacobian. Eq. (38)."""
    arms = platform @ rotation_matrix(angles).T
    lengths = np.linalg.norm(np.asarray(position) + arms - base, axis=1)
    return partial_derivatives(platform, base, position, angles) / (2.0 * lengths[:, None])
