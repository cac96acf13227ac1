"""A subscription that hears with each message what the middleware knows of its sender.

The events executor of this release ends with a SystemError at the first message of a subscription
whose callback asks for that. It serves waitables well, so the subscription is wrapped in one.
"""

from __future__ import annotations

from collections.abc import Callable
from typing import Any

from rclpy.qos import QoSProfile
from rclpy.subscription import Subscription
from rclpy.waitable import NumberOfEntities, Waitable

from wrist_control.ros.guarded import GuardedNode

Heard = Callable[[Any, dict[str, Any], int], None]


class Informed(Waitable):
    """Hears one topic; the node must hide `subscription` from its executor.

    Attributes:
        subscription: What hears.
    """

    def __init__(
        self,
        node: GuardedNode,
        kind: Any,
        topic: str,
        heard: Heard,
        qos: QoSProfile,
        raw: bool = False,
    ) -> None:
        """Start listening.

        Args:
            node: The node that hears.
            kind: Type of the messages.
            topic: Name of the topic.
            heard: Called with each message, what the middleware knows of it, and how many
                publishers are alive on the topic.
            qos: Quality of service.
            raw: Whether messages are handed on as bytes, of whatever size.
        """
        super().__init__(node.default_callback_group)
        self.subscription: Subscription = node.create_subscription(kind, topic, _never, qos)
        self._heard = (
            node.guarded(heard, f'topic {topic}') if raw else node.unpacking(kind, topic, heard)
        )
        self._index = 0
        node.add_waitable(self)

    def is_ready(self, wait_set: Any) -> bool:
        """Return whether a message waits."""
        return bool(wait_set.is_ready('subscription', self._index))

    def take_data(self) -> Any:
        """Return a message with what is known of it; None when another took it."""
        with self.subscription.handle:
            return self.subscription.handle.take_message(self.subscription.msg_type, True)

    async def execute(self, taken_data: Any) -> None:
        """Hand a message on."""
        if taken_data is not None:
            message, info = taken_data
            self._heard(message, info, self.subscription.get_publisher_count())

    def get_num_entities(self) -> NumberOfEntities:
        """Return what is waited for: one subscription."""
        return NumberOfEntities(1, 0, 0, 0, 0)

    def add_to_wait_set(self, wait_set: Any) -> None:
        """Wait for the subscription."""
        self._index = wait_set.add_subscription(self.subscription.handle)


def _never(_: Any) -> None:
    """Stand in for a callback: the executor does not see the subscription."""
