"""How often the Stewart platform's forward kinematics find the right pose, beside SciPy's.

Right is the pose that made the lengths; wrong is any other answer that is called a success. All
poses lie above the base on home's side of lock. python bench/bench_stewart_convergence.py [--n N]
"""

from __future__ import annotations

import argparse
import math
import sys
from collections.abc import Callable, Iterator, Sequence
from pathlib import Path
from typing import NamedTuple

import numpy as np
from rich.console import Console
from rich.progress import track
from rich.table import Table

sys.path.insert(0, str(Path(__file__).parents[1] / 'src' / 'wrist_control'))

from bench_stewart import BASE, FK, PLATFORM, WRIST, misses
from scipy.optimize import fsolve, least_squares
from scipy.spatial.transform import Rotation

from wrist_control.rotations import Pose, quaternion_of, turned, xyzw
from wrist_control.stewart.forward_kinematics import Status
from wrist_control.stewart.stages import unknowns
from wrist_control.studies.nguyen_angles import angles_of, partial_derivatives, pose_of

# Half-widths of the boxes around home: m, and rad of the rotation vector's components.
BOXES = {
    '±2 cm, ±0.2 rad': (0.02, 0.2),
    '±6 cm, ±0.5 rad': (0.06, 0.5),
    '±12 cm, ±0.8 rad': (0.12, 0.8),
    '±18 cm, ±1.1 rad': (0.18, 1.1),
}
# Hand speeds of the tracking runs, m/s and rad/s, at 100 Hz.
SPEEDS = {
    '0.1 m/s, 0.5 rad/s': (0.1, 0.5),
    '1 m/s, 5 rad/s': (1.0, 5.0),
    '4 m/s, 20 rad/s': (4.0, 20.0),
}
RATE = 100.0
CLOSE = 1e-6  # m, in the distance that proofs are stated in

Method = Callable[[tuple[float, ...], Pose], Pose | None]


class Score(NamedTuple):
    right: int
    wrong: int
    total: int

    def __str__(self) -> str:
        right, wrong = (100.0 * n / self.total for n in (self.right, self.wrong))
        return f'{right:.1f} | {wrong:.1f}'


def ours(lengths: tuple[float, ...], near: Pose) -> Pose | None:
    solution = FK.solve(lengths, near)
    return solution.pose if solution.status == Status.CONVERGED else None


def ours_unproven(lengths: tuple[float, ...], near: Pose) -> Pose | None:
    """Whatever pose there is in the answer: what a caller gets who does not look at the status."""
    return FK.solve(lengths, near).pose


def vector_of(pose: Pose) -> np.ndarray:
    return np.concatenate([pose.position, Rotation.from_quat(xyzw(pose.quaternion)).as_rotvec()])


def pose_from(x: np.ndarray) -> Pose:
    rotation = Rotation.from_rotvec(x[3:]).as_matrix()
    return Pose(quaternion_of(rotation.T), tuple(x[:3].tolist()))


def by_fsolve(lengths: tuple[float, ...], near: Pose) -> Pose | None:
    x, _, code, _ = fsolve(
        misses(np.array(lengths)), vector_of(near), full_output=True, xtol=1e-12
    )
    return pose_from(x) if code == 1 else None


def by_least_squares(lengths: tuple[float, ...], near: Pose) -> Pose | None:
    found = least_squares(misses(np.array(lengths)), vector_of(near), xtol=1e-14, ftol=1e-14)
    return pose_from(found.x) if found.success and found.cost < 1e-14 else None


def by_the_paper(lengths: tuple[float, ...], near: Pose) -> Pose | None:
    """Newton-Raphson on x, y, z and three angles, [Nguyen1991], section 4, corrected."""
    a = np.array([*near.position, *angles_of(near)])
    for _ in range(50):
        pose = pose_of(tuple(a[:3]), tuple(a[3:]))
        f = np.array(WRIST.assembly_at(pose)) ** 2 - np.array(lengths) ** 2
        if np.abs(f).sum() < 1e-12:
            return pose
        try:
            a = a - np.linalg.solve(partial_derivatives(PLATFORM, BASE, a[:3], tuple(a[3:])), f)
        except np.linalg.LinAlgError:
            return None
        if not np.abs(a).max() < 1e3:
            return None
    return None


