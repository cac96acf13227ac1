"""What a wrist drives: joints, their limits, and values given one for all or one for each."""

from __future__ import annotations

import math
from collections.abc import Sequence
from typing import Literal, NamedTuple

import numpy as np

from wrist_control.errors import InvalidValueError

Kind = Literal['revolute', 'prismatic']


class Joint(NamedTuple):
    """One driven joint: rad and rad/s, or m and m/s for a prismatic one."""

    name: str
    kind: Kind = 'revolute'
    lower: float = -math.inf
    upper: float = math.inf
    rate_limit: float = math.inf


def broadcast_to_joints(name: str, values: Sequence[float], joints: Sequence[str]) -> list[float]:
    """Return one value for each joint, where one for each or one for all is given.

    Args:
        name: What the values are called in an error.
        values: One number, or as many as there are joints.
        joints: Names of the joints.

    Raises:
        InvalidValueError: Another number of values.
    """
    if len(values) == 1:
        return [*values] * len(joints)
    if len(values) != len(joints):
        raise InvalidValueError(
            f'{name} has {len(values)} values; give 1 for all joints or one for each of '
            f'{", ".join(joints)}.'
        )
    return [*values]


def with_limits(
    joints: Sequence[Joint],
    rates: float | Sequence[float] | None,
    lower: float | Sequence[float] | None,
    upper: float | Sequence[float] | None,
) -> tuple[Joint, ...]:
    """Return the same joints with other limits: `Wrist.with_limits`."""
    limits = zip(
        joints,
        _limits(joints, 'joint_rate_limits', rates, [joint.rate_limit for joint in joints]),
        _limits(joints, 'joint_lower_limits', lower, [joint.lower for joint in joints]),
        _limits(joints, 'joint_upper_limits', upper, [joint.upper for joint in joints]),
        strict=True,
    )
    return tuple(
        _checked(joint._replace(rate_limit=rate, lower=low, upper=up))
        for joint, rate, low, up in limits
    )


def _limits(
    joints: Sequence[Joint],
    name: str,
    given: float | Sequence[float] | None,
    otherwise: list[float],
) -> list[float]:
    if given is None:
        return otherwise
    values = broadcast_to_joints(
        name,
        [float(value) for value in np.atleast_1d(np.asarray(given, dtype=float))],
        [joint.name for joint in joints],
    )
    if any(math.isnan(value) for value in values):
        raise InvalidValueError(f'{name} is {values}; every value must be a number.')
    return values


def _checked(joint: Joint) -> Joint:
    if not joint.rate_limit > 0.0:
        raise InvalidValueError(
            f'joint_rate_limits has {joint.rate_limit:g} for {joint.name}; it must be above 0, '
            'or .inf for no limit.'
        )
    if not joint.lower < joint.upper:
        raise InvalidValueError(
            f'The limits of {joint.name} cross: lower {joint.lower:g}, upper {joint.upper:g}; '
            'lower must be below upper.'
        )
    return joint
