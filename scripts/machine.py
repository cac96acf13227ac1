"""What setup needs to find on a machine, and the sentences that say what is missing.

Every check returns one sentence, or None where all is well.
"""

from __future__ import annotations

import importlib.util
import os
import platform
import re
import shutil
import sys
import sysconfig
from collections.abc import Callable, Iterable
from pathlib import Path

DISTRO = 'jazzy'

COMPILERS = {
    'C': ('CC', ('cc', 'gcc', 'clang')),
    'C++': ('CXX', ('c++', 'g++', 'clang++')),
}

FROM_PIP = 'python3-pip'  # brings what can install a module that Ubuntu has no package of

# Where ROS 2 is sourced nothing is installed; these Ubuntu packages bring what must be there.
APT_OF_MODULE = {
    'PIL': 'python3-pil',
    'ament_index_python': 'ros-jazzy-ament-index-python',
    'diagnostic_msgs': 'ros-jazzy-common-interfaces',
    'geometry_msgs': 'ros-jazzy-common-interfaces',
    'matplotlib': 'python3-matplotlib',
    'numpy': 'python3-numpy',
    'rclpy': 'ros-jazzy-rclpy',
    'rich': 'python3-rich',
    'sensor_msgs': 'ros-jazzy-common-interfaces',
    'std_msgs': 'ros-jazzy-common-interfaces',
    'std_srvs': 'ros-jazzy-common-interfaces',
    'tf2_msgs': 'ros-jazzy-tf2-msgs',
    'visualization_msgs': 'ros-jazzy-common-interfaces',
}
APT_OF_EXTRA = {
    'console': {'nicegui': FROM_PIP},
    'docs': {
        'furo': 'furo',
        'latex2mathml': FROM_PIP,
        'myst_parser': 'python3-myst-parser',
        'sphinx': 'python3-sphinx',
    },
    'physics': {'mujoco': FROM_PIP},
    'record': {'mcap': FROM_PIP, 'rosbags': FROM_PIP},
    'test': {
        'coverage': 'python3-coverage',
        'hypothesis': 'python3-hypothesis',
        'pytest': 'python3-pytest',
        'pytest_timeout': 'python3-pytest-timeout',
        'scipy': 'python3-scipy',
        'xdist': 'python3-pytest-xdist',
    },
}
APT_OF_PROGRAM = {'cmake': 'cmake', 'colcon': 'python3-colcon-common-extensions'}
APT_OF_ROS_PACKAGE = {
    'ament_cmake': 'ros-jazzy-ament-cmake',
    'rosidl_default_generators': 'ros-jazzy-rosidl-default-generators',
}


class SetupError(Exception):
    """Something that the user has to put right, in one sentence."""


def ros_is_sourced() -> bool:
    """Tell whether this shell already has a ROS in it."""
    return bool(os.environ.get('ROS_DISTRO'))


def version() -> str:
    """Return the version of the Python that runs."""
    return platform.python_version()


def has_module(name: str) -> bool:
    """Tell whether a module can be imported, without importing it."""
    return importlib.util.find_spec(name) is not None


def check(root: Path, extras: Iterable[str]) -> None:
    """Raise SetupError with a sentence for everything that is missing here."""
    checks: list[Callable[[], str | None]] = [lambda: path_problem(root)]
    if ros_is_sourced():
        checks += [lambda: distro_problem() or ros_problem(extras)]
    else:
        checks += [platform_problem, pip_problem]
    checks += [compiler_problem, header_problem]
    sentences = [sentence for find in checks if (sentence := find())]
    if sentences:
        raise SetupError('\n'.join(sentences))


def path_problem(root: Path) -> str | None:
    """CMake, colcon and the first lines of scripts do not survive blanks in a path."""
    if not any(character.isspace() for character in str(root)):
        return None
    return f"this folder's path has a blank in it, '{root}': move it to a path without blanks."


def platform_problem() -> str | None:
    """ROS 2 Jazzy has wheels for one platform only."""
    libc, libc_version = platform.libc_ver()
    found = f'{platform.system()} on {platform.machine()} with {libc or "no glibc"} {libc_version}'
    modern = libc == 'glibc' and tuple(map(int, libc_version.split('.'))) >= (2, 28)
    if platform.system() == 'Linux' and platform.machine() == 'x86_64' and modern:
        return None
    return (
        'the wheels of ROS 2 Jazzy are for Linux on x86_64 with glibc 2.28 or newer, but this is '
        f'{found.rstrip()}: install ROS 2 Jazzy itself and source it, or use such a machine.'
    )


def pip_problem() -> str | None:
    """Without venv and pip there is nothing to install the wheels into, or with."""
    if has_module('venv') and (has_module('ensurepip') or pip_reaches_elsewhere()):
        return None
    missing = 'ensurepip and pip' if has_module('venv') else 'venv'
    return (
        f'Python {version()} at {sys.executable} comes without {missing}: install it, on Ubuntu '
        'or Debian with `sudo apt install python3-venv`.'
    )


def pip_reaches_elsewhere() -> bool:
    """Tell whether this Python's pip can install into an environment that has no pip."""
    if not has_module('pip'):
        return False
    from pip import __version__ as pip_version

    return tuple(map(int, pip_version.split('.')[:2])) >= (22, 3)


