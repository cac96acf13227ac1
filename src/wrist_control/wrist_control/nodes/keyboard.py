"""The keyboard: a terminal whose keys turn the hand while they repeat."""

from __future__ import annotations

import math
import os
import signal
import sys
import textwrap
from collections.abc import Iterator
from typing import Any

from geometry_msgs.msg import TwistStamped
from rclpy.duration import Duration
from std_msgs.msg import Empty, Header

from wrist_control.nodes.keyboard_enable import Enabling
from wrist_control.nodes.keyboard_terminal import Terminal
from wrist_control.operating.keys import ENABLE, STOP, Keys
from wrist_control.operating.maneuvers import ZERO_RATES
from wrist_control.resolving.report import WristState
from wrist_control.ros import convert
from wrist_control.ros.diagnostics import OK, Diagnostics
from wrist_control.ros.guarded import GuardedNode
from wrist_control.ros.parameters import Spec
from wrist_control.ros.qos import NEWEST, OUTPUT
from wrist_control.ros.running import run
from wrist_control.ros.shown import SENTENCE, shown
from wrist_control.rotations import Vector
from wrist_interfaces.msg import WristStatus

SPECS = [
    Spec('rate', 50.0, 'Commands per second while a key is held', 'Hz', 20.0, 200.0),
    Spec('speed', 0.28, 'Hand rate of a held key, at the start', 'rad/s', 0.01, 100.0),
    Spec('max_speed', 2.0, 'The fastest that keys can make it', 'rad/s', 0.01, 100.0),
    Spec('frame_id', '', 'Frame of the commands: the hand frame, the forearm frame, or empty'),
]
PAGE = (
    'Hold     to turn the hand        rate',
    '  w s    pitch   forward, back      q',
    '  a d    roll    left, right        p',
    '  q e    yaw     left, right        r',
    '  + -    faster, slower',
    '  space  STOP    g  go on after it',
    '  Ctrl-C ends',
    '',
)
# How often the page is looked at again, s, and how old a status may be on it.
PAGE_PERIOD, STATUS_AGE = 0.1, 1.0
WIDEST = 76
# How long the last words are waited for.
LAST_WORDS = Duration(seconds=0.5)


class Keyboard(GuardedNode):
    """Publishes `cmd_vel` while a key of its terminal repeats, and shows `wrist_status`.

    Keys: w s pitch, a d roll, q e yaw; + - speed; space stops, g goes on after it; Ctrl-C ends.
    """

    def __init__(self, **node_options: Any) -> None:
        """Declare the parameters; the terminal is left alone.

        Args:
            node_options: Passed on to rclpy.

        Raises:
            WristError: A parameter cannot be used; the sentence says why.
        """
        super().__init__('keyboard', **node_options)
        self._values = self.declare(SPECS)
        self._terminal = Terminal()
        self._keys = Keys(self._values['speed'], self._values['max_speed'])
        self._status: tuple[float, str] = (-math.inf, '')
        self._suspended = self._resumed = False
        self._leads = False
        self._diagnostics = Diagnostics(self, self._health)
        self._commands = self.create_publisher(TwistStamped, 'cmd_vel', OUTPUT)
        self._stops = self.create_publisher(Empty, 'stop', OUTPUT)
        statuses = self.create_subscription(WristStatus, 'wrist_status', self._on_status, NEWEST)
        self._enabling = Enabling(self, statuses.topic_name)

    def wind_up(self) -> None:
        """Take the terminal, and begin to read it."""
        self._terminal.enter()
        signal.signal(signal.SIGTSTP, self._on_suspend)
        signal.signal(signal.SIGCONT, self._on_resume)
        # On the steady clock: whoever holds a key does so in real time.
        self.create_timer(1.0 / self._values['rate'], self._tick, clock=self.steady)
        self.create_timer(PAGE_PERIOD, self._show, clock=self.steady)

    def wind_down(self) -> None:
        """Ask for no motion, put the terminal back, and see that the last words arrive."""
        try:
            self._let_go()
            for said in (self._commands, self._stops):
                said.wait_for_all_acked(LAST_WORDS)
        finally:
            self._terminal.leave()

    def on_unexpected(self, sentence: str) -> None:
        """Ask for no motion."""
        self._let_go()

    def _on_suspend(self, *_: object) -> None:
        self._suspended = True

    def _on_resume(self, *_: object) -> None:
        self._resumed = True

    def _tick(self) -> None:
        if self._suspended:
            self._suspend()
        if self._resumed:
            self._resumed = False
            self._terminal.enter()
        now = self._now()
        asked = self._keys.take(self._terminal.read(), now)
        if asked == STOP:
            self._stops.publish(Empty())
            heard = self._stops.get_subscription_count()
            self._enabling.forget()
            self._enabling.said = 'Sent a stop; g goes on.' if heard else 'Nobody hears the stop.'
        elif asked == ENABLE:
            self._enabling.ask(now)
        self._enabling.look(now)
        rates = self._keys.rates(now)
        if rates is not None:
            self._publish(rates)
        self._leads = rates is not None
        if self._terminal.gone:
            os.kill(os.getpid(), signal.SIGTERM)

    def _suspend(self) -> None:
        """Stop as every program does at Ctrl-Z: the hand at rest, the terminal put back."""
        self._let_go()
        self._terminal.leave()
        self._suspended = False
        os.kill(os.getpid(), signal.SIGSTOP)

    def _let_go(self) -> None:
        self._keys.let_go()
        if self._leads:
            self._publish(ZERO_RATES)

    def _publish(self, rates: Vector) -> None:
        stamp = self.get_clock().now().to_msg()
        header = Header(stamp=stamp, frame_id=self._values['frame_id'])
        self._commands.publish(convert.command_message(header, rates))

    def _on_status(self, message: WristStatus) -> None:
        name = WristState(message.state).name
        self._status = self._now(), f'{name}: {shown(message.message, SENTENCE)}'

    def _now(self) -> float:
        return convert.seconds_of(self.steady.now().nanoseconds)

    def _show(self) -> None:
        if not (self._suspended or self._resumed):
            self._terminal.show([*self._page()])

    def _page(self) -> Iterator[str]:
        now = self._now()
        width = min(WIDEST, self._terminal.size()[0])
        speed = self._keys.speed
        p, q, r = self._keys.rates(now) or ZERO_RATES
        yield from PAGE
        yield f'speed {speed:.3f} rad/s, {math.degrees(speed):.1f} deg/s'
        yield f'p {p:+.2f}   q {q:+.2f}   r {r:+.2f} rad/s'
        yield ''
        heard, status = self._status
        if now - heard > STATUS_AGE:
            status = 'No wrist_status: no resolver is heard here.'
        yield from textwrap.wrap(status, width)
        for sentence in (self._enabling.said, *self.unexpected.values()):
            yield from textwrap.wrap(sentence, width)

    def _health(self) -> tuple[bytes, str, dict[str, str]]:
        return OK, 'Following its keys.' if self._leads else 'No key is held.', {}


def main() -> None:
    """Run the keyboard."""
    sys.exit(run(Keyboard))
