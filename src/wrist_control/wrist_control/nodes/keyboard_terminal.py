"""The terminal of the keyboard: it gives every key at once, shows one page, and is put back."""

from __future__ import annotations

import contextlib
import os
import select
import sys
import tempfile
import termios
from collections.abc import Sequence
from typing import Any, BinaryIO

from wrist_control.errors import InvalidValueError

IN, OUT, ERR = 0, 1, 2
IFLAG, LFLAG, CC = 0, 3, 6
MOST_BYTES = 1024
# Of a terminal that does not say.
UNKNOWN_SIZE = (80, 24)
# Another page, no cursor, and long lines cut off; and back.
ENTER, LEAVE = '\x1b[?1049h\x1b[?25l\x1b[?7l', '\x1b[?7h\x1b[?25h\x1b[?1049l'
HOME, BLANK, BELOW = '\x1b[H', '\x1b[K', '\x1b[J'


class Terminal:
    """A terminal that is entered, and left as it was found, as often as one likes.

    Meanwhile what is logged is kept: it would tear the page, and is told when the page is left.

    Attributes:
        gone: True once the terminal has closed.
    """

    def __init__(self) -> None:
        """Touch nothing yet."""
        self.gone = False
        self._found: list[Any] = []
        self._is_entered = False
        self._shown = ''
        self._log: BinaryIO | None = None
        self._stderr = ERR

    def enter(self) -> None:
        """Take every key at once, without those that came before; again after a stop as well.

        Raises:
            InvalidValueError: There is no terminal.
        """
        if not os.isatty(IN) or not os.isatty(OUT):
            raise InvalidValueError(
                'keyboard needs a terminal to read keys from and to show them in; start it in '
                'one, and neither from a pipe nor from a launch file.'
            )
        if not self._found:
            self._found = termios.tcgetattr(IN)
        # Whoever is in the background is stopped here, before anything is written.
        termios.tcsetattr(IN, termios.TCSAFLUSH, _every_key(self._found))
        self._shown = ''
        if not self._is_entered:
            self._is_entered = True
            self._keep_log()
            _write(ENTER)

    def leave(self) -> None:
        """Put the terminal back as it was; nothing happens where it was not entered."""
        if not self._is_entered:
            return
        self._is_entered = False
        with contextlib.suppress(OSError, termios.error):  # it may be gone
            _write(LEAVE)
            termios.tcsetattr(IN, termios.TCSAFLUSH, self._found)
        self._tell_log()

    def read(self) -> str:
        """Return what was typed since, without waiting."""
        if self.gone or not select.select([IN], [], [], 0.0)[0]:
            return ''
        try:
            typed = os.read(IN, MOST_BYTES)
        except OSError:
            typed = b''
        self.gone = not typed
        return typed.decode(errors='replace')

    def size(self) -> tuple[int, int]:
        """Return the columns and rows that there are now."""
        try:
            found = os.get_terminal_size(OUT)  # not COLUMNS, which does not follow a window
        except OSError:
            return UNKNOWN_SIZE
        return (found.columns, found.lines) if all(found) else UNKNOWN_SIZE

    def show(self, lines: Sequence[str]) -> None:
        """Show lines, the last ones where there is no room for all; only if they are others."""
        columns, rows = self.size()
        fitting = [line[:columns] for line in lines[-rows:]]
        page = HOME + f'{BLANK}\n'.join(fitting) + BLANK + BELOW
        # A terminal that takes nothing shall not hold up the keys.
        if page != self._shown and select.select([], [OUT], [], 0.0)[1]:
            self._shown = page
            with contextlib.suppress(OSError):
                _write(page)

    def _keep_log(self) -> None:
        if os.isatty(ERR):
            self._log = tempfile.TemporaryFile()  # noqa: SIM115 - until the page is left
            self._stderr = os.dup(ERR)
            os.dup2(self._log.fileno(), ERR)

    def _tell_log(self) -> None:
        if self._log is None:
            return
        sys.stderr.flush()
        os.dup2(self._stderr, ERR)
        os.close(self._stderr)
        with self._log as log, contextlib.suppress(OSError):
            log.seek(0)
            os.write(ERR, log.read())
        self._log = None


def _every_key(found: Sequence[Any]) -> list[Any]:
    """Return attributes for single keys without echo; Ctrl-C and Ctrl-Z stay signals."""
    attributes = [*found]
    attributes[IFLAG] &= ~termios.IXON  # or Ctrl-S would hold up the page, and with it the keys
    attributes[LFLAG] &= ~(termios.ICANON | termios.ECHO | termios.IEXTEN)
    attributes[CC] = [*found[CC]]
    attributes[CC][termios.VQUIT] = b'\0'  # or Ctrl-\ would end it without putting anything back
    attributes[CC][termios.VMIN], attributes[CC][termios.VTIME] = 1, 0
    return attributes


def _write(text: str) -> None:
    os.write(OUT, text.encode())
