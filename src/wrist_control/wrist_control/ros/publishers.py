"""Who publishes on a topic, by name."""

from __future__ import annotations

import time

from rclpy.node import Node

# Asking the graph takes 0.15 ms: it is not asked in every period, but after this long, s.
REMEMBERED = 1.0


class Publishers:
    """Names the publishers of a topic; the graph is asked now and then."""

    def __init__(self, node: Node) -> None:
        """Ask for a node's topics.

        Args:
            node: The one that listens.
        """
        self._node = node
        self._known: dict[str, tuple[float, str]] = {}

    def named(self, topic: str) -> str:
        """Return the names of all that publish on a topic: 'a', 'a and b', 'two of a'."""
        now = time.monotonic()
        when, names = self._known.get(topic, (0.0, ''))
        if not names or now - when > REMEMBERED:
            names = self._ask(topic)
            self._known[topic] = now, names
        return names

    def _ask(self, topic: str) -> str:
        found = [name.lstrip('/') for name in publishing(self._node, topic)]
        counted = [
            name if found.count(name) == 1 else f'{found.count(name)} publishers of {name}'
            for name in sorted(set(found))
        ]
        return ' and '.join(counted) or 'somebody who has left'


def publishing(node: Node, topic: str) -> list[str]:
    """Return the whole name of the node of each publisher of a topic, as a node sees them now."""
    return [
        f'{one.node_namespace.rstrip("/")}/{one.node_name}'
        for one in node.get_publishers_info_by_topic(topic)
    ]
