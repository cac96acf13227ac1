"""`python -m wrist_control`: what there is, and what more could be installed."""

from __future__ import annotations

import sys
import textwrap
from collections.abc import Iterable, Iterator
from importlib import metadata
from importlib.util import find_spec

from wrist_control.operating.maneuvers import MANEUVERS
from wrist_control.wrists import wrist_names

PACKAGE = 'wrist_control'
WIDTH = 79
INDENT = 13
# What the rest of the package imports beside numpy, and what it is needed for.
FIGURES = ('matplotlib', 'PIL', 'rich')
PHYSICS = ('mujoco',)
ROS = ('rclpy', 'wrist_interfaces')

EXAMPLE = f"""\
  from {PACKAGE} import fly
  flight = fly('three_gimbal', 'basic_test', joint_rate_limits=0.5)
  print(flight.time_lost[-1], 's lost in gimbal lock')
"""


def version() -> str:
    """Return the version that is installed."""
    try:
        return metadata.version(PACKAGE)
    except metadata.PackageNotFoundError:
        return '(not installed: run from its source)'


def missing(modules: Iterable[str]) -> list[str]:
    """Return which of some modules cannot be imported here."""
    return [module for module in modules if find_spec(module) is None]


def figures() -> str:
    """Say whether figures can be drawn."""
    absent = missing(FIGURES)
    if absent:
        return f"without {', '.join(absent)}: pip install '{PACKAGE}[figures]'"
    return f'python -m {PACKAGE}.studies.compare flies every wrist and draws them side by side'


def physics() -> str:
    """Say whether MuJoCo can move the wrists."""
    absent = missing(PHYSICS)
    if absent:
        return f"without {', '.join(absent)}: pip install '{PACKAGE}[physics]'"
    return f'python -m {PACKAGE}.studies.judge lets MuJoCo judge the kinematics'


def ros() -> str:
    """Say whether there are nodes to run."""
    absent = missing(ROS)
    if absent:
        return (
            f'without {", ".join(absent)}: source ROS 2 Jazzy and build the workspace with colcon'
        )
    return f'ros2 run {PACKAGE} three_gimbal_resolver; one <wrist>_resolver for every wrist'


def lines() -> Iterator[str]:
    """Give everything that is said."""
    yield f'{PACKAGE} {version()}: turns a robot hand by its own axes'
    yield ''
    told = {
        'wrists': ', '.join(wrist_names()),
        'maneuvers': ', '.join(MANEUVERS),
        'figures': figures(),
        'physics': physics(),
        'ROS 2': ros(),
    }
    for name, text in told.items():
        first, blank = f'  {name}'.ljust(INDENT), ' ' * INDENT
        yield textwrap.fill(text, WIDTH, initial_indent=first, subsequent_indent=blank)
    yield ''
    yield EXAMPLE


if __name__ == '__main__':
    sys.stdout.write('\n'.join(lines()))
