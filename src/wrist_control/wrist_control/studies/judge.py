"""Every wrist's kinematics before a judge that does not know them: `make judge`.

`python -m wrist_control.studies.judge [poses [step]]` prints a table, and fails where a difference
is beyond its bound. docs/results/physics.md says what it means.
"""

from __future__ import annotations

import sys
from collections.abc import Mapping

from rich.box import SIMPLE_HEAD
from rich.console import Console
from rich.progress import Progress
from rich.table import Table

from wrist_control.physics.models import MODELS
from wrist_control.studies.judgement import BOUND, LOADED, Verdict, judge
from wrist_control.wrists import make_wrist

POSES = 50
HEADINGS = ('wrist', 'poses', 'position', 'attitude', 'motion', 'efforts', 'steps/s')


def rows(verdicts: Mapping[str, Verdict]) -> list[tuple[str, ...]]:
    """Return what `HEADINGS` promise, as text."""
    return [
        (
            name,
            f'{verdict.poses}',
            f'{verdict.position:.0e}',
            f'{verdict.attitude:.0e}',
            f'{verdict.motion:.0e}',
            f'{verdict.effort:.0e}',
            f'{verdict.steps_per_second:.0f}',
        )
        for name, verdict in verdicts.items()
    ]


def table(verdicts: Mapping[str, Verdict], step: float) -> Table:
    """Return the verdicts as a table that a terminal of 80 columns has room for."""
    found = Table(
        title=f'MuJoCo and our kinematics, steps of {1e3 * step:g} ms',
        caption=(
            'Largest differences at rest under a payload: the hand against forward, as a share of '
            'the size and in rad; a small move against jacobian; efforts against its transpose. '
            f'Bound: {BOUND:g}.'
        ),
        box=SIMPLE_HEAD,
        show_edge=False,
    )
    for heading in HEADINGS:
        words = heading == 'wrist'
        found.add_column(heading, justify='left' if words else 'right', no_wrap=True)
    for name, row in zip(verdicts, rows(verdicts), strict=True):
        found.add_row(*row, style='' if verdicts[name].worst <= BOUND else 'red')
    return found


def main(poses: int = POSES, step: float = LOADED.step) -> bool:
    """Judge every wrist, print the table, and return whether a bound is broken."""
    console = Console()
    verdicts = {}
    with Progress(console=console, transient=True) as progress:
        task = progress.add_task('judging', total=poses * len(MODELS))
        for name in MODELS:
            progress.update(task, description=f'judging {name}')
            verdicts[name] = judge(
                make_wrist(name),
                poses,
                LOADED._replace(step=step),
                seen=lambda: progress.advance(task),
            )
    console.print(table(verdicts, step))
    beyond = [name for name, verdict in verdicts.items() if not verdict.worst <= BOUND]
    if beyond:
        console.print(f'Beyond the bound: {", ".join(beyond)}.')
    return bool(beyond)


if __name__ == '__main__':
    given = sys.argv[1:]
    sys.exit(main(*map(int, given[:1]), *map(float, given[1:2])))
