"""Fly every wrist through the same maneuvers, so that a person can choose one: `make compare`."""

from __future__ import annotations

import math
import sys
import textwrap
from collections.abc import Callable, Sequence
from itertools import groupby
from operator import itemgetter
from pathlib import Path
from typing import NamedTuple

import numpy as np
from matplotlib.axes import Axes
from matplotlib.figure import Figure
from rich.box import SIMPLE_HEAD
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
    wrists_here,
)
from wrist_control.studies.pictures import save

# A number of a maneuver that was not finished, in the picture.
STOPPED = '†'
HEADINGS = (
    'maneuver',
    'wrist',
    'time lost (s)',
    'peak rate (of limit)',
    'without limit',
    'path error (deg)',
    'closest margin',
    'first own limit',
    'at (s)',
)


def _degrees_per_second() -> str:
    return f'{math.degrees(JOINT_SPEEDS["revolute"]):g} deg/s'


def rows(performances: Sequence[Performance]) -> list[tuple[str, ...]]:
    """Return what `HEADINGS` promise, as text."""
    return [
        (
            o.maneuver,
            _marked(o),
            f'{o.time_lost:.2f}' if o.completed else 'stopped',
            f'{o.peak_rate:.3f}',
            f'{o.free_peak_rate:.2f}',
            f'{_error(o):.4f}',
            f'{o.margin:.3f}',
            o.stopped_by,
            f'{o.stopped_at:.1f}' if o.stopped_by else '',
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
    """Return the comparison as a table that a terminal of 80 columns has room for."""
    found = Table(
        title='Every wrist, the same maneuvers',
        caption=caption(),
        box=SIMPLE_HEAD,
        show_edge=False,
        padding=0,
    )
    for heading in HEADINGS[1:]:
        words = heading in ('wrist', 'first own limit')
        # Narrow headings leave the width to the cells.
        lines = heading.replace(' ', '\n')
        found.add_column(lines, justify='left' if words else 'right', no_wrap=True)
    for maneuver, group in groupby(rows(performances), key=itemgetter(0)):
        found.add_section()
        found.add_row(maneuver, style='bold')
        for _, *cells in group:
            found.add_row(*cells)
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
# Letters that fit into a cell.
WIDE_CELL = 17
DARK = 0.75
PANELS = (
    Panel('time lost (s), or what stopped the hand', lambda o: o.time_lost, '{:.2f}', 0.01, 10.0),
    Panel(
        'peak joint rate without a limit, divided by the limit',
        lambda o: o.free_peak_rate,
        '{:.1f}',
        1.0,
        100.0,
    ),
    Panel(
        'closest margin, 0 at lock: compare within a row', lambda o: o.margin, '{:.2f}', 1.0, 0.01
    ),
)
# A path error below this is not worth a panel, deg.
SMALL = 1e-3


def draw(performances: Sequence[Performance]) -> Figure:
    """Return the comparison as three maps, wrists by maneuvers, and what they leave out."""
    figure = Figure(figsize=(12.0, 9.5), layout='constrained')
    places = figure.subplots(2, 2).ravel()
    for axes, panel in zip(places, PANELS, strict=False):
        _draw_panel(axes, performances, panel)
    places[1].tick_params(labelleft=False)
    places[-1].set_axis_off()
    places[-1].text(0.05, 0.9, notes(performances), va='top', fontsize=11, linespacing=1.6)
    figure.suptitle(
        f'Every wrist, the same maneuvers, joints limited to {_degrees_per_second()}', fontsize=13
    )
    return figure


def notes(performances: Sequence[Performance]) -> str:
    """Return what the picture says in words: its marks, and path errors, nearly all of them 0."""
    worst = {
        o.wrist: max(_error(p) for p in performances if p.wrist == o.wrist) for o in performances
    }
    off = {wrist: error for wrist, error in worst.items() if error >= SMALL}
    return '\n'.join(
        [
            'Pale is good.',
            f'{STOPPED}  stopped before the end: its numbers are those until then',
            '*  points only, without roll',
            '',
            f'Path error: less than {SMALL:g}° everywhere{", but" if off else "."}',
            *(f'    {wrist}: up to {error:.3f}°' for wrist, error in off.items()),
        ]
    )


def _error(o: Performance) -> float:
    return math.degrees(o.path_error)


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
            _why_stopped(o) if stopped else _label(o, panel),
            ha='center',
            va='center',
            fontsize=6.5 if stopped else 9.5,
            linespacing=0.95,
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


def _why_stopped(o: Performance) -> str:
    """Return what stopped the hand and when, in lines that fit into a cell."""
    return textwrap.fill(f'{o.stopped_by} at {o.stopped_at:.1f} s', WIDE_CELL)


def _label(o: Performance, panel: Panel) -> str:
    return panel.form.format(panel.value(o)) + ('' if o.completed else f' {STOPPED}')


def main(
    folder: Path,
    wrists: Sequence[str] = (),
    maneuvers: Sequence[Maneuver] = MANEUVERS,
) -> None:
    """Compare wrists, all that there are unless some are named; print and write what comes out.

    Args:
        folder: Where the picture and the table go.
        wrists: Names of wrists.
        maneuvers: What they are asked to do.
    """
    console = Console()
    wrists = wrists or wrists_here(console.print)
    performances = compare(
        wrists, maneuvers, lambda pairs: track(pairs, 'flying', console=console)
    )
    picture = save(draw(performances), folder / 'compare.png', dpi=90.0)
    (folder / 'compare.md').write_text(markdown(performances), encoding='utf-8')
    console.print(table(performances))
    console.print(f'The picture is {picture}, the table {folder / "compare.md"}.')


if __name__ == '__main__':
    main(Path(sys.argv[1]) if len(sys.argv) > 1 else Path('out'))
