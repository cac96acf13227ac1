"""Make the steps of a recorded run again, and see whether they are the same to the last bit."""

from __future__ import annotations

import argparse
import sys
from collections.abc import Sequence
from pathlib import Path

from rich.console import Console

from wrist_control.bags import check_installed
from wrist_control.errors import WristError
from wrist_control.runs.terminal import add_run, progress


def main(arguments: Sequence[str] | None = None) -> int:
    """Replay a recording.

    Returns:
        The exit code: 0 when every joint command is the same, 1 when one is not, 2 when there is
        nothing to replay.
    """
    parser = argparse.ArgumentParser(prog='replay', description=__doc__)
    add_run(parser)
    chosen = parser.parse_args(arguments)
    console = Console(soft_wrap=True)
    try:
        check_installed()
        return _replay(chosen.run, chosen.namespace, console)
    except KeyboardInterrupt:
        return 130
    except WristError as error:
        print(f'Cannot replay: {error}', file=sys.stderr)
        return 2


def _replay(path: Path, space: str, console: Console) -> int:
    from wrist_control.bags.run import Run
    from wrist_control.runs.replaying import Comparison, Replay

    with progress(console) as shown:
        reading = shown.add_task('reading', total=1.0)
        run = Run(path, space, lambda share: shown.update(reading, completed=share))
        making = shown.add_task('making the steps again', total=1.0)
        seen: Comparison = Replay(run).make(lambda share: shown.update(making, completed=share))
    if run.cut:
        console.print(run.cut, highlight=False, markup=False)
    for sentence in seen.sentences():
        console.print(sentence, highlight=False, markup=False)
    return 0 if seen.exact else 1


if __name__ == '__main__':
    sys.exit(main())
