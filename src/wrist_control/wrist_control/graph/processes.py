"""Nodes as processes of their own, in their own namespace, that never outlive their caller."""

from __future__ import annotations

import os
import shutil
import signal
import subprocess
from collections.abc import Iterable, Iterator, Mapping, Sequence
from contextlib import contextmanager
from pathlib import Path
from types import TracebackType

from ament_index_python.packages import get_package_prefix, get_package_share_directory

from wrist_control.errors import WristError

PACKAGE = 'wrist_control'
# A node that has not ended this long after it was asked to is killed, s.
GRACE = 5.0
SIGNALS = (signal.SIGINT, signal.SIGTERM)
TERMINATED = 128 + signal.SIGTERM  # the exit code


class NodeEndedError(WristError, RuntimeError):
    """A node has ended by itself."""


def config_file(name: str) -> Path:
    """Return a ready parameter file by name."""
    return Path(get_package_share_directory(PACKAGE)) / 'config' / name


def executable_file(name: str) -> Path:
    """Return an executable of this package by name."""
    return Path(get_package_prefix(PACKAGE)) / 'lib' / PACKAGE / name


class Processes:
    """Starts nodes in one namespace; none of them outlives `end`, nor this process.

    Attributes:
        namespace: Where their topics are.
    """

    def __init__(
        self, namespace: str, files: Sequence[Path] = (), private: Sequence[str] = ()
    ) -> None:
        """Prepare a namespace.

        Args:
            namespace: Where their topics are.
            files: Parameter files for every node.
            private: Absolute topics that are kept inside the namespace.
        """
        self.namespace = namespace
        self._files = files
        self._private = private
        self._running: dict[str, subprocess.Popen] = {}

    def start(self, executable: str, parameters: Mapping[str, object]) -> None:
        """Start a node of this package.

        Args:
            executable: Its name under lib/wrist_control.
            parameters: Values that win over the files.
        """
        remaps = [f'__ns:={self.namespace}']
        remaps += [f'/{topic}:={self.namespace}/{topic}' for topic in self._private]
        values = [f'{name}:={_text(value)}' for name, value in parameters.items()]
        command = [
            *_ended_with_this_process(),
            str(executable_file(executable)),
            '--ros-args',
            *_each('-r', remaps),
            '--log-level',
            'warn',
        ]
        command += [*_each('--params-file', map(str, self._files)), *_each('-p', values)]
        # In a group of their own, so that Ctrl-C reaches the caller alone, who ends them in order.
        with _signals_held():  # or a node that has just begun would be known to nobody
            self._running[executable] = subprocess.Popen(command, start_new_session=True)

    def check(self) -> None:
        """Raise NodeEndedError if a node is gone."""
        for executable, process in self._running.items():
            if process.poll() is not None:
                raise NodeEndedError(
                    f'{executable} ended with exit code {process.returncode}; it says why above.'
                )

    def end(self) -> None:
        """End every node, and wait until they are gone."""
        for process in self._running.values():
            process.terminate()
        for process in self._running.values():
            try:
                process.wait(GRACE)
            except subprocess.TimeoutExpired:
                process.kill()
                process.wait()
        self._running.clear()


class NodeProcesses(Processes):
    """Nodes on a private clock, in a namespace that nobody else has; ended with the block."""

    def __init__(self, name: str, files: Sequence[Path]) -> None:
        """Prepare a namespace: no other graph on this machine is disturbed.

        Args:
            name: Beginning of the namespace.
            files: Parameter files for every node.
        """
        super().__init__(f'/{name}_{os.getpid()}', files, ('clock', 'diagnostics'))
        self._interruption: BaseException | None = None

    def __enter__(self) -> NodeProcesses:
        """Be told of SIGTERM as of Ctrl-C, so that the nodes are always ended."""
        self._before = {number: signal.signal(number, self._interrupt) for number in SIGNALS}
        return self

    def _interrupt(self, number: int, _: object) -> None:
        is_term = number == signal.SIGTERM
        self._interruption = SystemExit(TERMINATED) if is_term else KeyboardInterrupt()
        raise self._interruption

    def __exit__(
        self,
        kind: type[BaseException] | None,
        error: BaseException | None,
        trace: TracebackType | None,
    ) -> None:
        """End every node."""
        self.end()
        for number, handler in self._before.items():
            signal.signal(number, handler)
        if self._interruption is not None and isinstance(error, Exception):
            # It came in the middle of a call into ROS, which has made an error of its own of it.
            raise self._interruption from None


def _ended_with_this_process() -> list[str]:
    """Return what to begin a command with, so that even a killed caller leaves nothing running."""
    setpriv = shutil.which('setpriv')
    return [setpriv, '--pdeathsig', 'TERM', '--'] if setpriv else []


@contextmanager
def _signals_held() -> Iterator[None]:
    """Let a signal that comes within the block do what it does when the block is over."""
    told: list[int] = []
    before = {
        number: signal.signal(number, lambda came, _: told.append(came)) for number in SIGNALS
    }
    try:
        yield
    finally:
        for number, handler in before.items():
            signal.signal(number, handler)
        for came in told:
            signal.raise_signal(came)


def _each(flag: str, values: Iterable[str]) -> list[str]:
    return [part for value in values for part in (flag, value)]


def _text(value: object) -> str:
    return '.inf' if value == float('inf') else str(value)
