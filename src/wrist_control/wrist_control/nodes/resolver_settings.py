"""The parameters of a resolver, and the wrist and settings that they describe."""

from __future__ import annotations

import math
from collections.abc import Mapping
from typing import Any

from rclpy.parameter import Parameter

from wrist_control.errors import InvalidValueError
from wrist_control.resolving.period import SupervisorSettings
from wrist_control.ros.parameters import FRAME, NAMES, Spec
from wrist_control.wrists import Wrist, wrist_class, wrist_names
from wrist_control.wrists.joint import broadcast_to_joints

# What a joint may do when nobody says: 32 deg/s, [Barker1986]; 50 mm/s for a leg.
CAREFUL = {'revolute': math.radians(32.0), 'prismatic': 0.05}
# How long a joint takes to full speed, and from there to a stop, when nobody says, s.
SPEEDING_UP, SLOWING_DOWN = 0.25, 0.1
# No stop may take longer than this, s, from its rate limit or from what is fast at most.
LONGEST_STOP, FAST = 10.0, {'revolute': 10.0, 'prismatic': 1.0}
# How far a joint may be behind its command, rad and m.
BEHIND = {'revolute': 0.1, 'prismatic': 0.005}


def wrist_spec(wrist_name: str = '') -> Spec:
    """Return the parameter that says which wrist: of all that there are here, or this one."""
    names = (wrist_name,) if wrist_name else wrist_names()
    return Spec('wrist', names[0], 'Which wrist', choices=names)


def mechanism_specs(wrist_name: str) -> list[Spec]:
    """Return the parameters that describe the geometry of one wrist."""
    kind = wrist_class(wrist_name)
    texts = [
        Spec(text.parameter, [] if text.names else '', text.description, NAMES * text.names)
        for text in kind.texts().values()
    ]
    dimensions = [Spec(name, *facts) for name, facts in kind.dimensions().items()]
    points = [
        Spec(name, [], f'{points.description}; not given when empty', 'm')
        for name, points in kind.point_lists().items()
    ]
    return texts + dimensions + points


def example(wrist_name: str) -> list[Parameter]:
    """Return parameters with which the resolver of any wrist can be made, to be looked at."""
    texts = wrist_class(wrist_name).texts().values()
    return [Parameter(text.parameter, value=text.example) for text in texts if text.example]


def mechanism(wrist_name: str, values: Mapping[str, Any]) -> Wrist:
    """Return the wrist that the parameters describe, with the limits of its own.

    Raises:
        InvalidValueError: There is no such mechanism.
    """
    kind = wrist_class(wrist_name)
    given = {name: values[name] for name in kind.dimensions()}
    points = {name: values[name] for name in kind.point_lists() if values[name]}
    texts = {name: values[text.parameter] for name, text in kind.texts().items()}
    return kind(**given, **points, **texts)


def specs(wrist: Wrist) -> list[Spec]:
    """Return the parameters of one wrist's resolver, but for those that describe it."""
    joints = wrist.joints
    unit = 'm' if joints[0].kind == 'prismatic' else 'rad'
    fastest = [
        joint.rate_limit if math.isfinite(joint.rate_limit) else CAREFUL[joint.kind]
        for joint in joints
    ]
    order = ', '.join(joint.name for joint in joints)
    each = f'one for each of {order}, or one for all'
    return [
        Spec('rate', 100.0, 'Steps per second, from the node clock', 'Hz', 1.0, 2000.0),
        Spec(
            'command_timeout',
            0.25,
            'Age of a command after which the hand is ramped to a stop',
            's',
            0.01,
            10.0,
            live=True,
        ),
        Spec('stop_time', 0.1, 'How long the ramp to a stop takes', 's', 0.001, 10.0, live=True),
        Spec(
            'joint_rate_limits',
            fastest,
            f'Fastest joint motion, {each}; .inf for no limit',
            f'{unit}/s',
            0.0,
            live=True,
        ),
        Spec(
            'joint_acceleration_limits',
            [],
            f'How quickly joints may become faster, {each}; .inf for no limit; to full speed in '
            f'{SPEEDING_UP:g} s when empty',
            f'{unit}/s^2',
            0.0,
            live=True,
        ),
        Spec(
            'joint_deceleration_limits',
            [],
            f'How quickly joints may become slower, {each}; .inf for no limit; to a stop in '
            f'{SLOWING_DOWN:g} s when empty',
            f'{unit}/s^2',
            0.0,
            live=True,
        ),
        Spec(
            'joint_lower_limits',
            [joint.lower for joint in joints],
            f'Lowest joint position, {each}',
            unit,
            live=True,
        ),
        Spec(
            'joint_upper_limits',
            [joint.upper for joint in joints],
            f'Highest joint position, {each}',
            unit,
            live=True,
        ),
        Spec(
            'initial_positions',
            [],
            f"Where the joints start, one for each of {order}; the wrist's home when empty",
            unit,
        ),
        Spec(
            'require_joint_states',
            True,
            'Nothing is commanded before the joints were heard on joint_states',
        ),
        Spec(
            'feedback_timeout',
            0.25,
            'Age of the joint states after which a moving hand is ramped to a stop: FAULT',
            's',
            0.01,
            10.0,
            live=True,
        ),
        Spec(
            'tracking_tolerance',
            [BEHIND[joint.kind] for joint in joints],
            f'How far a joint may be behind its command, {each}',
            unit,
            0.0,
            live=True,
        ),
        Spec('tracking_time', 0.25, 'How long it may be, then FAULT', 's', 0.0, 10.0, live=True),
        Spec('forearm_frame', 'forearm', 'Name of the frame that the wrist stands on', FRAME),
        Spec('hand_frame', 'hand', 'Name of the frame that turns', FRAME),
        Spec(
            'require_deadman',
            False,
            'Move only while the topic deadman says true, at least once in each command_timeout',
        ),
        Spec('joint_prefix', '', 'Put before every joint name'),
    ]


