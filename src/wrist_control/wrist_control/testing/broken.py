"""What a broken law says."""

from __future__ import annotations

import numpy as np

from wrist_control.errors import WristError


class LawBrokenError(WristError, AssertionError):
    """A wrist does not keep a law."""


def require(kept: object, sentence: str) -> None:
    """Raise LawBrokenError with a sentence unless a law is kept."""
    if not kept:
        raise LawBrokenError(sentence)


def require_close(got: object, expected: object, tolerance: float, what: str) -> None:
    """Raise LawBrokenError unless two arrays agree within an absolute tolerance.

    Args:
        got: What the wrist answers.
        expected: What is true.
        tolerance: Largest difference allowed, in the unit of both.
        what: What is compared, and where.
    """
    one, other = np.asarray(got, dtype=float), np.asarray(expected, dtype=float)
    require(one.shape == other.shape, f'{what} has the shape {one.shape}, not {other.shape}')
    apart = np.abs(one - other)
    require(
        bool((apart <= tolerance).all()),
        f'{what} is {one.tolist()}, not {other.tolist()}: {float(np.max(apart)):.2g} apart',
    )
