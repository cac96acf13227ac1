"""How much of a step can be made without breaking a limit."""

from __future__ import annotations

from collections.abc import Callable, Iterable, Sequence
from itertools import count
from typing import TypeAlias, TypeVar

from wrist_control.resolving.limits import LimitAtWork, smallest_share

Made = TypeVar('Made')
# What a share of a step makes, or None and the limits that it would break.
Attempt: TypeAlias = Callable[[float], tuple['Made | None', Sequence[LimitAtWork]]]

# A limit that is neared in proportion to the share is met by the first guess, a gently bent one
# by the next few. After these it is one that no straight line leads to.
GUESSES = 6
# A guess below this is none: a joint resting on its limit can be led away from it and back over
# it within one step, and how far an edge is nobody may know. So much of the share is tried then.
LEAP = 0.1
# Of what the rate limits allow, less than this is no motion.
SMALLEST_FACTOR = 1e-6
# The share is known as well as this: less than an operator can tell.
RESOLUTION = 0.01


def largest_share(
    attempt: Attempt[Made], share: float, limits: Iterable[LimitAtWork] = ()
) -> tuple[float, Made | None, list[LimitAtWork]]:
    """Return the largest share found that can be made, what it makes, and every limit at work.

    A guess takes each limit to be neared in proportion to the share; where that fails, a tenth of
    the share is tried, again and again. If a little more than what can be made can be made as
    well, it is bisected against what could not. Where less than a millionth can be made, the
    share is 0 and None is made.

    Args:
        attempt: Makes a share of a step, or tells the limits that this would break.
        share: The share to begin with.
        limits: Those that have chosen it.
    """
    known = list(limits)
    too_much, smallest = share, SMALLEST_FACTOR * share
    for guesses in count():
        made, broken = attempt(share)
        if made is not None:
            break
        known = _joined(known, broken)
        too_much, guess = share, smallest_share(broken)
        share *= guess if guesses < GUESSES and guess > LEAP else LEAP
        if not share > smallest:
            return 0.0, None, known
    probe = (1.0 + RESOLUTION) * share
    while too_much - share > RESOLUTION * too_much:
        more, _ = attempt(probe)
        if more is None:
            too_much = probe
        else:
            share, made = probe, more
        probe = 0.5 * (share + too_much)
    return share, made, known


def _joined(known: list[LimitAtWork], broken: Iterable[LimitAtWork]) -> list[LimitAtWork]:
    """Return all limits, each kind once for a joint: as the whole command asked for it."""
    already = {(limit.joint, limit.kind) for limit in known}
    return known + [limit for limit in broken if (limit.joint, limit.kind) not in already]
