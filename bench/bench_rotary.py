"""How fast a platform's forward kinematics follow while its base anchors move, as ratios.

A Reachy Mini's head and the linear platform follow the same swings, each from its own answer
before; and the head's from a pose that is equal to it, where nothing is remembered. Each is timed
in turns with the others, by the time that the processor gave it, and the best turn counts.
python bench/bench_rotary.py
"""

from __future__ import annotations

import os
import sys
import time
from pathlib import Path

os.environ.setdefault('OPENBLAS_NUM_THREADS', '1')  # one thread is what is timed
import numpy as np

sys.path.insert(0, str(Path(__file__).parents[1] / 'src' / 'wrist_control'))

from wrist_control import make_wrist
from wrist_control.rotations import Pose, turned
from wrist_control.stewart.forward_kinematics import ForwardKinematics, Status
from wrist_control.wrists.platform import Platform

SAMPLES, TURNS, ROWS = 200, 200, 20
# The hand swings with these, rad/s, by this much, rad, and by a quarter of the platform's size.
SWINGS, TURN, SHIFT = np.array([1.1, 1.7, 0.9, 1.3, 0.7, 2.1]), 0.25, 0.25


class Way:
    """Readings of a platform that swings, with the pose before each.

    Attributes:
        name: What is timed.
        wrist: The platform.
    """

    def __init__(self, name: str, wrist: Platform, period: float, warm: bool = True) -> None:
        self.name, self.wrist, self._warm = name, wrist, warm
        home, self._readings = wrist.home_pose, []
        for number in range(SAMPLES):
            phases = np.sin(SWINGS * number * period)
            p, q, r = (TURN * phases[:3]).tolist()
            x, y, z = (np.array(home.position) + SHIFT * wrist.size * phases[3:]).tolist()
            pose = Pose(turned(home.quaternion, (p, q, r), 1.0), (x, y, z))
            self._readings.append((tuple(wrist.assembly_at(pose)), pose))

    def microseconds(self, first: int) -> float:
        """Return what a solve took, of some rows in a row."""
        near = self._readings[first][1]
        near = self.wrist.solve(self._readings[first][0], near).pose or near
        seconds = 0.0
        for positions, pose in self._readings[first + 1 : first + 1 + ROWS]:
            start = near if self._warm else Pose(*near)
            begun = time.thread_time()
            found = self.wrist.solve(positions, start)
            seconds += time.thread_time() - begun
            assert found.pose is not None
            assert found.status == Status.CONVERGED
            assert np.allclose(found.pose.position, pose.position, rtol=0.0, atol=1e-12)
            near = found.pose
        return 1e6 * seconds / ROWS


def rebuilt(wrist: Platform) -> float:
    """Return what new equations for every reading take, µs."""
    base = wrist.kinematics_at(tuple(wrist.home))[0].base
    begun = time.thread_time()
    for _ in range(ROWS):
        ForwardKinematics(wrist.platform, base, wrist.size, wrist.home_pose)
    return 1e6 * (time.thread_time() - begun) / ROWS


def main() -> None:
    """Time all ways in turns, and print the best of each and its ratio to the first."""
    head, legs = make_wrist('rotary_stewart'), make_wrist('stewart')
    assert isinstance(head, Platform)
    assert isinstance(legs, Platform)
    ways = [
        Way('legs on a base that stands, 100 Hz', legs, 0.01),
        Way('horns, 50 Hz', head, 0.02),
        Way('horns, 100 Hz', head, 0.01),
        Way('horns, 1 kHz', head, 0.001),
        Way('horns, 100 Hz, nothing remembered', head, 0.01, warm=False),
    ]
    best = [min(way.microseconds(7 * turn % 170) for turn in range(TURNS)) for way in ways]
    names = [way.name for way in ways]
    names.append('equations for new anchors, before any solve')
    best.append(min(rebuilt(head) for _ in range(TURNS)))
    for name, microseconds in zip(names, best, strict=True):
        print(f'{name:45} {microseconds:7.1f} µs  {microseconds / best[0]:5.2f} ×')


if __name__ == '__main__':
    main()
