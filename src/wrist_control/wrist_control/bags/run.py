"""One wrist's run, found in a recording."""

from __future__ import annotations

from collections.abc import Callable
from pathlib import Path
from typing import Any

import numpy as np

from wrist_control.bags.reading import Recording, Stamped
from wrist_control.errors import InvalidValueError

STATUS = 'wrist_interfaces/msg/WristStatus'
# The topics of a run, and the types that they must have.
TOPICS = {
    'wrist_status': STATUS,
    'step_inputs': 'wrist_interfaces/msg/StepInputs',
    'joint_command': 'sensor_msgs/msg/JointState',
    'joint_states': 'sensor_msgs/msg/JointState',
    'hand_pose': 'geometry_msgs/msg/PoseStamped',
    'cmd_vel': 'geometry_msgs/msg/TwistStamped',
    'cmd_vel_unstamped': 'geometry_msgs/msg/Twist',
}


class Run:
    """What was said in one wrist's graph.

    Attributes:
        path: Where it is recorded.
        space: The namespace that its topics are in, with a slash at the end.
        cut: What is wrong with the recording's end; empty where nothing is.
    """

    def __init__(
        self,
        path: Path,
        space: str = '',
        tell: Callable[[float], None] = lambda share: None,
    ) -> None:
        """Read a recording.

        Args:
            path: The folder of a recording, or its file.
            space: The namespace; that of the only resolver where it is empty.
            tell: Called now and then with the share that is read, 0 to 1.

        Raises:
            InvalidValueError: There is no run of a wrist in it, or there are several.
        """
        self._recording = Recording(path, _is_ours, tell)
        self.path, self.cut = path, self._recording.cut
        self.space = self._only_space(space)

    def messages(self, topic: str) -> list[Stamped]:
        """Return the messages of a topic of TOPICS, in the order they came."""
        name = self.space + topic
        if self._recording.types.get(name) != TOPICS[topic]:
            return []
        return self._recording.messages(name)

    def _only_space(self, wanted: str) -> str:
        found = [
            topic.removesuffix('wrist_status')
            for topic, kind in self._recording.types.items()
            if kind == STATUS and topic.endswith('/wrist_status')
        ]
        if not found:
            raise InvalidValueError(
                f'{self.path} is a recording of something else: no resolver says its wrist_status '
                f'in it; its topics are {", ".join(sorted(self._recording.types)[:12])}.'
            )
        asked = f'/{wanted.strip("/")}/'.replace('//', '/')
        if wanted and asked in found:
            return asked
        if wanted or len(found) > 1:
            raise InvalidValueError(
                f'{self.path} has the wrists of {", ".join(sorted(found))}; choose one of them '
                'with --namespace.'
            )
        return found[0]


def _is_ours(topic: str, kind: str) -> bool:
    return TOPICS.get(topic.rpartition('/')[2]) == kind


def stamp_of(message: Any) -> int:
    """Return when a message is stamped, ns."""
    stamp = message.header.stamp
    return int(stamp.sec) * 10**9 + int(stamp.nanosec)


def numbers(values: Any) -> tuple[float, ...]:
    """Return an array of a message as plain floats."""
    return tuple(np.asarray(values, dtype=float).tolist())


def twist_of(twist: Any) -> tuple[float, ...]:
    """Return (vx, vy, vz, p, q, r) of a twist of a message."""
    linear, angular = twist.linear, twist.angular
    return tuple(float(x) for x in (linear.x, linear.y, linear.z, angular.x, angular.y, angular.z))
