"""From a joystick's axes and buttons to hand rates: a dead-man button, a dead zone, a scale."""

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
    """

    axes: tuple[int, int, int]
    scales: tuple[float, float, float]
    deadzone: float
    enable_button: int

    def rates(self, axes: Sequence[float], buttons: Sequence[int]) -> Vector:
        """Return p, q, r, rad/s; zero while the enable button is not held.

        Raises:
            RefusedError: The joystick has no such axis or button, or says what is no number.
        """
        if self.enable_button >= len(buttons) or max(self.axes) >= len(axes):
            raise RefusedError(
                'too few axes or buttons',
                f'The joystick has {len(axes)} axes and {len(buttons)} buttons; joy_axes asks '
                f'for {list(self.axes)} and enable_button for {self.enable_button}, from 0.',
            )
        asked = [axes[number] for number in self.axes]
        if not all(math.isfinite(value) for value in asked):
            raise RefusedError('not finite', f'Refused a joystick that says {asked}.')
        if self.enable_button >= 0 and not buttons[self.enable_button]:
            return ZERO_RATES
        p, q, r = (
            scale * self._deflection(value)
            for scale, value in zip(self.scales, asked, strict=True)
        )
        return (p, q, r)

    def _deflection(self, value: float) -> float:
        # A driver that is not calibrated may say more than full deflection.
        beyond = max(0.0, min(1.0, abs(value)) - self.deadzone) / (1.0 - self.deadzone)
        return beyond if value > 0.0 else -beyond


class JoystickWithTimeout:
    """What the joystick asked for last, until it falls silent.

    Attributes:
        joystick: How it is held.
        timeout: s without a message after which the rates are zero.
    """

    def __init__(self, joystick: Joystick, timeout: float) -> None:
        """Start with nothing asked for."""
        self.joystick = joystick
        self.timeout = timeout
        self._rates: Vector = ZERO_RATES
        self._heard: float | None = None

    def take(self, axes: Sequence[float], buttons: Sequence[int], receipt_time: float) -> None:
        """Hear a joystick message.

        Args:
            axes: Deflections, -1 to 1.
            buttons: 1 where pressed.
            receipt_time: Now, s.

        Raises:
            RefusedError: As `Joystick.rates`; it counts as released.
        """
        self._rates, self._heard = ZERO_RATES, receipt_time
        self._rates = self.joystick.rates(axes, buttons)

    def rates(self, receipt_time: float) -> Vector:
        """Return p, q, r now, rad/s; zero when the joystick has been silent for too long."""
        if self._heard is None or receipt_time - self._heard > self.timeout:
            return ZERO_RATES
        return self._rates
