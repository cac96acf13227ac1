"""The simulations of [Nguyen1991], section 5, as the paper ran them: inches, single precision.

Not printed in the paper, and found from its Table 1 (docs/results/stewart.md): z₀ = 17 in. and a
level platform; length velocities by backward differences, the first one zero; numbers stored in
single precision and computed in double, as the C of its time did.
"""

from __future__ import annotations

import math
from collections.abc import Callable
from typing import Literal, NamedTuple

import numpy as np

from wrist_control.stewart.geometry import ring
from wrist_control.studies.nguyen_angles import (
    PaperAngles,
    partial_derivatives,
    rotation_matrix,
)

SAMPLING = 0.05  # s
HEIGHT = 17.0  # in., found
LEVEL = PaperAngles(0.0, 0.0, 0.0)
PLATFORM = np.array(ring(10.441, math.radians(99.20)))
BASE = np.array(ring(13.838, math.radians(16.0)))
# Both tolerances of the Newton-Raphson algorithm, tolf in in.² and tola in in. and rad: with this
# one it takes the 2 steps that the paper tells, in both cases.
TOLERANCE = 1e-3
MOST_ITERATIONS = 20

Scheme = Literal['backward', 'forward', 'central']
Path = Callable[[np.ndarray], tuple[np.ndarray, np.ndarray]]


class Case(NamedTuple):
    """One of the paper's two trajectories.

    Attributes:
        name: What the paper calls it.
        duration: s.
        path: Time to x, y and to their rates, in. and in./s, each of shape (n, 2).
        max_error: Table 1: x, y, z in µin., α, β, γ in µrad, l₁ to l₆ in in./s.
        rms_error: Table 1, the same.
    """

    name: str
    duration: float
    path: Path
    max_error: tuple[float, ...]
    rms_error: tuple[float, ...]


