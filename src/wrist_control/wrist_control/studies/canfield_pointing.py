"""The pointing study of [Canfield1997], section 4.6.3: three pointers, compared over directions.

A direction of the hand's z axis is (α, β): the azimuth, and the tilt from the forearm's z. Each
pointer's Jacobian is read in three ways: as the paper computed it; corrected; and without
coordinates, as hand rates p, q, so that no measure depends on where the pole of α and β lies.
"""

from __future__ import annotations

import math
from collections.abc import Callable, Sequence
from typing import Literal, NamedTuple

import numpy as np

from wrist_control.dexterity import Uniformity, dexterous_measure, jacobians, principal, sweep
from wrist_control.studies.canfield_closure import PrintedCarpal
from wrist_control.wrists.five_bar import FiveBar
from wrist_control.wrists.pitch_yaw import PitchYaw
from wrist_control.wrists.wrist import Positions, Wrist

Reading = Literal['printed', 'corrected', 'coordinate-free']
READINGS: tuple[Reading, ...] = ('printed', 'corrected', 'coordinate-free')


def hemisphere(largest: float, azimuths: int, tilts: int) -> tuple[np.ndarray, np.ndarray]:
    """Return α and β in equal steps, rad, shapes (azimuths,) and (tilts,); β = 0 is left out."""
    return (
        np.linspace(0.0, math.tau, azimuths, endpoint=False),
        np.linspace(largest / tilts, largest, tilts),
    )


def transform(alpha: np.ndarray, beta: np.ndarray) -> np.ndarray:
    """Return T of (4.27), (α̇, β̇) per (dN̂x/dt, dN̂y/dt) of the unit normal at α and β."""
    s, c = np.sin(beta), np.cos(beta)
    rows = [[-np.sin(alpha) / s, np.cos(alpha) / s], [np.cos(alpha) / c, np.sin(alpha) / c]]
    return _stacked(rows)


class Pointer(NamedTuple):
    """One of the three wrists that are compared.

    Attributes:
        name: What it is called by.
        wrist: The mechanism.
        aim: Joint positions for an azimuth α and tilts β, rad, as far as the wrist reaches.
        printed: The paper's (α̇, β̇) per joint rate over azimuths (a,) and tilts (b,), shape
            (a, b, 2, joints).
    """

    name: str
    wrist: Wrist
    aim: Callable[[float, Sequence[float]], list[Positions]]
    printed: Callable[[np.ndarray, np.ndarray], np.ndarray]


def carpal(base_ratio: float, plunge_ratio: float) -> Pointer:
    """Return the Carpal wrist of ratios R_b and R_d to a leg of 0.1 m."""
    wrist = PrintedCarpal(0.1 * base_ratio, 0.1, 0.1 * plunge_ratio)

    def aim(alpha: float, beta: Sequence[float]) -> list[Positions]:
        return sweep(wrist, (-math.sin(alpha), math.cos(alpha), 0.0), beta)

    def printed(alpha: np.ndarray, beta: np.ndarray) -> np.ndarray:
        """(4.29) as it stands: N̂ is at β/2, so that the second row is half of β̇."""
        slopes = np.full((len(alpha), len(beta), 2, 3), np.nan)
        for row, azimuth in enumerate(alpha.tolist()):
            for column, position in enumerate(aim(azimuth, beta.tolist())):
                slopes[row, column] = wrist.normal_jacobian(position)[:2]
        found: np.ndarray = transform(alpha[:, None], 0.5 * beta) @ slopes
        return found

    return Pointer(f'Carpal {base_ratio:g}, {plunge_ratio:g}', wrist, aim, printed)


def pitch_yaw() -> Pointer:
    """Return the serial pitch-yaw pointer, aimed by (4.32)."""

    def aim(alpha: float, beta: Sequence[float]) -> list[Positions]:
        return [(math.asin(-y), math.atan2(x, z)) for x, y, z in _normals(alpha, beta)]

    def printed(alpha: np.ndarray, beta: np.ndarray) -> np.ndarray:
        """(4.33), its -cos θ2 read as -cos θ1: docs/errata.md."""
        x, y = _horizontal(alpha[:, None], beta)
        theta_1 = np.arcsin(-y)
        theta_2 = np.arcsin(np.clip(x / np.cos(theta_1), -1.0, 1.0))
        s1, c1, s2, c2 = np.sin(theta_1), np.cos(theta_1), np.sin(theta_2), np.cos(theta_2)
        slopes = _stacked([[-s1 * s2, c1 * c2], [-c1, np.zeros_like(c1)]])
        found: np.ndarray = transform(alpha[:, None], beta) @ slopes
        return found

    return Pointer('pitch-yaw', PitchYaw(), aim, printed)


