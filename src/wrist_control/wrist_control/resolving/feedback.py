"""What the joints say of themselves: how old it is, whether they rest, whether they follow."""

from __future__ import annotations

import math
from collections.abc import Sequence
from typing import NamedTuple

from wrist_control.errors import InvalidValueError, RefusedError
from wrist_control.resolving.joint_order import in_joint_order
from wrist_control.resolving.state import State
from wrist_control.wrists.joint import Joint
from wrist_control.wrists.wrist import Wrist

# Joints rest when so many messages in a row lie within this of the first, rad and m: far above
# what an encoder trembles by, and far below what a person would call a motion.
RESTING_MESSAGES = 3
TREMBLE = {'revolute': 0.005, 'prismatic': 0.0001}
# A servo may rest so far outside its limits, rad and m; from there it may only move inward.
SAG = {'revolute': 0.02, 'prismatic': 0.001}
# The same for what is left of the limits of the whole wrist.
EDGE_SAG = 0.01
# No joint is further than this, rad or m: a thousand turns and more.
FURTHEST = 1e4


class Remembered(NamedTuple):
    """What there is to know of joint states that follow their commands.

    Attributes:
        positions: The newest, rad or m; empty before the first.
        first: Those that they rest at since.
        messages: How many there were since then.
        receipt: When the newest came, s.
    """

    positions: tuple[float, ...]
    first: tuple[float, ...]
    messages: int
    receipt: float


class Feedback:
    """The joint states of one wrist.

    Attributes:
        positions: The newest, rad or m; None before the first.
        refused: Why there is no start from where they rest; empty when nobody has tried.
    """

    def __init__(self, joints: Sequence[Joint]) -> None:
        """Listen for some joints."""
        self.positions: tuple[float, ...] | None = None
        self.refused = ''
        self._names = [joint.name for joint in joints]
        self._tremble = [TREMBLE[joint.kind] for joint in joints]
        self._receipt = -math.inf
        self._first: tuple[float, ...] = ()
        self._count_at_rest = 0
        self._behind_since: float | None = None

    def hear(
        self, names: Sequence[str], positions: Sequence[float], receipt_time: float
    ) -> tuple[float, ...]:
        """Take in joint states, and return the positions in the joints' own order.

        Args:
            names: Joint names, in any order; other joints may be among them.
            positions: Their positions, rad or m.
            receipt_time: Now, s.

        Raises:
            RefusedError: Wrong names, lengths or numbers; nothing has changed.
        """
        heard = in_joint_order(self._names, names, positions)
        if not all(abs(position) <= FURTHEST for position in heard):  # nan is not
            raise RefusedError(
                'not finite',
                f'Refused joint states {heard}; each must be finite, and at most {FURTHEST:g} '
                'rad (m) from 0.',
            )
        if not self._first or _excess(heard, self._first, self._tremble) > 0.0:
            self._first, self._count_at_rest, self.refused = heard, 0, ''
        self._count_at_rest += 1
        self.positions, self._receipt = heard, receipt_time
        return heard

    @property
    def remembered(self) -> Remembered:
        """What was heard so far."""
        return Remembered(self.positions or (), self._first, self._count_at_rest, self._receipt)

    def recall(self, remembered: Remembered) -> None:
        """Go on from what was heard elsewhere."""
        positions, self._first, self._count_at_rest, self._receipt = remembered
        self.positions = positions or None

    @property
    def lagging(self) -> bool:
        """True while a joint is further behind than it may be."""
        return self._behind_since is not None

    @property
    def resting(self) -> bool:
        """True while the joints are where they were several messages ago."""
        return self._count_at_rest >= RESTING_MESSAGES

    def age(self, receipt_time: float) -> float:
        """Return how long ago the newest came, s; inf before the first."""
        return receipt_time - self._receipt

    def what_is_missing(self, receipt_time: float) -> str:
        """Return what was heard last, for a sentence."""
        names = ', '.join(self._names)
        if self.positions is None:
            return f'no joint_states of {names} were heard'
        return f'the last joint_states of {names} came {self.age(receipt_time):.2f} s ago'

    def waiting_sentence(self, receipt_time: float, longest: float) -> str:
        """Return what is waited for, and how to go on.

        Args:
            receipt_time: Now, s.
            longest: Age up to which they are good enough to move by, s.
        """
        missing = self.what_is_missing(receipt_time)
        if self.positions is None:
            return (
                f'Waiting: {missing}; start the joints, or set require_joint_states to false to '
                'go on without.'
            )
        if self.age(receipt_time) > longest:
            return f'Waiting: {missing}, and nothing moves without them; start the joints.'
        return f'Waiting: {self.refused}' if self.refused else 'Waiting for the joints to rest.'

    def blind_sentence(self, receipt_time: float) -> str:
        """Return why a moving hand is stopped when the joints have fallen silent."""
        missing = self.what_is_missing(receipt_time)
        return f'Stopped, since {missing}: the hand would move unseen.'

    def forget_lag(self) -> None:
        """Watch anew whether the joints follow."""
        self._behind_since = None

    def joint_that_does_not_follow(
        self, told: Sequence[float], tolerance: Sequence[float], longest: float
    ) -> str | None:
        """Return a sentence once a joint has been too far from its command for too long.

        Args:
            told: Where the joints were told to be, rad or m.
            tolerance: How far from there each may be, rad or m.
            longest: For how long, s.
        """
        seen = self.positions or tuple(told)
        if _excess(seen, told, tolerance) <= 0.0:
            self._behind_since = None
        elif self._behind_since is None:
            self._behind_since = self._receipt
        elif self._receipt - self._behind_since > longest:
            _, name, at, wanted = max(
                (abs(one - other) - most, name, one, other)
                for name, one, other, most in zip(self._names, seen, told, tolerance, strict=True)
            )
            return f'{name} is at {at:.3f} but was told {wanted:.3f}: it does not follow.'
        return None

    def check_ready(self, receipt_time: float, longest: float) -> None:
        """See that the joints can be taken over: they were heard lately, and rest.

        Args:
            receipt_time: Now, s.
            longest: Age up to which joint states are good enough, s.

        Raises:
            InvalidValueError: They cannot.
        """
        if self.age(receipt_time) > longest:
            raise InvalidValueError(
                f'Cannot enable: {self.what_is_missing(receipt_time)}; start the joints first.'
            )
        if not self.resting:
            raise InvalidValueError(
                'Cannot enable: the joints do not rest; hold them still, and call it again.'
            )


