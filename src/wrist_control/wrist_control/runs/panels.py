"""The figures of a report, as parts of a page: SVG whose colours are the page's own.

Every figure is as wide as a telephone, so that its words can be read there.
"""

from __future__ import annotations

import base64
import math
import re
from collections.abc import Sequence
from io import BytesIO, StringIO
from itertools import pairwise
from typing import Any

import matplotlib
import numpy as np
from matplotlib.axes import Axes
from matplotlib.figure import Figure

from wrist_control.resolving.limits import LimitKind
from wrist_control.runs.series import Series
from wrist_control.studies.flight_figures import GREEK, MM, SHOWN
from wrist_control.studies.mechanism import draw, placed, seen, triangles

# Colours that stand for the page's: what draws them is replaced by their names.
INK, MUTED, GRID = '#010101', '#020202', '#030303'
FIRST, SECOND, THIRD = '#040404', '#050505', '#060606'
OTHERS = ('#070707', '#080808', '#090909')
LINES = (FIRST, SECOND, THIRD, *OTHERS)
NAMES = {
    INK: 'ink',
    MUTED: 'muted',
    GRID: 'grid',
    **{colour: f'line-{number}' for number, colour in enumerate(LINES, 1)},
}
WIDTH = 4.4  # inches
# More points than this cannot be told apart on any screen.
MOST_POINTS = 1600
# So many rows of limits are drawn.
MOST_ROWS = 8
WORDS = {
    LimitKind.RATE: 'rate',
    LimitKind.POSITION: 'end of travel',
    LimitKind.WORKSPACE: 'workspace',
    LimitKind.SINGULARITY: 'lock',
    LimitKind.ACCELERATION: 'change of rate',
}
STYLE: dict[Any, Any] = {
    'svg.fonttype': 'none',
    'font.size': 10.0,
    'font.family': 'sans-serif',
    'text.color': INK,
    'axes.labelcolor': MUTED,
    'axes.edgecolor': GRID,
    'xtick.color': MUTED,
    'ytick.color': MUTED,
    'axes.spines.top': False,
    'axes.spines.right': False,
    'grid.color': GRID,
    'axes.grid': True,
    'axes.axisbelow': True,
    'lines.linewidth': 1.3,
}


def hand_rates(series: Series) -> str:
    """Draw what was asked of the hand, and what it did."""
    used = [k for k in range(6) if np.any(series.commanded[:, k]) or np.any(series.achieved[:, k])]
    used = sorted({*used, 3, 4, 5})
    names = ('vx', 'vy', 'vz', 'p', 'q', 'r')
    with matplotlib.rc_context(STYLE):
        figure, panels = _figure(len(used), 0.95)
        for axes, component in zip(panels, used, strict=True):
            factor, unit = (1e3, 'mm/s') if component < 3 else (math.degrees(1.0), 'deg/s')
            achieved = factor * series.achieved[:, component]
            _line(axes, series, achieved, LINES[component % 3], 'achieved')
            commanded = factor * series.commanded[:, component]
            _line(axes, series, commanded, INK, 'commanded', width=0.8, style='--')
            axes.set_ylabel(f'{names[component]}, {unit}')
            _at_least(axes, 1.0)
        _legend(panels[0])
        return _svg(figure, 'hand')


def joint_rates(series: Series) -> str:
    """Draw how fast the joints moved, as shares of what they may."""
    with matplotlib.rc_context(STYLE):
        figure, (axes,) = _figure(1, 2.2)
        for column, joint in enumerate(series.resolver.wrist.joints):
            rates = series.joint_rates[:, column]
            if math.isfinite(joint.rate_limit):
                rates = 100.0 * rates / joint.rate_limit
            name = GREEK.get(joint.name, joint.name)
            _line(axes, series, rates, LINES[column % len(LINES)], name, _width(column))
        for end in (-100.0, 100.0):
            axes.axhline(end, color=MUTED, linewidth=0.8, linestyle=':')
        axes.set_ylabel('% of the limit')
        _legend(axes)
        return _svg(figure, 'joints')


def factor_and_margin(series: Series) -> str:
    """Draw how much of the command was followed, and how far lock was."""
    with matplotlib.rc_context(STYLE):
        figure, panels = _figure(3, 1.0)
        _line(panels[0], series, series.scale_factor, FIRST, '')
        panels[0].set(ylabel='F', ylim=(-0.05, 1.05))
        _line(panels[1], series, series.margin, THIRD, '')
        panels[1].set(ylabel='margin', ylim=(-0.05, max(1.05, 1.05 * series.margin.max())))
        row = series.closest
        panels[1].plot(series.time[row], series.margin[row], 'o', color=INK, markersize=4)
        _line(panels[2], series, series.time_lost, SECOND, '')
        panels[2].set(ylabel='lost, s')
        panels[2].set_ylim(bottom=0.0, top=max(0.1, 1.1 * series.time_lost.max()))
        return _svg(figure, 'factor')


def limits(series: Series) -> str:
    """Draw when which limit was at work; empty where none ever was."""
    rows = list(series.limits_at_work().items())[:MOST_ROWS]
    if not rows:
        return ''
    with matplotlib.rc_context(STYLE):
        figure, (axes,) = _figure(1, 0.55 + 0.28 * len(rows))
        for row, ((_, kind), spells) in enumerate(rows):
            bars = [(begin, end - begin) for begin, end in spells]
            axes.broken_barh(bars, (row - 0.3, 0.6), color=LINES[int(kind)], linewidth=0.6)
        labels = [f'{GREEK.get(name, name)}: {WORDS[kind]}' for (name, kind), _ in rows]
        axes.set_yticks(range(len(rows)), labels, color=INK)
        axes.set_ylim(len(rows) - 0.4, -0.6)
        axes.grid(axis='y', visible=False)
        axes.set_xlim(0.0, max(series.time[-1], series.period))
        return _svg(figure, 'limits')


