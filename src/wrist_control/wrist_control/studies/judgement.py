"""Our kinematics before a judge that does not know them: mechanisms that MuJoCo moves.

A mechanism carries a payload, is driven from pose to pose, and comes to rest. Then its hand has to
be where `forward` says of where its joints are; a small move has to turn the hand as `jacobian`
says; and its servos have to hold the payload with the efforts that `jacobian` says, by power.
"""

from __future__ import annotations

import math
import time
from collections.abc import Callable, Iterator, Sequence
from itertools import islice
from typing import NamedTuple, TypeVar

import numpy as np

from wrist_control.errors import UnreachableError
from wrist_control.physics.mechanism import Mechanism, Settings
from wrist_control.physics.models import build
from wrist_control.rotations import Pose, Vector, cross, rates_between, to_hand
from wrist_control.wrists.wrist import Wrist

Result = TypeVar('Result')

# A forearm held askew, so that the payload pulls at every joint, m/s².
GRAVITY: Vector = (3.0, -5.0, -7.9)
# The loops give way to their load by the square of the step: at this one all are well inside
# `BOUND`, docs/results/physics.md.
LOADED = Settings(step=0.0002, payload=1.0, gravity=GRAVITY, balanced=True)
# Most that a difference may be, as a share: of the size, of a turn of 1 rad, of the hand's motion,
# of the largest effort.
BOUND = 1e-6
# How far from home joints are drawn: rad, or as a share of the size for those that slide.
SPREAD = {'revolute': 1.0, 'prismatic': 0.4}
# Poses are this far from singular, and so is the straight way between them, looked at so often.
MARGIN, LOOKS = 0.2, 9
# And the mechanism itself holds its hand this firmly there: the Carpal wrist has places where it
# does not, which our margins do not see.
FIRM = 0.2
# A way takes this long, s; then it comes to rest.
DRIVE = 0.5
# Half of the small move, in the units of `SPREAD`.
NUDGE = 1e-4


class Verdict(NamedTuple):
    """The largest differences between a mechanism and our kinematics.

    Attributes:
        poses: At how many poses.
        position: Of the hand at rest, as a share of the mechanism's size.
        attitude: Of the hand at rest, rad.
        motion: Of the hand's motion in a small move, as a share of the largest there.
        effort: Of the servos' efforts, as a share of the largest.
        steps_per_second: How fast the physics ran.
    """

    poses: int
    position: float
    attitude: float
    motion: float
    effort: float
    steps_per_second: float

    @property
    def worst(self) -> float:
        """The largest of the differences, no number where one is none."""
        return float(np.max([self.position, self.attitude, self.motion, self.effort]))


class _Found(NamedTuple):
    """One pose: how far off the hand is, m, rad and share; efforts, and those expected."""

    position: float
    attitude: float
    motion: float
    efforts: np.ndarray
    expected: np.ndarray


def judge(
    wrist: Wrist,
    poses: int,
    settings: Settings = LOADED,
    built: Wrist | None = None,
    seen: Callable[[], None] = lambda: None,
) -> Verdict:
    """Drive a mechanism through random poses, the same in every run, and compare.

    Args:
        wrist: Whose kinematics are judged.
        poses: How many.
        settings: Of the mechanism.
        built: Whose mechanism judges, if another: so that a wrong length can be seen to show.
        seen: Called after each pose.
    """
    mechanism = build(built or wrist, settings)
    mechanism.start_at(wrist.home)
    rng = np.random.default_rng(1)
    watch = _Watch(mechanism)
    found = []
    for aim in islice(aims(wrist, rng), poses):
        found.append(_look(wrist, mechanism, watch, aim, rng))
        seen()
    largest = max(np.max(np.abs(one.expected)) for one in found)
    return Verdict(
        poses=poses,
        position=max(one.position for one in found) / mechanism.size,
        attitude=max(one.attitude for one in found),
        motion=max(one.motion for one in found),
        effort=float(max(np.max(np.abs(one.efforts - one.expected)) for one in found) / largest),
        steps_per_second=watch.steps_per_second,
    )


