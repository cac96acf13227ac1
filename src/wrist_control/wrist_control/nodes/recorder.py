"""The recorder: all that is said in one wrist's graph, as it was on the wire."""

from __future__ import annotations

import sys
import time
from collections.abc import Iterator
from functools import partial
from pathlib import Path
from typing import TYPE_CHECKING, Any

from rclpy.qos import DurabilityPolicy, QoSProfile, ReliabilityPolicy
from rclpy.subscription import Subscription

from wrist_control.bags import check_installed
from wrist_control.errors import InvalidValueError
from wrist_control.ros.definitions import definition, message_class, qos_facts
from wrist_control.ros.diagnostics import ERROR, OK, WARN, Diagnostics, Health
from wrist_control.ros.guarded import GuardedNode
from wrist_control.ros.informed import Informed
from wrist_control.ros.parameters import NAMES, Spec
from wrist_control.ros.running import run
from wrist_control.ros.shown import shown

if TYPE_CHECKING:
    from wrist_control.bags.writing import BagWriter

SPECS = [
    Spec('folder', '', 'Folder to record into, made new; wrist_<date>_<time> when empty'),
    Spec('leave_out', [], 'Topics that are not recorded, as markers', NAMES),
]
# Topics of everybody's that belong to a wrist's graph as well.
OF_ALL = ('/clock', '/diagnostics', '/parameter_events', '/rosout', '/tf', '/tf_static')
# How often new topics are looked for, and how much may be lost when this process is killed, s.
LOOK, FLUSH = 0.1, 0.25
# So many messages of one topic may wait here.
DEPTH = 1000


