"""Run one node until it is told to stop: a signal brings it to rest, and ends it with 0.

ROS's own signal handlers take the context away at once, in the middle of whatever is going on,
and nothing can be said any more. Here a signal only ends the spinning.
"""

from __future__ import annotations

import gc
import signal
import socket
import sys
import threading
import time
import traceback
from collections.abc import Callable
from importlib import import_module
from pathlib import Path
from typing import Any

import rclpy
from rclpy.executors import Executor, SingleThreadedExecutor
from rclpy.node import Node
from rclpy.signals import SignalHandlerOptions
from rclpy.task import Future

from wrist_control.errors import WristError
from wrist_control.ros import usage
from wrist_control.ros.command_line import silent_files, what_is_wrong
from wrist_control.ros.guarded import GuardedNode

# The events executor of this release spins at full load when it waits without a limit.
LONGEST_WAIT = 3600.0
# An executor that raises so often, each time within so many s, will not work again.
MOST_BREAKS, SOON = 10, 1.0
# How long a node that cannot start looks for somebody on /rosout, and lets the words go out, s.
LISTENERS_WITHIN, LAST_WORDS = 1.0, 0.3
SIGNALS = (signal.SIGINT, signal.SIGTERM, signal.SIGHUP)


def run(make_node: Callable[[], GuardedNode]) -> int:
    """Make a node and spin it to its end; or print what there is to know of it, for `--help`.

    Args:
        make_node: Called once ROS is up.

    Returns:
        The exit code: 0 after an ordinary stop, 1 after an error that nobody expected, 2 when the
        node refuses its parameters, or ROS the command line.
    """
    if usage.is_wanted(sys.argv):
        return usage.tell(make_node)
    told = _hear_signals()
    try:
        rclpy.init(args=sys.argv, signal_handler_options=SignalHandlerOptions.NO)
    except Exception as error:
        print(f'Cannot start: {what_is_wrong(error)}', file=sys.stderr)
        return 2
    refused = ''
    try:
        _live(make_node(), told)
    except WristError as error:
        refused = f'Cannot start: {error}'
    except Exception:
        traceback.print_exc()
        return 1
    else:
        return 0
    finally:
        if not refused:
            rclpy.try_shutdown()
    _tell_refused(refused)
    return 2


def _tell_refused(sentence: str) -> None:
    """Log why a node cannot start, so that whoever listens to /rosout hears it."""
    gc.collect()  # the node that could not start, whose name would be taken
    node = rclpy.create_node(Path(sys.argv[0]).name)
    node.get_logger().fatal(sentence)  # /rosout keeps it for whoever is found later
    end = time.monotonic() + LISTENERS_WITHIN
    while not node.count_subscribers('/rosout') and time.monotonic() < end:
        time.sleep(0.01)
    if node.count_subscribers('/rosout'):
        time.sleep(LAST_WORDS)
    rclpy.try_shutdown()


def _live(node: GuardedNode, told: socket.socket) -> None:
    ended: Future = Future()
    executor = make_executor(node)
    executor.add_node(node)
    for sentence in silent_files(sys.argv, node.get_fully_qualified_name()):
        node.get_logger().warning(sentence)
    executor.create_task(lambda: node.get_logger().info('Ready; Ctrl-C ends it.'))
    gc.collect()
    gc.freeze()  # what lives now lives to the end: it need not be looked at again
    threading.Thread(target=_await_signal, args=(told, ended), daemon=True).start()
    try:
        node.wind_up()
        _spin(node, executor, ended)
    finally:
        node.wind_down()
        executor.remove_node(node)
        executor.shutdown()
        node.destroy_node()


def _spin(node: GuardedNode, executor: Executor, ended: Future) -> None:
    """Spin to the end; what the executor itself raises is told, and only if it goes on ends it."""
    breaks = 0
    while rclpy.ok() and not ended.done():
        began = time.monotonic()
        try:
            executor.spin_until_future_complete(ended, timeout_sec=LONGEST_WAIT)
        except Exception as error:
            breaks = breaks + 1 if time.monotonic() - began < SOON else 1
            if breaks >= MOST_BREAKS:
                raise
            node.tell_unexpected('the executor', error)


def _hear_signals() -> socket.socket:
    """Turn signals, from now on, into bytes that can be read here: nothing is interrupted.

    They cannot be blocked and waited for instead: libraries have made threads before.
    """
    told, tell = socket.socketpair()
    tell.setblocking(False)
    signal.set_wakeup_fd(tell.detach(), warn_on_full_buffer=False)
    for number in SIGNALS:
        if number != signal.SIGHUP or signal.getsignal(number) != signal.SIG_IGN:  # by nohup
            signal.signal(number, lambda *_: None)
    return told


def _await_signal(told: socket.socket, ended: Future) -> None:
    while told.recv(1)[0] not in SIGNALS:
        pass  # a node may listen to others, which do not end it
    ended.set_result(None)


def make_executor(node: Node) -> Executor:
    """Return the executor with the least delay that serves a node reliably.

    Under a simulated clock the events executor of this release misses ticks now and then.
    """
    if node.get_parameter('use_sim_time').value:
        return SingleThreadedExecutor()
    try:
        experimental: Any = import_module('rclpy.experimental')
        return experimental.EventsExecutor()
    except (ImportError, AttributeError):
        return SingleThreadedExecutor()
