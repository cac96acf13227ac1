"""ROS domains that are shared out on one machine: nobody hears another one's graph."""

from __future__ import annotations

import fcntl
import os
import tempfile
from pathlib import Path

# Those whose ports lie below the range that Linux gives away by itself.
DOMAINS = range(1, 102)


def _last_use(path: Path) -> int:
    return path.stat().st_mtime_ns if path.exists() else 0


class Domain:
    """A ROS domain that nobody else on this machine uses who asks here.

    A lock on a file says so: the system takes it back even from a process that is killed. The one
    whose last use is longest ago is taken, for nodes that end may be heard a little longer.

    Attributes:
        number: Which it is.
    """

    def __init__(self) -> None:
        """Take one.

        Raises:
            RuntimeError: All are taken.
        """
        folder = Path(tempfile.gettempdir()) / 'wrist_control_domains'
        folder.mkdir(exist_ok=True)
        files = [folder / str(number) for number in DOMAINS]
        for path in sorted(files, key=_last_use):
            self._file = path.open('a')
            try:
                fcntl.flock(self._file, fcntl.LOCK_EX | fcntl.LOCK_NB)
            except BlockingIOError:
                self._file.close()
                continue
            os.utime(path)
            self.number = int(path.name)
            return
        raise RuntimeError('every ROS domain is in use')

    def release(self) -> None:
        """Give it back."""
        os.utime(self._file.name)
        self._file.close()
