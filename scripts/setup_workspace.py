"""Make everything that the workspace needs to run: Python packages, ROS 2, the built packages.

Each step leaves a stamp that says what it was made from.  A step whose stamp still matches is
skipped; any other is done again, so that an interrupted setup heals by itself.  Extras, named as
arguments, are what only some targets need: requirements-<extra>.txt.
"""

from __future__ import annotations

import fcntl
import hashlib
import os
import shutil
import signal
import sys
import time
from collections.abc import Callable, Iterable, Iterator, Sequence
from contextlib import contextmanager
from dataclasses import dataclass
from pathlib import Path

import machine
import progress
from progress import say

ROOT = Path(__file__).resolve().parent.parent
VENV = ROOT / '.venv'
LOGS = ROOT / 'log'
INTERFACES = ROOT / 'src' / 'wrist_interfaces'
CONTROL = ROOT / 'src' / 'wrist_control'
# The folders of files that come with the package, beside its modules.
SHIPPED = ('config', 'foxglove', 'launch', 'rviz', 'urdf')
# What ROS 2 ships and its wheels lack: colcon finds it only where it is named.
TF2 = ROOT / 'underlay' / 'tf2_msgs'


@dataclass(frozen=True)
class Step:
    """One thing to make, and what tells whether it is made already."""

    stamp: Path  # holds the key, written when everything else is there
    key: str  # a digest of what it is made from
    make: Callable[[], None]
    also: tuple[Path, ...] = ()  # what make leaves elsewhere

    def is_done(self) -> bool:
        """Tell whether the result is there, and was made from the same things."""
        made = self.stamp.is_file() and self.stamp.read_text() == self.key
        return made and all(path.exists() for path in self.also)

    def do(self) -> None:
        """Make the result, and put the stamp on it."""
        self.stamp.unlink(missing_ok=True)
        self.make()
        self.stamp.write_text(self.key)


def steps(extras: Iterable[str]) -> Iterator[Step]:
    """Return every step in order; all are done again when the first of them has changed."""
    if machine.ros_is_sourced():
        base = digest([], 'sourced', machine.version(), *sourced_prefixes(), str(ROOT))
        yield removal_step(TF2, base)
    else:
        # The path counts too, since neither an environment nor a build can be moved.
        python = f'{sys.version_info.major}.{sys.version_info.minor} {sys.base_prefix}'
        files = [ROOT / 'requirements-build.txt', ROOT / 'requirements.txt']
        base = digest(files, 'wheels', python, str(ROOT))
        yield Step(VENV / '.made_from', base, make_venv)
        yield build_step(TF2, digest([*files_in(TF2), *files_in(INTERFACES / 'cmake')], base))
    key = digest(files_in(INTERFACES), base)
    yield build_step(INTERFACES, key)
    # The modules themselves are linked, so that edits inside them need no new build.
    registry = CONTROL / 'wrist_control' / 'wrists' / 'registry.py'
    files = [registry, *(CONTROL / name for name in ('package.xml', 'setup.cfg', 'setup.py'))]
    # So are the files that come with them, but not one that is new.
    names = sorted(
        f'{name}/{one.name}' for name in SHIPPED for one in (CONTROL / name).glob('*.*')
    )
    yield build_step(CONTROL, digest(files, key, *names))
    for extra in extras:
        yield extra_step(extra, base)


def extra_step(extra: str, key: str) -> Step:
    """Return the step that adds what an extra names; in a sourced ROS, it has been looked for."""
    stamp = f'.made_from.{extra}'
    if machine.ros_is_sourced():
        return Step(ROOT / 'build' / stamp, key, lambda: None)
    name = f'requirements-{extra}'
    return Step(
        stamp=VENV / stamp,
        key=digest([ROOT / f'{name}.txt'], key),
        make=lambda: install(name, f'installing what `{extra}` needs'),
    )


def build_step(package: Path, key: str) -> Step:
    """Return the step that builds one package with colcon."""
    share = ROOT / 'install' / package.name / 'share' / package.name
    return Step(
        stamp=ROOT / 'build' / package.name / '.made_from',
        key=key,
        make=lambda: build(package),
        also=(share / 'package.sh', ROOT / 'install' / 'local_setup.sh'),
    )


def removal_step(package: Path, key: str) -> Step:
    """Return the step that leaves a package to the sourced ROS, whose own a build would hide."""
    folder = ROOT / 'build' / package.name

    def make() -> None:
        remove(package)
        folder.mkdir(parents=True)

    # The stamp of its build, so that either step is done again after the other.
    return Step(folder / '.made_from', key, make)


