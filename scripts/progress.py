"""Long commands: all that they say goes into a log, and how far they are onto the screen.

On a terminal that is one line, drawn over itself; elsewhere it is a line now and then.  Nothing
is installed yet when this runs, so that it stands on Python alone.
"""

from __future__ import annotations

import os
import re
import shutil
import signal
import subprocess
import sys
import time
from collections.abc import Callable, Mapping, Sequence
from contextlib import suppress
from pathlib import Path

DRAWN_EVERY = 0.2  # s, on a terminal
TOLD_EVERY = 15.0  # s, elsewhere
INTERRUPTIONS = (signal.SIGINT, signal.SIGTERM, signal.SIGHUP)
TIME_TO_END = 5.0  # s, for a command that is interrupted


def say(sentence: str) -> None:
    """Tell the user what is going on."""
    print(f'setup: {sentence}', flush=True)


def packages(pins: str) -> Callable[[str], str]:
    """Return what tells how many packages pip has, of those that a requirements file pins."""
    pinned = len(re.findall(r'^\S+==', pins, re.MULTILINE))

    def state(output: str) -> str:
        # Some pins are for other versions of Python.
        total = pinned - len(re.findall(r'^Ignoring ', output, re.MULTILINE))
        there = re.findall(r'^(?:Collecting|Processing|Requirement) ', output, re.MULTILINE)
        if '\nInstalling collected packages' in output:
            return f'unpacking {total} packages'
        return f'{len(there)} of {total} packages'

    return state


def percent(output: str) -> str:
    """Return how far CMake is, which counts once for each target that it is asked for."""
    percents = re.findall(r'^\[ *(\d+%)\]', output, re.MULTILINE)
    return percents[-1] if percents else 'getting ready'


class Progress:
    """What is shown of one command."""

    def __init__(self, title: str) -> None:
        self._title = title
        self._line = ''
        self._is_drawn = sys.stdout.isatty()
        self._began = self._told = time.monotonic()
        if self._is_drawn:
            self.show('')
        else:
            say(title)

    def show(self, state: str) -> None:
        """Show how far the command is, if it is time to."""
        now = time.monotonic()
        far = ', '.join(filter(None, (state, f'{now - self._began:.0f} s')))
        if self._is_drawn:
            width = shutil.get_terminal_size().columns or 80  # some terminals do not know theirs
            line = f'setup: {self._title}, {far}'[: width - 1]
            if line != self._line:
                self._line = line
                print(f'\r{line}\033[K', end='', flush=True)
        elif now - self._told >= TOLD_EVERY:
            self._told = now
            say(f'  {far}')

    def end(self) -> None:
        """Leave the line as it is, and what comes next below it."""
        if self._is_drawn:
            print(flush=True)


def run(
    title: str,
    command: Sequence[str],
    log: Path,
    state: Callable[[str], str] = lambda output: '',
    env: Mapping[str, str] | None = None,
) -> bool:
    """Run a command and show how far it is.

    Args:
        title: What it does.
        command: The command.
        log: Takes everything that it says.
        state: Tells how far it is from what it has said.
        env: Its environment variables, if not those of this process.

    Returns:
        Whether it did what it should.
    """
    log.parent.mkdir(exist_ok=True)
    progress = Progress(title)
    with log.open('w') as output:
        # What interrupts setup waits until there is a process to stop.
        signal.pthread_sigmask(signal.SIG_BLOCK, INTERRUPTIONS)
        # In a group of its own, so that what it has started ends with it.
        process = subprocess.Popen(
            command,
            env=env,
            stdin=subprocess.DEVNULL,
            stdout=output,
            stderr=output,
            start_new_session=True,
            preexec_fn=let_interrupt,
        )
    try:
        let_interrupt()
        while not ended(process, DRAWN_EVERY):
            progress.show(state(log.read_text(errors='replace')))
    finally:
        stop(process)
        progress.end()
    return process.returncode == 0


def let_interrupt() -> None:
    """Let signals interrupt this process."""
    signal.pthread_sigmask(signal.SIG_UNBLOCK, INTERRUPTIONS)


def ended(process: subprocess.Popen[bytes], within: float) -> bool:
    """Wait some s at most for a process, and tell whether it has ended."""
    try:
        process.wait(within)
    except subprocess.TimeoutExpired:
        return False
    return True


def stop(process: subprocess.Popen[bytes]) -> None:
    """End a process that still runs, and all that it has started: first asking, then not."""
    if process.poll() is not None:
        return
    try:
        os.killpg(process.pid, signal.SIGINT)
        ended(process, TIME_TO_END)
    finally:
        with suppress(ProcessLookupError):
            os.killpg(process.pid, signal.SIGKILL)
        process.wait()