METHODS: dict[str, Method] = {
    'ours, CONVERGED': ours,
    'ours, any pose': ours_unproven,
    'fsolve': by_fsolve,
    'least_squares': by_least_squares,
    'paper': by_the_paper,
}


def apart(one: Pose, other: Pose) -> float:
    return WRIST.size * math.dist(unknowns(one, WRIST.size), unknowns(other, WRIST.size))


def box_poses(n: int, shift: float, turn: float, seed: int) -> Iterator[Pose]:
    """Yield poses in a box around home, on home's side of lock and above the base."""
    rng, home, made = np.random.default_rng(seed), WRIST.home.pose, 0
    while made < n:
        pose = Pose(
            turned(home.quaternion, tuple(rng.uniform(-turn, turn, 3).tolist()), 1.0),
            tuple((np.array(home.position) + rng.uniform(-shift, shift, 3)).tolist()),
        )
        if WRIST.assembly_at(pose).hadamard_ratio * WRIST.home.hadamard_ratio > 0.0:
            made += 1
            yield pose


def score(method: Method, poses: Sequence[Pose], starts: Sequence[Pose]) -> Score:
    right = wrong = 0
    for pose, start in zip(poses, starts, strict=True):
        answer = method(tuple(WRIST.assembly_at(pose)), start)
        if answer is not None:
            near = apart(answer, pose) < CLOSE
            right, wrong = right + near, wrong + (not near)
    return Score(right, wrong, len(poses))


def flight(speed: float, turning: float, n: int) -> list[Pose]:
    """Return n poses of a wavy flight at 100 Hz, at most that fast."""
    waves = np.array([1.0, 1.3, 0.7, 1.1, 0.9, 1.2])
    reach = np.array([0.06, 0.06, 0.04, 0.3, 0.3, 0.4])
    pace = min(speed / (reach[:3] * waves[:3]).sum(), turning / (reach[3:] * waves[3:]).sum())
    z = WRIST.home.pose.position[2]
    found = []
    for t in np.arange(n) / RATE:
        x = reach * np.sin(pace * waves * t)
        found.append(pose_from(x + np.array([0.0, 0.0, z, 0.0, 0.0, 0.0])))
    return found


def tracked(method: Method, poses: Sequence[Pose]) -> Score:
    """Return how often a method keeps to a flight, each answer the start of the next."""
    right = wrong = 0
    before = poses[0]
    for pose in poses[1:]:
        answer = method(tuple(WRIST.assembly_at(pose)), before)
        if answer is not None:
            near = apart(answer, pose) < CLOSE
            right, wrong = right + near, wrong + (not near)
            before = answer
    return Score(right, wrong, len(poses) - 1)


def main(arguments: Sequence[str] | None = None) -> None:
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument('--n', type=int, default=500, help='poses for each number')
    n = parser.parse_args(arguments).n
    table = Table(title='right | wrong, % of the poses; the rest is called a failure')
    table.add_column('from')
    for name in METHODS:
        table.add_column(name, justify='right')
    for box, (shift, turn) in track(BOXES.items(), 'boxes', transient=True):
        poses = list(box_poses(n, shift, turn, 1))
        for label, starts in (
            ('home', [WRIST.home.pose] * n),
            ('random start in the box', list(box_poses(n, shift, turn, 2))),
        ):
            scores = [str(score(method, poses, starts)) for method in METHODS.values()]
            table.add_row(f'{label}, {box}', *scores)
    for name, (speed, turning) in track(SPEEDS.items(), 'tracking', transient=True):
        poses = flight(speed, turning, n)
        scores = [str(tracked(method, poses)) for method in METHODS.values()]
        table.add_row(f'the pose before, {name}', *scores)
    Console().print(table)


if __name__ == '__main__':
    main()
