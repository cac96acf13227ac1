"""Poses of platforms near home, as hypothesis draws them."""

import hypothesis.strategies as st

from wrist_control.rotations import Pose, turned


def poses_near(home, reach, angle=0.4):
    """Return a strategy of poses, moved from home by up to `reach`, m, and turned by `angle`, rad.

    Each is along or about one axis: all three together are further.
    """
    small, turns = st.floats(-reach, reach), st.floats(-angle, angle)
    return st.builds(
        lambda x, y, z, p, q, r: Pose(
            turned(home.quaternion, (p, q, r), 1.0), (x, y, home.position[2] + z)
        ),
        small, small, small, turns, turns, turns,
    )  # fmt: skip
