"""Faults that are none: nothing that anybody could see changes, so no test can find them."""

from __future__ import annotations

from typing import NamedTuple


class Equivalent(NamedTuple):
    """One random fault that is not made.

    Attributes:
        file: Path below the package's folder.
        line: The whole line it would be in.
        before: The text that would be replaced.
        after: What would replace it.
        why: Why nobody could tell.
    """

    file: str
    line: str
    before: str
    after: str
    why: str


EQUIVALENT: tuple[Equivalent, ...] = ()
