"""Draw figures 9, 10 and 11 of [Barker1986] again: the four-gimbal wrist.

`./env python -m wrist_control.gimbal_figures docs/results` writes them to a folder.
"""

from __future__ import annotations

import math
import sys
from collections.abc import Callable, Iterable, Sequence
from pathlib import Path

import numpy as np
from matplotlib.axes import Axes
from matplotlib.figure import Figure
from rich.progress import track

from wrist_control.flight import Flight, fly
from wrist_control.maneuvers import extended_test

INCH = 0.0254
GAINS = tuple(float(gain) for gain in np.round(np.arange(0.20, 4.01, 0.05), 2))
SPEEDS = (math.radians(32.0), math.radians(16.0))
NAMES = {'psi': 'ψ', 'theta': 'θ', 'phi': 'φ', 'alpha': 'α'}
STYLES = ('-', '--', '-.', ':')


def peak_rate(gain: float, speed: float) -> float:
    """Return the fastest gimbal increment of the extended test maneuver, rad/s."""
    flight = fly('four_gimbal', extended_test(speed), gain=gain)
    return float(np.abs(flight.joint_rates).max())


def peak_rates(
    gains: Sequence[float] = GAINS,
    speeds: Sequence[float] = SPEEDS,
    tracked: Callable[[Sequence[tuple[float, float]]], Iterable[tuple[float, float]]] = iter,
) -> np.ndarray:
    """Return the peak rates of figure 11, rad/s, shape (speeds, gains)."""
    pairs = [(gain, speed) for speed in speeds for gain in gains]
    found = [peak_rate(gain, speed) for gain, speed in tracked(pairs)]
    return np.array(found).reshape(len(speeds), len(gains))


def draw_flight(flight: Flight, title: str) -> Figure:
    """Draw a flight as the four parts of Barker's figures 9 and 10."""
    figure = Figure(figsize=(9.0, 7.0), layout='constrained')
    axes = figure.subplots(2, 2, sharex=True)
    joints = [NAMES[joint.name] for joint in flight.wrist.joints]
    # A row's inputs and rates hold until the next row, and the last row's are of no step.
    inputs = flight.scale_factor[:, None] * np.degrees(flight.command)
    _lines(axes[0, 0], flight.time[:-1], inputs[:-1], 'pqr', '(a) operator inputs (deg/s)')
    tips = [f'${axis}_{{tip}}$' for axis in 'xyz']
    _lines(axes[0, 1], flight.time, flight.tip / INCH, tips, '(b) probe tip (in.)')
    rates = np.degrees(flight.joint_rates[:-1])
    _lines(axes[1, 0], flight.time[:-1], rates, joints, '(c) gimbal angle rates (deg/s)')
    angles = np.degrees(flight.joint_positions)
    _lines(axes[1, 1], flight.time, angles, joints, '(d) gimbal angles (deg)')
    for below in axes[1]:
        below.set_xlabel('time (s)')
    figure.suptitle(title, fontsize=11)
    return figure


def _lines(
    axes: Axes, time: np.ndarray, values: np.ndarray, labels: Sequence[str], title: str
) -> None:
    for column, label, style in zip(values.T, labels, STYLES[: len(labels)], strict=True):
        axes.plot(time, column, style, label=label, linewidth=1.4)
    axes.set_title(title, fontsize=10)
    axes.grid(alpha=0.3)
    axes.legend(fontsize=9)


def draw_figure_11(gains: Sequence[float], peaks: np.ndarray) -> Figure:
    """Draw the peak rate of the extended test maneuver as a function of the gain."""
    figure = Figure(figsize=(7.5, 5.0), layout='constrained')
    axes = figure.subplots()
    for speed, row, style in zip(SPEEDS, np.degrees(peaks), ('-', '--'), strict=True):
        hand = f'{math.degrees(speed):g} deg/s'
        (line,) = axes.plot(gains, row, style, label=f'hand {hand}')
        axes.axvline(speed, color=line.get_color(), linestyle=':', linewidth=1.0)
        axes.annotate(f'K = {speed:.2f}', (speed, 3.0), fontsize=8, rotation=90, ha='right')
        axes.plot(0.8, np.interp(0.8, gains, row), 'o', color=line.get_color())
    axes.axhline(32.0, color='grey', linewidth=0.8)
    axes.set(
        xlabel='gain K (rad/s)',
        ylabel='peak gimbal angle rate (deg/s)',
        xlim=(0.0, max(gains)),
        ylim=(0.0, None),
        title='Extended test maneuver, h = 1/32 s\nleft of the dotted lines θ runs towards lock',
    )
    axes.grid(alpha=0.3)
    axes.legend()
    return figure


def main(folder: Path) -> None:
    """Write the three figures to a folder."""
    folder.mkdir(parents=True, exist_ok=True)
    peaks = peak_rates(tracked=lambda pairs: track(pairs, 'flying figure 11'))
    basic, extended = fly('four_gimbal', 'basic_test'), fly('four_gimbal', 'extended_test')
    figures = {
        9: draw_flight(basic, 'Basic test maneuver, four-gimbal wrist, K = 0.8'),
        10: draw_flight(extended, 'Extended test maneuver, four-gimbal wrist, K = 0.8'),
        11: draw_figure_11(GAINS, peaks),
    }
    for number, figure in figures.items():
        path = folder / f'barker-figure-{number}.png'
        figure.savefig(path, dpi=100)
        print(path)


if __name__ == '__main__':
    main(Path(sys.argv[1]) if len(sys.argv) > 1 else Path('out'))
