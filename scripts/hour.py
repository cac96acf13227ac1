"""An hour of simulated stick motion for each wrist: does anything drift, does memory grow?

The hand follows random sticks, as joints do that cannot change their rates at once. What it has
achieved is added up a second time, by products of rotation matrices: after an hour both must say
the same. Memory is what the process has taken at most, after a tenth of the way and at its end.
"""

from __future__ import annotations

import argparse
import math
import multiprocessing
import os
import resource
import sys
from collections.abc import Callable, Sequence
from functools import partial
from typing import NamedTuple

import numpy as np
from rich.console import Console
from rich.progress import Progress
from rich.table import Table

from wrist_control import WRISTS, make_wrist
from wrist_control.resolving import start, step
from wrist_control.testing.eased import sluggish
from wrist_control.testing.places import random_twist
from wrist_control.wrists import Wrist

HOUR = 3600.0  # s
RATE = 100.0  # steps per second
HELD = 37  # steps that each stick is held for
STICKS = (0.0, 0.1, 0.4, 1.0)  # rad/s
FASTEST = {'revolute': math.radians(32.0), 'prismatic': 0.05}
MOST_DRIFT = 1e-9  # rad, of any entry of a rotation matrix, and m
MOST_GROWTH = 1024  # KiB, less than one byte for each hundred steps


class Drift(NamedTuple):
    """What an hour has done to one wrist.

    Attributes:
        name: Which wrist.
        rotation: Largest difference of the two rotation matrices, rad.
        norm: By how much the quaternion's length differs from 1.
        joints: Largest difference of the hand's pose from that of the joints, rad and m.
        moved: Mean scale factor: it was not at rest all the time.
        growth: By how much the process has grown, KiB.
    """

    name: str
    rotation: float
    norm: float
    joints: float
    moved: float
    growth: int

    @property
    def good(self) -> bool:
        """Whether nothing drifts, nothing grows, and the hand has moved."""
        drift = max(self.rotation, self.norm, self.joints)
        return drift < MOST_DRIFT and self.growth <= MOST_GROWTH and self.moved > 0.1


def limited(name: str) -> Wrist:
    """Return a wrist with the limits of a resolver that is told none."""
    wrist = make_wrist(name)
    return sluggish(wrist.with_limits(rates=[FASTEST[joint.kind] for joint in wrist.joints]))


def rotation_of(turn: np.ndarray) -> np.ndarray:
    """Return the matrix that takes axes of before to axes of after a turn, by Rodrigues' rule."""
    angle = float(np.linalg.norm(turn))
    if angle == 0.0:
        return np.eye(3)
    x, y, z = turn / angle
    cross = np.array([[0.0, -z, y], [z, 0.0, -x], [-y, x, 0.0]])
    return np.eye(3) - math.sin(angle) * cross + (1.0 - math.cos(angle)) * (cross @ cross)


def held_for(name: str, duration: float, seed: int = 1) -> Drift:
    """Hold a stick for a time, and return what has drifted.

    Args:
        name: Which wrist.
        duration: s, in steps of 0.01 s.
        seed: Chooses the sticks.
    """
    wrist, random = limited(name), np.random.default_rng(seed)
    state = start(wrist)
    rotation = state.pose.rotation.copy()
    steps, followed, before = round(duration * RATE), 0.0, 0
    twist: Sequence[float] = ()
    for number in range(steps):
        if number % HELD == 0:
            twist = random_twist(wrist, random, float(random.choice(STICKS)))
        if number == steps // 10:
            before = _taken()
        taken = step(wrist, state, twist, 1.0 / RATE)
        state = taken.state
        followed += taken.scale_factor
        rotation = rotation_of(np.array(taken.achieved[3:]) / RATE) @ rotation
    there = wrist.forward(state.positions)
    apart = np.abs(np.subtract(there.position, state.pose.position))
    return Drift(
        name,
        rotation=float(np.abs(rotation - state.pose.rotation).max()),
        norm=abs(float(np.linalg.norm(state.pose.quaternion)) - 1.0),
        joints=float(max(apart.max(), np.abs(there.rotation - state.pose.rotation).max())),
        moved=followed / steps,
        growth=_taken() - before,
    )


def _taken() -> int:
    return resource.getrusage(resource.RUSAGE_SELF).ru_maxrss


def held_by_all(duration: float, told: Callable[[Drift], object]) -> list[Drift]:
    """Hold a stick for every wrist, each in a process of its own; tell of each that is done."""
    found = {}
    with multiprocessing.Pool(os.cpu_count(), maxtasksperchild=1) as pool:
        for drift in pool.imap_unordered(partial(held_for, duration=duration), WRISTS):
            found[drift.name] = drift
            told(drift)
    return [found[name] for name in WRISTS]


def main() -> int:
    """Hold the sticks, and show what has drifted."""
    parser = argparse.ArgumentParser(description=(__doc__ or '').splitlines()[0])
    parser.add_argument('--seconds', type=float, default=HOUR, help='simulated, for each wrist')
    options = parser.parse_args()
    console = Console()
    with Progress(console=console) as progress:
        task = progress.add_task('wrists', total=len(WRISTS))
        advance = partial(progress.advance, task)
        found = held_by_all(options.seconds, lambda _: advance())
    table = Table('wrist', 'rotation', 'norm', 'joints and hand', 'mean F', 'grown by')
    for name, rotation, norm, joints, moved, growth in found:
        cells = (f'{rotation:.1e} rad', f'{norm:.1e}', f'{joints:.1e}', f'{moved:.2f}')
        table.add_row(name, *cells, f'{growth} KiB')
    console.print(table)
    return 0 if all(drift.good for drift in found) else 1


if __name__ == '__main__':
    sys.exit(main())
