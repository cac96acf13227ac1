"""The console: a web page that holds the stick of one wrist, or of two beside each other."""

from __future__ import annotations

import math
import queue
import sys
import time
from collections.abc import Callable
from functools import partial
from typing import Any

from wrist_control.errors import InvalidValueError
from wrist_control.graph.processes import NodeEndedError, Processes
from wrist_control.operating.maneuvers import BARKER_SPEED, ZERO_RATES
from wrist_control.ros import usage
from wrist_control.ros.diagnostics import OK, WARN, Diagnostics
from wrist_control.ros.guarded import GuardedNode
from wrist_control.ros.parameters import Spec
from wrist_control.ros.running import run
from wrist_control.web.driver import Driver
from wrist_control.web.watched import WatchedWrist
from wrist_control.wrists import wrist_names
from wrist_control.wrists.registry import DESCRIBED

# What the second wrist's topics begin with.
SECOND = 'second'
NOBODY = 'none'


def startable() -> tuple[str, ...]:
    """Return the names of the wrists that need nothing else to be started."""
    return tuple(name for name in wrist_names() if name not in DESCRIBED)


def specs() -> list[Spec]:
    """Return the parameters of the console."""
    names = (NOBODY, *startable())
    return [
        Spec('host', '127.0.0.1', 'Address that the page is served at; 0.0.0.0 is for everybody'),
        Spec(
            'port', 8080, 'Port that the page is served at; 0 for any that is free', '', 0, 65535
        ),
        Spec('rate', 50.0, 'Commands per second while the stick is held', 'Hz', 10.0, 1000.0),
        Spec(
            'start',
            NOBODY,
            'Wrist that the console starts itself, with simulated joints; without one it joins '
            'the graph that is there',
            choices=names,
        ),
        Spec(
            'second',
            NOBODY,
            f'A wrist beside it on the same stick, in the namespace {SECOND}; started as well',
            choices=names,
        ),
        Spec('speed', BARKER_SPEED, 'Hand rate at full stick, at first', 'rad/s', 1e-3, 10.0),
        Spec('fastest', math.pi, 'Largest hand rate that a page may ask for', 'rad/s', 1e-3, 10.0),
    ]


class Console(GuardedNode):
    """Serves a page that drives one wrist or two, and shows what they do.

    The page is served by threads of its own; what they want of ROS they leave in `later`.

    Attributes:
        wrists: Those that are watched: the first, and one beside it.
        driver: Who holds the stick.
        startable: The names of those that it can start; none where it starts nothing.
        names: What it has started, by slot; NOBODY where nothing is.
        values: The parameters.
    """

    def __init__(self, **node_options: Any) -> None:
        """Declare the parameters; `open` begins.

        Args:
            node_options: Passed on to rclpy.

        Raises:
            WristError: A parameter cannot be used; the sentence says why.
        """
        super().__init__('console', **node_options)
        self.values = self.declare(specs())
        self.startable = startable() if self.values['start'] != NOBODY else ()
        if not self.startable and self.values['second'] != NOBODY:
            raise InvalidValueError(
                f'second is {self.values["second"]} where the console starts no wrist: give start '
                f'too, or run the second resolver in the namespace {SECOND}.'
            )
        self.wrists = (WatchedWrist(self), WatchedWrist(self, f'{SECOND}/'))
        self.driver = Driver(1.0 / self.values['rate'], self.values['fastest'])
        self.names = [NOBODY, NOBODY]
        namespace = self.get_namespace().rstrip('/')
        self._processes = (Processes(namespace or '/'), Processes(f'{namespace}/{SECOND}'))
        self._later: queue.SimpleQueue[Callable[[], object]] = queue.SimpleQueue()
        self._close: Callable[[], object] = bool
        self._diagnostics = Diagnostics(self, self._health)
        self.create_timer(1.0 / self.values['rate'], self._tick, clock=self.steady)

    def open(self) -> None:
        """Start the wrists that are asked for, and serve the page.

        Raises:
            InvalidValueError: It cannot be served there.
        """
        from wrist_control.web.server import Server  # not for whoever asks for help

        server = Server(self, self.values['host'], self.values['port'])
        self._close = server.close
        if self.startable:
            self._start(0, self.values['start'])
            self._start(1, self.values['second'])
        self.get_logger().info(f'The console is at {server.address}')

    def later(self, call: Callable[[], object]) -> None:
        """Have something done on the thread of the node; may be called from any."""
        self._later.put(call)

    def choose(self, slot: int, name: str) -> None:
        """Start another simulated wrist in a place, or none; may be called from any thread."""
        self.driver.release_all()
        self.later(partial(self._start, slot, name))

    def stop(self) -> None:
        """Stop every wrist, now; may be called from any thread."""
        self.driver.release_all()
        for wrist in self.wrists:
            wrist.stop()

    def wind_down(self) -> None:
        """Ask for no motion, close the page, and end what was started."""
        self.driver.release_all()
        for wrist in self.wrists:
            wrist.command(ZERO_RATES)
        self._close()
        for processes in self._processes:
            processes.end()

    def on_unexpected(self, sentence: str) -> None:
        """Let the stick go."""
        self.driver.release_all()

    def _start(self, slot: int, name: str) -> None:
        self._processes[slot].end()
        self.wrists[slot].lose()
        self.names[slot] = name
        if name != NOBODY:
            self._processes[slot].start('wrist_resolver', {'wrist': name})
            self._processes[slot].start('joint_simulator', {})

    def _tick(self) -> None:
        first = self.wrists[0].status
        rates = self.driver.rates(time.monotonic(), first.time_lost if first else 0.0)
        if rates is not None:
            for wrist in self.wrists:
                if wrist.status is not None:
                    wrist.command(rates)
        while not self._later.empty():
            self._later.get()()

    def _health(self) -> tuple[bytes, str, dict[str, str]]:
        for processes in self._processes:
            try:
                processes.check()
            except NodeEndedError as error:
                return WARN, str(error), {}
        held = self.driver.holder(time.monotonic())
        return OK, 'The stick is held.' if held else 'Nobody holds the stick.', {}


def _opened() -> Console:
    console = Console()
    console.open()
    return console


def main() -> None:
    """Run the console."""
    sys.exit(run(Console if usage.is_wanted(sys.argv) else _opened))
