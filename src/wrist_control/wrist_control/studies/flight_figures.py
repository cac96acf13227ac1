"""Pictures of flights, in the order of the panels of Barker's figures."""

from __future__ import annotations

import math
from collections.abc import Sequence
from functools import partial

import numpy as np
from matplotlib.axes import Axes
from matplotlib.figure import Figure

from wrist_control.flight import Flight
from wrist_control.studies.pictures import COLOURS, STYLES
from wrist_control.units import INCH

GREEK = {'psi': 'ψ', 'theta': 'θ', 'phi': 'φ', 'alpha': 'α'}
# What a position is shown in, by kind of joint: how many of it, and its name.
SHOWN = {'revolute': (math.degrees(1.0), 'deg'), 'prismatic': (1.0, 'm')}
# A rate beyond this many times the commanded one would hide all others.
CROWDED = 8.0
# Curves nearer to each other than this share of a panel's height are seen as one: half a line.
ALIKE = 0.003
# Height of one row of a legend, points.
LEGEND_ROW = 15.0
MM = 1e-3  # m


def draw_tip(flight: Flight, title: str) -> Figure:
    """Draw the probe tip over time, as in figure 6."""
    figure = Figure(figsize=(7.0, 4.0), layout='constrained')
    axes = figure.subplots()
    _tip(axes, flight, title)
    axes.set_xlabel('time, s')
    return figure


def draw_flight(flight: Flight, title: str) -> Figure:
    """Draw effective operator inputs, probe tip, joint rates and joint angles, as in figure 7."""
    figure = Figure(figsize=(11.0, 7.5), layout='constrained')
    axes = figure.subplots(2, 2, sharex=True)
    _inputs(axes[0, 0], flight)
    _tip(axes[0, 1], flight, '(b) Probe tip in forearm axes')
    _rates(axes[1, 0], flight)
    _positions(axes[1, 1], flight)
    for lowest in axes[1]:
        lowest.set_xlabel('time, s')
    figure.align_ylabels(axes)
    figure.suptitle(title)
    return figure


def _inputs(axes: Axes, flight: Flight) -> None:
    effective = np.degrees(flight.command * flight.scale_factor[:, None])
    _lines(axes, flight.time, effective, ('p', 'q', 'r'), steps=True)
    _label(axes, '(a) Effective operator inputs', 'deg/s')


def _tip(axes: Axes, flight: Flight, title: str) -> None:
    _lines(axes, flight.time, flight.tip / MM, ('x tip', 'y tip', 'z tip'))
    _label(axes, title, 'mm')
    inch = INCH / MM
    paper = axes.secondary_yaxis(
        'right', functions=(partial(np.multiply, 1.0 / inch), partial(np.multiply, inch))
    )
    paper.set_ylabel('in.')


def _rates(axes: Axes, flight: Flight) -> None:
    factors, unit = _shown(flight)
    rates = factors * flight.joint_rates
    _lines(axes, flight.time, rates, [f'{name} rate' for name in _names(flight)], steps=True)
    _limits(axes, factors * [joint.rate_limit for joint in flight.wrist.joints], f'{unit}/s')
    usual = max(1.0, float(np.degrees(np.abs(flight.command).max())))
    if np.abs(rates).max() > CROWDED * usual:
        axes.set_ylim(-2.5 * usual, 2.5 * usual)
        row, joint = np.unravel_index(np.abs(rates).argmax(), rates.shape)
        axes.annotate(
            f'off the scale: {rates[row, joint]:.0f} {unit}/s',
            (flight.time[row], 2.4 * usual),
            xytext=(8, -4),
            textcoords='offset points',
            va='top',
        )
    _label(axes, '(c) Joint rates', f'{unit}/s')


def _limits(axes: Axes, limits: np.ndarray, unit: str) -> None:
    """Draw every finite limit at both signs, once where several joints have the same."""
    for limit in np.unique(limits[np.isfinite(limits)]):
        for end, name in ((limit, f'limit ±{limit:.4g} {unit}'), (-limit, '_')):
            axes.axhline(end, color='0.6', linewidth=1.0, zorder=1.0, label=name)


def _positions(axes: Axes, flight: Flight) -> None:
    factors, unit = _shown(flight)
    _lines(axes, flight.time, factors * flight.joint_positions, _names(flight))
    _label(axes, f'(d) Joint {"angles" if unit == "deg" else "positions"}', unit)


def _shown(flight: Flight) -> tuple[np.ndarray, str]:
    """Return what each joint's position is multiplied by to be shown, and the unit it has then."""
    shown = [SHOWN[joint.kind] for joint in flight.wrist.joints]
    units = dict.fromkeys(unit for _, unit in shown)
    return np.array([factor for factor, _ in shown]), ' or '.join(units)


def _names(flight: Flight) -> list[str]:
    return [GREEK.get(joint.name, joint.name) for joint in flight.wrist.joints]


def _lines(
    axes: Axes, time: np.ndarray, values: np.ndarray, names: Sequence[str], steps: bool = False
) -> None:
    for column, name in enumerate(names):
        axes.plot(
            time,
            values[:, column],
            label=name,
            # Thinner on top of wider: where two are the same, both are seen.
            linewidth=max(1.4, 2.8 - 0.7 * column),
            color=COLOURS[column],
            linestyle=STYLES[column],
            drawstyle='steps-post' if steps else 'default',
        )


def _label(axes: Axes, title: str, unit: str) -> None:
    """Name a finished panel and its curves, above it, where no curve can be."""
    _name_what_coincides(axes)
    names = len(axes.get_legend_handles_labels()[1])
    columns = 4 if names <= 4 else 2
    legend = axes.legend(
        frameon=False,
        fontsize=9,
        ncols=columns,
        loc='lower left',
        bbox_to_anchor=(0.0, 1.0),
        borderaxespad=0.0,
        borderpad=0.2,
        columnspacing=1.0,
        handlelength=2.4,
        handletextpad=0.5,
    )
    # The panels keep their width: the title makes room for the rows.
    legend.set_in_layout(False)
    axes.set_title(title, loc='left', fontsize=10, pad=4.0 + LEGEND_ROW * -(-names // columns))
    axes.set_ylabel(unit)
    axes.grid(alpha=0.3)


def _name_what_coincides(axes: Axes) -> None:
    """Say of each curve that cannot be told from one before it all along that it lies on it."""
    low, high = axes.get_ylim()
    drawn: list[tuple[str, np.ndarray]] = []
    for line in axes.get_lines():
        name, values = str(line.get_label()), np.asarray(line.get_ydata())
        for other, those in drawn:
            same_size = values.shape == those.shape
            if same_size and np.abs(values - those).max() < ALIKE * (high - low):
                line.set_label(f'{name} (lies on {other.split()[0]})')
                break
        else:
            drawn.append((name, values))
