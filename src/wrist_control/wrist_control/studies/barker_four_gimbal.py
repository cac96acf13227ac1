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

from wrist_control.flight import Flight, fly
from wrist_control.operating.maneuvers import extended_test
from wrist_control.studies.barker_figure_5 import PAPER_GAIN
from wrist_control.studies.flight_figures import draw_flight
from wrist_control.studies.pictures import COLOURS, STYLES, save

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
    for speed, row, colour, style in zip(SPEEDS, np.degrees(peaks), COLOURS, STYLES, strict=False):
        hand = f'hand {math.degrees(speed):g} deg/s'
        axes.plot(gains, row, linestyle=style, color=colour, label=hand)
        axes.axvline(speed, color=colour, linestyle=':', linewidth=1.0)
        axes.annotate(f'K = {speed:.2f}', (speed, 3.0), fontsize=8, rotation=90, ha='right')
        axes.plot(PAPER_GAIN, np.interp(PAPER_GAIN, gains, row), 'o', color=colour)
    axes.annotate(
        f'K = {PAPER_GAIN:g}, as in the paper',
        (PAPER_GAIN, np.interp(PAPER_GAIN, gains, np.degrees(peaks[0]))),
        xytext=(6, -14),
        textcoords='offset points',
        fontsize=9,
    )
    axes.axhline(32.0, color='grey', linewidth=0.8)
    axes.annotate(
        '32 deg/s, the limit of figure 8',
        (max(gains), 32.0),
        xytext=(-4, 3),
        textcoords='offset points',
        ha='right',
        fontsize=9,
        color='0.3',
    )
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


def draw(
    basic: Flight, extended: Flight, gains: Sequence[float], peaks: np.ndarray
) -> dict[int, Figure]:
    """Return the three figures by their numbers."""
    wrist = 'four-gimbal wrist'
    return {
        9: draw_flight(basic, f'Figure 9: {wrist}, basic test maneuver, K = {PAPER_GAIN:g}'),
        10: draw_flight(
            extended, f'Figure 10: {wrist}, extended test maneuver, K = {PAPER_GAIN:g}'
        ),
        11: draw_figure_11(gains, peaks),
    }


def main(folder: Path, gains: Sequence[float] = GAINS) -> None:
    """Write the three figures to a folder."""
    peaks = peak_rates(gains, tracked=lambda pairs: track(pairs, 'flying figure 11'))
    basic, extended = (
        fly('four_gimbal', maneuver, gain=PAPER_GAIN)
        for maneuver in ('basic_test', 'extended_test')
    )
    for number, figure in draw(basic, extended, gains, peaks).items():
        print(save(figure, folder / f'barker-figure-{number}.png'))


if __name__ == '__main__':
    main(Path(sys.argv[1]) if len(sys.argv) > 1 else Path('out'))
