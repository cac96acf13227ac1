"""Check the code with ruff and mypy.

Where ROS 2 is sourced nothing is installed, so either may be missing or of another version, which
finds other things: then it is left out, with a sentence that says so.
"""

from __future__ import annotations

import subprocess
import sys
from importlib import metadata
from pathlib import Path

ROOT = Path(__file__).resolve().parent.parent

CHECKS = {
    'ruff': (['check'], ['format', '--check', '--quiet']),
    'mypy': ([],),
}


def pinned(tool: str) -> str:
    """Return the version of a tool that the code is written for."""
    for line in (ROOT / 'requirements-test.txt').read_text().splitlines():
        if line.startswith(f'{tool}=='):
            return line.split()[0].split('==')[1]
    raise LookupError(f'requirements-test.txt does not name {tool}')


def installed(tool: str) -> str:
    """Return the version of a tool that is there."""
    try:
        return metadata.version(tool)
    except metadata.PackageNotFoundError:
        return 'not installed'


def check(tool: str) -> bool:
    """Run one tool, and tell whether it found nothing wrong."""
    found, wanted = installed(tool), pinned(tool)
    if found != wanted:
        print(f'lint: {tool} is left out, since it is {found}; version {wanted} is needed')
        return True
    # A sum, since every command shall run, also after one that found something.
    commands = ([sys.executable, '-m', tool, *options] for options in CHECKS[tool])
    print(f'lint: {tool}', flush=True)
    return not sum(subprocess.run(command, cwd=ROOT).returncode for command in commands)


if __name__ == '__main__':
    failures = [tool for tool in CHECKS if not check(tool)]
    sys.exit(bool(failures))
