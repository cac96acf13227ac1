"""How fast the Stewart platform's forward kinematics are, as ratios within one run.

Every way solves the same lengths, each from the pose before: ours from its own answer there, and
from a pose that is equal to it, where what it knew about that answer does not help. Each is timed
in turns with the others, by the time that the processor gave it, and the best turn counts.
python bench/bench_stewart.py [--quick]
"""

from __future__ import annotations

import argparse
import os
import sys
import time
from collections.abc import Callable, Sequence
from functools import partial
from pathlib import Path

os.environ.setdefault('OPENBLAS_NUM_THREADS', '1')  # one thread is what is timed
import numpy as np
from rich.console import Console
from rich.progress import track
from rich.table import Table

sys.path.insert(0, str(Path(__file__).parents[1] / 'src' / 'wrist_control'))

from scipy.optimize import fsolve, least_squares
from scipy.spatial.transform import Rotation

from wrist_control import make_wrist
from wrist_control.rotations import Pose, Poses, turned, xyzw
from wrist_control.stewart import batch

WRIST = make_wrist('stewart')
FK = WRIST.forward_kinematics
PLATFORM, BASE = np.array(WRIST.platform), np.array(WRIST.base)
# A closed way through ±6 cm and ±0.3 rad around home, in as many samples at 100 Hz: the hand moves
# at 0.1 m/s and 0.5 rad/s, root mean square.
SHIFT, TURN, SAMPLES = 0.06, 0.3, 1000
# Solves in one turn: so few that other programs seldom come between.
ROWS = 20

OURS = 'ours, from its last answer'

Way = Callable[[int], tuple[np.ndarray, np.ndarray]]


class Problem:
    """Poses on a closed way, their lengths, and for each the pose one step before."""

    def __init__(self) -> None:
        home = WRIST.home.pose
        phases = 2.0 * np.pi * np.outer(np.arange(SAMPLES) / SAMPLES, [1, 2, 3, 2, 3, 1])
        along = np.sin(phases + np.arange(6.0))
        self.poses = [
            Pose(
                turned(home.quaternion, tuple((TURN * a[3:]).tolist()), 1.0),
                tuple((np.array(home.position) + SHIFT * a[:3]).tolist()),
            )
            for a in along
        ]
        self.before = self.poses[-1:] + self.poses[:-1]
        self.lengths = [tuple(WRIST.assembly_at(pose)) for pose in self.poses]
        self.rotvec = [self._vector(pose) for pose in self.before]

    @staticmethod
    def _vector(pose: Pose) -> np.ndarray:
        return np.concatenate(
            [pose.position, Rotation.from_quat(xyzw(pose.quaternion)).as_rotvec()]
        )


def misses(lengths: np.ndarray) -> Callable[[np.ndarray], np.ndarray]:
    """Return what a general solver is given: six lengths of a position and rotation vector."""

    def miss(x: np.ndarray) -> np.ndarray:
        angle2 = x[3] * x[3] + x[4] * x[4] + x[5] * x[5]
        angle = angle2**0.5
        a, b = (np.sin(angle) / angle, (1 - np.cos(angle)) / angle2) if angle else (1.0, 0.5)
        cross = np.array([[0.0, -x[5], x[4]], [x[5], 0.0, -x[3]], [-x[4], x[3], 0.0]])
        rotation = np.eye(3) + a * cross + b * (cross @ cross)
        legs = x[:3] + PLATFORM @ rotation.T - BASE
        return np.sqrt((legs * legs).sum(axis=1)) - lengths

    return miss


def misses_as_written(lengths: np.ndarray, loop: bool) -> Callable[[np.ndarray], np.ndarray]:
    """Return the same as it is usually written: SciPy's rotations, legs in a loop or at once."""

    def miss(x: np.ndarray) -> np.ndarray:
        rotation = Rotation.from_rotvec(x[3:]).as_matrix()
        if not loop:
            return np.linalg.norm(x[:3] + PLATFORM @ rotation.T - BASE, axis=1) - lengths
        legs = [x[:3] + rotation @ p - b for p, b in zip(PLATFORM, BASE, strict=True)]
        return np.array([np.linalg.norm(leg) for leg in legs]) - lengths

    return miss