def aims(wrist: Wrist, rng: np.random.Generator) -> Iterator[np.ndarray]:
    """Yield random joint positions, each reached straight from the one before, home at first."""
    mechanism = build(wrist)
    home = np.array(tuple(wrist.home))
    before = home
    while True:
        aim = home + _spread(wrist, mechanism.size) * rng.uniform(-1.0, 1.0, len(home))
        way = np.linspace(before, aim, LOOKS)
        if all(_inside(wrist, _plain(positions)) for positions in way) and all(
            _is_firm(mechanism, positions) for positions in way[LOOKS // 2 :: LOOKS // 2]
        ):
            before = aim
            yield aim


def _inside(wrist: Wrist, positions: tuple[float, ...]) -> bool:
    try:
        return wrist.margin(positions) > MARGIN and all(
            limit.remaining > 0.0 for limit in wrist.clearances(positions)
        )
    except UnreachableError:
        return False


def _is_firm(mechanism: Mechanism, positions: np.ndarray) -> bool:
    try:
        mechanism.start_at(positions)
    except UnreachableError:
        return False
    return mechanism.firmness > FIRM


def _spread(wrist: Wrist, size: float) -> np.ndarray:
    # Angles of a platform's servos that are further from home lead from there to other poses than
    # those on the mechanism's own way.
    turn = 1.0 if wrist.twist_size == 3 else 0.5
    units = {'revolute': turn, 'prismatic': size}
    return np.array([SPREAD[joint.kind] * units[joint.kind] for joint in wrist.joints])


class _Watch:
    """How much of the time the physics takes."""

    def __init__(self, mechanism: Mechanism) -> None:
        self._mechanism = mechanism
        self._seconds = self._simulated = 0.0

    def run(self, act: Callable[[], Result]) -> Result:
        begun, simulated = time.perf_counter(), self._mechanism.data.time
        result = act()
        self._seconds += time.perf_counter() - begun
        self._simulated += self._mechanism.data.time - simulated
        return result

    @property
    def steps_per_second(self) -> float:
        return self._simulated / self._mechanism.settings.step / self._seconds


def _look(
    wrist: Wrist,
    mechanism: Mechanism,
    watch: _Watch,
    aim: np.ndarray,
    rng: np.random.Generator,
) -> _Found:
    """Drive there, come to rest, and compare."""
    begin = mechanism.target
    mechanism.command(begin, (aim - begin) / DRIVE)
    watch.run(lambda: mechanism.advance(DRIVE))
    rested, ends = True, []
    nudge = NUDGE / max(SPREAD.values()) * _spread(wrist, mechanism.size)
    nudge *= rng.choice((-1.0, 1.0), len(aim)) * rng.uniform(0.5, 1.0, len(aim))
    for target in (aim - nudge, aim + nudge, aim):
        mechanism.command(target)
        rested = watch.run(mechanism.settle) and rested
        ends.append((mechanism.positions, mechanism.hand_pose))
    (first, before), (second, after), (positions, hand) = ends
    said = wrist.forward(_plain(positions))
    middle = _plain(0.5 * (first + second))
    return _Found(
        # What never comes to rest is nowhere.
        position=math.dist(said.position, hand.position) if rested else math.inf,
        attitude=math.hypot(*rates_between(said.quaternion, hand.quaternion, 1.0)),
        motion=_motion_error(wrist.jacobian(middle), second - first, before, after, hand),
        efforts=mechanism.efforts,
        expected=expected_efforts(wrist, _plain(positions), mechanism.settings),
    )


def _motion_error(
    jacobian: np.ndarray, move: np.ndarray, before: Pose, after: Pose, hand: Pose
) -> float:
    """Return how much a small move differs from the Jacobian's, as a share of the largest such."""
    turn = rates_between(before.quaternion, after.quaternion, 1.0)
    x, y, z = np.subtract(after.position, before.position).tolist()
    parts = [(jacobian[-3:], turn), (jacobian[:-3], to_hand(hand.quaternion, (x, y, z)))]
    return max(
        float(np.linalg.norm(rows @ move - found) / np.linalg.norm(rows, 2) / np.linalg.norm(move))
        for rows, found in parts
        if len(rows)
    )


def expected_efforts(wrist: Wrist, positions: tuple[float, ...], settings: Settings) -> np.ndarray:
    """Return the efforts that hold the payload: -Jᵀ f, for f the payload's weight.

    The Jacobian is that of the probe's end, where the payload hangs.
    """
    hand = wrist.forward(positions)
    x, y, z = to_hand(hand.quaternion, settings.gravity)
    weight: Vector = (settings.payload * x, settings.payload * y, settings.payload * z)
    jacobian = wrist.jacobian(positions)
    along = jacobian[:3] if wrist.twist_size == 6 else _origin_jacobian(wrist, positions, hand)
    return -(along.T @ weight + jacobian[-3:].T @ cross(wrist.probe, weight))


def _origin_jacobian(wrist: Wrist, positions: tuple[float, ...], hand: Pose) -> np.ndarray:
    """Return the velocity of the hand's origin per joint rate, hand axes: `forward`, differenced.

    Its Jacobian that turns is all that `jacobian` gives of a wrist that moves on no command.
    """
    small = 1e-5
    columns = []
    for joint in range(len(positions)):
        move = small * np.eye(len(positions))[joint]
        ends = (wrist.forward(_plain(positions + side * move)).position for side in (1.0, -1.0))
        ahead, behind = ends
        x, y, z = (np.subtract(ahead, behind) / (2.0 * small)).tolist()
        columns.append(to_hand(hand.quaternion, (x, y, z)))
    return np.array(columns).T


def _plain(positions: Sequence[float] | np.ndarray) -> tuple[float, ...]:
    return tuple(np.asarray(positions).tolist())
