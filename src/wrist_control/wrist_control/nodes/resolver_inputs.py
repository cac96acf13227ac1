"""What a resolver hears of its operators: commands, the dead-man's switch, and stop."""

from __future__ import annotations

import math
from collections.abc import Callable, Mapping, Sequence
from functools import partial
from typing import Any

from geometry_msgs.msg import Twist, TwistStamped
from rclpy.subscription import Subscription
from std_msgs.msg import Bool, Empty

from wrist_control.errors import RefusedError
from wrist_control.nodes.resolver_clock import StepClock
from wrist_control.resolving.commands import CommandPolicy, ReceivedTwist
from wrist_control.resolving.period import Mode
from wrist_control.resolving.permission import Deadman
from wrist_control.resolving.sources import Origin, Sources
from wrist_control.resolving.stamp_order import StampOrder
from wrist_control.resolving.supervisor import Supervisor
from wrist_control.ros import convert
from wrist_control.ros.diagnostics import Diagnostics
from wrist_control.ros.guarded import GuardedNode
from wrist_control.ros.informed import Informed
from wrist_control.ros.publishers import Publishers
from wrist_control.ros.qos import EVERY, EVERY_RELIABLE, NEWEST
from wrist_control.ros.shown import shown


class Inputs:
    """The subscriptions of a resolver by which people move and stop the hand."""

    def __init__(
        self,
        node: GuardedNode,
        values: Mapping[str, Any],
        supervisor: Supervisor,
        diagnostics: Diagnostics,
        clock: StepClock,
        hidden: list[Subscription],
    ) -> None:
        """Start listening.

        Args:
            node: The resolver.
            values: Its parameters, as they are now.
            supervisor: Told of every command that counts.
            diagnostics: Told of every other.
            clock: Tells both times, and is told what is heard.
            hidden: Filled with the subscriptions that no executor may see.
        """
        self._hidden = hidden
        self._node, self._values = node, values
        self._supervisor, self._diagnostics = supervisor, diagnostics
        self._clock = clock
        self._warned_unstamped = False
        self._linear_until = -math.inf
        self._sources = Sources()
        self._orders = {'cmd_vel': StampOrder(), 'cmd_vel_unstamped': StampOrder()}
        self._publishers = Publishers(node)
        self._deadman = Deadman() if values['require_deadman'] else None
        self._listen(TwistStamped, 'cmd_vel', self._on_stamped, NEWEST)
        self._listen(Twist, 'cmd_vel_unstamped', self._on_unstamped, NEWEST)
        if self._deadman is not None:
            self._listen(Bool, 'deadman', partial(self._on_deadman, self._deadman), EVERY)
        # The second one asks for what was lost; the first one hears those who do not repeat it.
        for qos in (EVERY, EVERY_RELIABLE):
            node.create_subscription(Empty, 'stop', self._on_stop, qos)

    def withheld(self) -> str:
        """Return why the hand may not move now, one sentence; empty when it may."""
        now = self._clock.receipt_time()
        if self._sources.mixed(now):
            topic = self._sources.leading
            return (
                f'Stopped: {self._publishers.named(topic)} send on {topic} and cannot be told '
                'apart; end all but one of them.'
            )
        if self._deadman is None:
            return ''
        return self._deadman.withheld(now, self._values['command_timeout'])

    def with_refused(self, sentence: str) -> str:
        """Return a sentence that also says what of the commands is not followed, and why."""
        now = self._clock.receipt_time()
        parts = [sentence.removesuffix('.')]
        if topics := self._sources.refused(now):
            parts.append(self._refusal(topics))
        if now < self._linear_until:
            parts.append('the linear part of the command is left out, for this wrist only turns')
        return '; '.join(parts) + '.' if parts[1:] else sentence

    def _refusal(self, topics: Sequence[str]) -> str:
        leading = self._sources.leading
        leader = f'{self._publishers.named(leading)} on {leading}'
        if leading in topics:
            refused = f'one of {leader} leads, what others send there is refused'
        else:
            others = ' and '.join(f'{self._publishers.named(t)} on {t}' for t in topics)
            refused = f'commands of {others} are refused while {leader} leads'
        return f'{refused}: end all but one'

    def _listen(
        self, kind: Any, topic: str, heard: Callable[[Any, Origin], None], qos: Any
    ) -> None:
        """Hear a topic, each message with where it comes from."""

        def on_message(message: Any, info: dict[str, Any], publishers: int) -> None:
            number, sent = info['publication_sequence_number'], info['source_timestamp']
            heard(message, Origin(topic, number, sent, publishers))

        self._hidden.append(Informed(self._node, kind, topic, on_message, qos).subscription)

    def _on_stamped(self, message: TwistStamped, origin: Origin) -> None:
        stamp = convert.seconds(message.header.stamp)
        if stamp is None and not self._warned_unstamped:
            self._warned_unstamped = True
            self._node.get_logger().warning(
                'Commands on cmd_vel have no stamp; each counts as new.'
            )
        twist = convert.twist_values(message.twist)
        self._take(ReceivedTwist(twist, shown(message.header.frame_id), stamp), origin)

    def _on_unstamped(self, message: Twist, origin: Origin) -> None:
        self._take(ReceivedTwist(convert.twist_values(message)), origin)

    def _on_stop(self, _: Empty) -> None:
        self._supervisor.stop('Stopped: somebody sent a message on stop.', Mode.DISABLED)

    def _take(self, received: ReceivedTwist, origin: Origin) -> None:
        timeout = self._values['command_timeout']
        policy = CommandPolicy(timeout, self._values['hand_frame'], self._values['forearm_frame'])
        stamp_time, now = self._clock.stamp_time(), self._clock.receipt_time()
        try:
            command = policy.accept(received, stamp_time=stamp_time, receipt_time=now)
            self._sources.admit(origin, now, timeout)
            self._orders[origin.topic].check(command, stamp_time=stamp_time, timeout=timeout)
        except RefusedError as error:
            self._diagnostics.refuse(origin.topic, error)
        else:
            self._supervisor.take_command(command)
            if self._supervisor.wrist.twist_size == 3 and any(command.twist[:3]):
                self._linear_until = now + timeout
            self._clock.timing.hear('command', command.receipt, command.stamp)

    def _on_deadman(self, deadman: Deadman, message: Bool, origin: Origin) -> None:
        deadman.take(message.data, self._clock.receipt_time(), origin.publishers)
