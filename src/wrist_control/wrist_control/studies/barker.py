"""Barker's figures 6, 7 and 8 in numbers: what the paper prints beside what was measured."""

from __future__ import annotations

import math
from typing import NamedTuple

import numpy as np

from wrist_control.flight import Flight, fly
from wrist_control.rotations import Vector

# The probe pauses while it is this close to vertical, rad.
NEAR_VERTICAL = math.radians(1.0)
DOWN: Vector = (0.0, 0.0, -1.0)
LEFT: Vector = (0.0, 1.0, 0.0)


class Line(NamedTuple):
    """One line of a table: what is measured, as printed, as measured."""

    what: str
    paper: str
    measured: str


def probe_direction(flight: Flight) -> np.ndarray:
    """Return the unit vector along the probe in forearm axes, shape (n, 3)."""
    along = flight.tip - flight.hand_position
    return np.asarray(along / np.linalg.norm(along, axis=1, keepdims=True))


def angle_from_vertical(flight: Flight) -> np.ndarray:
    """Return the angle between the probe and straight down, rad, shape (n,)."""
    x, y, z = probe_direction(flight).T
    return np.arctan2(np.hypot(x, y), -z)


def arc_error(flight: Flight) -> float:
    """Return the largest angle between the probe and the two arcs of Barker's figure 6, rad."""
    x, y, _ = np.abs(probe_direction(flight).T)
    return float(np.max(np.arcsin(np.minimum(1.0, np.minimum(x, y)))))


def pause(flight: Flight) -> float:
    """Return how much longer the probe stays near vertical than it would without scaling, s."""
    away = angle_from_vertical(flight)
    lock = int(np.argmin(away))
    entered = np.interp(-NEAR_VERTICAL, -away[: lock + 1], flight.time[: lock + 1])
    left = np.interp(NEAR_VERTICAL, away[lock:], flight.time[lock:])
    speed = np.abs(flight.command).max()
    return float(left - entered - 2.0 * NEAR_VERTICAL / speed)


def peak_rates(flight: Flight) -> np.ndarray:
    """Return the largest real rate of each joint, deg/s, shape (joints,)."""
    return np.asarray(np.degrees(np.abs(flight.joint_rates).max(axis=0)))


def tip_error(flight: Flight, row: int, target: Vector) -> float:
    """Return how far the tip is from where a direction points, in probe lengths."""
    return float(np.linalg.norm(probe_direction(flight)[row] - np.array(target)))


def _inches(flight: Flight, row: int, target: Vector) -> str:
    return f'{6.0 * tip_error(flight, row, target):.4f} in.'


def three_gimbal_table(unscaled: Flight, scaled: Flight) -> list[Line]:
    """Return the table of figures 6, 7 and 8 for the basic test maneuver.

    Args:
        unscaled: Flown without rate limits at 1/32 s.
        scaled: The same with every gimbal held to 32 deg/s.
    """
    lock = int(np.argmin(angle_from_vertical(unscaled)))
    psi, _, phi = np.degrees(unscaled.joint_positions[lock + 1] - unscaled.joint_positions[lock])
    peak = peak_rates(unscaled)
    delay = scaled.time[-1] - unscaled.time[-1]
    return [
        Line('6: probe vertical after', '2.8125 s', f'{unscaled.time[lock]:.4f} s'),
        Line('6: tip off (0, 0, -6) there', '0', _inches(unscaled, lock, DOWN)),
        Line('6: tip off (0, 6, 0) at last', '0', _inches(unscaled, -1, LEFT)),
        Line('7: jump of ψ, φ at lock', '90°, 90°', f'{psi:.4f}°, {phi:.4f}°'),
        Line('7: rate of ψ, φ at lock', 'infinite', f'{peak[0]:.4f} deg/s = 90° / h'),
        Line('7: peak rate of θ', '32 deg/s', f'{peak[1]:.4f} deg/s'),
        Line('7: path error', 'agrees exactly', f'{math.degrees(arc_error(unscaled)):.4f}°'),
        Line('8: delay by scaling', 'about 2.8 s', f'{delay:.4f} s'),
        Line('8: pause at vertical', 'about 2.8 s', f'{pause(scaled):.4f} s'),
        _at_half_the_limit(scaled),
        Line('8: time lost, ∫(1 − F) dt', 'not printed', f'{scaled.time_lost[-1]:.4f} s'),
        Line('8: peak rate of any gimbal', '32 deg/s', f'{peak_rates(scaled).max():.4f} deg/s'),
        Line('8: tip off (0, 6, 0) at last', '0', _inches(scaled, -1, LEFT)),
        Line('8: path error', 'moves as desired', f'{math.degrees(arc_error(scaled)):.4f}°'),
    ]


def _at_half_the_limit(scaled: Flight) -> Line:
    limits = [0.5 * joint.rate_limit for joint in scaled.wrist.joints]
    slow = pause(fly(scaled.wrist, scaled.maneuver, joint_rate_limits=limits))
    ratio = slow / pause(scaled)
    return Line('8: the same at half the limit', 'twice as long', f'{slow:.4f} s = {ratio:.4f} ×')
