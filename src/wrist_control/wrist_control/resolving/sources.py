"""Who leads the hand: one source at a time, and only what is certainly its own. No ROS, no clock.

The middleware does not say who sent a message. It says the number that its publisher gave it, 1,
2, 3 and so on, when it was sent, and how many publishers are alive on the topic. A best-effort
subscription loses numbers, and never hears those of one publisher in another order.
"""

from __future__ import annotations

import math
from typing import NamedTuple

from wrist_control.errors import RefusedError

# Numbers this near to the leader's may be the leader's, or those of somebody who began with it.
NEAR = 64
# Beside other publishers a source is known by this many numbers in a row: two that take turns
# show a number twice, or one that goes back, within three messages.
PROVED = 3
# Two sources are remembered for this long after they were noticed, s: where messages are lost, or
# one is slow, neither the hand nor the sentence shall flicker.
NOTICED = 1.0


class Origin(NamedTuple):
    """Where a message comes from, as far as the middleware tells.

    Attributes:
        topic: The topic.
        number: The number that its publisher gave it; None where the middleware has none.
        sent: When it was sent, ns, by its publisher's clock.
        publishers: How many are alive on the topic.
    """

    topic: str
    number: int | None
    sent: int
    publishers: int

    @property
    def alone(self) -> bool:
        """True where nobody else could have sent it."""
        return self.publishers <= 1


class Trail(NamedTuple):
    """The last that was heard of the source that leads.

    Attributes:
        topic: Its topic.
        number: The last number.
        sent: When that was sent, ns.
        heard: When that came, s of receipt time.
        proofs: How many numbers in a row, at most PROVED; a gap takes one of those away.
    """

    topic: str
    number: int
    sent: int
    heard: float
    proofs: int


class Sources:
    """Lets through what certainly comes from the one source that leads the hand.

    Who comes first leads, until it has been silent for the timeout.
    """

    def __init__(self) -> None:
        """Begin with nobody in the lead."""
        self._leader: Trail | None = None
        self._mixed = -math.inf
        self._refused: dict[str, float] = {}

    @property
    def leading(self) -> str:
        """Return the topic of who leads, or led last; empty before the first."""
        return '' if self._leader is None else self._leader.topic

    def mixed(self, receipt_time: float) -> bool:
        """Return whether two sources were heard that cannot be told apart: nobody leads."""
        return 0.0 <= receipt_time - self._mixed <= NOTICED

    def refused(self, receipt_time: float) -> list[str]:
        """Return the topics on which somebody else than the leader was refused just now."""
        return [t for t, when in self._refused.items() if 0.0 <= receipt_time - when <= NOTICED]

    def admit(self, origin: Origin, receipt_time: float, timeout: float) -> None:
        """Let a message through.

        Args:
            origin: Where it comes from.
            receipt_time: Now, s.
            timeout: Silence after which somebody else may lead, s.

        Raises:
            RefusedError: It is not the leader's, or not for certain.
        """
        leader = self._leader
        if leader is None or not 0.0 <= receipt_time - leader.heard <= timeout:
            self._leader = self._first(origin, receipt_time)
        elif origin.topic != leader.topic:
            raise self._anothers(origin, receipt_time, timeout)
        else:
            self._leader = self._next(leader, origin, receipt_time, timeout)
        if self.mixed(receipt_time):
            raise _mixed(origin)
        if self._leader.proofs < PROVED:
            raise RefusedError(
                'not certain whose',
                f'Refused a command on {origin.topic}: {origin.publishers} publishers are alive '
                f'there, and its number does not follow; end all but one.',
            )

    @staticmethod
    def _first(origin: Origin, receipt_time: float) -> Trail:
        proofs = PROVED if origin.alone else 1
        return Trail(origin.topic, origin.number or 0, origin.sent, receipt_time, proofs)

    def _next(self, leader: Trail, origin: Origin, receipt_time: float, timeout: float) -> Trail:
        if origin.number is None and origin.alone:
            return leader._replace(heard=receipt_time)
        step = 0 if origin.number is None else origin.number - leader.number
        forward = step > 0 and origin.sent >= leader.sent
        if forward and (origin.alone or step <= NEAR):
            proofs = leader.proofs + 1 if step == 1 else min(leader.proofs, PROVED - 1)
            proofs = PROVED if origin.alone else min(proofs, PROVED)
            return Trail(leader.topic, leader.number + step, origin.sent, receipt_time, proofs)
        if not origin.alone and abs(step) <= NEAR:
            self._mixed = receipt_time
            raise _mixed(origin)
        raise self._anothers(origin, receipt_time, timeout)

    def _anothers(self, origin: Origin, receipt_time: float, timeout: float) -> RefusedError:
        self._refused[origin.topic] = receipt_time
        return RefusedError(
            'another source leads',
            f'Refused a command on {origin.topic}: another source leads the hand until it has '
            f'been silent for {timeout:g} s (command_timeout).',
        )


def _mixed(origin: Origin) -> RefusedError:
    return RefusedError(
        'sources not told apart',
        f'Refused a command on {origin.topic}: two sources send there and cannot be told apart; '
        'end one of them.',
    )
