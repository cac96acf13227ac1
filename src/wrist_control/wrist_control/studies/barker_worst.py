"""How fast the four gimbals must be, over maneuvers: is Barker's "worst-type" one the worst?

`./env python -m wrist_control.studies.barker_worst docs/results` draws it into a folder. Every
maneuver pitches the hand up from home and then makes a whole turn about one axis of the hand,
both at 32 deg/s, as the extended test maneuver does with 90° and the z axis.
"""

from __future__ import annotations

import math
import sys
from collections.abc import Callable, Iterable, Sequence
from pathlib import Path
from typing import NamedTuple

import numpy as np
from matplotlib import colormaps
from matplotlib.axes import Axes
from matplotlib.figure import Figure
from rich.console import Console
from rich.progress import track
from rich.table import Table

from wrist_control.operating.maneuvers import BARKER_SPEED
from wrist_control.studies.barker_figure_5 import peak_rates
from wrist_control.studies.pictures import COLOURS, STYLES, save

# The turns about an axis of the hand that need more than the pitch itself, by their rate.
AXES = {
    '+r': (0.0, 0.0, 1.0),
    '−r': (0.0, 0.0, -1.0),
    '+p': (1.0, 0.0, 0.0),
    '−p': (-1.0, 0.0, 0.0),
}
ANY = 'worst axis found'
# How the search narrows, rad: the peaks are ridges, sharp to one side.
NARROWER = (0.1, 0.05, 0.025, 0.0125)
# What the paper's conclusion allows: gimbals twice as fast as the hand.
ALLOWED = 2.0
# Peaks nearer to each other than this are drawn as one, hand rates.
ALIKE = 0.01


class Map(NamedTuple):
    """Peak rates over pitches and over axes in the plane of p and r.

    Attributes:
        pitch: rad, shape (n,).
        heading: Of the axis, from +p over +r, rad, shape (m,).
        peak: In hand rates, shape (n, m).
    """

    pitch: np.ndarray
    heading: np.ndarray
    peak: np.ndarray


def pitches(step: float) -> np.ndarray:
    """Return 0 to 90° in steps given in degrees, rad: beyond it the peaks are no higher."""
    return np.radians(np.arange(0.0, 90.0 + 0.5 * step, step))


def spread(count: int) -> np.ndarray:
    """Return directions that share the sphere evenly, Fibonacci's lattice, shape (count, 3)."""
    z = 1.0 - (2.0 * np.arange(count) + 1.0) / count
    around = math.pi * (1.0 + math.sqrt(5.0)) * np.arange(count)
    ring = np.sqrt(1.0 - z * z)
    return np.stack([ring * np.cos(around), ring * np.sin(around), z], axis=1)


def peaks(pitch: np.ndarray, directions: np.ndarray) -> np.ndarray:
    """Return the peak rate of every pitch with every axis, in hand rates.

    Args:
        pitch: rad, shape (n,).
        directions: Unit axes (p, q, r), shape (m, 3).

    Returns:
        Shape (n, m).
    """
    every = np.repeat(pitch, len(directions)), np.tile(directions, (len(pitch), 1))
    return peak_rates(*every).reshape(len(pitch), len(directions)) / BARKER_SPEED


