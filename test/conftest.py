"""A real ROS graph for each test, in a domain of its own."""

from __future__ import annotations

import math
import os
import subprocess
import time
import uuid
from collections.abc import Callable, Iterator
from contextlib import contextmanager
from pathlib import Path
from typing import Any

import pytest
import rclpy
from rclpy.executors import SingleThreadedExecutor
from rclpy.node import Node
from rclpy.qos import QoSProfile

from wrist_control.graph.domains import Domain
from wrist_control.graph.lockstep import Lockstep
from wrist_control.nodes.resolver import Resolver

# Set to another value in each test, so that its processes are told from all others.
MARK = 'WRIST_CONTROL_TEST'


class Graph:
    """The nodes of one test, wired by one executor.

    Attributes:
        domain: Its ROS domain.
        processes: Those of the test: none outlives it, to be heard by the next in this domain.
        outside: A node that stands for everybody else: publishes and listens by topic only.
    """

    def __init__(self) -> None:
        self._domain = Domain()
        self.domain = self._domain.number
        self.context = rclpy.Context()
        rclpy.init(context=self.context, domain_id=self.domain)
        self.executor = SingleThreadedExecutor(context=self.context)
        self._nodes: list[Node] = []
        self.processes: list[subprocess.Popen] = []
        self.outside = self.add(rclpy.create_node('outside', context=self.context))

    def add(self, node: Node) -> Node:
        self._nodes.append(node)
        self.executor.add_node(node)
        return node

    def start(self, kind: Callable[..., Node], *arguments: str, **parameters: Any) -> Node:
        """Start one of our nodes with parameters.

        `namespace` is not a parameter, and `free_joints` is: rates that may change at once.
        """
        namespace = parameters.pop('namespace', '')
        if kind is Resolver:
            # Most tests have no joints beside the resolver; those that do ask for the default.
            parameters.setdefault('require_joint_states', False)
            if parameters.pop('free_joints', False):
                parameters['joint_acceleration_limits'] = [math.inf]
                parameters['joint_deceleration_limits'] = [math.inf]
        overrides = [rclpy.Parameter(name, value=value) for name, value in parameters.items()]
        node = kind(
            *arguments,
            namespace=namespace,
            context=self.context,
            parameter_overrides=overrides,
            use_global_arguments=False,
        )
        return self.add(node)

    def end(self, node: Node) -> None:
        """End one of the nodes."""
        self._nodes.remove(node)
        self.executor.remove_node(node)
        node.destroy_node()

    def listen(self, kind: Any, topic: str) -> list[Any]:
        """Return a list that grows with everything heard on a topic."""
        heard: list[Any] = []
        self.outside.create_subscription(kind, topic, heard.append, QoSProfile(depth=100))
        return heard

    def publisher(self, kind: Any, topic: str, listeners: int = 1) -> Any:
        """Return a publisher that has found its subscribers."""
        publisher = self.outside.create_publisher(kind, topic, 10)
        self.until(lambda: publisher.get_subscription_count() >= listeners)
        return publisher

    def call(self, kind: Any, service: str, request: Any) -> Any:
        """Call a service and return its answer."""
        client = self.outside.create_client(kind, service)
        self.until(client.service_is_ready)
        future = client.call_async(request)
        self.until(future.done)
        return future.result()

    def until(self, condition: Callable[[], object], limit: float = 20.0) -> None:
        """Spin until something is true."""
        end = time.monotonic() + limit
        while not condition():
            assert time.monotonic() < end, f'not within {limit} s'
            self.executor.spin_once(timeout_sec=0.05)

    def spin(self, seconds: float) -> None:
        """Spin for a while."""
        end = time.monotonic() + seconds
        while time.monotonic() < end:
            self.executor.spin_once(timeout_sec=0.02)

    @contextmanager
    def stranger(self, kind: Any, topic: str) -> Iterator[None]:
        """Let a node of another process, `old_teleop`, publish on a topic."""
        context = rclpy.Context()
        rclpy.init(context=context, domain_id=self.domain)
        try:
            node = rclpy.create_node('old_teleop', context=context)
            node.create_publisher(kind, topic, 10)
            yield
            node.destroy_node()
        finally:
            rclpy.shutdown(context=context)

    def lockstep(self, period: float) -> Lockstep:
        """Return a clock for nodes that use simulated time."""
        return Lockstep(self.outside, period, executor=self.executor)

    def close(self) -> None:
        for process in self.processes:
            process.kill()
            process.wait()
        for node in self._nodes:
            self.executor.remove_node(node)
            node.destroy_node()
        self.executor.shutdown()
        rclpy.shutdown(context=self.context)
        self._domain.release()


@pytest.fixture
def graph() -> Iterator[Graph]:
    made = Graph()
    yield made
    made.close()


@pytest.fixture
def until_ready() -> Callable[[Any], None]:
    """Wait until a node's process, whose stderr is a pipe, says that it is ready."""

    def wait(process: Any) -> None:
        said = ''
        while 'Ready' not in said:
            line = process.stderr.readline()
            assert line, f'it ended: {said}'
            said += line

    return wait


@pytest.fixture
def process_environment() -> Iterator[dict[str, str]]:
    """The environment for a test's own processes: a domain of their own, and their mark."""
    domain = Domain()
    yield {**os.environ, 'ROS_DOMAIN_ID': str(domain.number), MARK: uuid.uuid4().hex}
    domain.release()


@pytest.fixture
def own_processes(process_environment: dict[str, str]) -> Callable[[], list[str]]:
    """List the command lines of all that this test has started, and of nothing else."""
    mark = f'{MARK}={process_environment[MARK]}'.encode()

    def listed() -> list[str]:
        found = []
        for folder in Path('/proc').glob('[0-9]*'):
            try:
                if mark in (folder / 'environ').read_bytes().split(b'\0'):
                    found.append((folder / 'cmdline').read_text())
            except OSError:
                continue  # it has ended, or is somebody else's
        return found

    return listed


@pytest.fixture(scope='module')
def chromium() -> Iterator[Any]:
    """A browser for all tests of a module; without one they are skipped."""
    reason = 'the page is not tried: playwright is not installed'
    playwright = pytest.importorskip('playwright.sync_api', reason=reason)
    from .console_stage import Browser

    with playwright.sync_playwright() as api:
        made = Browser(api, MARK)
        yield made
        made.close()


@pytest.fixture
def browser(chromium: Any) -> Iterator[Any]:
    """The browser, without any page open."""
    chromium.problems.clear()
    yield chromium
    chromium.leave()