def completed(values: Mapping[str, Any]) -> dict[str, Any]:
    """Return parameters with the limits that follow from others where none were given."""
    rates = values['joint_rate_limits']
    return {
        **values,
        'joint_acceleration_limits': values['joint_acceleration_limits']
        or [rate / SPEEDING_UP for rate in rates],
        'joint_deceleration_limits': values['joint_deceleration_limits']
        or [rate / SLOWING_DOWN for rate in rates],
    }


def limited(wrist: Wrist, values: Mapping[str, Any]) -> Wrist:
    """Return a wrist with the joint limits of the parameters.

    Raises:
        InvalidValueError: The limits cannot be used.
    """
    wrist = wrist.with_limits(
        rates=values['joint_rate_limits'],
        lower=values['joint_lower_limits'],
        upper=values['joint_upper_limits'],
        accelerations=values['joint_acceleration_limits'],
        decelerations=values['joint_deceleration_limits'],
    )
    for joint in wrist.joints:
        if joint.deceleration_limit < min(joint.rate_limit, FAST[joint.kind]) / LONGEST_STOP:
            raise InvalidValueError(
                f'joint_deceleration_limits has {joint.deceleration_limit:g} for {joint.name}, '
                f'which may move at {joint.rate_limit:g}: valid is what stops it within '
                f'{LONGEST_STOP:g} s.'
            )
    return wrist


def check_own(wrist: Wrist, values: Mapping[str, Any]) -> None:
    """Let a limit only narrow what the mechanism can do by itself.

    Args:
        wrist: With the limits of its own.
        values: The parameters that the node is started with.

    Raises:
        InvalidValueError: A limit would be wider.
    """
    own = {
        'joint_rate_limits': [joint.rate_limit for joint in wrist.joints],
        'joint_lower_limits': [joint.lower for joint in wrist.joints],
        'joint_upper_limits': [joint.upper for joint in wrist.joints],
    }
    given = {name: values[name] for name in own}
    _check_none_wider(wrist, own, given, 'valid is {}, as the mechanism itself has it')


def check_ceilings(wrist: Wrist, started: Mapping[str, Any], changed: Mapping[str, Any]) -> None:
    """Let a live limit only narrow what the node was started with: that is the ceiling.

    Every parameter whose name ends in _limits is one: a lower limit may rise, others may fall.

    Args:
        wrist: For its joints.
        started: The values that the node was started with.
        changed: The new values, by name.

    Raises:
        InvalidValueError: A limit would be wider than at the start.
    """
    limits = {name: value for name, value in changed.items() if name.endswith('_limits')}
    valid = 'while the node runs valid is {}, as it was started: start it again with another limit'
    _check_none_wider(wrist, started, limits, valid)


def _check_none_wider(
    wrist: Wrist, ceilings: Mapping[str, Any], limits: Mapping[str, Any], valid: str
) -> None:
    joints = [joint.name for joint in wrist.joints]
    for name, values in limits.items():
        is_lower = name.endswith('_lower_limits')
        most = broadcast_to_joints(name, ceilings[name], joints)
        wanted = broadcast_to_joints(name, values, joints)
        for joint, ceiling, value in zip(joints, most, wanted, strict=True):
            if value < ceiling if is_lower else value > ceiling:
                bound = f'{"at least" if is_lower else "at most"} {ceiling:g}'
                raise InvalidValueError(f'{name} is {value:g} for {joint}; {valid.format(bound)}.')


def settings(wrist: Wrist, values: Mapping[str, Any]) -> SupervisorSettings:
    """Return what the supervisor is told of the parameters."""
    return SupervisorSettings(
        dt=1.0 / values['rate'],
        command_timeout=values['command_timeout'],
        stop_time=values['stop_time'],
        initial_positions=tuple(values['initial_positions']) or wrist.home,
        tracking_tolerance=tuple(
            broadcast_to_joints(
                'tracking_tolerance',
                values['tracking_tolerance'],
                [joint.name for joint in wrist.joints],
            )
        ),
        tracking_time=values['tracking_time'],
        require_joint_states=values['require_joint_states'],
        feedback_timeout=values['feedback_timeout'],
    )
