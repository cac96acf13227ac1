"""The dexterity study: `python -m wrist_control.studies.dexterity_maps [folder]` draws into out/.

Tables 4.2 and 4.3 and figures 4.3 to 4.5 and 4.8 to 4.10 of [Canfield1997], and maps of every
wrist of this suite. docs/results/dexterity.md says what they mean.
"""

from __future__ import annotations

import math
import sys
from collections.abc import Callable
from functools import partial
from pathlib import Path
from typing import NamedTuple

from matplotlib.figure import Figure
from rich.console import Console
from rich.progress import track
from rich.table import Table

from wrist_control import WRISTS, make_wrist
from wrist_control.dexterity import Uniformity
from wrist_control.studies import dexterity_figures as figures
from wrist_control.studies.canfield_closure import (
    TABLE_4_2,
    TABLE_4_2_AZIMUTH,
    TABLE_4_2_PRINTED,
    TABLE_4_2_TILTS,
    sample,
)
from wrist_control.studies.canfield_pointing import (
    READINGS,
    Pointer,
    Reading,
    carpal,
    five_bar,
    pitch_yaw,
    pointing_measure,
)
from wrist_control.studies.pictures import save

# R_b and R_d of Table 4.3 are not printed: these come nearest to its row, and these are the
# paper's own for figure 4.5, with the largest R_d that it calls a hemisphere.
POINTERS = (carpal(0.38, 0.86), carpal(0.75, 0.6), pitch_yaw(), five_bar())
# D_min, D_max and σ as printed in Table 4.3.
PRINTED = {
    POINTERS[0].name: ('0.45', '~0.61', '0.0375'),
    'pitch-yaw': ('0.1', '~1.0', '0.2047'),
    'five-bar': ('0.7', '~1.2', '0.1249'),
}


class Workspace(NamedTuple):
    """Over which directions a dexterous measure is taken; the paper does not say.

    Attributes:
        name: What it is called by.
        largest: Tilt up to which the directions go, rad.
        by_solid_angle: Whether directions count by their solid angle or in equal steps of α, β.
    """

    name: str
    largest: float
    by_solid_angle: bool


# The pitch-yaw pointer's D_min is the printed 0.1 at π/2 - 0.1: the only hint of where to end.
WORKSPACES = (
    Workspace('solid angle, β ≤ π/2 - 0.1', 0.5 * math.pi - 0.1, True),
    Workspace('equal steps, β ≤ 89.5°', math.radians(89.5), False),
)


def table_4_2() -> Table:
    """Return Table 4.2, measured below printed: no digit differs."""
    table = Table('β (°)', '', 'θ1', 'θ2', 'θ3', 'closure', 'det J', title='Table 4.2')
    for tilt, printed in zip(TABLE_4_2_TILTS, TABLE_4_2_PRINTED, strict=True):
        measured = sample(TABLE_4_2, TABLE_4_2_AZIMUTH, tilt).rounded()
        table.add_row('', 'paper', *printed)
        table.add_row(f'{math.degrees(tilt):g}', 'here', *measured, end_section=True)
    return table


def table_4_3(place: Workspace, measures: dict[tuple[str, str, str], Uniformity]) -> Table:
    """Return Table 4.3 in every reading over one choice of directions."""
    table = Table(
        'pointer', 'reading', 'D min', 'D max', 'σ', 'σ / mean', title=f'Table 4.3: {place.name}'
    )
    for pointer in POINTERS:
        if pointer.name in PRINTED:
            table.add_row(pointer.name, 'paper', *PRINTED[pointer.name], '')
        for reading in READINGS:
            found = measures[place.name, pointer.name, reading]
            values = (found.least, found.largest, found.deviation, found.relative)
            table.add_row(pointer.name, reading, *(f'{x:.4f}' for x in values))
        table.add_section()
    return table


def main(folder: Path) -> None:
    """Make every table and picture of the study."""
    console = Console()
    measures: dict[tuple[str, str, str], Uniformity] = {}
    for job in track([*_measuring(measures), *_drawing(folder)], 'dexterity', console=console):
        job()
    console.print(table_4_2())
    for place in WORKSPACES:
        console.print(table_4_3(place, measures))
    console.print(f'The pictures are {folder}/dexterity_*.png.')


def _measuring(into: dict[tuple[str, str, str], Uniformity]) -> list[Callable[[], None]]:
    def measure(place: Workspace, reading: Reading, pointer: Pointer) -> None:
        found = pointing_measure(pointer, reading, place.largest, place.by_solid_angle)
        into[place.name, pointer.name, reading] = found

    return [
        partial(measure, place, reading, pointer)
        for place in WORKSPACES
        for reading in READINGS
        for pointer in POINTERS
    ]


def _drawing(folder: Path) -> list[Callable[[], None]]:
    wrists = {name: make_wrist(name) for name in WRISTS}
    pointers = (POINTERS[0], *POINTERS[2:])
    pictures: dict[str, Callable[[], Figure]] = {
        'fig_4_3': figures.edges,
        'fig_4_4': figures.measures,
        'fig_4_5': figures.plunges,
        'fig_4_8_to_4_10': partial(figures.pointing, pointers, READINGS),
        'wrists': partial(figures.overview, wrists),
        **{f'map_{name}': partial(figures.workspace, name, made) for name, made in wrists.items()},
    }

    def draw(name: str, picture: Callable[[], Figure]) -> None:
        save(picture(), folder / f'dexterity_{name}.png', dpi=90.0)

    return [partial(draw, *pair) for pair in pictures.items()]


if __name__ == '__main__':
    main(Path(sys.argv[1]) if len(sys.argv) > 1 else Path('out'))
