"""A file of MCAP that is complete after every flush, whatever becomes of its writer.

MCAP ends with a footer, and most readers look for it first. Here one that says nothing more stands
behind all that was flushed, and the next flush begins where it begins: killed between any two
flushes the writer leaves a whole file.
"""

from __future__ import annotations

import os
from contextlib import suppress
from pathlib import Path

from mcap.data_stream import RecordBuilder
from mcap.records import DataEnd, Footer
from mcap.writer import MCAP0_MAGIC


def _ending() -> bytes:
    builder = RecordBuilder()
    DataEnd(data_section_crc=0).write(builder)
    Footer(summary_start=0, summary_offset_start=0, summary_crc=0).write(builder)
    return bytes(builder.end()) + MCAP0_MAGIC


ENDING = _ending()


class CompleteFile:
    """What `mcap.writer.Writer` writes into."""

    def __init__(self, path: Path) -> None:
        """Make the file.

        Raises:
            OSError: It is there already, or cannot be made.
        """
        self._file = os.open(path, os.O_WRONLY | os.O_CREAT | os.O_EXCL, 0o644)
        self._size = 0
        self._pending = bytearray()

    def write(self, data: bytes) -> int:
        """Keep bytes for the next flush."""
        self._pending += data
        return len(data)

    def tell(self) -> int:
        """Return how many bytes were written so far; the ending is none of them."""
        return self._size + len(self._pending)

    def flush(self) -> None:
        """Put what was written onto the disk, with an ending behind it.

        Raises:
            OSError: It does not fit there; the file ends as it did before.
        """
        try:
            self._put(bytes(self._pending) + ENDING)
        except OSError:
            self._pending.clear()
            with suppress(OSError):
                os.ftruncate(self._file, self._size)
                self._put(ENDING)
            raise
        self._size += len(self._pending)
        self._pending.clear()

    def close(self) -> None:
        """Put what is left onto the disk: the writer's own ending, which is longer than ours.

        Raises:
            OSError: It does not fit there; the file ends as it did before.
        """
        try:
            self.flush()
            os.ftruncate(self._file, self._size)
        finally:
            os.close(self._file)

    def _put(self, data: bytes) -> None:
        done = 0
        while done < len(data):
            done += os.pwrite(self._file, data[done:], self._size + done)
