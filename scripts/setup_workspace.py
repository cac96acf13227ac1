"""Make everything that the workspace needs to run: Python packages, ROS 2, the built packages.

Each step leaves a stamp that says what it was made from.  A step whose stamp still matches is
skipped; any other is done again from nothing, so that an interrupted setup heals by itself.
"""

from __future__ import annotations

import fcntl
import hashlib
import os
import shutil
import signal
import subprocess
import sys
import time
from collections.abc import Callable, Iterable, Iterator, Sequence
from contextlib import contextmanager
from dataclasses import dataclass
from pathlib import Path

import machine

ROOT = Path(__file__).resolve().parent.parent
VENV = ROOT / '.venv'
LOGS = ROOT / 'log'
INTERFACES = ROOT / 'src' / 'wrist_interfaces'
CONTROL = ROOT / 'src' / 'wrist_control'


@dataclass(frozen=True)
class Step:
    """One thing to make, and what tells whether it is made already."""

    folder: Path  # holds the stamp; made anew by make
    key: str  # a digest of what it is made from
    make: Callable[[], None]
    also: tuple[Path, ...] = ()  # what make leaves elsewhere

    @property
    def stamp(self) -> Path:
        """The file that holds the key, written when everything else is there."""
        return self.folder / '.made_from'

    def is_done(self) -> bool:
        """Tell whether the result is there, and was made from the same things."""
        made = self.stamp.is_file() and self.stamp.read_text() == self.key
        return made and all(path.exists() for path in self.also)

    def do(self) -> None:
        """Make the result, and put the stamp on it."""
        self.stamp.unlink(missing_ok=True)
        self.make()
        self.stamp.write_text(self.key)


def steps() -> Iterator[Step]:
    """Return every step in order; each one is done again when one before it has changed."""
    if machine.ros_is_sourced():
        key = digest([], 'sourced', machine.version(), *sourced_prefixes(), str(ROOT))
    else:
        # The path counts too, since neither an environment nor a build can be moved.
        python = f'{sys.version_info.major}.{sys.version_info.minor} {sys.base_prefix}'
        key = digest([ROOT / 'requirements.txt'], 'wheels', python, str(ROOT))
        yield Step(VENV, key, make_venv)
    key = digest((path for path in INTERFACES.rglob('*') if path.is_file()), key)
    yield build_step(INTERFACES, key)
    # The modules themselves are linked, so that edits inside them need no new build.
    registry = CONTROL / 'wrist_control' / 'wrists' / 'registry.py'
    files = [registry, *(CONTROL / name for name in ('package.xml', 'setup.cfg', 'setup.py'))]
    configs = sorted(path.name for path in (CONTROL / 'config').glob('*.yaml'))
    yield build_step(CONTROL, digest(files, key, *configs))


def build_step(package: Path, key: str) -> Step:
    """Return the step that builds one package with colcon."""
    share = ROOT / 'install' / package.name / 'share' / package.name
    return Step(
        folder=ROOT / 'build' / package.name,
        key=key,
        make=lambda: build(package.name),
        also=(share / 'package.sh', ROOT / 'install' / 'local_setup.sh'),
    )


def sourced_prefixes() -> list[str]:
    """Return where the sourced ROS is, without this workspace, which may be sourced too."""
    prefixes = os.environ.get('AMENT_PREFIX_PATH', '').split(os.pathsep)
    return [prefix for prefix in prefixes if ROOT not in Path(prefix).parents]


def digest(files: Iterable[Path], *words: str) -> str:
    """Return a digest of some words, and of the names and contents of some files."""
    total = hashlib.sha256(repr(words).encode())
    for file in sorted(files):
        content = hashlib.sha256(file.read_bytes()).hexdigest()
        total.update(f'{file.relative_to(ROOT)} {content}\n'.encode())
    return total.hexdigest()


def make_venv() -> None:
    """Make .venv anew and install every package of requirements.txt."""
    say(f'making .venv with Python {machine.version()}')
    bare = [] if machine.has_module('ensurepip') else ['--without-pip']
    venv = [sys.executable, '-m', 'venv', '--clear', *bare, str(VENV)]
    if failed(venv, LOGS / 'setup_venv.txt'):
        raise machine.SetupError(f'.venv could not be made: see {LOGS / "setup_venv.txt"}.')
    (VENV / 'COLCON_IGNORE').touch()  # colcon shall not look for packages in it
    (VENV / 'local_setup.sh').touch()  # colcon warns about a ROS prefix without one

    say('installing ROS 2 Jazzy and the tools, about 200 MB: one to three minutes')
    requirements = str(ROOT / 'requirements.txt')
    # The pins hold for what pip needs to build a source distribution, too.
    pins = {'PIP_CONSTRAINT': requirements, 'PIP_BUILD_CONSTRAINT': requirements, 'PIP_USER': '0'}
    options = ['--no-input', '--disable-pip-version-check', '--no-deps', '--progress-bar=off']
    install = [*pip(), 'install', *options, '-r', requirements]
    if failed(install, LOGS / 'setup_pip.txt', os.environ | pins):
        raise machine.SetupError(machine.pip_sentence(LOGS / 'setup_pip.txt'))
    (VENV / 'made_with').write_text(sys.executable)


