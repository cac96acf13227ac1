"""Joints that may lie: what a supervisor hears of them in an attack."""

from __future__ import annotations

from collections.abc import Sequence

from hostile.numbers import hostile_number
from wrist_control.testing.places import Random
from wrist_control.wrists import Joint

HUGE = 'x' * 100_000
NAMES = ('', ' ', 'psi', 'leg_1', 'phi\n', 'no joint', HUGE)


class HostileJoints:
    """Joints that follow what they are told, lag, are stuck, fall silent or jump.

    Attributes:
        positions: Where they are, rad or m.
    """

    def __init__(
        self, joints: Sequence[Joint], positions: Sequence[float], random: Random
    ) -> None:
        """Rest somewhere.

        Args:
            joints: The joints.
            positions: Where they are, rad or m.
            random: Chooses what they do.
        """
        self.positions = [*positions]
        self._names = [joint.name for joint in joints]
        self._random = random
        self._way = 'follow'

    def told(self, positions: Sequence[float]) -> None:
        """Hear a command, and perhaps begin to behave in another way."""
        if self._random.random() < 0.01:
            self._way = str(self._random.choice(['follow', 'follow', 'lag', 'stuck', 'silent']))
        share = {'follow': 1.0, 'lag': 0.3, 'stuck': 0.0, 'silent': 1.0}[self._way]
        self.positions = [
            here + share * (there - here)
            for here, there in zip(self.positions, positions, strict=True)
        ]

    def pushed(self, far: float) -> None:
        """Be moved by somebody, each joint by at most so much, rad or m."""
        away = self._random.uniform(-far, far, size=len(self.positions)).tolist()
        self.positions = [at + by for at, by in zip(self.positions, away, strict=True)]

    def messages(self) -> list[tuple[list[str], list[float]]]:
        """Return what is heard of them in a period: the truth, or nothing, or nonsense."""
        found = [] if self._way == 'silent' else [([*self._names], [*self.positions])]
        if self._random.random() < 0.1:
            found.insert(int(self._random.integers(len(found) + 1)), self._nonsense())
        return found

    def _nonsense(self) -> tuple[list[str], list[float]]:
        names, positions = [*self._names], [*self.positions]
        index = int(self._random.integers(len(names)))
        kind = self._random.integers(8)
        if kind < 3:
            positions[index] = hostile_number(self._random)
        elif kind == 3:
            names[index] = str(self._random.choice(NAMES))
        elif kind == 4:
            names.append(names[index])
            positions.append(0.0)
        elif kind == 5:
            del positions[index]
        elif kind == 6:
            names, positions = [], []
        else:
            names, positions = names * 500, positions * 500
        return names, positions
