"""Reproduce the simulations of [Nguyen1991]: Table 1, figures 6 to 11, and what is not printed.

python -m wrist_control.studies.nguyen [--out FOLDER]
"""

from __future__ import annotations

import argparse
from collections.abc import Iterator, Sequence
from pathlib import Path
from typing import NamedTuple

import numpy as np
from matplotlib.figure import Figure
from rich.console import Console
from rich.progress import Progress
from rich.table import Table

from wrist_control.studies.nguyen_angles import PaperAngles
from wrist_control.studies.nguyen_cases import (
    CASES,
    HEIGHT,
    LEVEL,
    Case,
    Scheme,
    pose_errors,
    printed_misfit,
    summary,
    times,
    velocity_errors,
)
from wrist_control.studies.pictures import COLOURS, STYLES, save

ROWS = (
    *('x (µin.)', 'y (µin.)', 'z (µin.)', 'α (µrad)', 'β (µrad)', 'γ (µrad)'),
    *(f'l{leg} (in./s)' for leg in range(1, 7)),
)
SCHEMES: tuple[Scheme, ...] = ('backward', 'forward', 'central')


class Misfit(NamedTuple):
    """How far the velocity columns of Table 1 are from what one guess gives, in./s."""

    scheme: Scheme
    height: float
    largest: float


def search(progress: Progress | None = None) -> list[Misfit]:
    """Return the best height of each way to differentiate: what the paper does not print.

    Every height from 10 to 25 in. in steps of 0.05 in., level platform.
    """
    heights = np.arange(10.0, 25.001, 0.05)
    task = progress.add_task('heights', total=3 * len(heights)) if progress else None
    best = []
    for scheme in SCHEMES:
        found = []
        for height in heights:
            largest = float(np.abs(printed_misfit(height, LEVEL, scheme)).max())
            found.append(Misfit(scheme, round(float(height), 2), largest))
            if progress and task is not None:
                progress.advance(task)
        best.append(min(found, key=lambda misfit: misfit.largest))
    return best


def fitted_attitude() -> tuple[float, PaperAngles]:
    """Return height, in., and angles, rad, that fit the columns best: Gauss-Newton from level."""
    at, h = np.array([HEIGHT, 0.0, 0.0, 0.0]), 1e-4
    for _ in range(4):
        misfit = _misfit(at)
        slope = np.array(
            [(_misfit(at + h * e) - _misfit(at - h * e)) / (2 * h) for e in np.eye(4)]
        ).T
        at = at - np.linalg.lstsq(slope, misfit, rcond=None)[0]
    return float(at[0]), PaperAngles(*(float(x) for x in at[1:]))


def _misfit(at: np.ndarray) -> np.ndarray:
    return printed_misfit(float(at[0]), PaperAngles(*at[1:]))


def measured(case: Case) -> tuple[np.ndarray, np.ndarray]:
    """Return the largest and the RMS errors of one case, the twelve rows of Table 1."""
    errors = np.hstack([pose_errors(case)[0], velocity_errors(case)])
    return summary(errors)


def table_1() -> Table:
    """Return the paper's Table 1 beside what is measured."""
    table = Table(title='[Nguyen1991], Table 1: paper | measured')
    for heading in ('', *(f'{case.name}, {kind}' for case in CASES for kind in ('max', 'RMS'))):
        table.add_column(heading, justify='right')
    results = [measured(case) for case in CASES]
    for row, name in enumerate(ROWS):
        cells = []
        for case, (most, rms) in zip(CASES, results, strict=True):
            cells.append(f'{case.max_error[row]:g} | {most[row]:.4f}')
            cells.append(f'{case.rms_error[row]:g} | {rms[row]:.4f}')
        table.add_row(name, *cells)
    return table


def search_table(best: Sequence[Misfit]) -> Table:
    """Return what was found for the height and for the way to differentiate."""
    table = Table(title='What Table 1 says of what is not printed')
    for heading in ('differences', 'best z0 (in.)', 'largest misfit of 24 numbers (in./s)'):
        table.add_column(heading, justify='right')
    for misfit in best:
        table.add_row(misfit.scheme, f'{misfit.height:.2f}', f'{misfit.largest:.5f}')
    return table


def figures() -> Iterator[tuple[int, Figure]]:
    """Yield figures 6 to 11, with their numbers."""
    for first, case in zip((6, 9), CASES, strict=True):
        pose, velocity = pose_errors(case)[0], velocity_errors(case)
        lines = (
            (pose[:, :3], 'error of the position (µin.)', ('x', 'y', 'z')),
            (
                pose[:, 3:],
                'error of the angles (µrad)',
                ('α, about z', 'β, about y', 'γ, about x'),
            ),
            (
                velocity,
                'error of the leg rates (in./s)',
                tuple(f'$l_{leg}$' for leg in range(1, 7)),
            ),
        )
        for number, (errors, label, names) in enumerate(lines, start=first):
            title = f'Fig. {number}. {case.name}'
            yield number, _figure(title, times(case), errors, label, names)


def _figure(
    title: str, t: np.ndarray, errors: np.ndarray, label: str, names: Sequence[str]
) -> Figure:
    figure = Figure(figsize=(6.4, 3.6), layout='constrained')
    axes = figure.subplots()
    for column, name in enumerate(names):
        axes.plot(
            t, errors[:, column], label=name, lw=1.2, ls=STYLES[column], color=COLOURS[column]
        )
    axes.set(title=title, xlabel='time (s)', ylabel=label, xlim=(t[0], t[-1]))
    axes.grid(alpha=0.3)
    axes.legend(loc='upper left', bbox_to_anchor=(1.0, 1.0), fontsize='small')
    return figure


def main(arguments: Sequence[str] | None = None) -> None:
    """Print the tables and draw the figures."""
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument('--out', type=Path, default=Path('out/stewart'), help='for the figures')
    folder = parser.parse_args(arguments).out
    console = Console()
    with Progress(console=console, transient=True) as progress:
        best = search(progress)
        for number, figure in progress.track(figures(), total=6, description='figures'):
            save(figure, folder / f'figure_{number:02d}.png', dpi=110.0)
    console.print(search_table(best))
    height, angles = fitted_attitude()
    console.print(
        f'Fitted with a free attitude: z0 = {height:.3f} in., α, β, γ = '
        f'{", ".join(f"{angle:.4f}" for angle in angles)} rad.'
    )
    console.print(table_1())
    for case in CASES:
        console.print(f'{case.name}: {pose_errors(case)[1]:.2f} Newton steps on average; paper: 2')
    console.print(f'Figures: {folder}/')


if __name__ == '__main__':
    main()
