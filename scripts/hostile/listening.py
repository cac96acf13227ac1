"""What is heard of live nodes, and judged message by message."""

from __future__ import annotations

import math
import threading
import time
from collections import deque
from collections.abc import Iterator, Sequence
from typing import Any

from hostile.rules import SLACK, broken_limits
from hostile.verdict import Verdict
from wrist_control.wrists import Joint

# A stamp more than this away from the clock is that of another clock, s.
SAME_CLOCK = 30.0
# Two steps are a pause apart from so many periods on; stamps are not punctual to the last bit.
PAUSE = 1.4
# Where joints that are taken over may be against what they said, rad or m.
TAKEN_OVER = 1e-6


def floats_of(message: Any) -> Iterator[float]:
    """Yield every number with a fraction in a message, however deep."""
    if isinstance(message, float):
        yield message
    elif hasattr(message, 'get_fields_and_field_types'):
        for name in message.get_fields_and_field_types():
            yield from floats_of(getattr(message, name))
    elif not isinstance(message, (str, bytes, int)) and hasattr(message, '__iter__'):
        for one in message:
            yield from floats_of(one)


class Judge:
    """Judges a stream of joint commands, or of joint states, message by message.

    Attributes:
        heard: How many messages it was given.
        moving: Whether the last one moves a joint.
        grace: So long after the last command there may be motion, s: timeout, ramp and delays.
    """

    def __init__(self, joints: Sequence[Joint], dt: float, verdict: Verdict) -> None:
        """Judge joints that nobody may move yet.

        Args:
            joints: The joints, with their limits.
            dt: The period of the stream, s.
            verdict: Told of every finding.
        """
        self.heard, self.moving, self.grace = 0, False, 1.2
        self._joints, self._dt, self._verdict = joints, dt, verdict
        self._names = [joint.name for joint in joints]
        self._positions: Sequence[float] | None = None
        # Where it was begun: joints that stood a little outside may be no further outside.
        self._start: Sequence[float] = ()
        self._rates: Sequence[float] = (0.0,) * len(joints)
        self._stamp = self._published = -math.inf
        self._said: deque[tuple[float, ...]] = deque(maxlen=500)
        self._until, self._stopped = -math.inf, False
        self._lock = threading.Lock()

    def allow(self, seconds: float | None = None) -> None:
        """Allow motion from now on, for a while, unless it is stopped."""
        with self._lock:
            if not self._stopped:
                wanted = time.time() + (self.grace if seconds is None else seconds)
                self._until = max(self._until, wanted)

    def forbid(self, *, stopped: bool = False) -> None:
        """Expect rest once the grace is over; after a stop, whatever is commanded."""
        with self._lock:
            self._stopped = self._stopped or stopped
            self._until = min(self._until, time.time() + self.grace)

    def go_on(self) -> None:
        """Undo a stop."""
        with self._lock:
            self._stopped = False

    def hear_joints(self, message: Any) -> None:
        """Hear where the joints, or those who lie about them, say that they are."""
        at = dict(zip(message.name, message.position, strict=False))
        if all(name in at for name in self._names):
            self._said.append(tuple(at[name] for name in self._names))

    def hear(self, message: Any, published: float | None = None) -> None:
        """Judge the next message.

        Args:
            message: It.
            published: When it was, s, on a clock that does not jump; its stamp when not known.
                A process may be held up between the two: then the pause is longer than it says.
        """
        self.heard += 1
        positions, rates = tuple(message.position), tuple(message.velocity)
        stamp = message.header.stamp.sec + 1e-9 * message.header.stamp.nanosec
        gap, self._stamp = stamp - self._stamp, stamp
        published = stamp if published is None else published
        pause, self._published = published - self._published, published
        steady = 0.0 < gap <= PAUSE * self._dt and pause <= PAUSE * self._dt
        if not all(math.isfinite(x) for x in (*positions, *rates)):
            self._verdict.find('nonfinite', f'{positions} at {rates}')
            return
        if list(message.name) != self._names or len(positions) != len(rates):
            self._verdict.find('limits', f'it names {list(message.name)[:9]}')
            return
        for sentence in self._broken(positions, rates, gap, steady):
            self._verdict.find('limits', f'{sentence}; {gap / self._dt:.3f} periods later')
        self.moving = any(rates)
        if self.moving:
            self._judge_motion(stamp, rates)
        self._positions, self._rates = positions, rates

    def _judge_motion(self, stamp: float, rates: Sequence[float]) -> None:
        now = time.time()
        since = min(stamp, now) if abs(stamp - now) < SAME_CLOCK else now
        with self._lock:
            late = since - self._until
        if late > 0.0:
            self._verdict.find('uncommanded', f'{rates}, {late:.3f} s after it should rest')

    def _broken(
        self, positions: Sequence[float], rates: Sequence[float], gap: float, steady: bool
    ) -> Iterator[str]:
        before = [*self._rates]
        if not steady:
            # The joints went on to where they were told, and no further: over all of the pause
            # that is slower, by how much nobody here can tell to the last bit.
            before = [
                min(max(new, min(0.0, old)), max(0.0, old))
                for old, new in zip(before, rates, strict=True)
            ]
        if self._positions is None or self._is_taken_over(positions, rates, steady):
            self._start = self._positions = positions
        yield from broken_limits(self._joints, self._start, positions, before, rates, self._dt)
        periods = max(1.0, round(gap / self._dt)) if math.isfinite(gap) else 1.0
        for joint, old, new in zip(self._joints, self._positions, positions, strict=True):
            most = joint.rate_limit * self._dt * periods * SLACK + 1e-9
            if abs(new - old) > most:
                yield f'{joint.name} jumps from {old!r} to {new!r}'

    def _is_taken_over(
        self, positions: Sequence[float], rates: Sequence[float], steady: bool
    ) -> bool:
        """Return whether the resolver begins again where the joints say that they rest."""
        if any(rates) or steady:
            return False
        return any(
            max(abs(one - other) for one, other in zip(said, positions, strict=True)) < TAKEN_OVER
            for said in [*self._said]
        )


class Pulse:
    """When each node last said in /diagnostics how it is, and what it said of errors."""

    def __init__(self) -> None:
        """Know nobody yet."""
        self._last: dict[str, float] = {}
        self.errors: dict[str, str] = {}

    def spoke(self, node: str, since: float) -> bool:
        """Return whether a node has said something since a time, s of the monotonic clock."""
        return self._last.get(node, -math.inf) > since

    def hear(self, message: Any) -> None:
        """Hear a message of /diagnostics."""
        for status in message.status:
            node, _, part = status.name.partition(': ')
            self._last[node] = time.monotonic()
            if part == 'errors':
                self.errors[node] = status.message