def positions(series: Series) -> str:
    """Draw where the joints were told to be."""
    with matplotlib.rc_context(STYLE):
        figure, (axes,) = _figure(1, 2.2)
        for column, joint in enumerate(series.resolver.wrist.joints):
            factor, unit = SHOWN[joint.kind]
            name = GREEK.get(joint.name, joint.name)
            values = factor * series.positions[:, column]
            _line(axes, series, values, LINES[column % len(LINES)], name, _width(column))
            axes.set_ylabel(unit)
        _legend(axes)
        return _svg(figure, 'positions')


def tip(series: Series) -> str:
    """Draw the way of the probe's tip over time."""
    with matplotlib.rc_context(STYLE):
        figure, (axes,) = _figure(1, 2.2)
        for column, name in enumerate('xyz'):
            _line(axes, series, series.tip[:, column] / MM, LINES[column], name)
        axes.set_ylabel('mm')
        _legend(axes)
        return _svg(figure, 'tip')


def mechanism(series: Series) -> str:
    """Return the mechanism at its closest to lock, with the way of its tip, PNG as base64."""
    bodies = series.resolver.wrist.bodies(series.configuration(series.closest))
    figure = Figure(figsize=(WIDTH, WIDTH))
    axes = figure.add_axes((0.0, 0.0, 1.0, 1.0))
    trail = _thin(series.tip)
    draw(axes, bodies, trail)
    surfaces = [placed(triangles(shape), body.pose) for body in bodies for shape in body.shapes]
    points = np.concatenate([*(one.reshape(-1, 3) for one in surfaces), trail])
    flat = seen(points)[:, :2]
    low, high = flat.min(axis=0), flat.max(axis=0)
    middle, half = 0.5 * (low + high), 0.53 * float((high - low).max())
    axes.set(xlim=(middle[0] - half, middle[0] + half), ylim=(middle[1] - half, middle[1] + half))
    drawn = BytesIO()
    figure.savefig(drawn, format='png', dpi=200.0, transparent=True)
    return base64.b64encode(drawn.getvalue()).decode()


def _figure(count: int, height: float) -> tuple[Figure, Sequence[Axes]]:
    figure = Figure(figsize=(WIDTH, 0.5 + count * height), layout='constrained')
    panels = figure.subplots(count, 1, sharex=True, squeeze=False)[:, 0]
    panels[-1].set_xlabel('time, s')
    figure.align_ylabels(panels)
    return figure, list(panels)


def _legend(axes: Axes) -> None:
    """Name the lines above a panel, where none of them can be."""
    names = len(axes.get_legend_handles_labels()[1])
    axes.legend(
        loc='lower left',
        bbox_to_anchor=(0.0, 1.0),
        frameon=False,
        ncols=names if names <= 4 else 3,
        borderaxespad=0.0,
        borderpad=0.2,
        handlelength=1.4,
        columnspacing=1.0,
    )


def _line(
    axes: Axes,
    series: Series,
    values: np.ndarray,
    colour: str,
    name: str,
    width: float = 1.3,
    style: str = '-',
) -> None:
    rows = _rows(values)
    axes.plot(series.time[rows], values[rows], style, color=colour, linewidth=width, label=name)
    axes.set_xlim(0.0, max(series.time[-1], series.period))


def _width(column: int) -> float:
    """Return how thick a line is: thinner on top of thicker, both are seen where they coincide."""
    return max(1.1, 2.8 - 0.8 * column)


def _rows(values: np.ndarray) -> np.ndarray:
    """Return the rows that show all there is to see of many: the extremes of each bin."""
    count = len(values)
    if count <= MOST_POINTS:
        return np.arange(count)
    edges = np.linspace(0, count, MOST_POINTS // 2 + 1).astype(int)
    chosen = {0, count - 1}
    for begin, end in pairwise(edges):
        part = values[begin:end]
        chosen |= {begin + int(part.argmin()), begin + int(part.argmax())}
    return np.array(sorted(chosen))


def _thin(points: np.ndarray) -> np.ndarray:
    return points[:: max(1, len(points) // MOST_POINTS)]


def _at_least(axes: Axes, half: float) -> None:
    """Show no less than this to both sides of zero: trembling shall not fill a panel."""
    low, high = axes.get_ylim()
    axes.set_ylim(min(low, -half), max(high, half))


def _svg(figure: Figure, name: str) -> str:
    """Return a figure as a part of a page, with the page's colours in it."""
    text = StringIO()
    with matplotlib.rc_context({**STYLE, 'svg.hashsalt': name}):
        figure.savefig(text, format='svg', transparent=True, metadata={'Date': None})
    svg = text.getvalue()
    svg = svg[svg.index('<svg') :]
    svg = re.sub(r'<metadata>.*?</metadata>', '', svg, flags=re.DOTALL)
    svg = re.sub(r'\s(?:width|height)="[\d.]+pt"', '', svg, count=2)
    svg = re.sub(
        r'(id="|#)((?:figure|axes|patch|line2d|text|matplotlib|legend|xtick|ytick)\w*)',
        rf'\1{name}-\2',
        svg,
    )
    for colour, called in NAMES.items():
        svg = svg.replace(colour, f'var(--{called})')
    return svg
