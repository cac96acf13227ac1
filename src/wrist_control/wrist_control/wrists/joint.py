"""What a wrist drives: joints, their limits, and values given one for all or one for each."""

from __future__ import annotations

import math
from collections.abc import Sequence
from typing import Literal, NamedTuple, TypeAlias

import numpy as np

from wrist_control.errors import InvalidValueError

Kind = Literal['revolute', 'prismatic']
# One limit for all joints, one for each, or None for those that they have.
Limits: TypeAlias = 'float | Sequence[float] | None'


class Joint(NamedTuple):
    """One driven joint: rad and rad/s, or m and m/s for a prismatic one.

    Attributes:
        name: The papers' symbol.
        kind: How it moves.
        lower: Lowest position.
        upper: Highest position.
        rate_limit: Fastest motion.
        acceleration_limit: How quickly it may become faster, rad/s² or m/s².
        deceleration_limit: How quickly it may become slower, rad/s² or m/s².
    """

    name: str
    kind: Kind = 'revolute'
    lower: float = -math.inf
    upper: float = math.inf
    rate_limit: float = math.inf
    acceleration_limit: float = math.inf
    deceleration_limit: float = math.inf

    def used(self, position: float, rate: float) -> float:
        """Return how much of its limits a joint uses, 0 to 1: of its speed, or of its range.

        A range that is open at an end has no middle, and does not count.

        Args:
            position: rad or m.
            rate: rad/s or m/s.
        """
        speed = abs(rate) / self.rate_limit
        middle, half = 0.5 * (self.lower + self.upper), 0.5 * (self.upper - self.lower)
        return max(speed, abs(position - middle) / half) if math.isfinite(half) else speed


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
    rates: Limits = None,
    lower: Limits = None,
    upper: Limits = None,
    accelerations: Limits = None,
    decelerations: Limits = None,
) -> tuple[Joint, ...]:
    """Return the same joints with other limits: `Wrist.with_limits`."""
    names = [joint.name for joint in joints]

    def column(name: str, given: Limits, otherwise: list[float]) -> list[float]:
        return otherwise if given is None else _limits(names, f'joint_{name}_limits', given)

    limits = zip(
        joints,
        column('rate', rates, [joint.rate_limit for joint in joints]),
        column('lower', lower, [joint.lower for joint in joints]),
        column('upper', upper, [joint.upper for joint in joints]),
        column('acceleration', accelerations, [joint.acceleration_limit for joint in joints]),
        column('deceleration', decelerations, [joint.deceleration_limit for joint in joints]),
        strict=True,
    )
    return tuple(
        _checked(
            joint._replace(
                rate_limit=rate,
                lower=low,
                upper=up,
                acceleration_limit=faster,
                deceleration_limit=slower,
            )
        )
        for joint, rate, low, up, faster, slower in limits
    )


def _limits(joints: Sequence[str], name: str, given: float | Sequence[float]) -> list[float]:
    values = broadcast_to_joints(
        name, [float(value) for value in np.atleast_1d(np.asarray(given, dtype=float))], joints
    )
    if any(math.isnan(value) for value in values):
        raise InvalidValueError(f'{name} is {values}; every value must be a number.')
    return values


def _checked(joint: Joint) -> Joint:
    for what in ('rate', 'acceleration', 'deceleration'):
        limit = getattr(joint, f'{what}_limit')
        if not limit > 0.0:
            raise InvalidValueError(
                f'joint_{what}_limits has {limit:g} for {joint.name}; it must be above 0, '
                'or .inf for no limit.'
            )
    if not joint.lower < joint.upper:
        raise InvalidValueError(
            f'The limits of {joint.name} cross: lower {joint.lower:g}, upper {joint.upper:g}; '
            'lower must be below upper.'
        )
    return joint