def compiler_problem() -> str | None:
    """The messages are compiled, as C and as C++."""
    missing = []
    for language, (variable, programs) in COMPILERS.items():
        named = os.environ.get(variable, '').split()[:1]
        if not any(shutil.which(program) for program in named or programs):
            missing.append(f'{language} (looked for {", ".join(named or programs)})')
    if not missing:
        return None
    return (
        f'no compiler found for {" and ".join(missing)}: install one, on Ubuntu or Debian with '
        '`sudo apt install build-essential`.'
    )


def header_problem() -> str | None:
    """The Python side of the messages is compiled against Python's own headers."""
    header = Path(sysconfig.get_path('include')) / 'Python.h'
    if header.is_file():
        return None
    return (
        f'Python {version()} at {sys.executable} comes without its C headers ({header} is not '
        'there): install them, on Ubuntu or Debian with `sudo apt install python3-dev`.'
    )


def distro_problem() -> str | None:
    """Other distributions of ROS have other interfaces."""
    distro = os.environ['ROS_DISTRO']
    if distro == DISTRO:
        return None
    return (
        f"ROS_DISTRO is '{distro}', but wrist_control is written for ROS 2 Jazzy: source "
        '/opt/ros/jazzy/setup.bash, or use a shell without ROS to have Jazzy installed as wheels.'
    )


def ros_problem(extras: Iterable[str]) -> str | None:
    """A sourced ROS must have everything, since nothing is installed beside it."""
    prefixes = [Path(path) for path in os.environ.get('AMENT_PREFIX_PATH', '').split(':') if path]
    if not prefixes:
        return (
            'ROS_DISTRO is set but AMENT_PREFIX_PATH is empty, so ROS 2 is only half sourced: '
            f'run `. /opt/ros/{DISTRO}/setup.sh` first.'
        )
    missing = {
        **absent(APT_OF_PROGRAM, shutil.which),
        **absent(APT_OF_ROS_PACKAGE, lambda name: is_ros_package(name, prefixes)),
        **absent(APT_OF_MODULE, has_module),
    }
    for extra in extras:
        missing |= absent(APT_OF_EXTRA.get(extra, {}), has_module)
    if not missing:
        return None
    packages = ' '.join(sorted(set(missing.values())))
    unpackaged = ', '.join(name for name, apt in missing.items() if apt == FROM_PIP)
    return (
        f'ROS 2 {DISTRO} is sourced, so nothing is installed, but {sys.executable} lacks '
        f'{", ".join(missing)}: run `sudo apt install {packages}`'
        f'{unpackaged and f", and install {unpackaged} with its pip"}.'
    )


def absent(apt_of: dict[str, str], is_there: Callable[[str], object]) -> dict[str, str]:
    """Return the part of a table whose names are not there."""
    return {name: apt for name, apt in apt_of.items() if not is_there(name)}


def is_ros_package(name: str, prefixes: Iterable[Path]) -> bool:
    """Tell whether a ROS package is installed under one of the prefixes."""
    return any((prefix / 'share' / name / 'package.xml').is_file() for prefix in prefixes)


# What pip writes when it cannot reach an index at all, or when the index lacks a version.  It may
# speak of a conflict then, although pinned versions, installed without their needs, have none.
NOT_DOWNLOADED = (
    'NewConnectionError',
    'NameResolutionError',
    'ConnectTimeoutError',
    'ReadTimeoutError',
    'ProxyError',
    'SSLError',
    'Connection refused',
    'Network is unreachable',
    'No matching distribution',
    'ResolutionImpossible',
)


FULL_DISK = ('No space left on device', 'Disk quota exceeded')


def why(log: Path, otherwise: str) -> str:
    """Say why a command failed: for want of space if its output says so, or otherwise."""
    if any(sign in log.read_text(errors='replace') for sign in FULL_DISK):
        return (
            'there is no space left on a disk: setup needs about 1 GB in this folder, and pip '
            f'some in its cache and in TMPDIR; make room and run this again (output: {log}).'
        )
    return otherwise


def pip_sentence(log: Path) -> str:
    """Say in one sentence why pip failed, as far as its output tells."""
    output = log.read_text(errors='replace')
    if 'DO NOT MATCH THE HASHES' in output:
        others = ', '.join(re.findall(r'^ {4}([\w.-]+==[\w.]+)', output, re.MULTILINE))
        return (
            f'what was downloaded as {others or "one of the packages"} is not what was reviewed: '
            'its hash is not in the requirements file, so it was not installed. Find out who '
            f"changed it, there or on the way, before you go on (pip's output: {log})."
        )
    if any(sign in output for sign in NOT_DOWNLOADED):
        return (
            'the Python packages could not be downloaded, since the package index could not be '
            'reached or does not have them: connect to the network, or set PIP_INDEX_URL or '
            f"HTTPS_PROXY as your network needs it, and run this again (pip's output: {log})."
        )
    errors = [line for line in output.splitlines() if line.startswith('ERROR:')]
    reason = errors[0] if errors else 'nothing about why'
    return why(
        log, f'pip could not install the packages, and says "{reason}" (its output: {log}).'
    )
