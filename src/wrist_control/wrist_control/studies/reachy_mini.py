"""A Reachy Mini's head before its maker's own forward kinematics and model: `make reachy`.

The maker's packages are compared with and never depended on: without them a sentence says how to
get them. docs/results/reachy-mini.md holds what this prints. [ReachyMini].
"""

from __future__ import annotations

import importlib
import json
import math
import sys
import time
from collections.abc import Callable, Sequence
from functools import partial
from importlib.util import find_spec
from pathlib import Path
from typing import Any, NamedTuple

import numpy as np

from wrist_control.errors import InvalidValueError, UnreachableError, WristError
from wrist_control.rotations import IDENTITY, Pose, quaternion_of, turned
from wrist_control.stewart.forward_kinematics import Status
from wrist_control.wrists.rotary_stewart import RotaryStewart

POSES = 1000
# Limits of the maker's joints stewart_1 to stewart_6, rad.
LOWER = np.radians([-48.0, -80.0, -48.0, -80.0, -70.0, -80.0])
UPPER = np.radians([80.0, 70.0, 80.0, 48.0, 80.0, 48.0])
# How far poses are drawn from home, m and rad.
SHIFT, TURN = 0.03, 0.7
# Height of our base, amid the servos, above the maker's, at the foot, m.
RAISED = 0.0766333
# Where the head sleeps, of the maker's own seed: rows of its rotation, and its place, m.
SLEEP = ((0.911, 0.004, 0.413), (-0.004, 1.0, -0.001), (-0.413, -0.001, 0.911))
SLEEPS_AT = (-0.021, 0.001, 0.133 - RAISED)
# The maker's daemon makes so many steps for each reading; more show what it converges to.
ITERATIONS = (3, 10, 100)
# And so many where it goes on from the reading before, at the daemon's 50 Hz: s. The head swings
# about and along its axes with these, rad/s.
FOLLOWING = (1, 3)
PERIOD = 0.02
SWINGS = np.array([1.1, 1.7, 0.9, 1.3, 0.7, 2.1])
# An answer is right within this of the pose that the angles were made of, m and ‖ΔR‖: a hundred
# times what the maker's own dimensions are rounded to.
RIGHT = (1e-4, 2e-3)
MISSING = "The maker's packages are not here; `make reachy` fetches them, and compares with them."


class Row(NamedTuple):
    """What a solver made of all poses.

    Attributes:
        solver: Which, and with how many steps.
        seed: Where it started.
        right: Share of right answers.
        worst: The largest error of a right answer, m.
        microseconds: A solve took, the middle one of all.
    """

    solver: str
    seed: str
    right: float
    worst: float
    microseconds: float


class Maker:
    """The maker's solver, as its daemon sets it up."""

    def __init__(self) -> None:
        """Load the maker's packages.

        Raises:
            InvalidValueError: They are not here.
        """
        data = json.loads((_package() / 'assets' / 'kinematics_data.json').read_text('utf-8'))
        try:
            module: Any = importlib.import_module('reachy_mini_rust_kinematics')
        except ImportError as error:
            raise InvalidValueError(MISSING) from error
        self._solver = module.ReachyMiniRustKinematics(
            data['motor_arm_length'], data['rod_length']
        )
        for motor in data['motors']:
            place = np.linalg.inv(np.array(motor['T_motor_world'])).tolist()
            branch = 1 if motor['solution'] else -1
            self._solver.add_branch(motor['branch_position'], place, branch)

    def start(self, seed: np.ndarray) -> None:
        """Begin at a transform of the head, shape (4, 4)."""
        self._solver.reset_forward_kinematics(seed.tolist())

    def follow(self, iterations: int, angles: Sequence[float]) -> np.ndarray:
        """Return the head's transform after so many steps from where the solver is."""
        found: Any = None
        for _ in range(iterations):
            found = self._solver.forward_kinematics([*angles], 0.0)
        return np.array(found)

    def solve(self, seed: np.ndarray, iterations: int, angles: Sequence[float]) -> np.ndarray:
        """Return the head's transform that so many steps from a seed lead to, shape (4, 4)."""
        self.start(seed)
        return self.follow(iterations, angles)


def _package() -> Path:
    found = find_spec('reachy_mini')
    if found is None or not found.submodule_search_locations:
        raise InvalidValueError(MISSING)
    return Path(found.submodule_search_locations[0])


def transform(pose: Pose) -> np.ndarray:
    """Return a pose of ours as the maker gives it: from the foot, shape (4, 4)."""
    found = np.eye(4)
    found[:3, :3], found[:3, 3] = pose.rotation.T, pose.position
    found[2, 3] += RAISED
    return found


def asleep() -> Pose:
    """Return where the head sleeps, on the base of ours."""
    columns = np.array(SLEEP).T
    u = columns[0] / np.linalg.norm(columns[0])
    v = columns[1] - (columns[1] @ u) * u
    v /= np.linalg.norm(v)
    return Pose(quaternion_of(np.array([u, v, np.cross(u, v)])), SLEEPS_AT)


