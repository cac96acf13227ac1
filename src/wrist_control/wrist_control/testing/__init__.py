"""Laws that every wrist keeps, for those who add one: `check_wrist(MyWrist())`.

Each law compares an answer of the wrist with an independent truth (finite differences, another of
its answers, the mathematics of rotations) at random places, the same ones in every run.
"""

from __future__ import annotations

from collections.abc import Callable

import numpy as np

from wrist_control.testing.answers import ANSWERS
from wrist_control.testing.broken import LawBrokenError
from wrist_control.testing.eased import EASED
from wrist_control.testing.held import HELD
from wrist_control.testing.lock import LOCK
from wrist_control.testing.motion import MOTION
from wrist_control.testing.seen import SEEN
from wrist_control.wrists.wrist import Wrist

__all__ = ['LAWS', 'LawBrokenError', 'check_wrist']

Law = Callable[[Wrist, np.random.Generator], None]
LAWS: dict[str, Law] = {
    law.__name__: law for law in (*ANSWERS, *LOCK, *MOTION, *HELD, *EASED, *SEEN)
}


def check_wrist(wrist: Wrist, seed: int = 1) -> None:
    """Check that a wrist keeps every law.

    Args:
        wrist: The mechanism, with its default limits or others.
        seed: Chooses the places where it is asked.

    Raises:
        LawBrokenError: A law is broken; the sentence says which, where, and by how much.
    """
    for name, law in LAWS.items():
        try:
            law(wrist, np.random.default_rng(seed))
        except LawBrokenError as error:
            raise LawBrokenError(f'{type(wrist).__name__} breaks {name}: {error}') from error