def files_in(folder: Path) -> Iterator[Path]:
    """Return every file in a folder, however deep."""
    return (path for path in folder.rglob('*') if path.is_file())


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
    """Make .venv anew and install what every target needs."""
    bare = [] if machine.has_module('ensurepip') else ['--without-pip']
    venv = [sys.executable, '-m', 'venv', '--clear', *bare, str(VENV)]
    log = LOGS / 'setup_venv.txt'
    if not progress.run(f'making .venv with Python {machine.version()}', venv, log):
        raise machine.SetupError(machine.why(log, f'.venv could not be made: see {log}.'))
    (VENV / 'COLCON_IGNORE').touch()  # colcon shall not look for packages in it
    (VENV / 'local_setup.sh').touch()  # colcon warns about a ROS prefix without one
    # First what builds a distribution without a wheel: no other build tool is taken.
    install('requirements-build', 'installing the build tools')
    install('requirements', 'installing ROS 2 Jazzy and the tools, about 200 MB')
    (VENV / 'made_with').write_text(sys.executable)


def install(name: str, title: str) -> None:
    """Install what one requirements file pins, and nothing that is not what was reviewed."""
    requirements = ROOT / f'{name}.txt'
    options = ['--no-input', '--disable-pip-version-check', '--progress-bar=off']
    options += ['--require-hashes', '--no-deps', '--no-build-isolation']
    command = [*pip(), 'install', *options, '-r', str(requirements)]
    # Constraints of the user's own would only stand against the pins.
    env = {name: value for name, value in os.environ.items() if name != 'PIP_BUILD_CONSTRAINT'}
    env |= {'PIP_CONSTRAINT': os.devnull, 'PIP_USER': '0'}
    log = LOGS / f'setup_{name}.txt'
    if not progress.run(title, command, log, progress.packages(requirements.read_text()), env):
        raise machine.SetupError(machine.pip_sentence(log))


def pip() -> list[str]:
    """Return the command that installs into .venv, also where venv could not put pip there."""
    own = str(VENV / 'bin' / 'python')
    if machine.has_module('ensurepip'):
        return [own, '-m', 'pip']
    return [sys.executable, '-m', 'pip', '--python', own]


def remove(package: Path) -> None:
    """Remove what was built of one package."""
    for folder in ('build', 'install'):
        shutil.rmtree(ROOT / folder / package.name, ignore_errors=True)


def build(package: Path) -> None:
    """Build one package from nothing."""
    remove(package)
    env = build_environment()
    python = sys.executable if machine.ros_is_sourced() else str(VENV / 'bin' / 'python')
    colcon = shutil.which('colcon', path=env['PATH']) or 'colcon'
    command = [colcon, 'build', '--base-paths', str(package.relative_to(ROOT))]
    command += ['--packages-select', package.name]
    command += ['--symlink-install', '--event-handlers', 'console_direct+', '--cmake-args']
    command += ['-DBUILD_TESTING=OFF', '-DCMAKE_BUILD_TYPE=Release']
    command += [f'-DPython3_EXECUTABLE={python}']
    log = LOGS / f'setup_{package.name}.txt'
    if not progress.run(f'building {package.name}', command, log, progress.percent, env):
        print(*log.read_text(errors='replace').splitlines()[-30:], sep='\n', file=sys.stderr)
        otherwise = f'{package.name} could not be built, as said above and in {log}.'
        raise machine.SetupError(machine.why(log, otherwise))


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


def setup(extras: Sequence[str]) -> None:
    """Do every step that is not done yet."""
    start = time.monotonic()
    open_steps = [step for step in steps(extras) if not step.is_done()]
    if not open_steps:
        return
    machine.check(ROOT, extras)
    for step in open_steps:
        step.do()
    say(f'done in {time.monotonic() - start:.0f} s')


def check_names(extras: Iterable[str]) -> None:
    """Raise SetupError for an extra that nothing is known about."""
    known = {path.stem.removeprefix('requirements-') for path in ROOT.glob('requirements-*.txt')}
    known -= {'build'}  # which every setup installs
    for extra in extras:
        if extra not in known:
            raise machine.SetupError(
                f"there is no extra '{extra}': choose from {', '.join(sorted(known))}."
            )


def main(extras: Sequence[str]) -> int:
    """Set the workspace up; every foreseeable failure is one sentence and a non-zero exit."""
    # All end alike, and what was started ends as well; nohup's wish is heeded.
    for number in progress.INTERRUPTIONS:
        if signal.getsignal(number) is not signal.SIG_IGN:
            signal.signal(number, signal.default_int_handler)
    try:
        check_names(extras)
        with alone():
            setup(extras)
    except (machine.SetupError, OSError) as error:
        for sentence in str(error).splitlines():
            print(f'setup: {sentence}', file=sys.stderr)
        return 1
    except KeyboardInterrupt:
        print('setup: interrupted; run the same command again to finish it', file=sys.stderr)
        return 130
    return 0


if __name__ == '__main__':
    sys.exit(main(sys.argv[1:]))
