"""Where a wrist is asked: random places, and how well it can be commanded there."""

from __future__ import annotations

import math
from collections.abc import Callable, Iterator, Sequence

import numpy as np

from wrist_control.errors import UnreachableError
from wrist_control.rotations import Pose, rates_between
from wrist_control.testing.broken import require
from wrist_control.wrists.wrist import Positions, Wrist

# Joints are sent this far from home: revolute ones anywhere, rad; prismatic ones by this share.
WHOLE_RANGE = math.pi
PRISMATIC_SHARE = 0.05
# A place is regular when it is conditioned at least this well, of 1 at home.
REGULAR = 0.05
MOST_TRIES = 4000

Random = np.random.Generator
Line = Callable[[float], Positions]


def random_positions(wrist: Wrist, random: Random, share: float = 1.0) -> tuple[float, ...]:
    """Return random joint positions around home within the limits; not all can be assembled."""
    found = []
    for joint, home in zip(wrist.joints, wrist.home, strict=True):
        reach = WHOLE_RANGE if joint.kind == 'revolute' else PRISMATIC_SHARE * abs(home)
        position = home + share * reach * random.uniform(-1.0, 1.0)
        found.append(float(min(max(position, joint.lower), joint.upper)))
    return tuple(found)


def regular_places(wrist: Wrist, random: Random, count: int) -> Iterator[Positions]:
    """Yield joint positions all over the joints' ranges, away from lock."""
    conditioning = Conditioning(wrist)
    near = wrist.forward(wrist.home)
    for _ in range(MOST_TRIES):
        try:
            # Half of them near home: some mechanisms can be assembled there only.
            share = random.choice([0.2, 1.0])
            positions = _assembled(wrist, random_positions(wrist, random, share), near)
            wrist.forward(positions)
            if conditioning(positions) < REGULAR:
                continue
        except UnreachableError:
            continue
        yield positions
        count -= 1
        if not count:
            return
    require(False, 'too few places around home can be assembled away from lock')


def _assembled(wrist: Wrist, positions: tuple[float, ...], home: Pose) -> Positions:
    """Return joint positions that say which pose they hold, these or, roughly, so far from home.

    Where joint positions alone fit several poses, most that are picked at random fit none, and it
    takes long to be sure of that: the hand is sent where the joints would take it at home.

    Raises:
        UnreachableError: The mechanism cannot be assembled there, or not within its limits.
    """
    if type(wrist).resolve_assembly is Wrist.resolve_assembly:
        return positions
    way = wrist.jacobian(wrist.home) @ np.subtract(positions, wrist.home)
    found = wrist.inverse(wrist.target_pose(home, way.tolist(), 1.0), wrist.home)
    for joint, position in zip(wrist.joints, found, strict=True):
        if not joint.lower <= position <= joint.upper:
            raise UnreachableError('outside the limits')
    return found


def rate_map(wrist: Wrist, positions: Sequence[float]) -> np.ndarray:
    """Return joint rates per hand twist, shape (joints, twist_size), as `rates` makes them.

    Half the difference of a twist and its opposite: what a wrist does by itself drops out.
    """
    try:
        columns = [
            0.5 * np.subtract(wrist.rates(positions, there), wrist.rates(positions, back))
            for there, back in _unit_twists(wrist.twist_size)
        ]
    except ArithmeticError:  # exactly at lock
        return np.full((len(positions), wrist.twist_size), math.inf)
    return np.array(columns).T


def _unit_twists(size: int) -> list[tuple[list[float], list[float]]]:
    return [(axis.tolist(), (-axis).tolist()) for axis in np.eye(size)]


def is_outside(wrist: Wrist, positions: Sequence[float]) -> bool:
    """Return whether a clearance is used up at joint positions."""
    return any(clearance.remaining <= 0.0 for clearance in wrist.clearances(positions))


class Conditioning:
    """How well a wrist can be commanded, 1 at home and 0 at lock.

    The least singular value of what `rates` invert, and of `rates` themselves: at lock either
    the joints would need endless rates, or the hand moves though no joint does.
    """

    def __init__(self, wrist: Wrist) -> None:
        """Ask a wrist at home."""
        self._wrist = wrist
        self._components = list(wrist.followed_components)
        self._home_gains = self.gains(wrist.home)

    def gains(self, positions: Sequence[float]) -> np.ndarray:
        """Return the singular values of joint rates per followed twist, largest first."""
        mapped = rate_map(self._wrist, positions)[:, self._components]
        if not np.isfinite(mapped).all():
            return np.full(len(self._components), math.inf)
        return np.linalg.svd(mapped, compute_uv=False)

    def __call__(self, positions: Sequence[float]) -> float:
        """Return the conditioning at joint positions."""
        gains, home = self.gains(positions), self._home_gains
        return float(min(home[0] / gains[0], gains[-1] / home[-1]))


def twist_between(wrist: Wrist, before: Pose, after: Pose, dt: float) -> np.ndarray:
    """Return the constant twist from a pose to another, hand axes, shape (twist_size,)."""
    travel = before.rotation @ (np.array(after.position) - before.position) / dt
    angular = rates_between(before.quaternion, after.quaternion, dt)
    return np.array([*travel, *angular])[-wrist.twist_size :]


def random_twist(wrist: Wrist, random: Random, speed: float = 1.0) -> tuple[float, ...]:
    """Return a random twist, rad/s, and m/s a tenth as large."""
    angular = random.normal(size=3)
    angular *= speed / np.linalg.norm(angular)
    linear = 0.1 * speed * random.uniform(-1.0, 1.0, size=3)
    return tuple(float(x) for x in (*linear, *angular)[-wrist.twist_size :])
