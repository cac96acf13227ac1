"""Pictures of flights, in the order of the panels of Barker's figures."""

from __future__ import annotations

from collections.abc import Sequence
from pathlib import Path

import matplotlib

matplotlib.use('Agg')  # pictures are files: no screen is needed

import matplotlib.pyplot as plt
import numpy as np
from matplotlib.axes import Axes
from matplotlib.figure import Figure

from wrist_control.flight import Flight
from wrist_control.units import INCH

GREEK = {'psi': 'ψ', 'theta': 'θ', 'phi': 'φ', 'alpha': 'α'}
# Readable in black and white and by the colour-blind.
COLORS = ('#0072b2', '#d55e00', '#009e73', '#cc79a7', '#e69f00', '#56b4e9')
STYLES = ('-', '--', '-.', ':', '-', '--')
# A rate beyond this many times the commanded one would hide all others.
CROWDED = 8.0


def draw_tip(flight: Flight, title: str) -> Figure:
    """Draw the probe tip over time, as in figure 6."""
    figure, axes = plt.subplots(figsize=(7.0, 4.0), layout='constrained')
    _tip(axes, flight, title)
    return figure


def draw_flight(flight: Flight, title: str) -> Figure:
    """Draw effective operator inputs, probe tip, joint rates and joint angles, as in figure 7."""
    figure, axes = plt.subplots(2, 2, figsize=(11.0, 7.5), sharex=True, layout='constrained')
    _inputs(axes[0, 0], flight)
    _tip(axes[0, 1], flight, '(b) Probe tip in forearm axes')
    _rates(axes[1, 0], flight)
    _angles(axes[1, 1], flight)
    figure.suptitle(title)
    return figure


def save(figure: Figure, path: Path) -> Path:
    """Write a picture and close it."""
    path.parent.mkdir(parents=True, exist_ok=True)
    figure.savefig(path, dpi=100)
    plt.close(figure)
    return path


def _inputs(axes: Axes, flight: Flight) -> None:
    effective = np.degrees(flight.command * flight.scale_factor[:, None])
    _lines(axes, flight.time, effective, ('p', 'q', 'r'), steps=True)
    _label(axes, '(a) Effective operator inputs', 'deg/s')


def _tip(axes: Axes, flight: Flight, title: str) -> None:
    _lines(axes, flight.time, flight.tip / INCH, ('x tip', 'y tip', 'z tip'))
    _label(axes, title, 'in.')


def _rates(axes: Axes, flight: Flight) -> None:
    rates = np.degrees(flight.joint_rates)
    _lines(axes, flight.time, rates, [f'{name} rate' for name in _names(flight)], steps=True)
    _label(axes, '(c) Joint rates', 'deg/s')
    usual = max(1.0, float(np.degrees(np.abs(flight.command).max())))
    if np.abs(rates).max() > CROWDED * usual:
        axes.set_ylim(-2.5 * usual, 2.5 * usual)
        row, joint = np.unravel_index(np.abs(rates).argmax(), rates.shape)
        axes.annotate(
            f'off the scale: {rates[row, joint]:.0f} deg/s',
            (flight.time[row], 2.4 * usual),
            xytext=(8, -4),
            textcoords='offset points',
            va='top',
        )


def _angles(axes: Axes, flight: Flight) -> None:
    _lines(axes, flight.time, np.degrees(flight.joint_positions), _names(flight))
    _label(axes, '(d) Joint angles', 'deg')


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
            linewidth=1.6,
            color=COLORS[column],
            linestyle=STYLES[column],
            drawstyle='steps-post' if steps else 'default',
        )


def _label(axes: Axes, title: str, unit: str) -> None:
    axes.set_title(title, loc='left', fontsize=10)
    axes.set_ylabel(unit)
    axes.set_xlabel('time, s')
    axes.grid(alpha=0.3)
    axes.legend(frameon=False, fontsize=9)