def worst(pitch: float, count: int) -> tuple[np.ndarray, float]:
    """Return the axis that was found to need the fastest gimbals, shape (3,), and their peak.

    It is the best of axes all over the sphere, then of ever nearer ones around it: there may be
    worse ones.

    Args:
        pitch: rad.
        count: Axes all over the sphere; a quarter as many each time around the best.
    """
    best, most = np.array([0.0, 0.0, 1.0]), 0.0
    for around in (None, *NARROWER):
        tried = spread(count) if around is None else best + around * spread(count // 4)
        tried /= np.linalg.norm(tried, axis=1, keepdims=True)
        found = peaks(np.array([pitch]), tried)[0]
        if found.max() > most:
            best, most = tried[np.argmax(found)], float(found.max())
    return best, most


def curves(
    pitch: np.ndarray,
    count: int,
    tracked: Callable[[Sequence[float]], Iterable[float]] = iter,
) -> dict[str, np.ndarray]:
    """Return the peaks over pitch by name: about each axis of the hand, and the worst found."""
    found = dict(zip(AXES, peaks(pitch, np.array(list(AXES.values()))).T, strict=True))
    found[ANY] = np.array([worst(angle, count)[1] for angle in tracked(pitch.tolist())])
    return found


def plane(pitch: np.ndarray, headings: int) -> Map:
    """Return the peaks over pitch and over axes in the plane of p and r."""
    heading = np.linspace(-math.pi, math.pi, headings)
    axes = np.stack([np.cos(heading), np.zeros(headings), np.sin(heading)], axis=1)
    return Map(pitch, heading, peaks(pitch, axes))


def draw(pitch: np.ndarray, found: dict[str, np.ndarray], around: Map) -> Figure:
    """Draw the peaks over pitch, and over pitch and axis."""
    figure = Figure(figsize=(12.0, 5.2), layout='constrained')
    left, right = figure.subplots(1, 2)
    _lines(left, pitch, found)
    mesh = right.pcolormesh(
        np.degrees(around.pitch),
        np.degrees(around.heading),
        around.peak.T,
        cmap=colormaps['viridis'].resampled(12),
        shading='nearest',
        vmin=1.0,
        vmax=4.0,
    )
    right.contour(
        np.degrees(around.pitch),
        np.degrees(around.heading),
        around.peak.T,
        [ALLOWED],
        colors='white',
        linewidths=0.8,
    )
    right.set_yticks([-180, -90, 0, 90, 180], ['−p', '−r', '+p', '+r', '−p'])
    right.set(
        xlabel='pitch before the turn (deg)',
        ylabel='axis of the turn, in the plane of p and r',
        title='(b) white lines: twice the hand rate',
    )
    figure.colorbar(mesh, ax=right, label='peak gimbal rate / hand rate', extend='max')
    figure.suptitle('Four-gimbal wrist, K = 0.8 rad/s: pitch, then one whole turn, at 32 deg/s')
    return figure


def _lines(axes: Axes, pitch: np.ndarray, found: dict[str, np.ndarray]) -> None:
    for (name, peak), colour, style in zip(found.items(), COLOURS, STYLES, strict=False):
        axes.plot(np.degrees(pitch), peak, label=name, color=colour, linestyle=style)
    axes.axhline(ALLOWED, color='grey', linewidth=0.8)
    axes.annotate('twice the hand rate', (89.0, ALLOWED), ha='right', va='bottom', fontsize=8)
    axes.plot(90.0, found['+r'][-1], 'o', color=COLOURS[0])
    together = same_from(pitch, found)
    one = '' if together is None else f'\n{", ".join(AXES)} are one from {together:g}° on'
    axes.annotate(
        f'extended test maneuver{one}',
        (90.0, found['+r'][-1]),
        xytext=(-6, -4),
        textcoords='offset points',
        ha='right',
        va='top',
        fontsize=8,
    )
    axes.set(
        xlabel='pitch before the turn (deg)',
        ylabel='peak gimbal rate / hand rate',
        xlim=(0.0, 91.0),
        ylim=(0.0, None),
        title='(a) by the axis of the turn',
    )
    axes.grid(alpha=0.3)
    axes.legend(fontsize=9, ncols=2, loc='lower center')


def same_from(pitch: np.ndarray, found: dict[str, np.ndarray]) -> float | None:
    """Return from which pitch on the turns about all axes need the same, deg, or None."""
    apart = np.flatnonzero(np.ptp([found[name] for name in AXES], axis=0) > ALIKE)
    first = apart[-1] + 1 if apart.size else 0
    return math.degrees(pitch[first]) if first < len(pitch) else None


def table(pitch: np.ndarray, found: dict[str, np.ndarray]) -> Table:
    """Return where each curve is highest, and where it is above twice the hand's rate."""
    shown = Table(title='Peak gimbal rate, hand at 32 deg/s')
    for heading in ('axis', 'worst pitch (deg)', 'peak (deg/s)', '× hand', '> 2 × at (deg)'):
        shown.add_column(heading, justify='right')
    for name, peak in found.items():
        most = int(np.argmax(peak))
        beyond = np.degrees(pitch[peak > ALLOWED])
        speed = f'{math.degrees(BARKER_SPEED) * peak[most]:.1f}'
        where = f'{beyond[0]:g} to {beyond[-1]:g}' if beyond.size else ''
        degrees = f'{math.degrees(pitch[most]):g}'
        shown.add_row(name, degrees, speed, f'{peak[most]:.2f}', where)
    return shown


def main(folder: Path, step: float = 1.0, count: int = 500, headings: int = 181) -> None:
    """Print the table and write the picture to a folder.

    Args:
        folder: Where the picture goes.
        step: Between pitches, deg.
        count: Axes all over the sphere.
        headings: Axes in the plane of p and r.
    """
    console, pitch = Console(), pitches(step)
    found = curves(pitch, count, lambda angles: track(angles, 'pitches', console=console))
    console.print(table(pitch, found))
    figure = draw(pitch, found, plane(pitch, headings))
    console.print(save(figure, folder / 'barker-worst-maneuver.png'))


if __name__ == '__main__':
    main(Path(sys.argv[1]) if len(sys.argv) > 1 else Path('out'))
