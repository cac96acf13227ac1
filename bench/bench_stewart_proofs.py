"""The Stewart platform's proofs put to the test, by means that they do not share.

Errors against solutions in extended precision, ways against many small steps of another solver,
and radii against the other poses that fit the lengths.
python bench/bench_stewart_proofs.py [--quick]
"""

from __future__ import annotations

import argparse
import math
import os
import sys
from collections.abc import Sequence
from pathlib import Path

os.environ.setdefault('OPENBLAS_NUM_THREADS', '1')
import numpy as np
from rich.console import Console
from rich.progress import track

sys.path.insert(0, str(Path(__file__).parents[1] / 'src' / 'wrist_control'))

from wrist_control import make_wrist
from wrist_control.rotations import Pose, about_z, product, turned
from wrist_control.stewart.forward_kinematics import Status

WRIST = make_wrist('stewart')
FK = WRIST.forward_kinematics
HOME = WRIST.home.pose
PLATFORM, BASE = (np.array(x, dtype=np.longdouble) for x in (WRIST.platform, WRIST.base))
SHIFT, TURN = 0.1, 0.6
STEPS = 150

Frame = tuple[np.ndarray, np.ndarray]  # position, and rotation from platform to base, extended


def random_pose(rng: np.random.Generator, near_lock: bool) -> Pose:
    """Return a pose in the box, or one at home's height 0.1 to 10⁻⁶ rad from lock."""
    if near_lock:
        tilt = turned(HOME.quaternion, tuple(rng.uniform(-0.01, 0.01, 3).tolist()), 1.0)
        return Pose(
            product(about_z(0.5 * math.pi - 10 ** rng.uniform(-6, -1)), tilt), HOME.position
        )
    position = np.array(HOME.position) + rng.uniform(-SHIFT, SHIFT, 3)
    turn = tuple(rng.uniform(-TURN, TURN, 3).tolist())
    return Pose(turned(HOME.quaternion, turn, 1.0), tuple(position.tolist()))


def frame(pose: Pose) -> Frame:
    """Return a pose with a rotation that is orthogonal to extended precision."""
    rotation = np.array(pose.rotation.T, dtype=np.longdouble)
    return np.array(pose.position, dtype=np.longdouble), _orthogonal(rotation)


def _orthogonal(rotation: np.ndarray) -> np.ndarray:
    for _ in range(2):
        rotation = 0.5 * rotation @ (3.0 * np.eye(3) - rotation.T @ rotation)
    return rotation


def newton(at: Frame, lengths: np.ndarray) -> Frame:
    """Return the pose after one Newton step on the six lengths, base axes throughout."""
    d, rotation = at
    arms = PLATFORM @ rotation.T
    legs = d + arms - BASE
    found = np.sqrt((legs * legs).sum(axis=1))
    n = legs / found[:, None]
    lines = np.hstack([n, np.cross(arms, n)]).astype(float)
    change = np.linalg.solve(lines, (lengths - found).astype(float)).astype(np.longdouble)
    x, y, z = change[3:]
    turn = np.array([[0, -z, y], [z, 0, -x], [-y, x, 0]])
    return d + change[:3], _orthogonal(rotation + turn @ rotation + 0.5 * turn @ turn @ rotation)


def apart(one: Frame, other: Frame) -> float:
    """Return the distance in which proofs are stated, m."""
    turn = WRIST.size * (one[1] - other[1])[:, :2]
    return float(np.sqrt(((one[0] - other[0]) ** 2).sum() + (turn * turn).sum()))


def used_bound(pose: Pose) -> float:
    """Return the true error as a share of its bound; 0 where nothing is claimed."""
    lengths = tuple(WRIST.assembly_at(pose))
    solution = FK.solve(lengths, FK.solve(lengths, pose).pose)
    if solution.pose is None or not solution.error_bound < math.inf:
        return 0.0
    answer = frame(solution.pose)
    truth = answer
    for _ in range(4):
        truth = newton(truth, np.array(lengths, dtype=np.longdouble))
    return apart(answer, truth) / solution.error_bound


def way_misses(pose: Pose) -> float | None:
    """Return how far from the answer small steps from home end, m; None if not CONVERGED."""
    goal = np.array(WRIST.assembly_at(pose), dtype=np.longdouble)
    solution = FK.solve(tuple(goal.astype(float)))
    if solution.status != Status.CONVERGED:
        return None
    at, start = frame(HOME), np.array(WRIST.home, dtype=np.longdouble)
    # Steps shrink towards the goal: close to lock the pose goes like the root of what is left.
    for share in 1.0 - np.linspace(1.0, 0.0, STEPS + 1)[1:] ** 2:
        lengths = np.sqrt(start**2 + share * (goal**2 - start**2))
        for _ in range(5):
            at = newton(at, lengths)
    return apart(at, frame(solution.pose))


def closest_twin(pose: Pose) -> tuple[int, float]:
    """Return how many pairs of poses fit the lengths, and the least distance per radius."""
    found = FK.assemblies(tuple(WRIST.assembly_at(pose)))
    ratios = [
        apart(frame(one.pose), frame(other.pose)) / one.unique_radius
        for one in found
        for other in found
        if one is not other
    ]
    return len(ratios), min(ratios, default=math.inf)


def main(arguments: Sequence[str] | None = None) -> None:
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument('--quick', action='store_true', help='a tenth of the poses')
    scale = 1 if parser.parse_args(arguments).quick else 10
    rng = np.random.default_rng(7)
    poses = [random_pose(rng, near_lock=i % 5 == 0) for i in range(250 * scale)]
    used = max(used_bound(pose) for pose in track(poses, 'errors', transient=True))
    ways = [way_misses(pose) for pose in track(poses[: 40 * scale], 'ways', transient=True)]
    misses = [miss for miss in ways if miss is not None]
    twins = [closest_twin(pose) for pose in track(poses[: 40 * scale], 'twins', transient=True)]
    console = Console()
    console.print(f'{len(poses)} errors: at most {100 * used:.1f} % of a bound was used.')
    console.print(f'{len(misses)} ways called CONVERGED: at most {max(misses):.1e} m off.')
    console.print(
        f'{sum(n for n, _ in twins)} pairs with the same lengths: the closest at '
        f'{min(ratio for _, ratio in twins):.2f} radii.'
    )
    if used > 1.0 or max(misses) > 1e-9 or min(ratio for _, ratio in twins) < 1.0:
        raise SystemExit('A proof does not hold.')


if __name__ == '__main__':
    main()
