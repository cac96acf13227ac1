"""How punctual the steps of a node are: which come too soon, which are missed, and how late."""

from __future__ import annotations

from collections import deque
from collections.abc import Iterable

# Share of a period by which two steps may be closer together than it.
TOLERANCE = 0.1
# What is shown is of so many s, s.
SPAN = 5.0
MOST_SAMPLES = 5000


class Timing:
    """Keeps steps a period apart by their stamps, and remembers how late they and commands were.

    Attributes:
        missed: How many steps were not made, because the one before came late.
    """

    def __init__(self, period: float) -> None:
        """Begin with no step.

        Args:
            period: Time between two steps, s.
        """
        self.missed = 0
        self._period = round(1e9 * period)
        self._last: int | None = None
        samples = min(MOST_SAMPLES, max(1, round(SPAN / period)))
        self._lateness: deque[float] = deque(maxlen=samples)
        self._latency: deque[float] = deque(maxlen=samples)
        self._heard: dict[str, float] = {}
        self._waiting: float | None = None

    def is_due(self, stamp: int) -> bool:
        """Return whether a step may be made: its joints would seem too fast if it came too soon.

        Args:
            stamp: Stamp of the step, ns.
        """
        return self._last is None or not 0 <= stamp - self._last < self._soonest

    def is_late(self, stamp: int) -> bool:
        """Return whether a step comes so late that the next must be put off."""
        return self._last is not None and stamp - self._last > 2 * self._period - self._soonest

    def step(self, stamp: int) -> None:
        """Count a step that is made, and the ones before it that were not."""
        if self._last is not None and stamp > self._last:
            gap = stamp - self._last
            self.missed += max(0, round(gap / self._period) - 1)
            self._lateness.append(1e-9 * (gap - self._period))
        if self._waiting is not None:
            self._latency.append(1e-9 * stamp - self._waiting)
            self._waiting = None
        self._last = stamp

    def hear(self, what: str, now: float, stamp: float | None = None) -> None:
        """Remember when something came, s, and when it was stamped if it counts from a step on."""
        self._heard[what] = now
        self._waiting = self._waiting if stamp is None else stamp

    def values(self, now: float) -> dict[str, str]:
        """Return what is shown of it.

        Args:
            now: s, on the clock of `hear`.
        """
        shown = {'missed steps': str(self.missed), 'lateness of a step': _spread(self._lateness)}
        for what, heard in self._heard.items():
            shown[f'age of the newest {what}'] = f'{now - heard:.3f} s'
        if self._latency:
            shown['latency from stamp to step'] = _spread(self._latency)
        return shown

    @property
    def _soonest(self) -> int:
        return round((1.0 - TOLERANCE) * self._period)


def _spread(samples: Iterable[float]) -> str:
    """Return the median, the 99th percentile and the largest of some times, in ms."""
    ordered = sorted(samples)
    if not ordered:
        return 'none yet'
    at = [ordered[round(share * (len(ordered) - 1))] for share in (0.5, 0.99, 1.0)]
    return ', '.join(
        f'{name} {1e3 * x:.2f} ms' for name, x in zip(('p50', 'p99', 'max'), at, strict=True)
    )
