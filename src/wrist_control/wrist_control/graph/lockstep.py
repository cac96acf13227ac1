"""A simulated clock that ticks only when every node has answered the tick before.

Nodes in their own processes then give the same answer in every run, on any machine, to the last
bit, and as fast as they can or as slowly as a person wants to watch.
"""

from __future__ import annotations

import time
from collections.abc import Callable, Mapping
from typing import Any

from builtin_interfaces.msg import Time
from rclpy.executors import Executor, SingleThreadedExecutor
from rclpy.node import Node
from rclpy.qos import QoSProfile
from rosgraph_msgs.msg import Clock

from wrist_control.errors import WristError

# A tick is sent again after this long, s: a clock message may be lost.
AGAIN = 0.1
# While nodes are still finding each other a tick may go unanswered; then the next is tried, s.
WARM_UP = 0.5
# What was published at one tick must have arrived everywhere before the next, s.
SETTLE = 0.004
# Simulated time starts here, s: zero would mean that there is no time yet.
START = 10


class NoAnswerError(WristError, TimeoutError):
    """A node has not answered a tick."""


class Lockstep:
    """Ticks a clock and collects what nodes publish at each tick.

    Attributes:
        ticks: Number of the present tick.
        heard: Every message in the order it came, by topic; from `begin` on, one for each tick.
    """

    def __init__(
        self,
        node: Node,
        period: float,
        limit: float = 20.0,
        alive: Callable[[], object] = bool,
        executor: Executor | None = None,
    ) -> None:
        """Prepare a clock on the topic `clock` of a node's namespace.

        Args:
            node: Any node of the caller's; it is spun here while waiting.
            period: Simulated time between ticks, s.
            limit: How long a tick may stay unanswered, s.
            alive: Called while waiting; raises when waiting has become useless.
            executor: Spun while waiting, when the node is in one already.
        """
        self.ticks = -1
        self.heard: dict[str, list[Any]] = {}
        self._node = node
        self._period_ns = round(period * 1e9)
        self._limit = limit
        self._alive = alive
        self._clock = node.create_publisher(Clock, 'clock', 10)
        self._executor = executor or SingleThreadedExecutor(context=node.context)
        if executor is None:
            self._executor.add_node(node)

    def listen(self, topics: Mapping[str, Any]) -> None:
        """Wait from now on for these stamped topics, name to message type, at every tick."""
        for topic, kind in topics.items():
            self.heard[topic] = []
            self._node.create_subscription(
                kind, topic, self.heard[topic].append, QoSProfile(depth=100)
            )

    def begin(self) -> None:
        """Tick until everybody answers: nodes need a moment to find each other.

        Raises:
            NoAnswerError: Somebody never does, in one sentence.
        """
        end = time.monotonic() + self._limit
        while True:
            self.ticks += 1
            silent = self._answered_within(WARM_UP)
            if not silent:
                return
            if time.monotonic() > end:
                raise self._no_answer(silent)

    def tick(self) -> None:
        """Go one period on, and wait until everybody has answered.

        Raises:
            NoAnswerError: Somebody did not, in one sentence.
        """
        time.sleep(SETTLE)
        self.ticks += 1
        silent = self._answered_within(self._limit)
        if silent:
            raise self._no_answer(silent)

    def _answered_within(self, limit: float) -> list[str]:
        """Send the present tick until everybody has answered; return who has not in time."""
        end = time.monotonic() + limit
        again = 0.0
        while (silent := self._silent()) and time.monotonic() < end:
            if time.monotonic() > again:
                self._clock.publish(Clock(clock=self._now()))
                again = time.monotonic() + AGAIN
            self._alive()
            self._executor.spin_once(timeout_sec=0.02)
        return silent

    def _no_answer(self, silent: list[str]) -> NoAnswerError:
        return NoAnswerError(
            f'Nothing came on {", ".join(silent)} within {self._limit:g} s; is the node that '
            'publishes it running?'
        )

    def _silent(self) -> list[str]:
        now = self._now()
        return [
            topic
            for topic, messages in self.heard.items()
            if not messages or messages[-1].header.stamp != now
        ]

    def _now(self) -> Time:
        nanoseconds = START * 10**9 + self.ticks * self._period_ns
        return Time(sec=nanoseconds // 10**9, nanosec=nanoseconds % 10**9)
