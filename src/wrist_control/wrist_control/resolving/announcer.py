"""What a person can read: a sentence that stays for a while, an axis that does not flip."""

from __future__ import annotations

from collections.abc import Sequence

from wrist_control.resolving.report import WristState

# A sentence stays at least this long, s, unless the state changes.
HELD = 0.5
# What is said of these must not wait: the hand stops, or cannot move.
AT_ONCE = (WristState.DISABLED, WristState.STALE, WristState.FAULT)


class Announcer:
    """Holds a sentence for as long as a person needs to read it."""

    def __init__(self) -> None:
        """Begin with nothing said."""
        self._said = ''
        self._state: WristState | None = None
        self._since = 0.0

    def say(self, state: WristState, sentence: str, receipt_time: float) -> str:
        """Return the sentence to show.

        Args:
            state: What the wrist is doing.
            sentence: What this step has to say.
            receipt_time: Now, s.
        """
        held = 0.0 <= receipt_time - self._since < HELD
        if state == self._state and state not in AT_ONCE and held:
            return self._said
        if (state, sentence) != (self._state, self._said):
            self._state, self._said, self._since = state, sentence, receipt_time
        return self._said


class SteadyAxis:
    """Keeps the sign of an axis, which means the same either way, from step to step."""

    def __init__(self) -> None:
        """Begin with no axis."""
        self._last: tuple[float, ...] = ()

    def turned(self, axis: Sequence[float]) -> tuple[float, ...]:
        """Return the axis, or its opposite where that is nearer to the last one."""
        along = sum(a * b for a, b in zip(self._last, axis, strict=False))
        found = tuple(-a if along < 0.0 else a for a in axis)
        if any(found):
            self._last = found
        return found
