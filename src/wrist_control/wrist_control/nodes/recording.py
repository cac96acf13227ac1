"""What was heard on the topics, as the same arrays that `fly` returns."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from typing import Any

import numpy as np

from wrist_control.flight import PROBE, Flight
from wrist_control.maneuvers import Maneuver
from wrist_control.nodes import convert
from wrist_control.rotations import to_forearm
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
        heard: `wrist_status`, `joint_command` and `joint_states` of the same ticks.
    """
    commands = [convert.twist_values(status.commanded) for status in heard['wrist_status']]
    moving = [row for row, command in enumerate(commands) if any(command)]
    rows = range(moving[0], moving[-1] + 2)
    statuses = [heard['wrist_status'][row] for row in rows]
    positions = np.array([heard['joint_states'][row].position for row in rows])
    poses = [wrist.forward(tuple(row)) for row in positions.tolist()]
    where = np.array([pose.position for pose in poses])
    return Flight(
        wrist=wrist,
        maneuver=maneuver,
        time=dt * np.arange(len(rows)),
        command=np.array([commands[row][-wrist.twist_size :] for row in rows]),
        achieved=np.array([convert.twist_values(status.achieved) for status in statuses]),
        joint_positions=positions,
        joint_rates=np.array([heard['joint_command'][row].velocity for row in rows]),
        hand_rotation=np.array([pose.rotation for pose in poses]),
        hand_position=where,
        tip=where + np.array([to_forearm(pose.quaternion, PROBE) for pose in poses]),
        scale_factor=np.array([status.scale_factor for status in statuses]),
        time_lost=np.array([heard['wrist_status'][row - 1].time_lost for row in rows]),
        margin=np.array([status.margin for status in statuses]),
        limited=tuple(tuple(limit.joint for limit in status.limits) for status in statuses),
        completed=True,
    )
