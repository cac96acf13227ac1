"""Once a second on /diagnostics: how the node is, what it refused, and how punctual it is."""

from __future__ import annotations

from collections import Counter
from collections.abc import Callable

from diagnostic_msgs.msg import DiagnosticArray, DiagnosticStatus, KeyValue

from wrist_control.errors import RefusedError
from wrist_control.ros.guarded import GuardedNode
from wrist_control.ros.qos import OUTPUT
from wrist_control.ros.shown import SENTENCE, shown

OK, WARN, ERROR = DiagnosticStatus.OK, DiagnosticStatus.WARN, DiagnosticStatus.ERROR
Health = tuple[bytes, str, dict[str, str]]


class Diagnostics:
    """Counts what a node refuses and publishes how it is.

    Attributes:
        refused: How many messages were refused so far, by topic and reason.
    """

    def __init__(self, node: GuardedNode, health: Callable[[], Health]) -> None:
        """Publish for a node.

        Args:
            node: The node.
            health: Asked once a second for a level, a sentence and the values to show.
        """
        self.refused: Counter[str] = Counter()
        self._node = node
        node.on_refused = self.refuse
        self._health = health
        self._seen = 0
        self._publisher = node.create_publisher(DiagnosticArray, '/diagnostics', OUTPUT)
        node.create_timer(1.0, self._publish, clock=node.steady)

    def refuse(self, topic: str, error: RefusedError) -> None:
        """Count a refused message, and say why at most once a second."""
        self.refused[f'{topic}: {error.reason}'] += 1
        self._node.get_logger().warning(shown(str(error), SENTENCE), throttle_duration_sec=1.0)

    def _publish(self) -> None:
        level, message, values = self._health()
        total = sum(self.refused.values())
        input_level = WARN if total > self._seen else OK
        self._seen = total
        counts = {f'refused {reason}': str(count) for reason, count in self.refused.items()}
        status = [
            self._status('state', level, message, values),
            self._status('input', input_level, f'{total} messages refused so far', counts),
        ]
        if errors := self._node.unexpected:
            status.append(self._status('errors', ERROR, next(iter(errors.values())), errors))
        array = DiagnosticArray(status=status)
        array.header.stamp = self._node.get_clock().now().to_msg()
        self._publisher.publish(array)

    def _status(
        self, part: str, level: bytes, message: str, values: dict[str, str]
    ) -> DiagnosticStatus:
        return DiagnosticStatus(
            level=level,
            name=f'{self._node.get_fully_qualified_name().lstrip("/")}: {part}',
            message=shown(message, SENTENCE),
            hardware_id='wrist_control',
            values=[
                KeyValue(key=shown(key), value=shown(value, SENTENCE))
                for key, value in values.items()
            ],
        )
