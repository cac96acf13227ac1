"""What was heard on the topics, as the same arrays that `fly` returns."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from typing import Any

import numpy as np

from wrist_control.flight import Flight, Row
from wrist_control.operating.maneuvers import Maneuver
from wrist_control.ros import convert
from wrist_control.wrists import Wrist


def recorded_flight(
    wrist: Wrist, maneuver: Maneuver, dt: float, heard: Mapping[str, Sequence[Any]]
) -> Flight:
    """Return a flight as it was heard, from the first command that was followed to the last.

    The hand is where the joints really are, as `joint_states` says: the command of one tick is
    where the joints are at the next.

    Args:
        wrist: The mechanism.
        maneuver: What was flown.
        dt: Time between ticks, s.
        heard: `wrist_status`, `joint_command` and `joint_states`, equally stamped at each tick.
    """
    statuses = _moving(heard['wrist_status'])
    commands = _stamped_like(statuses, heard['joint_command'])
    states = _stamped_like(statuses, heard['joint_states'])
    return Flight.from_rows(
        wrist,
        maneuver,
        dt,
        [_row(wrist, dt, *together) for together in zip(statuses, commands, states, strict=True)],
    )


def _row(wrist: Wrist, dt: float, status: Any, command: Any, state: Any) -> Row:
    """Return what was said at one tick; a status counts the time that its own step has lost."""
    positions = tuple(state.position)
    return Row(
        positions=positions,
        pose=wrist.forward(positions),
        command=convert.twist_values(status.commanded)[-3:],
        achieved=convert.twist_values(status.achieved),
        joint_rates=command.velocity,
        scale_factor=status.scale_factor,
        time_lost=status.time_lost - (1.0 - status.scale_factor) * dt,
        margin=status.margin,
        limited=tuple(limit.joint for limit in status.limits),
    )


def in_step(heard: Mapping[str, Sequence[Any]]) -> bool:
    """Return whether each node acted at every tick on what the others said at the tick before.

    On a machine that is very busy a message can arrive after the next tick.

    Args:
        heard: `cmd_vel`, `wrist_status`, `joint_command` and `joint_states` of the same ticks.
    """
    followed = [convert.twist_values(status.commanded) for status in heard['wrist_status']]
    asked = [convert.twist_values(command.twist) for command in heard['cmd_vel']]
    told = [list(command.position) for command in heard['joint_command']]
    seen = [list(state.position) for state in heard['joint_states']]
    n = len(asked)
    return followed[-n:][1:] == asked[:-1] and all(
        np.allclose(one, other, rtol=0.0, atol=1e-9)
        for one, other in zip(seen[-n:][1:], told[-n:][:-1], strict=True)
    )


def _moving(statuses: Sequence[Any]) -> Sequence[Any]:
    """Return the statuses from the first followed command to the first zero after the last."""
    rows = [
        row for row, status in enumerate(statuses) if any(convert.twist_values(status.commanded))
    ]
    return statuses[rows[0] : rows[-1] + 2]


def _stamped_like(statuses: Sequence[Any], messages: Sequence[Any]) -> list[Any]:
    by_stamp = {convert.seconds(message.header.stamp): message for message in messages}
    return [by_stamp[convert.seconds(status.header.stamp)] for status in statuses]
