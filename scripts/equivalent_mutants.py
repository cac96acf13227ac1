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


MANEUVERS = 'operating/maneuvers.py'
EQUIVALENT = (
    *(
        Equivalent(
            MANEUVERS,
            'x, y, z = (chance.gauss(0.0, 1.0) for _ in range(3))',
            '1.0',
            after,
            'a direction has no length',
        )
        for after in ('(10.0)', '(0.1)', '(2.0)')
    ),
    *(
        Equivalent(
            'operating/pilot.py',
            'self._share = 1.0',
            '1.0',
            after,
            'at the first order no time has been lost, and so the share is not looked at',
        )
        for after in ('(10.0)', '(0.1)', '(2.0)', '(0.0)', '(-1.0)')
    ),
    Equivalent(
        'resolving/platform_observer.py',
        'self._searched = -math.inf',
        '-math.inf',
        '(math.inf)',
        'either way no search lies less than a second back',
    ),
    *(
        Equivalent(
            'wrists/pitch_yaw.py',
            'before = self.inverse(pose, (0.0, 0.0))',
            '0.0',
            after,
            'whole turns are taken off again',
        )
        for after in ('(1.0)', '(-1.0)')
    ),
)
