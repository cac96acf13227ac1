"""From a joystick's axes and buttons to hand rates: a dead-man button, a dead zone, a curve.

A driver may say nothing true of an axis before it has moved, and a trigger rests at one end of its
axis: so nothing moves before every axis that is followed has been seen at rest.
"""

from __future__ import annotations

import math
from collections.abc import Sequence
from typing import NamedTuple

from wrist_control.errors import RefusedError
from wrist_control.operating.maneuvers import ZERO_RATES
from wrist_control.rotations import Vector


class Joystick(NamedTuple):
    """How a joystick is held.

    Attributes:
        axes: Numbers of the axes that give p, q and r.
        scales: p, q and r at full deflection, rad/s; a negative one turns the axis round.
        deadzone: Deflections below this, of 1, count as none; the rest is stretched over 0 to 1.
        enable_button: Number of the button that must be held, -1 for none.
        expo: 0 for rates in proportion, up to 1 for the cube of the deflection: finer in the
            middle, the same at the end.
        turbo_button: Number of the button that changes the speed while it is held, -1 for none.
        turbo_factor: Times as fast then; below 1 is slower.
    """

    axes: tuple[int, int, int]
    scales: tuple[float, float, float]
    deadzone: float
    enable_button: int
    expo: float = 0.0
    turbo_button: int = -1
    turbo_factor: float = 1.0

    def rates(self, axes: Sequence[float], buttons: Sequence[int]) -> Vector:
        """Return p, q, r, rad/s; zero while the enable button is not held.

        Raises:
            RefusedError: The joystick has no such axis or button, or says what is no number.
        """
        asked = self._asked(axes)
        if max(self.enable_button, self.turbo_button) >= len(buttons):
            raise RefusedError(
                'too few buttons',
                f'The joystick has {len(buttons)} buttons; enable_button asks for '
                f'{self.enable_button} and turbo_button for {self.turbo_button}, from 0.',
            )
        if not self.is_enabled(buttons):
            return ZERO_RATES
        is_turbo = self.turbo_button >= 0 and buttons[self.turbo_button]
        factor = self.turbo_factor if is_turbo else 1.0
        p, q, r = (
            factor * scale * self._curved(self._deflection(value))
            for scale, value in zip(self.scales, asked, strict=True)
        )
        return (p, q, r)

    def is_enabled(self, buttons: Sequence[int]) -> bool:
        """Return whether the enable button is held, where there is one."""
        return self.enable_button < 0 or bool(buttons[self.enable_button])

    def is_at_rest(self, axes: Sequence[float]) -> bool:
        """Return whether no axis that is followed is beyond the dead zone.

        Raises:
            RefusedError: As `rates`.
        """
        return not any(self._deflection(value) for value in self._asked(axes))

    def _asked(self, axes: Sequence[float]) -> list[float]:
        if max(self.axes) >= len(axes):
            raise RefusedError(
                'too few axes',
                f'The joystick has {len(axes)} axes; joy_axes asks for {list(self.axes)}, from 0.',
            )
        asked = [axes[number] for number in self.axes]
        if not all(math.isfinite(value) for value in asked):
            raise RefusedError('not finite', f'Refused a joystick that says {asked}.')
        return asked

    def _deflection(self, value: float) -> float:
        # A driver that is not calibrated may say more than full deflection.
        beyond = max(0.0, min(1.0, abs(value)) - self.deadzone) / (1.0 - self.deadzone)
        return beyond if value > 0.0 else -beyond

    def _curved(self, deflection: float) -> float:
        return (1.0 - self.expo) * deflection + self.expo * deflection**3


class JoystickWithTimeout:
    """What the joystick asked for last, until it falls silent.

    Who begins, lets go of the enable button with a stick deflected, or was silent, must let go of
    the sticks before the hand moves again.

    Attributes:
        joystick: How it is held.
        timeout: s without a message after which the rates are zero.
        must_let_go: True while the joystick asks for motion that does not count yet.
    """

    def __init__(self, joystick: Joystick, timeout: float) -> None:
        """Start with nothing asked for."""
        self.joystick = joystick
        self.timeout = timeout
        self.must_let_go = False
        self._rates: Vector = ZERO_RATES
        self._heard: float | None = None
        self._counts = False

    def take(self, axes: Sequence[float], buttons: Sequence[int], receipt_time: float) -> None:
        """Hear a joystick message.

        Args:
            axes: Deflections, -1 to 1.
            buttons: 1 where pressed.
            receipt_time: Now, s.

        Raises:
            RefusedError: As `Joystick.rates`; it counts as released.
        """
        held = self._counts and not self._is_silent(receipt_time)
        self._rates, self._heard = ZERO_RATES, receipt_time
        self._counts = self.must_let_go = False
        rates = self.joystick.rates(axes, buttons)
        at_rest = self.joystick.is_at_rest(axes)
        self._counts = at_rest or (held and self.joystick.is_enabled(buttons))
        self.must_let_go = not self._counts and any(rates)
        self._rates = rates if self._counts else ZERO_RATES

    def rates(self, receipt_time: float) -> Vector:
        """Return p, q, r now, rad/s; zero when the joystick has been silent for too long."""
        return ZERO_RATES if self._is_silent(receipt_time) else self._rates

    def _is_silent(self, receipt_time: float) -> bool:
        return self._heard is None or receipt_time - self._heard > self.timeout