class Recorder(GuardedNode):
    """Listens to all topics of its namespace, and writes them into a folder as rosbag2 does.

    It says nothing but /diagnostics. At every moment the folder is a whole recording.
    """

    def __init__(self, **node_options: Any) -> None:
        """Declare the parameters, and record from the first look on.

        Args:
            node_options: Passed on to rclpy.

        Raises:
            WristError: A parameter cannot be used, or the extra is not installed; the sentence
                says why.
        """
        self._hidden: list[Subscription] = []
        super().__init__('recorder', **node_options)
        values = self.declare(SPECS)
        check_installed()
        self._folder = _free_folder(values['folder'])
        self._left_out = {self.resolve_topic_name(name) for name in values['leave_out']}
        self._bag: BagWriter | None = None
        self._ended = ''
        self._numbers: dict[str, int] = {}
        self._from_the_first: set[str] = set()
        self._lost: dict[str, int] = {}
        self._told = 0
        self._not_recorded: dict[str, str] = {}
        Diagnostics(self, self._health)
        self.create_timer(LOOK, self._look, clock=self.steady)
        self.create_timer(FLUSH, self._flush, clock=self.steady)

    @property
    def subscriptions(self) -> Iterator[Subscription]:
        """Return what an executor shall serve of them: none, they are waited for otherwise."""
        return (each for each in super().subscriptions if each not in self._hidden)

    def wind_down(self) -> None:
        """Finish the recording, and say what is in it."""
        if self._bag is None:
            return
        if not self._ended:
            self._keep(self._bag.close)
        self.get_logger().info(self._summary())

    def _look(self) -> None:
        if self._ended:
            return
        if self._bag is None:
            self._keep(self._begin)
        for topic, _ in self.get_topic_names_and_types():
            if self._bag and self._belongs(topic) and topic not in self._numbers:
                self._listen(self._bag, topic)

    def _begin(self) -> None:
        from wrist_control.bags.writing import BagWriter

        self._bag = BagWriter(self._folder)
        self.get_logger().info(f'Recording into {self._folder}.')

    def _belongs(self, topic: str) -> bool:
        if topic in self._left_out:
            return False
        if topic in OF_ALL:  # unless it has another name here
            return bool(self.resolve_topic_name(topic) == topic)
        space = self.get_namespace().rstrip('/') + '/'
        return topic.startswith(space) and (space != '/' or topic.count('/') == 1)

    def _listen(self, bag: BagWriter, topic: str) -> None:
        if topic in self._not_recorded:
            return
        try:
            publishers = self.get_publishers_info_by_topic(topic)
            known = publishers or self.get_subscriptions_info_by_topic(topic)
            if not known:
                return
            kind = known[0].topic_type
            text, made = definition(kind), message_class(kind)
        except (InvalidValueError, ValueError) as error:
            self._not_recorded[topic] = shown(str(error))
            self.get_logger().warning(f'{topic} is not recorded: {shown(str(error))}')
            return
        lasting = all(x.qos_profile.durability == DurabilityPolicy.TRANSIENT_LOCAL for x in known)
        hashed = str(known[0].topic_type_hash)
        offers = [qos_facts(each.qos_profile) for each in publishers]
        from wrist_control.bags.writing import Topic

        channel = bag.add(Topic(topic, kind, text, hashed, offers))
        self._numbers[topic] = 0
        if not publishers:
            self._from_the_first.add(topic)
        hear = partial(self._on_message, topic, channel)
        heard = Informed(self, made, topic, hear, _listening(lasting), raw=True)
        self._hidden.append(heard.subscription)

    def _on_message(
        self, topic: str, channel: int, data: bytes, info: dict[str, Any], publishers: int
    ) -> None:
        number = info['publication_sequence_number'] or 0
        last, self._numbers[topic] = self._numbers[topic], number
        whole = last > 0 or topic in self._from_the_first
        if publishers == 1 and whole and last < number - 1:
            self._lost[topic] = self._lost.get(topic, 0) + number - last - 1
        if self._ended or self._bag is None:
            return
        came, sent = info['received_timestamp'], info['source_timestamp']
        if self.simulated:
            came = sent = self.get_clock().now().nanoseconds
        self._keep(partial(self._bag.write, channel, data, came, sent, number))

    def _flush(self) -> None:
        if self._bag is not None and not self._ended:
            self._keep(self._bag.flush)

    def _keep(self, write: Any) -> None:
        """Write, and end the recording where the disk takes no more."""
        try:
            write()
        except (OSError, InvalidValueError) as error:
            reason = getattr(error, 'strerror', None) or str(error)
            self._ended = (
                f'The recording in {self._folder} has ended ({reason}): what was written before '
                'can be read; make room, and record again into another folder.'
            )
            self.get_logger().error(self._ended)

    def _summary(self) -> str:
        bag = self._bag
        assert bag is not None
        lost = sum(self._lost.values())
        topics = sum(1 for count in bag.counts.values() if count)
        return (
            f'Recorded {bag.messages} messages of {topics} topics in {bag.duration:.1f} s, '
            f'{lost} lost: {self._folder} ({bag.size / 1e6:.1f} MB).'
        )

    def _health(self) -> Health:
        if self._ended:
            return ERROR, self._ended, {}
        if self._bag is None:
            return OK, 'Beginning to record.', {}
        values = {topic: str(count) for topic, count in sorted(self._bag.counts.items())}
        values |= {f'lost of {topic}': str(count) for topic, count in self._lost.items()}
        values |= {f'{topic} is not recorded': why for topic, why in self._not_recorded.items()}
        lost = sum(self._lost.values())
        level = WARN if lost > self._told or self._not_recorded else OK
        self._told = lost
        return level, self._summary().replace('Recorded', 'Recording:', 1), values


def _free_folder(name: str) -> Path:
    """Return the folder to record into.

    Raises:
        InvalidValueError: It is there already, or cannot be made.
    """
    from wrist_control.bags.writing import check_free

    folder = Path(name or time.strftime('wrist_%Y-%m-%d_%H-%M-%S')).expanduser()
    check_free(folder)
    return folder


def _listening(lasting: bool) -> QoSProfile:
    """Return how to listen: whoever speaks never waits for a recorder."""
    if lasting:
        return QoSProfile(
            depth=DEPTH,
            reliability=ReliabilityPolicy.RELIABLE,
            durability=DurabilityPolicy.TRANSIENT_LOCAL,
        )
    return QoSProfile(depth=DEPTH, reliability=ReliabilityPolicy.BEST_EFFORT)


def main() -> None:
    """Run the recorder."""
    sys.exit(run(Recorder))
