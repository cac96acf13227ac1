"""A console of one's own and a browser before it: for tests, benchmark and pictures."""

from __future__ import annotations

import os
import re
import shutil
import signal
import subprocess
from collections.abc import Iterator
from contextlib import contextmanager

from wrist_control.graph.domains import Domain
from wrist_control.graph.processes import executable_file

BROWSERS = ('chromium', 'chromium-browser', 'google-chrome', 'google-chrome-stable')
BROWSER = next(filter(None, map(shutil.which, BROWSERS)), None)
MISSING = f'none of {", ".join(BROWSERS)} is installed'
# For root Chromium has no sandbox to offer.
FLAGS = ['--no-sandbox'] if os.geteuid() == 0 else []


def console_command(**parameters: object) -> list[str]:
    """Return what starts a console at any free port, with the wrists that are asked for."""
    given = {'port': 0, 'start': 'three_gimbal', **parameters}
    flags = [part for name, value in given.items() for part in ('-p', f'{name}:={value}')]
    return [str(executable_file('console')), '--ros-args', *flags]


@contextmanager
def served(**parameters: object) -> Iterator[str]:
    """Run a console in a ROS domain of its own; yield the address of its page."""
    domain = Domain()
    process = subprocess.Popen(
        console_command(**parameters),
        env={**os.environ, 'ROS_DOMAIN_ID': str(domain.number)},
        stderr=subprocess.PIPE,
        text=True,
    )
    try:
        assert process.stderr is not None
        found = None
        while found is None:
            line = process.stderr.readline()
            if not line:
                raise RuntimeError('the console has ended')
            found = re.search(r'http://\S+', line)
        yield found[0]
    finally:
        process.send_signal(signal.SIGINT)
        process.wait()
        domain.release()
