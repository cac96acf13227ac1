"""Each wrist as a mechanism of MuJoCo's: links, hinges, loops and servos, without our kinematics.

Needs the extra `physics`; nothing but the judge and the nodes that offer it import this room.
"""

from importlib.util import find_spec

if find_spec('mujoco') is None:
    raise ImportError(
        "wrist_control.physics needs MuJoCo: pip install 'wrist_control[physics]', or in its "
        'repository make judge.'
    )
