"""The four-gimbal wrist by figure 5 of [Barker1986], for many maneuvers at once.

`fly` takes one wrist through one maneuver with everything that may hold it up. A search over
thousands of maneuvers needs the gimbals alone, without limits, as arrays.
"""

from __future__ import annotations

import math

import numpy as np

from wrist_control.operating.maneuvers import BARKER_SPEED, EARLY
from wrist_control.wrists.four_gimbal import SIDE

STEP = 1.0 / 32.0  # s
# K of figures 9 and 10, rad/s.
PAPER_GAIN = 0.8


def peak_rates(
    pitches: np.ndarray,
    directions: np.ndarray,
    speed: float = BARKER_SPEED,
    gain: float = PAPER_GAIN,
    step: float = STEP,
) -> np.ndarray:
    """Return the fastest gimbal increments of pitching, then turning on, from home, rad/s.

    θ must stay within ±90°: the gain must be above the hand's rate.

    Args:
        pitches: How far the hand pitches up first, rad, shape (n,), none negative.
        directions: The axis of the whole turn that follows, unit (p, q, r), shape (n, 3).
        speed: Of the hand in both parts, rad/s.
        gain: K of eq. (1), rad/s.
        step: h, s.
    """
    pitching, turning = pitches / (speed * step), math.tau / (speed * step)
    first = np.ceil(pitching - EARLY)
    hand = np.tile(np.eye(3), (len(pitches), 1, 1))
    gimbals = np.zeros((3, len(pitches)))
    alpha, law, peak = np.zeros((3, len(pitches)))
    for k in range(math.ceil(first.max() + turning - EARLY)):
        # The last step of each part is flown slower, so that the part ends exactly.
        pitched = np.clip(pitching - k, 0.0, 1.0) * (k < first)
        turned = np.clip(turning - (k - first), 0.0, 1.0) * (k >= first)
        command = pitched[:, None] * np.array([0.0, 1.0, 0.0]) + turned[:, None] * directions
        before, law = law, _alpha_rates(gimbals, gain)
        alpha_rate = 1.5 * law - 0.5 * before
        alpha += step * alpha_rate
        hand = _rotations(-speed * step * command) @ hand
        found = _gimbals(hand, alpha)
        moved = (found - gimbals + math.pi) % math.tau - math.pi
        fastest = np.maximum(np.abs(moved).max(axis=0) / step, np.abs(alpha_rate))
        peak = np.where(pitched + turned > 0.0, np.maximum(peak, fastest), peak)
        gimbals = found
    return peak


def _alpha_rates(gimbals: np.ndarray, gain: float) -> np.ndarray:
    """Return α̇ of eq. (1), rad/s, 0 at home, where the extrapolation starts."""
    _, theta, phi = gimbals
    return np.where(np.sin(phi) < SIDE, 1.0, -1.0) * gain * np.sin(theta)


def _rotations(turns: np.ndarray) -> np.ndarray:
    """Return the matrices of rotation vectors, rad, shape (n, 3), by Rodrigues' formula."""
    angle = np.linalg.norm(turns, axis=1)[:, None, None]
    cross = np.cross(np.eye(3), turns[:, None])
    # sin x / x and (1 - cos x) / x², right at 0 too.
    once, twice = np.sinc(angle / math.pi), 0.5 * np.sinc(0.5 * angle / math.pi) ** 2
    return np.asarray(np.eye(3) + once * cross + twice * (cross @ cross))


def _gimbals(hand: np.ndarray, alpha: np.ndarray) -> np.ndarray:
    """Return ψ, θ, φ of the hand's matrices C for an α, rad, shape (3, n). Figure 5(b)."""
    s, c = np.sin(alpha)[:, None], np.cos(alpha)[:, None]
    x, y, z = hand[:, 0] * c - hand[:, 1] * s, hand[:, 0] * s + hand[:, 1] * c, hand[:, 2]
    theta = np.arctan2(-x[:, 2], np.hypot(x[:, 0], x[:, 1]))
    return np.stack([np.arctan2(x[:, 1], x[:, 0]), theta, np.arctan2(y[:, 2], z[:, 2])])
