"""A copy of what sets up, on a machine whose every command is faked: minutes become moments."""

from __future__ import annotations

import shutil
import signal
import subprocess
import sys
import time
from collections.abc import Callable
from pathlib import Path

import machine

ROOT = Path(__file__).resolve().parents[1]
TOOLS = ('cat', 'cp', 'dirname', 'grep', 'ln', 'mkdir', 'paste', 'rm', 'sleep', 'touch', 'tr')
SOON = 20.0  # s; all of it takes far less

# Stands for a Python of any machine: its modules and what its setup starts are said from outside.
PYTHON = """
case "$1 $2" in
  '-m venv') exec venv "$@" ;;
  '-m pip') exec pip "$@" ;;
  '-c '*) exec {real} -I -S "$@" ;;
esac
shift
exec {real} -I -S -c '
import importlib.machinery, os, platform, runpy, sys, types
sys.executable = "{here}/python3"
sys.path.insert(0, "scripts")
sys.modules.update(dict.fromkeys(os.environ["ABSENT"].split()))
for name in os.environ["PRESENT"].split():
    sys.modules[name] = types.ModuleType(name)
    sys.modules[name].__spec__ = importlib.machinery.ModuleSpec(name, None)
platform.machine = lambda: "x86_64"
runpy.run_path("scripts/setup_workspace.py", run_name="__main__")
' "$@"
"""
# What each command does where all is well.
FAKES = {
    'python3': PYTHON,
    'venv': 'rm -rf .venv; mkdir -p .venv/bin; cp {here}/python3 .venv/bin/python',
    'pip': '',
    'colcon': """
mkdir -p build/$5 install/$5/share/$5
touch install/local_setup.sh install/$5/share/$5/package.sh
""",
    'cc': '',
    'c++': '',
}


class Machine:
    """A machine with a checkout on it, set up as often as a test likes."""

    def __init__(self, folder: Path, checkout: str = 'checkout') -> None:
        self.checkout = folder / checkout
        self.absent = ''  # modules that its Python lacks
        self.present = ''  # and those that it has, beside its own
        self._fakes = folder / 'bin'
        self._calls = folder / 'calls'
        self._copy()
        self._fakes.mkdir()
        for tool in TOOLS:
            (self._fakes / tool).symlink_to(shutil.which(tool) or tool)
        for name in FAKES:
            self.mend(name)

    def _copy(self) -> None:
        for folder in ('src/wrist_interfaces', 'underlay'):
            shutil.copytree(ROOT / folder, self.checkout / folder)
        control = 'src/wrist_control'
        names = ('setup', 'setup_workspace.py', 'machine.py', 'progress.py')
        for file in (
            *(ROOT / 'scripts' / name for name in names),
            *ROOT.glob('requirements*.txt'),
            *(ROOT / control / name for name in ('package.xml', 'setup.cfg', 'setup.py')),
            ROOT / control / 'wrist_control' / 'wrists' / 'registry.py',
        ):
            copy = self.checkout / file.relative_to(ROOT)
            copy.parent.mkdir(parents=True, exist_ok=True)
            shutil.copy(file, copy)

    def fake(self, name: str, body: str) -> None:
        """Put a command on the machine that does no more than a few lines of shell."""
        body = body.replace('{here}', str(self._fakes)).replace('{real}', sys.executable)
        told = f'echo "{name} $*" >> {self._calls}\n'
        command = self._fakes / name
        command.write_text(f'#!/bin/sh\n{told}{body}\n')
        command.chmod(0o755)

    def mend(self, name: str) -> None:
        """Let a command do again what it does where all is well."""
        self.fake(name, FAKES[name])

    def without(self, *names: str) -> None:
        """Take commands away from the machine."""
        for name in names:
            (self._fakes / name).unlink()

    def sourced(self) -> dict[str, str]:
        """Give the machine a ROS that has what the base needs; return what sourcing it sets."""
        prefix = self.checkout.parent / 'ros'
        for package in machine.APT_OF_ROS_PACKAGE:
            share = prefix / 'share' / package
            share.mkdir(parents=True)
            (share / 'package.xml').touch()
        self.fake('cmake', '')
        self.present = ' '.join(machine.APT_OF_MODULE)
        return {'ROS_DISTRO': 'jazzy', 'AMENT_PREFIX_PATH': str(prefix)}

    def calls(self, name: str) -> list[str]:
        """Return how a command has been called until now."""
        return [line for line in content(self._calls).splitlines() if line.split()[0] == name]

    def start(self, *extras: str, **variables: str) -> subprocess.Popen[str]:
        """Start the setup."""
        return subprocess.Popen(
            [self.checkout / 'scripts' / 'setup', *extras],
            env={**self._variables(), **variables},
            stdout=subprocess.PIPE,
            stderr=subprocess.PIPE,
            text=True,
            # Whoever runs the tests in the background has them ignore it.
            preexec_fn=lambda: signal.signal(signal.SIGINT, signal.default_int_handler),
        )

    def _variables(self) -> dict[str, str]:
        return {'PATH': str(self._fakes), 'ABSENT': self.absent, 'PRESENT': self.present}

    def set_up(self, *extras: str, **variables: str) -> tuple[int, str]:
        """Set up, and return the exit code and all that was said."""
        return said(self.start(*extras, **variables))


def said(process: subprocess.Popen[str]) -> tuple[int, str]:
    """Wait for a setup to end, and return its exit code and all that it said, in sentences."""
    output, errors = process.communicate(timeout=SOON)
    sentences = output + errors
    assert 'Traceback' not in sentences
    return process.returncode, sentences


def until(condition: Callable[[], object]) -> None:
    """Wait until something is true."""
    end = time.monotonic() + SOON
    while not condition():
        assert time.monotonic() < end, f'not within {SOON} s'
        time.sleep(0.02)


def content(file: Path) -> str:
    """Return what is in a file that may not be there yet."""
    return file.read_text() if file.exists() else ''


def is_alive(pid: int) -> bool:
    """Tell whether a process lives; one that has ended and was not waited for does not."""
    try:
        return ') Z ' not in Path(f'/proc/{pid}/stat').read_text()
    except OSError:
        return False