def ways(problem: Problem) -> dict[str, Way]:
    """Return everything that is compared: the row of a problem to position and rotation."""
    matrices = np.random.default_rng(1).normal(size=(6, 6))
    side = np.ones(6)

    answer = problem.before[0]

    def tracked(row: int) -> Pose:
        nonlocal answer
        answer = FK.solve(problem.lengths[row], answer).pose
        return answer

    def from_any(row: int) -> Pose:
        return FK.solve(problem.lengths[row], problem.before[row]).pose

    def numpy_solve(row: int) -> None:
        np.linalg.solve(matrices, side)

    def by_fsolve(row: int) -> np.ndarray:
        return fsolve(misses(np.array(problem.lengths[row])), problem.rotvec[row], xtol=1e-12)

    def by_fsolve_as_written(row: int, loop: bool = False) -> np.ndarray:
        miss = misses_as_written(np.array(problem.lengths[row]), loop)
        return fsolve(miss, problem.rotvec[row], xtol=1e-12)

    def by_least_squares(row: int) -> np.ndarray:
        miss = misses(np.array(problem.lengths[row]))
        return least_squares(
            miss, problem.rotvec[row], xtol=1e-14, ftol=1e-14, gtol=1e-14, method='lm'
        ).x

    return {
        OURS: tracked,
        'numpy.linalg.solve, one 6×6': numpy_solve,
        'scipy fsolve, legs in a loop': partial(by_fsolve_as_written, loop=True),
        # Not next to the other one, which would warm the processor's cache for it.
        'ours, from any pose near by': from_any,
        'scipy fsolve, legs at once': by_fsolve_as_written,
        'scipy fsolve, tuned by hand': by_fsolve,
        'scipy least_squares (lm), tuned': by_least_squares,
    }


def best_times(found: dict[str, Way], rows: int, turns: int) -> dict[str, float]:
    """Return the best time per call of each way, s."""
    best = dict.fromkeys(found, float('inf'))
    for turn in track(range(turns), 'one by one', transient=True):
        for name, way in found.items():
            chosen = [(turn * ROWS + row) % rows for row in range(ROWS)]
            began = time.thread_time()
            for row in chosen:
                way(row)
            best[name] = min(best[name], (time.thread_time() - began) / ROWS)
    return best


def worst_errors(found: dict[str, Way], problem: Problem) -> dict[str, float]:
    """Return the largest error of each way relative to the pose, position and rotation."""
    worst = {}
    for name, way in found.items():
        if 'numpy' in name:
            continue
        errors = []
        for row, pose in enumerate(problem.poses):
            answer = way(row)
            if isinstance(answer, Pose):
                d, rotation = np.array(answer.position), answer.rotation.T
            else:
                d, rotation = answer[:3], Rotation.from_rotvec(answer[3:]).as_matrix()
            size = np.linalg.norm(pose.position)
            errors.append(np.abs(d - pose.position).max() / size)
            errors.append(np.abs(rotation - pose.rotation.T).max())
        worst[name] = max(errors)
    return worst


def batch_times(problem: Problem, n: int, turns: int) -> tuple[float, float, float]:
    """Return the time per pose of a batch: all of it, its Newton steps, and its proofs, s."""
    repeat = -(-n // len(problem.poses))
    lengths = np.tile(problem.lengths, (repeat, 1))[:n]
    near = Poses(
        np.tile([p.quaternion for p in problem.before], (repeat, 1))[:n],
        np.tile([p.position for p in problem.before], (repeat, 1))[:n],
    )
    whole, solving, proving = [], [], []
    for _ in track(range(turns), 'batches', transient=True):
        began = time.thread_time()
        found = FK.solve_batch(lengths, near)
        whole.append(time.thread_time() - began)
        assert (found.status == 0).all()
        newton = prove = 0.0
        for part in batch.chunks(n):
            start = batch.unknowns_of(near, FK.size, part)
            began = time.thread_time()
            roots = batch.newton(FK.planar, batch.right_sides(FK.planar, lengths[part]), start)
            between = time.thread_time()
            batch.prove(FK.planar, roots, start)
            newton += between - began
            prove += time.thread_time() - between
        solving.append(newton)
        proving.append(prove)
    return min(whole) / n, min(solving) / n, min(proving) / n


def main(arguments: Sequence[str] | None = None) -> None:
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument('--quick', action='store_true', help='fewer turns')
    quick = parser.parse_args(arguments).quick
    problem = Problem()
    found = ways(problem)
    times = best_times(found, len(problem.poses), 10 if quick else 100)
    errors = worst_errors(found, problem)
    ours = times[OURS]
    table = Table(
        title='Stewart platform, 1 mm and 5 mrad from the pose before; ours with its proof'
    )
    for heading in ('', 'µs', '÷ ours', 'largest error, relative'):
        table.add_column(heading, justify='left' if not heading else 'right')
    for name, seconds in times.items():
        error = f'{errors[name]:.1e}' if name in errors else ''
        table.add_row(name, f'{1e6 * seconds:.1f}', f'{seconds / ours:.2f}', error)
    n = 20_000 if quick else 100_000
    whole, solving, proving = batch_times(problem, n, 3 if quick else 8)
    table.add_section()
    for name, seconds in (
        (f'ours, batch of {n:,}, per pose', whole),
        ('  its Newton steps', solving),
        ('  its proofs', proving),
    ):
        table.add_row(name, f'{1e6 * seconds:.2f}', f'{seconds / ours:.3f}', '')
    Console().print(table)
    Console().print(f'Proofs ÷ Newton steps of the batch: {proving / solving:.2f}.')


if __name__ == '__main__':
    main()
