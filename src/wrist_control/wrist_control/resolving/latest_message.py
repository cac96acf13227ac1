"""The latest message of a stream that was stamped before now: the same answer in every run."""

from __future__ import annotations

from typing import Generic, TypeVar

Message = TypeVar('Message')


class LatestMessage(Generic[Message]):
    """Holds back a message until time has passed its stamp, or until a newer one arrives.

    Two processes that are woken by the same tick of a simulated clock race each other. With this
    rule a message counts from the first step after its stamp, whoever is faster; and a sender
    whose clock is ahead is one message late, never unheard.

    Attributes:
        counting: The one that counts; None when there is none.
        waiting: The one that is held back; None when there is none.
    """

    def __init__(self) -> None:
        """Start with no message."""
        self.counting: Message | None = None
        self.waiting: Message | None = None
        self._stamp: float | None = None

    def put(self, stamp: float | None, message: Message) -> None:
        """Take a message.

        Args:
            stamp: s, None when it has none and so counts at once.
            message: The message.
        """
        if self.waiting is not None:
            self.counting = self.waiting
        self._stamp, self.waiting = stamp, message

    def at(self, stamp_time: float) -> Message | None:
        """Return the latest message that counts now, None when there is none yet.

        Args:
            stamp_time: Now, s, on the clock of the stamps.
        """
        if self.waiting is not None and (self._stamp is None or self._stamp < stamp_time):
            self.counting, self.waiting = self.waiting, None
        return self.counting

    def clear(self) -> None:
        """Drop every message."""
        self.counting = self.waiting = None