def straight_line(t: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
    """Return Test Case 1, eqs. (39)-(40)."""
    share = 1.0 + 3.0 * np.exp(-3.5 / 3.0 * t) - 4.0 * np.exp(-3.5 / 4.0 * t)
    rate = 3.5 * (np.exp(-3.5 / 4.0 * t) - np.exp(-3.5 / 3.0 * t))
    reach = np.array([6.3, 9.45])
    return np.array([-3.5, -5.0]) + share[:, None] * reach, rate[:, None] * reach


def circle(t: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
    """Return Test Case 2, eqs. (41)-(44), with φ₀ + 2π in (44), so that the angle goes on."""
    t1, t2, t3 = 1.0, 9.0, 10.0
    acceleration = 2.0 * math.pi / (t1 * (t3 - t1))
    parts = [t < t1, t < t2]
    angle = np.select(
        parts,
        [0.5 * acceleration * t**2, acceleration * t1 * (t - 0.5 * t1)],
        2.0 * math.pi - 0.5 * acceleration * (t3 - t) ** 2,
    )
    rate = np.select(parts, [acceleration * t, acceleration * t1], acceleration * (t3 - t))
    along = np.stack([np.cos(angle), np.sin(angle)], axis=1)
    across = np.stack([-np.sin(angle), np.cos(angle)], axis=1)
    return 5.0 * along, 5.0 * rate[:, None] * across


# As printed, signs of RMS errors and the digits of l₆ included.
LINE = Case(
    'Straight line motion',
    5.0,
    straight_line,
    (-1.907, -2.146, -1.907, 0.156, 0.103, 0.106,
     0.1546, 0.1619, -0.0433, 0.0955, 0.1084, -0.0369),
    (0.7615, 0.7313, 0.2684, 0.0623, 0.0407, 0.0445,
     0.0343, 0.0361, -0.0177, 0.0212, 0.0239, -0.0166),
)  # fmt: skip
CIRCLE = Case(
    'Circular motion',
    10.0,
    circle,
    (-2.384, -1.9374, -1.907, 0.154, -0.113, 0.111,
     0.0419, -0.0486, 0.0473, 0.0478, -0.0494, 0.4919),
    (0.8737, 0.7367, 0.2691, 0.0607, 0.0461, 0.0473,
     0.0250, 0.0196, 0.0215, 0.0216, 0.0197, 0.0250),
)  # fmt: skip
CASES = (LINE, CIRCLE)


def times(case: Case) -> np.ndarray:
    """Return the instants of a case, s."""
    return SAMPLING * np.arange(round(case.duration / SAMPLING) + 1)


def stored(values: np.ndarray) -> np.ndarray:
    """Return numbers as single precision keeps them, for arithmetic in double."""
    return values.astype(np.float32).astype(float)


def velocity_errors(
    case: Case,
    height: float = HEIGHT,
    angles: PaperAngles = LEVEL,
    scheme: Scheme = 'backward',
    single: bool = True,
) -> np.ndarray:
    """Return differentiated lengths minus J_M⁻¹ ȧ, in./s, shape (n, 6). [Nguyen1991], fig. 5."""
    t = times(case)
    xy, rates = case.path(t)
    arms = PLATFORM @ rotation_matrix(angles).T - BASE
    legs = np.insert(xy, 2, height, axis=1)[:, None] + arms
    lengths = np.linalg.norm(legs, axis=2)
    computed = np.einsum('tik,tk->ti', legs[:, :, :2], rates) / lengths
    slope = np.diff(stored(lengths) if single else lengths, axis=0) / SAMPLING
    errors = np.zeros_like(computed)
    if scheme == 'backward':
        errors[1:] = slope - computed[1:]
    elif scheme == 'forward':
        errors[:-1] = slope - computed[:-1]
    else:
        errors[1:-1] = 0.5 * (slope[1:] + slope[:-1]) - computed[1:-1]
    return errors


def pose_errors(case: Case) -> tuple[np.ndarray, float]:
    """Return what the paper's Newton-Raphson algorithm misses, and its mean number of steps.

    Returns:
        Errors of x, y, z in µin. and of α, β, γ in µrad, shape (n, 6); and the number.
    """
    xy, _ = case.path(times(case))
    truth = stored(np.insert(np.pad(xy, ((0, 0), (0, 3))), 2, HEIGHT, axis=1))
    a, errors, steps = truth[0], np.zeros_like(truth), 0
    for row, wanted in enumerate(truth):
        lengths = stored(np.sqrt(squares(wanted)[0]))
        a, more = newton_raphson(lengths, a)
        errors[row], steps = 1e6 * (a - wanted), steps + more
    return errors, steps / len(truth)


def newton_raphson(lengths: np.ndarray, a: np.ndarray) -> tuple[np.ndarray, int]:
    """Return the paper's answer, and in how many steps. [Nguyen1991], section 4, steps 2 to 7.

    Corrected: step 6 takes |δa|, and comes after step 7's addition, so that the last δa counts.
    """
    for steps in range(MOST_ITERATIONS):
        found, derivative = squares(a)
        f = found - lengths * lengths
        if np.abs(f).sum() < TOLERANCE:
            return a, steps
        change = np.linalg.solve(derivative, -f)
        a = stored(a + change)
        if np.abs(change).sum() < TOLERANCE:
            return a, steps + 1
    return a, MOST_ITERATIONS


def squares(a: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
    """Return l², in.², and its derivatives by (x, y, z, α, β, γ), shape (6, 6)."""
    platform, base, angles = stored(PLATFORM), stored(BASE), PaperAngles(*a[3:])
    legs = a[:3] + platform @ rotation_matrix(angles).T - base
    x, y, z = a[:3]
    return (legs * legs).sum(axis=1), partial_derivatives(platform, base, (x, y, z), angles)


def summary(errors: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
    """Return the errors of largest size, with their signs, and the RMS errors, by column."""
    largest = np.abs(errors).argmax(axis=0)
    return errors[largest, range(errors.shape[1])], np.sqrt((errors**2).mean(axis=0))


def printed_misfit(
    height: float, angles: PaperAngles = LEVEL, scheme: Scheme = 'backward'
) -> np.ndarray:
    """Return measured minus printed sizes, in./s: the 24 length velocities of Table 1.

    The circle's l₆, printed 0.4919 and meant 0.0419, is taken as meant.
    """
    found = []
    for case in CASES:
        most, rms = summary(velocity_errors(case, height, angles, scheme, single=False))
        meant = np.abs(case.max_error[6:])
        meant[meant > 0.4] = 0.0419
        found += [np.abs(most) - meant, rms - np.abs(case.rms_error[6:])]
    return np.concatenate(found)
