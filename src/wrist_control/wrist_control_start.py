"""Begins every executable: from the first moment on a signal ends it, with 0 and without a word.

Python needs a second to import ROS, and would end with a traceback meanwhile. Nothing was sent
by then, so nothing needs to be brought to rest. Once there is a node `ros/running.py` hears the
signals. This module stands beside the package, for whatever is in it imports all of it.
"""

import os
import signal
import sys
from functools import partial
from importlib import import_module

PACKAGE = 'wrist_control'
NODES = f'{PACKAGE}.nodes'
# What is no node, and ends by itself.
COMMANDS = ('replay', 'report')
INTERRUPTED = 130  # the exit code of a command that Ctrl-C ends
SHOW_CURSOR = b'\x1b[?25h\n'
# Executables that stand in a room of their own.
ROOMS = {'console': f'{PACKAGE}.web'}


def __getattr__(name: str) -> partial[None]:
    """Return what `setup.py` names as an entry point: an executable's own beginning."""
    if name.startswith('_'):
        raise AttributeError(name)
    return partial(_start, name)


def _start(executable: str) -> None:
    if executable in COMMANDS:
        signal.signal(signal.SIGINT, _interrupt)
        sys.exit(import_module(f'{PACKAGE}.{executable}').main())
    for number in (signal.SIGINT, signal.SIGTERM, signal.SIGHUP):
        if number != signal.SIGHUP or signal.getsignal(number) != signal.SIG_IGN:  # by nohup
            signal.signal(number, lambda *_: os._exit(0))
    wrist = executable.removesuffix('_resolver')
    if wrist != executable:
        import_module(f'{NODES}.resolver').main(wrist)
    else:
        import_module(f'{ROOMS.get(executable, NODES)}.{executable}').main()


def _interrupt(*_: object) -> None:
    if sys.stdout.isatty():
        os.write(sys.stdout.fileno(), SHOW_CURSOR)  # which a progress bar has hidden
    os._exit(INTERRUPTED)
