"""Fly every wrist through the same maneuvers, so that a person can choose one: `make compare`."""

from __future__ import annotations

import math
import sys
from collections.abc import Callable, Sequence
from pathlib import Path
from typing import NamedTuple

import numpy as np
from matplotlib.axes import Axes
from matplotlib.figure import Figure
from rich.console import Console
from rich.progress import track
from rich.table import Table

from wrist_control.operating.maneuvers import BARKER_SPEED, Maneuver
from wrist_control.studies.comparison import (
    JOINT_SPEEDS,
    MANEUVERS,
    PATIENCE,
    Performance,
    compare,
)
from wrist_control.studies.pictures import save
from wrist_control.wrists import WRISTS

HEADINGS = (
    'maneuver',
    'wrist',
    'time lost (s)',
    'peak rate (of limit)',
    'without limit',
    'path error (deg)',
    'closest margin',
    'first limit of its own',
    'completed',
)


def _degrees_per_second() -> str:
    return f'{math.degrees(JOINT_SPEEDS["revolute"]):g} deg/s'


def rows(performances: Sequence[Performance]) -> list[tuple[str, ...]]:
    """Return what `HEADINGS` promise, as text."""
    return [
        (
            o.maneuver,
            _marked(o),
            f'{o.time_lost:.2f}' if o.completed else '–',
            f'{o.peak_rate:.3f}',
            f'{o.free_peak_rate:.2f}',
            f'{math.degrees(o.path_error):.4f}',
            f'{o.margin:.3f}',
            f'{o.stopped_by} at {o.stopped_at:.1f} s' if o.stopped_by else '',
            'yes' if o.completed else 'no',
        )
        for o in performances
    ]


def caption() -> str:
    """Return what the numbers stand for."""
    return (
        f'Joint limit {_degrees_per_second()}, legs {JOINT_SPEEDS["prismatic"]:.3f} m/s; hand at '
        f'most {math.degrees(BARKER_SPEED):g} deg/s. '
        '* points only: its roll is what the mechanism forces, and its path error is that of the '
        f'pointing axis. A maneuver is given up when it loses {PATIENCE:g} s.'
    )


def table(performances: Sequence[Performance]) -> Table:
    """Return the comparison as a table for a terminal."""
    found = Table(title='Every wrist, the same maneuvers', caption=caption())
    for number, heading in enumerate(HEADINGS):
        found.add_column(heading, justify='right' if 2 <= number <= 6 else 'left')
    shown = rows(performances)
    for row, following in zip(shown, [*shown[1:], ('',)], strict=True):
        found.add_row(*row, end_section=row[0] != following[0])
    return found


def markdown(performances: Sequence[Performance]) -> str:
    """Return the comparison as a Markdown table."""
    lines = [HEADINGS, ('---',) * len(HEADINGS), *rows(performances)]
    return ''.join(f'| {" | ".join(line)} |\n' for line in lines) + f'\n{caption()}\n'


class Panel(NamedTuple):
    """One quantity of the picture.

    Attributes:
        title: What it is, with its unit.
        value: Gets it from a performance.
        form: How its value is written.
        good: The value drawn palest.
        bad: The value drawn darkest; shades in between are logarithmic.
    """

    title: str
    value: Callable[[Performance], float]
    form: str
    good: float
    bad: float


# A shade from which white can be read better than black.
DARK = 0.75
PANELS = (
    Panel('time lost (s), or what stopped the hand', lambda o: o.time_lost, '{:.1f}', 0.01, 10.0),
    Panel(
        'peak joint rate without a limit (× the limit)',
        lambda o: o.free_peak_rate,
        '{:.1f}',
        1.0,
        100.0,
    ),
    Panel('path error (deg)', lambda o: math.degrees(o.path_error), '{:.3f}', 0.001, 1.0),
    Panel('closest margin (0 at lock)', lambda o: o.margin, '{:.2f}', 1.0, 0.01),
)


def draw(performances: Sequence[Performance]) -> Figure:
    """Return the comparison as four maps, wrists by maneuvers."""
    figure = Figure(figsize=(12.0, 9.5), layout='constrained')
    for axes, panel in zip(
        figure.subplots(2, 2, sharex=True, sharey=True).flat, PANELS, strict=True
    ):
        _draw_panel(axes, performances, panel)
    figure.suptitle(
        f'Every wrist, the same maneuvers, joints limited to {_degrees_per_second()}\n'
        'pale is good; × stopped before the end; * points only, without roll',
        fontsize=12,
    )
    return figure


def _draw_panel(axes: Axes, performances: Sequence[Performance], panel: Panel) -> None:
    wrists = list(dict.fromkeys(_marked(o) for o in performances))
    maneuvers = list(dict.fromkeys(o.maneuver for o in performances))
    shades = np.zeros((len(wrists), len(maneuvers)))
    for o in performances:
        row, column = wrists.index(_marked(o)), maneuvers.index(o.maneuver)
        shade = math.log(max(panel.value(o), 1e-9) / panel.good) / math.log(panel.bad / panel.good)
        shades[row, column] = min(1.0, max(0.0, shade))
        stopped = panel is PANELS[0] and not o.completed
        axes.text(
            column,
            row,
            f'{o.stopped_by}\nat {o.stopped_at:.1f} s' if stopped else _label(o, panel),
            ha='center',
            va='center',
            fontsize=7.5 if stopped else 9.5,
            color='white' if shades[row, column] > DARK else 'black',
        )
    axes.imshow(shades, cmap='OrRd', vmin=0.0, vmax=1.15, aspect='auto')
    axes.set_yticks(range(len(wrists)), wrists)
    axes.set_xticks(
        range(len(maneuvers)), [name.replace('_', '\n', 1).replace('_', ' ') for name in maneuvers]
    )
    axes.tick_params(length=0)
    for line in range(1, len(wrists)):
        axes.axhline(line - 0.5, color='white', linewidth=1.5)
    axes.set_title(panel.title, fontsize=11)


def _marked(o: Performance) -> str:
    return o.wrist if o.follows_roll else f'{o.wrist} *'


def _label(o: Performance, panel: Panel) -> str:
    return panel.form.format(panel.value(o)) + ('' if o.completed else ' ×')


def main(
    folder: Path,
    wrists: Sequence[str] = tuple(WRISTS),
    maneuvers: Sequence[Maneuver] = MANEUVERS,
) -> None:
    """Compare wrists, print the table, and write it and the picture to a folder."""
    console = Console()
    performances = compare(
        wrists, maneuvers, lambda pairs: track(pairs, 'flying', console=console)
    )
    picture = save(draw(performances), folder / 'compare.png', dpi=90.0)
    (folder / 'compare.md').write_text(markdown(performances), encoding='utf-8')
    console.print(table(performances))
    console.print(f'The picture is {picture}, the table {folder / "compare.md"}.')


if __name__ == '__main__':
    main(Path(sys.argv[1]) if len(sys.argv) > 1 else Path('out'))
