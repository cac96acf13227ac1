"""The parameters of simulated physics, and the driven mechanism that they describe."""

from __future__ import annotations

import math
from collections.abc import Mapping
from importlib.util import find_spec
from typing import TYPE_CHECKING, Any

from wrist_control.errors import InvalidValueError
from wrist_control.ros.parameters import FRAME, Spec
from wrist_control.wrists import WRISTS, Wrist
from wrist_control.wrists.joint import broadcast_to_joints
from wrist_control.wrists.plugins import plugged_in_mechanisms

if TYPE_CHECKING:
    from wrist_control.physics.driven import DrivenMechanism

# Standard gravity [CGPM1901], m/s².
GRAVITY = 9.80665
POSITIONS, RATES = 'joint_command', 'joint_velocity_command'
EACH = 'one for each joint, or one for all'
MODELLED = (*WRISTS, *plugged_in_mechanisms())
WRIST = Spec('wrist', 'three_gimbal', 'Which wrist is simulated', choices=MODELLED)
SPECS = [
    WRIST,
    Spec('rate', 100.0, 'Joint states per second, from the node clock', 'Hz', 1.0, 2000.0),
    Spec('command', POSITIONS, 'The topic that the servos follow', choices=(POSITIONS, RATES)),
    Spec(
        'velocity_timeout',
        0.25,
        'Age of a joint_velocity_command after which the servos hold',
        's',
        0.01,
        10.0,
    ),
    Spec(
        'initial_positions',
        [],
        f"Where the joints start, {EACH}; the wrist's home when empty",
        'rad or m',
    ),
    Spec(
        'servo_bandwidth',
        100.0,
        'How quickly a servo moves what it carries: the root of stiffness over inertia at home',
        'rad/s',
        1.0,
        1000.0,
    ),
    Spec(
        'servo_damping',
        1.0,
        'Damping ratio of a servo; 1 is soonest there without going past',
        '',
        0.1,
        10.0,
    ),
    Spec('effort_limits', [math.inf], f'Most that a servo does, {EACH}', 'N*m or N', 0.0),
    Spec('joint_friction', [0.0], f'Dry friction, {EACH}', 'N*m or N', 0.0, 1000.0),
    Spec('payload', 0.0, "What hangs at the end of the hand's probe", 'kg', 0.0, 1000.0),
    Spec(
        'gravity',
        [0.0, 0.0, -GRAVITY],
        'Which way and how much everything falls, x, y, z of the forearm',
        'm/s^2',
        -1000.0,
        1000.0,
    ),
    Spec('balanced', False, 'Links have counterweights: gravity pulls at the payload alone'),
    Spec('loop_delay', 0.0, 'How much later a command reaches the servos', 's', 0.0, 1.0),
    Spec('stuck_joint', '', 'Name of a joint that sticks where it is; none when empty', live=True),
    Spec('physics_step', 0.0005, 'Time step of the physics', 's', 1e-5, 0.005),
    Spec('forearm_frame', 'forearm', 'Name of the frame that the wrist stands on', FRAME),
    Spec('joint_prefix', '', 'Put before every joint name'),
]


def check_stuck(wrist: Wrist, name: str) -> None:
    """See that a joint that shall stick is one of a wrist's, or that none shall.

    Raises:
        InvalidValueError: It is not.
    """
    names = [joint.name for joint in wrist.joints]
    if name and name not in names:
        raise InvalidValueError(
            f'stuck_joint is {name!r}; valid is one of {", ".join(names)}, or empty for none.'
        )


def start_of(wrist: Wrist, values: Mapping[str, Any]) -> tuple[float, ...]:
    """Return where the joints start, rad or m.

    Raises:
        InvalidValueError: Not one for each joint, or outside the mechanism's own limits.
    """
    if not values['initial_positions']:
        return tuple(wrist.home)
    names = [joint.name for joint in wrist.joints]
    positions = broadcast_to_joints('initial_positions', values['initial_positions'], names)
    for joint, position in zip(wrist.joints, positions, strict=True):
        if not (math.isfinite(position) and joint.lower <= position <= joint.upper):
            raise InvalidValueError(
                f'initial_positions has {position:g} for {joint.name}; valid is '
                f'{joint.lower:g} to {joint.upper:g}, and finite.'
            )
    return tuple(positions)


def driven(wrist: Wrist, values: Mapping[str, Any]) -> DrivenMechanism:
    """Return a wrist's mechanism with the drives that the parameters describe, at its start.

    Raises:
        WristError: A parameter cannot be used, or the physics is not installed.
    """
    if find_spec('mujoco') is None:
        raise InvalidValueError(
            'mujoco, which the physics needs, is not installed; `make setup-physics` gets it.'
        )
    from wrist_control.physics.driven import DrivenMechanism, Drives
    from wrist_control.physics.mechanism import Settings
    from wrist_control.physics.models import build

    names = [joint.name for joint in wrist.joints]
    if len(values['gravity']) != 3:
        raise InvalidValueError(
            f'gravity has {len(values["gravity"])} values; give three: for x, y and z.'
        )
    x, y, z = values['gravity']
    settings = Settings(
        step=values['physics_step'],
        bandwidth=values['servo_bandwidth'],
        damping_ratio=values['servo_damping'],
        payload=values['payload'],
        gravity=(x, y, z),
        balanced=values['balanced'],
    )
    drives = Drives(
        period=1.0 / values['rate'],
        delay=values['loop_delay'],
        effort_limits=broadcast_to_joints('effort_limits', values['effort_limits'], names),
        friction=broadcast_to_joints('joint_friction', values['joint_friction'], names),
        by_rates=values['command'] == RATES,
    )
    start = start_of(wrist, values)
    made = DrivenMechanism(build(wrist, settings), wrist.joints, drives, start)
    check_stuck(wrist, values['stuck_joint'])
    made.stick(values['stuck_joint'])
    return made
