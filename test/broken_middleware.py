"""What makes a node's executor raise after a while, as if the middleware itself were broken.

No callback of a node is at fault then, so none can be blamed.
"""

BREAKS = """
import sys, time
from wrist_control.ros import running

class Breaks:
    def __init__(self, executor):
        self.executor, self.end = executor, time.monotonic() + {after}
    def __getattr__(self, name):
        return getattr(self.executor, name)
    def spin_until_future_complete(self, future, timeout_sec):
        self.executor.spin_until_future_complete(future, max(0.0, self.end - time.monotonic()))
        raise RuntimeError('the middleware is broken')

make = running.make_executor
running.make_executor = lambda node: Breaks(make(node))
{run}
"""


def broken(after, run):
    """Return a program that runs a node, and breaks what it runs on after so many s."""
    return BREAKS.format(after=after, run=run)
