"""Closure and singularity of the Carpal wrist: Table 4.2 and figure 4.3 of [Canfield1997]."""

from __future__ import annotations

import math
from collections.abc import Sequence
from dataclasses import dataclass
from typing import NamedTuple

import numpy as np

from wrist_control.dexterity import sweep
from wrist_control.errors import UnreachableError
from wrist_control.wrists.carpal import AZIMUTHS, LOOSE, Carpal
from wrist_control.wrists.wrist import Clearance, Positions


@dataclass(frozen=True)
class PrintedCarpal(Carpal):
    """The wrist as the dissertation sees it: not ended where the hand is loose. docs/errata.md."""

    def clearances(self, positions: Sequence[float]) -> tuple[Clearance, ...]:
        """Return what is left to the edge of the workspace alone."""
        return tuple(one for one in super().clearances(positions) if one.name != LOOSE)


# What gives every digit of Table 4.2: R_b = 0.75 and R_d = 0.7 with a leg of ten (the determinant
# grows with the leg, the discriminant with its square), tilted by these β towards α = -90°.
TABLE_4_2 = PrintedCarpal(base_radius=7.5, leg_length=10.0, plunge=7.0)
TABLE_4_2_AZIMUTH = -0.5 * math.pi
TABLE_4_2_TILTS = tuple(math.radians(beta) for beta in (75.75, 75.9, 75.95, 75.972))
# θ1, θ2, θ3 in degrees, discriminant and det J as printed.
TABLE_4_2_PRINTED = (
    ('44.43', '122.29', '-24.66', '1.986', '0.0433'),
    ('44.43', '123.08', '-24.81', '0.6458', '0.0249'),
    ('44.43', '123.53', '-24.86', '0.1996', '0.0139'),
    ('44.43', '124.00', '-24.88', '0.0034', '0.0018'),
)

# Longest step of the search for a singular tilt, rad.
STEP = math.radians(0.5)


class Sample(NamedTuple):
    """One row of Table 4.2.

    Attributes:
        angles: θ1, θ2, θ3, rad.
        discriminant: The smallest of the three legs', 0 at closure, in leg lengths squared.
        determinant: det J of (4.12), 0 at a singular position, in leg lengths.
    """

    angles: Positions
    discriminant: float
    determinant: float

    def rounded(self) -> tuple[str, ...]:
        """Return θ1, θ2, θ3 in degrees, discriminant and det J to the digits of the table."""
        angles = (f'{math.degrees(theta):.2f}' for theta in self.angles)
        places = 3 if self.discriminant > 1.0 else 4
        return (*angles, f'{self.discriminant:.{places}f}', f'{self.determinant:.4f}')


def fold(wrist: Carpal, azimuth: float) -> float:
    """Return the tilt β at which a leg folds at the home plunge, rad; π where none does.

    Leg i folds where tan(β/2) cos(α - α_i) = 1/s, s = (-R_d R_b ± √(R_d² + R_b² - 1)) /
    (1 - R_d²): never when R_d² + R_b² < 1, in ratios to the leg length.

    Args:
        wrist: With its legs outward at home.
        azimuth: α, the direction of the tilt in the base plate, rad.
    """
    rb, rd = wrist.base_radius / wrist.leg_length, wrist.plunge / wrist.leg_length
    square = rd * rd + rb * rb - 1.0
    if square < 0.0:
        return math.pi
    root = math.sqrt(square)
    x, y = math.cos(azimuth), math.sin(azimuth)
    cotangent = max(
        s * (x * cos + y * sin) / (1.0 - rd * rd)
        for s in (-rd * rb - root, -rd * rb + root)
        for cos, sin in AZIMUTHS
    )
    return 2.0 * math.atan2(1.0, max(0.0, cotangent))


def sample(wrist: Carpal, azimuth: float, tilt: float) -> Sample:
    """Return closure and singularity where the hand is tilted by β towards α, rad.

    Raises:
        UnreachableError: The wrist does not close there.
    """
    near = sweep(wrist, _axis(azimuth), np.linspace(0.0, tilt, 40).tolist())[-1]
    angles = _tilted(wrist, azimuth, tilt, near)
    return Sample(angles, _discriminant(wrist, angles), _determinant(wrist, angles))


def _axis(azimuth: float) -> tuple[float, float, float]:
    return (-math.sin(azimuth), math.cos(azimuth), 0.0)


def _tilted(wrist: Carpal, azimuth: float, tilt: float, near: Positions) -> Positions:
    return wrist.inverse(wrist.target_pose(wrist.forward(wrist.home), _axis(azimuth), tilt), near)


def _determinant(wrist: Carpal, angles: Positions) -> float:
    return float(np.linalg.det(wrist.normal_jacobian(angles)))


def _discriminant(wrist: Carpal, angles: Positions) -> float:
    """Return b² - 4ac of the leg nearest to its fold, for its quadratic in 2 tan(θ/2).

    That is 16 l² (cos θ - (n_r / n_z) sin θ)², 0 where the leg lies along the midplane's normal.
    """
    a1, _, a3, a4 = wrist.forward(angles).quaternion
    slopes = (
        math.cos(theta) - (a3 * cos - a4 * sin) / a1 * math.sin(theta)
        for theta, (cos, sin) in zip(angles, AZIMUTHS, strict=True)
    )
    return 16.0 * wrist.leg_length**2 * min(slope * slope for slope in slopes)


def closure_edge(wrist: Carpal, azimuth: float) -> float:
    """Return the tilt β where the wrist stops closing, rad, found by trying poses alone."""
    tilt, step, angles = 0.0, STEP, wrist.home
    while step > 1e-9 and tilt + step < math.pi:
        try:
            angles = _tilted(wrist, azimuth, tilt + step, angles)
            tilt += step
        except UnreachableError:
            step *= 0.5
    return tilt


def singular_edge(wrist: Carpal, azimuth: float) -> float:
    """Return the tilt β where det J comes to 0, rad, found from det J alone.

    det² goes to 0 in a straight line: each step covers half the way to where that line ends.
    """
    tilt, step, before, angles = 0.0, STEP, 0.0, wrist.home
    while step > 1e-9 and tilt + step < math.pi:
        tilt += step
        angles = _tilted(wrist, azimuth, tilt, angles)
        square = _determinant(wrist, angles) ** 2
        slope = (before - square) / step
        step = min(STEP, 0.5 * square / slope) if slope > 0.0 else STEP
        before = square
    return tilt
