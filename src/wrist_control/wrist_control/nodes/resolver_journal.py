"""What a resolver's steps were made from, said while somebody listens: a replay needs no more."""

from __future__ import annotations

import json
import math
from collections.abc import Mapping
from typing import Any

from builtin_interfaces.msg import Time
from rclpy.node import Node
from std_msgs.msg import Header

from wrist_control.resolving.witness import Before, Heard, Kind, WitnessedSupervisor
from wrist_control.ros.parameters import plain
from wrist_control.ros.qos import OUTPUT
from wrist_control.wrists.wrist import Configuration
from wrist_interfaces.msg import HeardInput, StepInputs

# How often all parameters are said again, s: whoever begins to listen waits no longer for them.
AGAIN = 1.0


class Journal:
    """The publisher of `step_inputs`."""

    def __init__(
        self,
        node: Node,
        values: Mapping[str, Any],
        supervisor: WitnessedSupervisor,
    ) -> None:
        """Make the publisher.

        Args:
            node: The resolver.
            values: Its parameters, as they are at any time; which wrist it has is among them.
            supervisor: Whose steps are told.
        """
        self._values, self._supervisor = values, supervisor
        self._steps_between = max(1, round(AGAIN * values['rate']))
        self._steps_left = 0
        self._publisher = node.create_publisher(StepInputs, 'step_inputs', OUTPUT)

    def note_parameters(self) -> None:
        """Note that parameters have changed."""
        self._supervisor.note_parameters(self._parameters())

    def publish(self, stamp: Time, receipt_time: float, withheld: str, pause: float) -> None:
        """Say what the step that was just made was made from, if somebody listens.

        Args:
            stamp: The step's.
            receipt_time: Its time, s.
            withheld: Why the hand might not move; empty when it might.
            pause: How long before it the step before was made, s.
        """
        if self._publisher.get_subscription_count():
            message = _of_before(self._supervisor.before)
            message.header = Header(stamp=stamp, frame_id=self._values['hand_frame'])
            message.number = self._supervisor.number
            message.heard = [_of_heard(heard) for heard in self._all_heard()]
            message.receipt_time, message.pause = receipt_time, pause
            message.withheld = withheld
            self._publisher.publish(message)
        else:
            self._steps_left = 0
        self._supervisor.turn_over()

    def _all_heard(self) -> list[Heard]:
        heard = self._supervisor.heard
        self._steps_left -= 1
        if self._steps_left < 0 and not any(one.kind is Kind.PARAMETERS for one in heard):
            self._steps_left = self._steps_between
            return [Heard(Kind.PARAMETERS, text=self._parameters()), *heard]
        return heard

    def _parameters(self) -> str:
        return json.dumps({name: plain(value) for name, value in self._values.items()})


def _of_heard(heard: Heard) -> HeardInput:
    return HeardInput(
        kind=int(heard.kind),
        receipt_time=heard.receipt_time,
        stamp=_or_nan(heard.stamp),
        values=list(heard.values),
        names=list(heard.names),
        flag=heard.flag,
        text=heard.text,
        then=heard.then,
    )


def _of_before(before: Before) -> StepInputs:
    state, joints = before.state, before.joints
    return StepInputs(
        mode=before.mode.name,
        resting=before.resting,
        adopted=before.adopted,
        positions=[float(x) for x in state.positions],
        assembled=isinstance(state.positions, Configuration),
        joint_rates=[float(x) for x in state.joint_rates],
        pose=[float(x) for x in (*state.pose.position, *state.pose.quaternion)],
        steering=[float(x) for x in state.steering_state],
        time_lost=float(state.time_lost),
        withheld_since=_or_nan(before.withheld_since),
        joints=list(joints.positions),
        joints_first=list(joints.first),
        joints_count=joints.messages,
        joints_receipt=joints.receipt,
    )


def _or_nan(value: float | None) -> float:
    return math.nan if value is None else value
