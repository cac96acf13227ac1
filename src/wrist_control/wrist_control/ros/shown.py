"""How a text that somebody else has written is shown: in one line, and short."""

from __future__ import annotations

NAME = 80
SENTENCE = 400


def shown(text: str, most: int = NAME) -> str:
    """Return a text as it may stand in a log, a status or a diagnosis.

    A name with a line break in it could forge a whole line of the log, and one of a megabyte
    could hide all others.

    Args:
        text: As it came.
        most: How many characters are left of it.
    """
    escaped = ''.join(
        c if c.isprintable() else c.encode('unicode_escape').decode() for c in text[: most + 1]
    )
    return escaped if len(escaped) <= most else f'{escaped[: most - 1]}…'
