"""Who holds the stick, and for how long: a lease that ends by itself.

A page that shows a stick can freeze, lose its connection or be closed at any moment, and then says
nothing; and what it had said before may arrive later. So whoever holds the stick renews a lease,
again and again, and each renewal proves that it was asked for just now: it carries the beat, the
newest time that the server has told the page.
"""

from __future__ import annotations

from typing import Generic, NamedTuple, TypeVar

# s until whoever held the stick has let it go: after its last renewal came, and after its beat.
# The first is for a page that falls silent, the second for one that is heard late.
LASTS, OLDEST = 0.25, 0.45

Asked = TypeVar('Asked')


class Renewal(NamedTuple, Generic[Asked]):
    """What whoever holds a stick says again and again.

    Attributes:
        holder: Who it is: one page.
        grip: Number of this grip of the holder's: a higher one each time the stick is taken.
        beat: The newest beat that the holder has heard, s.
        asked: What is asked for while the stick is held so.
    """

    holder: str
    grip: int
    beat: float
    asked: Asked


class Lease(Generic[Asked]):
    """Lets one holder at a time ask for something, until it is silent or lets go.

    A grip that has ended, however it did, never asks for anything again: the stick must be let go
    and taken anew. All times are s on one clock that never jumps.
    """

    def __init__(self) -> None:
        """Begin with nobody holding."""
        self._held: Renewal[Asked] | None = None
        self._until = 0.0
        self._ended: dict[str, int] = {}

    def renew(self, renewal: Renewal[Asked], now: float) -> str:
        """Take or keep the stick; return why not, one sentence, or nothing.

        Args:
            renewal: What the holder says.
            now: When it was received, s.
        """
        held = self.held(now)
        if renewal.grip <= self._ended.get(renewal.holder, 0):
            return 'That grip has ended: let go, and take the stick anew.'
        if held is not None and renewal.holder != held.holder:
            self._ended[renewal.holder] = renewal.grip
            return 'Somebody else holds the stick: take it when they have let go.'
        if not 0.0 <= now - renewal.beat <= OLDEST:
            self.release(renewal.holder)
            self._ended[renewal.holder] = renewal.grip
            return 'That came too late to count: let go, and take the stick anew.'
        self._held, self._until = renewal, min(now + LASTS, renewal.beat + OLDEST)
        self._ended[renewal.holder] = renewal.grip - 1  # whatever came before it
        return ''

    def release(self, holder: str) -> None:
        """Let go, if it is this holder who holds."""
        if self._held is not None and self._held.holder == holder:
            self._end(self._held)

    def release_all(self) -> None:
        """Let go, whoever holds."""
        if self._held is not None:
            self._end(self._held)

    def forget(self, holder: str) -> None:
        """Let go, and forget a holder that will never come back."""
        self.release(holder)
        self._ended.pop(holder, None)

    def held(self, now: float) -> Renewal[Asked] | None:
        """Return what is asked for now, and by whom; None while nobody holds the stick."""
        if self._held is not None and now > self._until:
            self._end(self._held)
        return self._held

    def _end(self, held: Renewal[Asked]) -> None:
        self._ended[held.holder] = held.grip
        self._held = None
