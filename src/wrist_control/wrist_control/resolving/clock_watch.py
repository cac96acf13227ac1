"""Notices a simulated clock that jumps or stands still. It is told two times and reads neither.

A clock that is slow is not one that stands still: how long its next tick may take is learned from
the last. And only time that the node was awake counts: a process that was held up itself cannot
tell whether the clock went on meanwhile.
"""

from __future__ import annotations

# So many times the last gap between two readings is still the clock's own pace.
PATIENCE = 3.0
# A gap is not taken for the clock's pace beyond this, s.
LONGEST_GAP = 1.0
# Between two looks no more than this counts as awake, s.
AWAKE = 0.05

AGAIN = 'the hand is ramped to a stop; send commands again to go on.'


class ClockWatch:
    """Looks at a clock now and then, and keeps a time for ages that never goes back.

    Attributes:
        timeout: How long the clock may stand still, and how far it may leap at once, s.
        stands: True while it stands still.
        troubles: How often it jumped or came to stand.
        last: The last of them in one sentence; empty before the first.
    """

    def __init__(self, timeout: float) -> None:
        """Wait for a first reading that is not zero: zero means that there is no time yet."""
        self.timeout = timeout
        self.stands = False
        self.troubles = 0
        self.last = ''
        self._reading = 0
        self._regained = 0
        self._jumped = False
        self._seen = 0
        self._looked: float | None = None
        self._still = self._gap = 0.0

    def age_time(self, reading: int) -> int:
        """Return the reading, ns, but later by whatever the clock has jumped back."""
        leap = reading - self._reading if self._reading else 0
        self._reading = reading
        if leap < 0:
            self._regained -= leap
            self._trouble(f'The clock jumped back by {-1e-9 * leap:.3f} s')
        elif leap > 1e9 * self.timeout:
            self._trouble(f'The clock jumped ahead by {1e-9 * leap:.3f} s')
        self._jumped = self._jumped or leap < 0 or leap > 1e9 * self.timeout
        return reading + self._regained

    def look(self, reading: int, steady: float) -> bool:
        """Return whether whatever moves has to stop now.

        Args:
            reading: What the clock shows, ns.
            steady: Now, s, on a clock that never stops.
        """
        self.age_time(reading)
        self._still += min(steady - self._looked, AWAKE) if self._looked is not None else 0.0
        self._looked = steady
        if reading != self._seen:
            self._gap = min(self._still, LONGEST_GAP)
            self._seen, self._still, self.stands = reading, 0.0, False
        elif reading and self._still > max(self.timeout, PATIENCE * self._gap):
            if not self.stands:
                self._trouble(f'The clock has stood still for {self._still:.2f} s')
            self.stands = True
        jumped, self._jumped = self._jumped, False
        return jumped or self.stands

    def _trouble(self, what: str) -> None:
        self.troubles += 1
        self.last = f'{what}: {AGAIN}'
