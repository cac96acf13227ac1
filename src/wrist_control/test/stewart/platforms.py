"""Platforms, poses and distances that the tests of this folder share."""

import math

import numpy as np
from hypothesis import strategies as st

from wrist_control import make_wrist
from wrist_control.rotations import Pose, turned
from wrist_control.stewart import stages

WRIST = make_wrist('stewart')
FK = WRIST.forward_kinematics
HOME = WRIST.home.pose
SIZE = WRIST.size
# A platform and a base that are not planar, and not regular either.
CROOKED = make_wrist(
    'stewart',
    platform_anchors=np.array(WRIST.platform) + 0.03 * np.sin(np.arange(18.0)).reshape(6, 3),
    base_anchors=np.array(WRIST.base) + 0.04 * np.cos(np.arange(18.0)).reshape(6, 3),
)
# Six different points on each plane: planar, and not rings.
SCATTERED = make_wrist(
    'stewart',
    platform_anchors=np.array(WRIST.platform)
    + 0.03 * np.sin(np.arange(18.0)).reshape(6, 3) * [1, 1, 0],
    base_anchors=np.array(WRIST.base) + 0.04 * np.cos(np.arange(18.0)).reshape(6, 3) * [1, 1, 0],
)


def poses(shift, turn):
    d, a = st.floats(-shift, shift), st.floats(-turn, turn)
    return st.builds(
        lambda x, y, z, p, q, r: Pose(
            turned(HOME.quaternion, (p, q, r), 1.0), (x, y, HOME.position[2] + z)
        ),
        d, d, d, a, a, a,
    )  # fmt: skip


def random_poses(n, shift, turn, seed=0):
    rng = np.random.default_rng(seed)
    return [
        Pose(
            turned(HOME.quaternion, tuple(rng.uniform(-turn, turn, 3).tolist()), 1.0),
            tuple((np.array(HOME.position) + rng.uniform(-shift, shift, 3)).tolist()),
        )
        for _ in range(n)
    ]


def lengths_of(pose, wrist=WRIST):
    return tuple(wrist.assembly_at(pose))


def said(lengths):
    return [f'leg_{leg} at {length:g} m' for leg, length in enumerate(lengths, start=1)]


def apart(one, other):
    """The distance in which proofs are stated: ‖(Δd, L Δu, L Δv)‖, m."""
    return SIZE * math.dist(stages.unknowns(one, SIZE), stages.unknowns(other, SIZE))


def exactly(lengths, pose, platform=WRIST.platform, base=WRIST.base):
    """Polish a pose to about 19 digits: Newton steps with residuals in extended precision.

    Returns position and rotation matrix (platform to base) as extended arrays.
    """
    p, b = (np.array(x, dtype=np.longdouble) for x in (platform, base))
    wanted = np.array(lengths, dtype=np.longdouble)
    a1, a2, a3, a4 = (np.longdouble(x) for x in pose.quaternion)
    q, d = np.array([a1, a4, a3, a2]), np.array(pose.position, dtype=np.longdouble)
    for _ in range(4):
        q = q / np.sqrt((q * q).sum())
        w, x, y, z = q
        rotation = np.array(
            [
                [1 - 2 * (y * y + z * z), 2 * (x * y - w * z), 2 * (x * z + w * y)],
                [2 * (x * y + w * z), 1 - 2 * (x * x + z * z), 2 * (y * z - w * x)],
                [2 * (x * z - w * y), 2 * (y * z + w * x), 1 - 2 * (x * x + y * y)],
            ]
        )
        arms = p @ rotation.T
        legs = d + arms - b
        found = np.sqrt((legs * legs).sum(axis=1))
        n = legs / found[:, None]
        lines = np.hstack([n, np.cross(arms, n)]).astype(float)
        change = np.linalg.solve(lines, (wanted - found).astype(float)).astype(np.longdouble)
        d = d + change[:3]
        half = change[3:] / 2
        dw = np.concatenate([[np.longdouble(1)], half])
        q = np.array(
            [
                dw[0] * w - half @ q[1:],
                *(dw[0] * q[1:] + w * half + np.cross(half, q[1:])),
            ]
        )
    return d, rotation
