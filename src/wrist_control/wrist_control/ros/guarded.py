"""A node that nothing from outside can end: callbacks are guarded, and messages are bounded."""

from __future__ import annotations

import functools
import traceback
from collections.abc import Callable
from typing import Any

from rcl_interfaces.msg import SetParametersResult
from rclpy.clock import Clock, ClockType
from rclpy.parameter import Parameter
from rclpy.serialization import deserialize_message

from wrist_control.errors import RefusedError
from wrist_control.ros.parameters import ParameterNode
from wrist_control.ros.shown import shown

# A message of a thousand joints has about half of this; to unpack a larger one takes too long.
MOST_BYTES = 256 * 1024
KEPT = 'use_sim_time cannot change while a node runs: start it again with the other value.'


class GuardedNode(ParameterNode):
    """What every node of this package is.

    An exception that nobody expected ends no callback's node: it is logged once, shown in
    /diagnostics until `unexpected` is cleared, and `on_unexpected` brings the hand to rest.

    Timers run on a steady clock, which nobody can set; where `use_sim_time` is set, and the
    caller does not ask for another, on the simulated one.

    Attributes:
        steady: The clock that never jumps.
        simulated: True where `use_sim_time` is set.
        unexpected: One sentence for each such exception, by where it came from.
        on_refused: Called with a topic and why a message was not even unpacked.
    """

    def __init__(self, node_name: str, **node_options: Any) -> None:
        """Make the node.

        Args:
            node_name: What it is called.
            node_options: Passed on to rclpy.
        """
        self.steady = Clock(clock_type=ClockType.STEADY_TIME)
        self.unexpected: dict[str, str] = {}
        self.on_refused: Callable[[str, RefusedError], None] = lambda topic, error: None
        super().__init__(node_name, **node_options)
        self.simulated: bool = self.get_parameter('use_sim_time').value
        # Before the callback that rclpy has set up, which would change the clock at once.
        self.add_on_set_parameters_callback(self._keep_clock)

    def wind_up(self) -> None:
        """Take what only a running node needs; called once, before its first callback.

        Raises:
            WristError: It cannot run here; the sentence says why.
        """

    def wind_down(self) -> None:
        """Bring to rest whatever this node moves; called once, after its last callback."""

    def on_unexpected(self, sentence: str) -> None:
        """Bring to rest whatever this node moves, because of an error; the node goes on."""

    def tell_unexpected(self, where: str, error: Exception) -> str:
        """Log an exception that nobody expected, once, and act on it; return a sentence."""
        what = shown(str(error)) or 'no reason given'
        sentence = f'An error in {where} that nobody expected ({type(error).__name__}: {what}).'
        if where not in self.unexpected:
            frames = ''.join(traceback.format_tb(error.__traceback__))
            self.get_logger().error(f'{sentence}\nTraceback:\n{frames}')
        self.unexpected[where] = sentence
        try:
            self.on_unexpected(sentence)
        except Exception as another:
            self.get_logger().error(f'And no ramp could be made: {shown(str(another))}')
        return sentence

    def create_timer(self, timer_period_sec: float, callback: Any, **options: Any) -> Any:
        """Make a timer whose callback is guarded."""
        where = getattr(callback, '__qualname__', 'a timer')
        options.setdefault('clock', self.get_clock() if self.simulated else self.steady)
        return super().create_timer(timer_period_sec, self.guarded(callback, where), **options)

    def create_subscription(
        self, msg_type: Any, topic: str, callback: Any, qos_profile: Any, **options: Any
    ) -> Any:
        """Listen to messages that are not too large; the callback is guarded."""
        # Raw, so that a message is measured before any time is spent on it.
        return super().create_subscription(
            msg_type,
            topic,
            self.unpacking(msg_type, topic, callback),
            qos_profile,
            raw=True,
            **options,
        )

    def unpacking(self, kind: Any, topic: str, callback: Any) -> Any:
        """Return a guarded callback of raw messages: those not too large are unpacked."""

        def unpack(data: bytes, *more: Any) -> None:
            try:
                message = _unpacked(data, kind)
            except RefusedError as error:
                self.on_refused(topic, error)
            else:
                callback(message, *more)

        return self.guarded(unpack, f'topic {topic}')

    def create_service(self, srv_type: Any, srv_name: str, callback: Any, **options: Any) -> Any:
        """Offer a service whose callback is guarded: it answers why it could not do it."""

        def answer(sentence: str, _: Any, response: Any) -> Any:
            if hasattr(response, 'success'):
                response.success, response.message = False, sentence
            return response

        guarded = self.guarded(callback, f'service {srv_name}', answer)
        return super().create_service(srv_type, srv_name, guarded, **options)

    def add_on_set_parameters_callback(self, callback: Any) -> None:
        """Have a callback look at new parameters, guarded: what it cannot judge is refused."""
        guarded = self.guarded(callback, 'a change of parameters', _refuse_parameters)
        super().add_on_set_parameters_callback(guarded)

    def add_post_set_parameters_callback(self, callback: Any) -> None:
        """Have a guarded callback follow new parameters."""
        super().add_post_set_parameters_callback(self.guarded(callback, 'a change of parameters'))

    def _keep_clock(self, parameters: list[Parameter]) -> SetParametersResult:
        changed = any(p.name == 'use_sim_time' and p.value != self.simulated for p in parameters)
        return SetParametersResult(successful=not changed, reason=KEPT if changed else '')

    def guarded(
        self, callback: Any, where: str, answer: Callable[..., Any] = lambda *_: None
    ) -> Any:
        """Return a callback that never raises.

        Args:
            callback: What may raise.
            where: What it is for.
            answer: Makes the answer in its place, of a sentence and its arguments.
        """

        @functools.wraps(callback)
        def call(*arguments: Any) -> Any:
            try:
                return callback(*arguments)
            except Exception as error:
                return answer(self.tell_unexpected(where, error), *arguments)

        return call


def _unpacked(data: bytes, kind: Any) -> Any:
    if len(data) > MOST_BYTES:
        raise RefusedError(
            'too large',
            f'Refused a message of {len(data)} bytes; at most {MOST_BYTES} are looked at.',
        )
    try:
        return deserialize_message(data, kind)
    except Exception as error:
        raise RefusedError('malformed', 'Refused a message that cannot be unpacked.') from error


def _refuse_parameters(sentence: str, _: Any) -> SetParametersResult:
    return SetParametersResult(successful=False, reason=sentence)
