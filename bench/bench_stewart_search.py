"""How many poses the search finds for the lengths of a Stewart platform, beside chance.

No count here is more than a lower bound: a search proves what it finds, not that there is no more.
Chance is 70 solves of six legs at a time, from starts anywhere above the base.
python bench/bench_stewart_search.py [--n N]
"""

from __future__ import annotations

import argparse
import sys
from collections import Counter
from collections.abc import Sequence
from pathlib import Path
from time import perf_counter

import numpy as np
from rich.console import Console
from rich.progress import track
from rich.table import Table

sys.path.insert(0, str(Path(__file__).parents[1] / 'src' / 'wrist_control'))

from bench_stewart import FK, WRIST
from bench_stewart_convergence import box_poses

from wrist_control.rotations import Pose, unit
from wrist_control.stewart import assembly, general, stages

# Half-widths of the boxes around home: m, and rad of the rotation vector's components.
BOXES = {'±5 cm, ±0.3 rad': (0.05, 0.3), '±10 cm, ±0.6 rad': (0.10, 0.6)}
STARTS = 70
SAME = 1e-6  # m, in the distance that proofs are stated in
PLATFORMS = general.scaled(WRIST.platform, WRIST.base, WRIST.size)


def by_chance(lengths: tuple[float, ...], rng: np.random.Generator) -> list[Pose]:
    """Return the poses that random starts find for lengths."""
    goal, found = general.squares(PLATFORMS, lengths), []
    for _ in range(STARTS):
        x, y = rng.uniform(-0.2, 0.2, 2).tolist()
        quaternion = unit(tuple(rng.normal(size=4).tolist()))
        start = Pose(quaternion, (x, y, float(rng.uniform(0.05, 0.55))))
        one = general.solve_general(PLATFORMS, goal, stages.unknowns(start, WRIST.size))
        if one is not None and one.at[6] > 0.0:
            found.append(one)
    return [stages.pose_of(one.at, WRIST.size) for one in assembly.different(found)]


def on_homes_side(poses: Sequence[Pose]) -> int:
    home = WRIST.home.hadamard_ratio
    return sum(WRIST.assembly_at(pose).hadamard_ratio * home > 0.0 for pose in poses)


def row(box: str, shift: float, turn: float, n: int) -> list[str]:
    """Return one row of the table: what the search and chance find in a box of poses."""
    rng = np.random.default_rng(3)
    above: Counter[int] = Counter()
    searched = chance = missed = several = 0
    spent = 0.0
    for pose in track(box_poses(n, shift, turn, 1), box, n, transient=True):
        lengths = tuple(WRIST.assembly_at(pose))
        started = perf_counter()
        found = [one.pose for one in FK.assemblies(lengths) if one.pose is not None]
        spent += perf_counter() - started
        others = by_chance(lengths, rng)
        new = [one for one in others if all(FK.apart(one, two) > SAME for two in found)]
        searched, chance, missed = searched + len(found), chance + len(others), missed + len(new)
        several += on_homes_side(found + new) > 1
        above[len(found + new)] += 1
    counts = ', '.join(f'{count}: {above[count]}' for count in sorted(above))
    return [
        box,
        f'{100.0 * several / n:.1f} %',
        counts,
        str(searched),
        str(chance),
        str(missed),
        f'{1e3 * spent / n:.0f}',
    ]


def main(arguments: Sequence[str] | None = None) -> None:
    """Compare the search with chance, and show the table."""
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument('--n', type=int, default=400, help='poses for each box')
    n = parser.parse_args(arguments).n
    table = Table(title='lower bounds: there may be more poses than were found')
    for name in (
        'box around home',
        'at least two on this side of lock',
        'at least so many above the base: sets of lengths',
        'found by the search',
        'found by chance',
        'by chance alone',
        'ms a search',
    ):
        table.add_column(name)
    for box, (shift, turn) in BOXES.items():
        table.add_row(*row(box, shift, turn, n))
    Console(width=160).print(table)


if __name__ == '__main__':
    main()