def places(wrist: RotaryStewart, count: int) -> list[tuple[Pose, tuple[float, ...]]]:
    """Return random poses within the joints' limits, with their angles; the same in every run."""
    rng = np.random.default_rng(0)
    found: list[tuple[Pose, tuple[float, ...]]] = []
    while len(found) < count:
        axis = rng.normal(size=3)
        rates = (axis * rng.uniform(0.0, TURN) / np.linalg.norm(axis)).tolist()
        place = np.array(wrist.home_pose.position) + rng.uniform(-SHIFT, SHIFT, 3)
        pose = Pose(turned(IDENTITY, (rates[0], rates[1], rates[2]), 1.0), tuple(place.tolist()))
        try:
            angles = np.array(tuple(wrist.assembly_at(pose)))
        except UnreachableError:
            continue
        if np.all(angles >= LOWER) and np.all(angles <= UPPER):
            found.append((pose, tuple(angles.tolist())))
    return found


def judged(
    solver: str,
    seed: str,
    chosen: Sequence[tuple[Pose, tuple[float, ...]]],
    solve: Callable[[tuple[float, ...]], np.ndarray | None],
) -> Row:
    """Return how a solver did at poses; None of it is an answer that it does not stand by."""
    off, seconds = [], []
    for pose, angles in chosen:
        begun = time.perf_counter()
        found = solve(angles)
        seconds.append(time.perf_counter() - begun)
        off.append((math.inf, math.inf) if found is None else _error(found, transform(pose)))
    place, turn = np.array(off).T
    right = (place <= RIGHT[0]) & (turn <= RIGHT[1])
    return Row(
        solver,
        seed,
        float(np.mean(right)),
        float(np.max(place[right], initial=0.0)),
        1e6 * float(np.median(seconds)),
    )


def _error(found: np.ndarray, true: np.ndarray) -> tuple[float, float]:
    place, turn = found[:3, 3] - true[:3, 3], found[:3, :3] - true[:3, :3]
    return float(np.linalg.norm(place)), float(np.linalg.norm(turn))


def compared(count: int = POSES) -> list[Row]:
    """Return how both solvers did, from home and from sleep.

    Raises:
        InvalidValueError: The maker's packages are not here.
    """
    maker, wrist, rows = Maker(), RotaryStewart(), []
    chosen = places(wrist, count)
    for name, seed in (('home', wrist.home_pose), ('sleep', asleep())):
        rows.append(judged('ours, with its proof', name, chosen, partial(_ours, wrist, seed)))
        for steps in ITERATIONS:
            solve = partial(maker.solve, transform(seed), steps)
            rows.append(judged(f"the maker's, {steps} steps", name, chosen, solve))
    way = path(wrist, count)
    rows.append(judged('ours, with its proof', 'the reading before', way, _Followed(wrist)))
    for steps in FOLLOWING:
        maker.start(transform(wrist.home_pose))
        solve = partial(maker.follow, steps)
        rows.append(judged(f"the maker's, {steps} steps", 'the reading before', way, solve))
    return rows


class _Followed:
    """Our solver from reading to reading."""

    def __init__(self, wrist: RotaryStewart) -> None:
        self._wrist, self._near = wrist, wrist.home_pose

    def __call__(self, angles: tuple[float, ...]) -> np.ndarray | None:
        found = self._wrist.solve(angles, self._near)
        if found.pose is None or found.status != Status.CONVERGED:
            return None
        self._near = found.pose
        return transform(found.pose)


def path(wrist: RotaryStewart, count: int) -> list[tuple[Pose, tuple[float, ...]]]:
    """Return readings of a head that looks around, with the poses that they are made of."""
    found, home = [], np.array(wrist.home_pose.position)
    for number in range(count):
        phases = SWINGS * number * PERIOD
        turn = (0.25 * np.sin(phases[:3])).tolist()
        place = home + 0.008 * np.sin(phases[3:])
        pose = Pose(turned(IDENTITY, (turn[0], turn[1], turn[2]), 1.0), tuple(place.tolist()))
        found.append((pose, tuple(wrist.assembly_at(pose))))
    return found


def _ours(wrist: RotaryStewart, near: Pose, angles: tuple[float, ...]) -> np.ndarray | None:
    found = wrist.solve(angles, near)
    if found.pose is None or found.status != Status.CONVERGED:
        return None
    return transform(found.pose)


def table(rows: Sequence[Row]) -> str:
    """Return rows as a table in Markdown."""
    lines = [
        '| solver | from | right | worst of these | a solve |',
        '| --- | --- | --- | --- | --- |',
    ]
    lines += [
        f'| {row.solver} | {row.seed} | {100.0 * row.right:.1f} % | {1e6 * row.worst:.2g} µm | '
        f'{row.microseconds:.0f} µs |'
        for row in rows
    ]
    return '\n'.join(lines)


def main() -> int:
    """Print the comparison."""
    sys.path += sys.argv[1:2]  # where the maker's packages are
    try:
        print(table(compared()))
    except WristError as error:
        print(error, file=sys.stderr)
        return 2
    return 0


if __name__ == '__main__':
    sys.exit(main())
