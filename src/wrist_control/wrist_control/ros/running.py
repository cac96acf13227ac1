"""Run one node until it is told to stop: SIGINT and SIGTERM end it cleanly with exit code 0."""

from __future__ import annotations

import gc
import signal
import sys
from collections.abc import Callable
from importlib import import_module
from typing import Any

import rclpy
from rclpy._rclpy_pybind11 import RCLError
from rclpy.executors import Executor, ExternalShutdownException, SingleThreadedExecutor
from rclpy.node import Node
from rclpy.task import Future

from wrist_control.errors import WristError

# The events executor of this release spins at full load when it waits without a limit.
LONGEST_WAIT = 3600.0
SIGNALS = (signal.SIGINT, signal.SIGTERM)


def run(make_node: Callable[[], Node]) -> int:
    """Make a node and spin it to its end.

    Args:
        make_node: Called once ROS is up.

    Returns:
        The exit code: 0 after an ordinary stop, 2 when the node refuses its parameters.
    """
    # While things are half made a signal would pull ROS away from under them: it has to wait.
    signal.pthread_sigmask(signal.SIG_BLOCK, SIGNALS)
    # rclpy's own handlers end the node; an exception at any moment would only get in their way.
    signal.signal(signal.SIGINT, lambda *_: None)
    rclpy.init(args=sys.argv)
    try:
        _spin(make_node())
    except WristError as error:
        print(f'Cannot start: {error}', file=sys.stderr)
        return 2
    except ExternalShutdownException:
        pass
    except RCLError:
        if rclpy.ok():  # otherwise the end came in the middle of something
            raise
    finally:
        rclpy.try_shutdown()
    return 0


def _spin(node: Node) -> None:
    def ready() -> None:
        node.get_logger().info('Ready; Ctrl-C ends it.')
        signal.pthread_sigmask(signal.SIG_UNBLOCK, SIGNALS)

    executor = make_executor(node)
    executor.add_node(node)
    executor.create_task(ready)
    gc.collect()
    gc.freeze()  # what lives now lives to the end: it need not be looked at again
    try:
        while rclpy.ok():
            executor.spin_until_future_complete(Future(), timeout_sec=LONGEST_WAIT)
    finally:
        executor.remove_node(node)
        executor.shutdown()
        node.destroy_node()


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
