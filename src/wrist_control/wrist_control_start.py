"""Begins every executable: from the first moment on a signal ends it, with 0 and without a word.

Python needs a second to import ROS, and would end with a traceback meanwhile. Nothing was sent
by then, so nothing needs to be brought to rest. Once there is a node `ros/running.py` hears the
signals. This module stands beside the package, for whatever is in it imports all of it.
"""

import os
import signal
from functools import partial
from importlib import import_module

NODES = 'wrist_control.nodes'
# Executables that stand in a room of their own.
ROOMS = {'console': 'wrist_control.web'}


def __getattr__(name: str) -> partial[None]:
    """Return what `setup.py` names as an entry point: an executable's own beginning."""
    if name.startswith('_'):
        raise AttributeError(name)
    return partial(_start, name)


def _start(executable: str) -> None:
    for number in (signal.SIGINT, signal.SIGTERM, signal.SIGHUP):
        if number != signal.SIGHUP or signal.getsignal(number) != signal.SIG_IGN:  # by nohup
            signal.signal(number, lambda *_: os._exit(0))
    wrist = executable.removesuffix('_resolver')
    if wrist != executable:
        import_module(f'{NODES}.resolver').main(wrist)
    else:
        import_module(f'{ROOMS.get(executable, NODES)}.{executable}').main()