def pip() -> list[str]:
    """Return the command that installs into .venv, also where venv could not put pip there."""
    own = str(VENV / 'bin' / 'python')
    if machine.has_module('ensurepip'):
        return [own, '-m', 'pip']
    return [sys.executable, '-m', 'pip', '--python', own]


def build(package: str) -> None:
    """Build one package from nothing."""
    say(f'building {package}')
    for folder in ('build', 'install'):
        shutil.rmtree(ROOT / folder / package, ignore_errors=True)
    env = build_environment()
    python = sys.executable if machine.ros_is_sourced() else str(VENV / 'bin' / 'python')
    colcon = shutil.which('colcon', path=env['PATH']) or 'colcon'
    command = [colcon, 'build', '--base-paths', 'src', '--packages-select', package]
    command += ['--symlink-install', '--event-handlers', 'console_direct+', '--cmake-args']
    command += ['-DBUILD_TESTING=OFF', '-DCMAKE_BUILD_TYPE=Release']
    command += [f'-DPython3_EXECUTABLE={python}']
    log = LOGS / f'setup_{package}.txt'
    if failed(command, log, env):
        print(*log.read_text(errors='replace').splitlines()[-30:], sep='\n', file=sys.stderr)
        raise machine.SetupError(f'{package} could not be built, as said above and in {log}.')


def build_environment() -> dict[str, str]:
    """Return the environment variables under which colcon builds."""
    # make's own variables would reach the makes that CMake starts, and confuse them.
    dropped = {'MAKEFLAGS', 'MAKELEVEL', 'MAKEOVERRIDES', 'MFLAGS'}
    if machine.ros_is_sourced():
        return {name: value for name, value in os.environ.items() if name not in dropped}
    # What belongs to another environment must not leak into this one.
    dropped |= {'CONDA_PREFIX', 'COLCON_PREFIX_PATH', '_ROS_WHEELS_BOOTSTRAP_COMPLETE'}
    env = {name: value for name, value in os.environ.items() if name not in dropped}
    env['PATH'] = os.pathsep.join([str(VENV / 'bin'), env.get('PATH', os.defpath)])
    return env | dict.fromkeys(
        ('VIRTUAL_ENV', 'AMENT_PREFIX_PATH', 'CMAKE_PREFIX_PATH'), str(VENV)
    )


def failed(command: Sequence[str], log: Path, env: dict[str, str] | None = None) -> bool:
    """Run a command with all of its output in a log, and tell whether it failed."""
    log.parent.mkdir(exist_ok=True)
    with log.open('w') as output:
        done = subprocess.run(
            command, cwd=ROOT, env=env, stdin=subprocess.DEVNULL, stdout=output, stderr=output
        )
    return done.returncode != 0


@contextmanager
def alone() -> Iterator[None]:
    """Wait until no other setup of this checkout is running."""
    with (ROOT / '.setup.lock').open('w') as lock:
        try:
            fcntl.flock(lock, fcntl.LOCK_EX | fcntl.LOCK_NB)
        except BlockingIOError:
            say('another setup is running here; waiting for it to end')
            fcntl.flock(lock, fcntl.LOCK_EX)
        yield


def say(sentence: str) -> None:
    """Tell the user what is going on."""
    print(f'setup: {sentence}', flush=True)


def setup() -> None:
    """Do every step that is not done yet."""
    start = time.monotonic()
    open_steps = [step for step in steps() if not step.is_done()]
    if not open_steps:
        return
    machine.check(ROOT)
    for step in open_steps:
        step.do()
    say(f'done in {time.monotonic() - start:.0f} s')


def main() -> int:
    """Set the workspace up; every foreseeable failure is one sentence and a non-zero exit."""
    signal.signal(signal.SIGTERM, signal.default_int_handler)  # so that children end as well
    try:
        with alone():
            setup()
    except (machine.SetupError, OSError) as error:
        for sentence in str(error).splitlines():
            print(f'setup: {sentence}', file=sys.stderr)
        return 1
    except KeyboardInterrupt:
        print('setup: interrupted; run the same command again to finish it', file=sys.stderr)
        return 130
    return 0


if __name__ == '__main__':
    sys.exit(main())
