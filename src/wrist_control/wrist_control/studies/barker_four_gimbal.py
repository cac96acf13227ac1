"""Draw figures 9, 10 and 11 of [Barker1986] again: the four-gimbal wrist.

`./env python -m wrist_control.studies.barker_four_gimbal docs/results` writes them to a folder.
"""

from __future__ import annotations

import math
import sys
from collections.abc import Callable, Iterable, Sequence
from pathlib import Path

import numpy as np
from matplotlib.figure import Figure
from rich.progress import track

from wrist_control.flight import fly
from wrist_control.operating.maneuvers import extended_test
from wrist_control.studies.flight_figures import draw_flight, save

GAINS = tuple(float(gain) for gain in np.round(np.arange(0.20, 4.01, 0.05), 2))
SPEEDS = (math.radians(32.0), math.radians(16.0))


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
        title='Figure 11: extended test maneuver\nleft of the dotted lines θ runs towards lock',
    )
    axes.grid(alpha=0.3)
    axes.legend()
    return figure


def main(folder: Path) -> None:
    """Write the three figures to a folder."""
    peaks = peak_rates(tracked=lambda pairs: track(pairs, 'flying figure 11'))
    basic, extended = fly('four_gimbal', 'basic_test'), fly('four_gimbal', 'extended_test')
    figures = {
        9: draw_flight(basic, 'Figure 9: four-gimbal wrist, basic test maneuver, K = 0.8'),
        10: draw_flight(extended, 'Figure 10: four-gimbal wrist, extended test maneuver, K = 0.8'),
        11: draw_figure_11(GAINS, peaks),
    }
    for number, figure in figures.items():
        print(save(figure, folder / f'barker-figure-{number}.png'))


if __name__ == '__main__':
    main(Path(sys.argv[1]) if len(sys.argv) > 1 else Path('out'))
