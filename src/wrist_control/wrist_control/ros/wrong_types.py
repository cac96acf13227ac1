"""Notices publishers of the wrong type, which DDS would leave unheard without a word.

Fast DDS does not raise rclpy's incompatible-type event, so the graph itself is asked.
"""

from __future__ import annotations

from collections.abc import Mapping

from wrist_control.ros.guarded import GuardedNode
from wrist_control.ros.shown import shown


class WrongTypes:
    """Looks once a second who publishes what a node listens to.

    Attributes:
        found: One sentence for each wrong publisher, by its name and topic.
    """

    def __init__(self, node: GuardedNode, topics: Mapping[str, str]) -> None:
        """Watch some topics.

        Args:
            node: The node that listens.
            topics: The right type by topic name, such as 'geometry_msgs/msg/Twist'.
        """
        self.found: dict[tuple[str, str], str] = {}
        self._node = node
        self._topics = {node.resolve_topic_name(topic): kind for topic, kind in topics.items()}
        node.create_timer(1.0, self._look, clock=node.steady)

    def _look(self) -> None:
        for topic, kind in self._topics.items():
            try:
                publishers = self._node.get_publishers_info_by_topic(topic)
            except UnicodeDecodeError:
                self._name(topic, kind, 'somebody', 'a type whose name is not text')
                continue
            for publisher in publishers:
                if publisher.topic_type != kind:
                    self._name(topic, kind, publisher.node_name, publisher.topic_type)

    def _name(self, topic: str, kind: str, node_name: str, wrong: str) -> None:
        node_name, wrong = shown(node_name), shown(wrong)
        if (node_name, topic) in self.found:
            return
        sentence = (
            f'{node_name} publishes {wrong} on {topic} and is not heard; publish {kind}, or '
            'remap it.'
        )
        self.found[node_name, topic] = sentence
        self._node.get_logger().error(sentence)
