"""What the console asks of its wrists at every moment: of whoever holds the stick, or nothing."""

from __future__ import annotations

import math
import threading
from collections.abc import Sequence
from typing import NamedTuple

from wrist_control.errors import RefusedError
from wrist_control.operating.lease import LASTS, Lease, Renewal
from wrist_control.operating.maneuvers import MANEUVERS, ZERO_RATES, make_maneuver
from wrist_control.operating.pilot import Pilot
from wrist_control.rotations import Vector


class Asked(NamedTuple):
    """What whoever holds the stick asks for.

    Attributes:
        deflection: Of the stick in p, q, r, each -1 to 1.
        speed: Hand rate at full deflection, rad/s, and of a maneuver.
        maneuver: What to fly instead while it is held; empty for the stick.
    """

    deflection: Vector
    speed: float
    maneuver: str = ''


class Driver:
    """Turns the lease of the stick into rates; every method may be called from any thread.

    All times are s on one clock that never jumps.
    """

    def __init__(self, period: float, fastest: float) -> None:
        """Begin with nobody holding.

        Args:
            period: How long each command is held, s.
            fastest: Largest hand rate that may be asked for, rad/s.
        """
        self._lease: Lease[Asked] = Lease()
        self._lock = threading.Lock()
        self._period = period
        self._fastest = fastest
        self._pilot: Pilot | None = None
        self._flown_by: tuple[str, int] | None = None
        self._zeros = 0

    def hold(self, renewal: Renewal[Asked], now: float) -> str:
        """Take or keep the stick; return why not, one sentence, or nothing."""
        try:
            renewal = renewal._replace(asked=self._checked(renewal.asked))
        except RefusedError as error:
            self.release(renewal.holder)
            return str(error)
        with self._lock:
            return self._lease.renew(renewal, now)

    def release(self, holder: str) -> None:
        """Let go, if it is this holder who holds."""
        with self._lock:
            self._lease.release(holder)

    def release_all(self) -> None:
        """Let go, whoever holds."""
        with self._lock:
            self._lease.release_all()

    def forget(self, holder: str) -> None:
        """Let go, for a holder that will never come back."""
        with self._lock:
            self._lease.forget(holder)

    def holder(self, now: float) -> str:
        """Return who holds the stick; nothing when nobody does."""
        with self._lock:
            held = self._lease.held(now)
        return held.holder if held else ''

    def rates(self, now: float, time_lost: float) -> Vector | None:
        """Return p, q, r to ask for now, rad/s; None when there is nothing to say.

        After the stick is let go zeros are said for a moment, so that one of them arrives; then
        nothing, for whoever says nothing keeps nobody else from leading the hand.

        Args:
            now: Now, s.
            time_lost: The time that the hand has lost so far, s.
        """
        with self._lock:
            held = self._lease.held(now)
            if held is None:
                self._pilot, self._zeros = None, max(0, self._zeros - 1)
                return ZERO_RATES if self._zeros else None
            self._zeros = math.ceil(LASTS / self._period)
            if held.asked.maneuver:
                return self._flown(held, now, time_lost)
            x, y, z = held.asked.deflection
            speed = held.asked.speed
            return (speed * x, speed * y, speed * z)

    def _flown(self, held: Renewal[Asked], now: float, time_lost: float) -> Vector:
        """Return what a maneuver asks for; when it is done the stick is let go."""
        grip = (held.holder, held.grip)
        if self._pilot is None or self._flown_by != grip:
            maneuver = make_maneuver(held.asked.maneuver, held.asked.speed)
            self._pilot, self._flown_by = Pilot(maneuver, self._period), grip
        rates = self._pilot.rates(now, time_lost)
        if self._pilot.done:
            self._lease.release(held.holder)
        return rates

    def _checked(self, asked: Asked) -> Asked:
        """Return what is asked for within its bounds.

        Raises:
            RefusedError: It is not finite, or there is no such maneuver.
        """
        numbers: Sequence[float] = (*asked.deflection, asked.speed)
        if not all(math.isfinite(number) for number in numbers):
            raise RefusedError('not finite', 'The page sent a number that is not finite.')
        if asked.maneuver and asked.maneuver not in MANEUVERS:
            raise RefusedError(
                'no such maneuver', f'There is no maneuver {asked.maneuver!r} to fly.'
            )
        x, y, z = (max(-1.0, min(1.0, value)) for value in asked.deflection)
        speed = max(1e-6, min(self._fastest, asked.speed))
        return Asked((x, y, z), speed, asked.maneuver)
