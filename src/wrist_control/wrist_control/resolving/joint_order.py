"""Named joint values in the order of a wrist's joints, whatever else is among them."""

from __future__ import annotations

import math
from collections.abc import Sequence

from wrist_control.errors import RefusedError

# A whole robot has fewer joints than this; to look through more takes too long.
MOST_JOINTS = 1000


def in_joint_order(
    joints: Sequence[str], names: Sequence[str], values: Sequence[float]
) -> tuple[float, ...]:
    """Return the values of some joints in their own order.

    Joints that are not asked for are left alone: one topic may carry the whole robot.

    Args:
        joints: Names of the joints that are asked for, in order.
        names: Names as they came, in any order.
        values: One for each name; no need to be finite.

    Raises:
        RefusedError: Too many names, not one value for each, or a joint that is missing or named
            twice.
    """
    if max(len(names), len(values)) > MOST_JOINTS:
        raise RefusedError(
            'too many joints',
            f'There are {len(names)} joint names and {len(values)} values; at most {MOST_JOINTS} '
            'are looked at.',
        )
    if len(names) != len(values):
        raise RefusedError(
            'wrong length',
            f'There are {len(names)} joint names and {len(values)} values; send one value for '
            'each name.',
        )
    index_of = {name: index for index, name in enumerate(names)}
    for joint in joints:
        if (times := names.count(joint)) != 1:
            raise RefusedError(
                'wrong joint names',
                f'{joint} is named {times} times; name each of {", ".join(joints)} once.',
            )
    return tuple(float(values[index_of[joint]]) for joint in joints)


def finite_in_joint_order(
    joints: Sequence[str], names: Sequence[str], values: Sequence[float]
) -> tuple[float, ...]:
    """Return what some joints are told, in their own order: `in_joint_order`, and finite.

    Raises:
        RefusedError: As there; or no joint at all, or a value that is not finite.
    """
    told = in_joint_order(joints, names, values)
    if not told or not all(math.isfinite(value) for value in told):
        raise RefusedError('not finite', f'Refused a command that is not finite: {list(told)}.')
    return told