def _excess(
    positions: Sequence[float], others: Sequence[float], tolerance: Sequence[float]
) -> float:
    """Return by how much the worst joint is further from its other place than it may be."""
    return max(
        abs(one - other) - most
        for one, other, most in zip(positions, others, tolerance, strict=True)
    )


def state_at(wrist: Wrist, measured: Sequence[float], before: State) -> State:
    """Return the state of a wrist whose joints are where they say.

    Args:
        wrist: The mechanism, with the limits to keep.
        measured: Joint positions, rad or m.
        before: The state before; of several assemblies the one that follows from it is meant.

    Raises:
        UnreachableError: The mechanism cannot be assembled there.
    """
    positions = wrist.resolve_assembly(measured, before.pose)
    return State(positions, wrist.forward(positions), time_lost=before.time_lost)


def checked_start(wrist: Wrist, measured: Sequence[float], before: State) -> State:
    """Return the state to start from where the joints are: `state_at`, inside every limit.

    Raises:
        InvalidValueError: A joint, or the whole wrist, is outside its limits by more than a servo
            rests outside them; the sentence says which and what to do.
        UnreachableError: The mechanism cannot be assembled there.
    """
    for joint, position in zip(wrist.joints, measured, strict=True):
        sag = SAG[joint.kind]
        if not joint.lower - sag <= position <= joint.upper + sag:
            raise InvalidValueError(
                f'{joint.name} is at {position:.3f}, outside its limits of {joint.lower:g} to '
                f'{joint.upper:g}; move it inside, or widen the limits.'
            )
    state = state_at(wrist, measured, before)
    crossed = [
        limit.name for limit in wrist.clearances(state.positions) if limit.remaining < -EDGE_SAG
    ]
    if crossed:
        raise InvalidValueError(
            f'The joints are at {tuple(measured)}, outside: {", ".join(crossed)}; move them in.'
        )
    return state
