"""The hostile campaign: what nobody in earnest would send, by the million, and what comes of it.

Every row of the table is one attack. All that is counted in it must be zero.
"""

from __future__ import annotations

import argparse
import signal
import sys
from collections.abc import Sequence
from functools import partial

from rich.console import Console
from rich.progress import BarColumn, MofNCompleteColumn, Progress, TextColumn, TimeRemainingColumn
from rich.table import Table

from hostile import library, live
from hostile.verdict import Verdict

STEPS, MESSAGES = 1_000_000, 100_000
WIDTH = 120  # of what is written to a file
WORKERS = 2  # as many as the cores of a small machine


def table(verdicts: Sequence[Verdict]) -> Table:
    """Return the table of what was found."""
    made = Table('attack')
    for heading in (
        'count',
        'limit violations',
        'non-finite outputs',
        'dead nodes',
        'uncommanded motion',
    ):
        made.add_column(heading, justify='right')
    for one in verdicts:
        numbers = (one.count, one.limits, one.nonfinite, one.dead, one.uncommanded)
        made.add_row(one.attack, *map(str, numbers), style='' if one.good else 'red')
    return made


def show(verdicts: Sequence[Verdict], console: Console) -> bool:
    """Show the table and the first findings of each attack, and tell whether all is well."""
    console.print(table(verdicts))
    for one in verdicts:
        for sentence in one.examples:
            text = f'{one.attack}: {sentence}'
            console.print(text, markup=False, highlight=False, soft_wrap=True)
    return all(one.good for one in verdicts)


def main() -> int:
    """Attack the library and the nodes, and show what was found."""
    parser = argparse.ArgumentParser(description=(__doc__ or '').splitlines()[0])
    parser.add_argument('--seed', type=int, default=1, help='another seed makes other attacks')
    parser.add_argument('--steps', type=int, default=STEPS, help='of the library; 0 for none')
    parser.add_argument('--messages', type=int, default=MESSAGES, help='to nodes; 0 for none')
    parser.add_argument('--workers', type=int, default=WORKERS, help='processes of the library')
    options = parser.parse_args()
    # As Ctrl-C: the processes are ended.
    signal.signal(signal.SIGTERM, lambda *_: sys.exit(143))
    console = Console(width=None if sys.stdout.isatty() else WIDTH)
    found: list[Verdict] = []
    columns = (TextColumn('{task.description}'), BarColumn(), MofNCompleteColumn())
    with Progress(*columns, TimeRemainingColumn(), console=console) as progress:
        if options.steps:
            task = progress.add_task('library', total=options.steps)
            found += library.verdicts(
                options.steps,
                options.seed,
                options.workers,
                lambda count: progress.update(task, advance=count),
            )
        if options.messages:
            task = progress.add_task('live', total=options.messages)
            sent = partial(progress.update, task)
            for verdict in live.verdicts(
                options.messages, options.seed, lambda count: sent(advance=count)
            ):
                progress.update(task, description=verdict.attack)
                found.append(verdict)
    console.print(f'seed {options.seed}')
    return 0 if show(found, console) else 1


if __name__ == '__main__':
    sys.exit(main())