def five_bar() -> Pointer:
    """Return the spherical five-bar pointer, aimed by its true kinematics."""

    def aim(alpha: float, beta: Sequence[float]) -> list[Positions]:
        return [(math.atan2(x, z), math.atan2(y, z)) for x, y, z in _normals(alpha, beta)]

    def printed(alpha: np.ndarray, beta: np.ndarray) -> np.ndarray:
        """(4.36): right for the passive joints' angles, not for the actuated ones."""
        x, y = _horizontal(alpha[:, None], beta)
        zero = np.zeros_like(x)
        slopes = _stacked([[np.sqrt(1.0 - x * x), zero], [zero, np.sqrt(1.0 - y * y)]])
        found: np.ndarray = transform(alpha[:, None], beta) @ slopes
        return found

    return Pointer('five-bar', FiveBar(), aim, printed)


def pointing_jacobians(
    pointer: Pointer, alpha: np.ndarray, beta: np.ndarray, reading: Reading
) -> np.ndarray:
    """Return a pointer's Jacobians over a grid of directions.

    Args:
        pointer: The wrist and how it is aimed.
        alpha: Azimuths, rad, shape (a,).
        beta: Tilts, rad, shape (b,).
        reading: Rows α̇, β̇ as the paper has them or corrected; or the rates p, q.

    Returns:
        Shape (a, b, 2, joints); NaN where the wrist does not reach.
    """
    if reading == 'printed':
        return pointer.printed(alpha, beta)
    wrist = pointer.wrist
    found = np.full((len(alpha), len(beta), 2, len(wrist.joints)), np.nan)
    for row, azimuth in enumerate(alpha.tolist()):
        positions = pointer.aim(azimuth, beta.tolist())
        inside = jacobians(wrist, positions)
        if reading == 'corrected':
            hand_axes = np.array([wrist.forward(position).rotation for position in positions])
            inside = _spherical(hand_axes, inside, np.array(azimuth), beta[: len(positions)])
        found[row, : len(positions)] = inside
    return found


def pointing_measure(
    pointer: Pointer,
    reading: Reading,
    largest: float,
    by_solid_angle: bool,
    azimuths: int = 120,
    tilts: int = 179,
) -> Uniformity:
    """Return how uniform the least principal dexterity is: a row of Table 4.3.

    Args:
        pointer: The wrist and how it is aimed.
        reading: How its Jacobian is read.
        largest: Tilt up to which the directions go, rad.
        by_solid_angle: Count every direction by its solid angle, instead of equal steps of α, β.
        azimuths: How many α.
        tilts: How many β.
    """
    alpha, beta = hemisphere(largest, azimuths, tilts)
    least = principal(pointing_jacobians(pointer, alpha, beta, reading))[..., -1]
    weights = np.broadcast_to(np.sin(beta), least.shape) if by_solid_angle else None
    return dexterous_measure(least, weights)


def _spherical(
    hand_axes: np.ndarray, pq: np.ndarray, alpha: np.ndarray, beta: np.ndarray
) -> np.ndarray:
    """Return (α̇, β̇) per joint rate from p and q, which move z by q x - p y in hand axes."""
    moved = hand_axes[:, 0, :2, None] * pq[:, None, 1] - hand_axes[:, 1, :2, None] * pq[:, None, 0]
    found: np.ndarray = transform(alpha, beta) @ moved
    return found


def _normals(alpha: float, beta: Sequence[float]) -> list[tuple[float, float, float]]:
    return [
        (math.sin(b) * math.cos(alpha), math.sin(b) * math.sin(alpha), math.cos(b)) for b in beta
    ]


def _horizontal(alpha: np.ndarray, beta: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
    """Return N_x and N_y of (4.31)."""
    return np.sin(beta) * np.cos(alpha), np.sin(beta) * np.sin(alpha)


def _stacked(rows: list[list[np.ndarray]]) -> np.ndarray:
    return np.stack([np.stack(np.broadcast_arrays(*row), axis=-1) for row in rows], axis=-2)
