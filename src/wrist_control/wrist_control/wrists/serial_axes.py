"""The axes of two to four joints in series: where they and the hand are, and which lock."""

from __future__ import annotations

import math
from collections.abc import Sequence
from dataclasses import dataclass
from functools import cached_property
from itertools import pairwise
from typing import TypeVar

from wrist_control.errors import InvalidValueError
from wrist_control.rotations import (
    IDENTITY,
    Pose,
    Vector,
    about,
    between,
    cross,
    placed,
    product,
    to_forearm,
    to_hand,
)
from wrist_control.wrists.joint import Joint
from wrist_control.wrists.robot_description import Chain
from wrist_control.wrists.three_axes import ThreeAxes, angle_between

# Two axes in a row that are closer to parallel than this, rad, turn the hand about one alone.
PARALLEL = 0.01
# A home with less of a margin than this has its second joint where the margin is larger.
ROOM = 0.5
HAND_AXES: tuple[Vector, ...] = ((1.0, 0.0, 0.0), (0.0, 1.0, 0.0), (0.0, 0.0, 1.0))
Item = TypeVar('Item')


@dataclass(frozen=True)
class SerialAxes:
    """The joints of a chain, and which three axes lock when they lie in a plane.

    These are the joints themselves if they are three. Of four, one is spare: the first or the
    last, whichever leaves the others less that they cannot reach. Of two, the third axis is the
    one of the hand that they point along.
    """

    chain: Chain

    def __post_init__(self) -> None:
        """Refuse axes that turn the hand about fewer axes than there are joints.

        Raises:
            InvalidValueError: Two in a row are parallel.
        """
        for one, other in pairwise(self.chain.driven):
            if math.sin(angle_between(one.axis, other.axis)) < math.sin(PARALLEL):
                raise InvalidValueError(
                    f'The axes of {one.joint.name} and {other.joint.name} are parallel and turn '
                    'the hand about one axis alone; name other joints, or fewer.'
                )

    @cached_property
    def joints(self) -> tuple[Joint, ...]:
        """The joints with the limits of the description."""
        return tuple(one.joint for one in self.chain.driven)

    @cached_property
    def directions(self) -> tuple[Vector, ...]:
        """Unit vectors along the axes while all joints are at 0, forearm axes."""
        return tuple(one.axis for one in self.chain.driven)

    @cached_property
    def spare(self) -> int:
        """Which of four joints is the spare one: the last, 3, or the first, 0."""
        last, first = (
            sum(end.beyond for end in ThreeAxes(*three).ends)
            for three in (self.directions[:3], self.directions[1:])
        )
        return 3 if last <= first + 1e-9 else 0

    @cached_property
    def forced_axis(self) -> int:
        """The hand axis, 0 to 2 for x, y, z, that two joints point along."""
        a, b = self.in_hand(self._middle)
        normal = cross(a, b)
        return max(range(3), key=lambda axis: round(abs(normal[axis]), 9))

    @cached_property
    def pointing_axis(self) -> int:
        """The hand axis, 0 to 2 for x, y, z, that points away from the wrist."""
        if len(self.directions) == 2:
            return self.forced_axis
        last = self.in_hand(self._middle)[-1]
        return max(range(3), key=lambda axis: round(abs(last[axis]), 9))

    @cached_property
    def followed_axes(self) -> tuple[int, ...]:
        """The hand axes that the joints turn about on command."""
        forced = {self.forced_axis} if len(self.directions) == 2 else set()
        return tuple(sorted({0, 1, 2} - forced))

    @cached_property
    def three(self) -> ThreeAxes:
        """The three axes that lock."""
        if len(self.directions) == 2:
            pointing = to_forearm(self.chain.tip.quaternion, HAND_AXES[self.forced_axis])
            return ThreeAxes(*self.directions, pointing)
        return ThreeAxes(*self.of_three(self.directions))

    @cached_property
    def home(self) -> tuple[float, ...]:
        """Where every joint has room, and the margin is at least a half where it can be."""
        found = list(self._middle)
        second = self.of_three(range(len(found)))[1]
        found[second] = self._away_from_lock(self.joints[second], found[second])
        return tuple(found)

    def of_three(self, row: Sequence[Item]) -> Sequence[Item]:
        """Return what belongs to the joints that are not spare, of a row with one for each."""
        return row if len(row) < 4 else row[:3] if self.spare else row[1:]

    def locking(self, in_hand: Sequence[Vector]) -> Sequence[Vector]:
        """Return the three axes that lock, in hand axes, of those of all joints."""
        if len(in_hand) == 2:
            return (*in_hand, HAND_AXES[self.forced_axis])
        return self.of_three(in_hand)

    def beyond_lock(self, positions: Sequence[float]) -> float:
        """Return how far the second of the three is turned on from its lock, rad."""
        return self.of_three(positions)[1] - self.three.lock

    def poses(self, positions: Sequence[float]) -> list[Pose]:
        """Return where each joint has its link, and the hand, forearm axes.

        A link's axes are the forearm's while all joints are at 0, and its origin is in its joint.
        """
        found: list[Pose] = []
        at, before = Pose(IDENTITY), (0.0, 0.0, 0.0)
        for one, position in zip(self.chain.driven, positions, strict=True):
            at = placed(at, Pose(about(one.axis, position), between(before, one.origin)))
            before = one.origin
            found.append(at)
        tip = self.chain.tip
        found.append(placed(at, Pose(tip.quaternion, between(before, tip.position))))
        return found

    def in_hand(self, positions: Sequence[float]) -> list[Vector]:
        """Return the axes as unit vectors in hand axes, outermost first."""
        found: list[Vector] = []
        inward = self.chain.tip.quaternion
        for axis, position in zip(reversed(self.directions), reversed(positions), strict=True):
            found.insert(0, to_hand(inward, axis))
            inward = product(about(axis, position), inward)
        return found

    @cached_property
    def _middle(self) -> tuple[float, ...]:
        """0 where a joint can be there, else the middle of its range."""
        return tuple(
            0.0 if joint.lower < 0.0 < joint.upper else 0.5 * (joint.lower + joint.upper)
            for joint in self.joints
        )

    def _away_from_lock(self, joint: Joint, position: float) -> float:
        lock = self.three.lock
        if abs(math.sin(position - lock)) >= ROOM:
            return position
        quarters = [lock + (0.5 + half) * math.pi for half in range(-6, 6)]
        inside = [turn for turn in quarters if joint.lower < turn < joint.upper]
        if inside:
            return min(inside, key=lambda turn: abs(turn - position))
        return max(
            (0.5 * (bound + position) for bound in (joint.lower, joint.upper)),
            key=lambda turn: abs(math.sin(turn - lock)),
        )
