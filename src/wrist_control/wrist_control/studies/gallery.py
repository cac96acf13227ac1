"""Every wrist as its mechanism, still and in motion: `make gallery`."""

from __future__ import annotations

import math
import sys
from collections.abc import Sequence
from io import BytesIO
from pathlib import Path
from typing import NamedTuple

import numpy as np
from matplotlib.axes import Axes
from matplotlib.figure import Figure
from PIL import Image
from rich.console import Console
from rich.progress import track

from wrist_control.flight import Flight, fly
from wrist_control.operating.maneuvers import make_maneuver
from wrist_control.rotations import Pose, quaternion_of
from wrist_control.studies.comparison import JOINT_SPEEDS, about_approach, approach_axis
from wrist_control.studies.mechanism import Window, draw, window
from wrist_control.studies.pictures import save
from wrist_control.wrists import WRISTS, make_wrist
from wrist_control.wrists.body import Body

MANEUVER = 'basic_test'
# A hand that is held up for longer cannot go on, s.
PATIENCE = 3.0
# Steps a second of the flight; every one of so many is a picture of the animation.
STEPS, EVERY = 40.0, 4
LAST = 1.5  # how long the last picture stays, s
SIDE, DPI = 4.0, 90.0  # inches, as matplotlib wants it, and pixels an inch
QUALITY = 50


class Show(NamedTuple):
    """A wrist on its way through the maneuver.

    Attributes:
        flight: What happened, the joints held to Barker's 32 deg/s.
        scenes: The bodies at each of the flight's times.
        window: What of the plane of the picture they ever fill.
    """

    flight: Flight
    scenes: list[tuple[Body, ...]]
    window: Window


def show(name: str) -> Show:
    """Fly a wrist through the basic test maneuver, and return what is to see of it."""
    wrist = make_wrist(name)
    limits = [JOINT_SPEEDS[joint.kind] for joint in wrist.joints]
    maneuver = about_approach(make_maneuver(MANEUVER), approach_axis(wrist))
    flight = fly(wrist, maneuver, STEPS, limits, probe=wrist.probe, patience=PATIENCE)
    scenes = []
    for rotation, position, joints in zip(
        flight.hand_rotation, flight.hand_position, flight.joint_positions, strict=True
    ):
        x, y, z = position.tolist()
        pose = Pose(quaternion_of(rotation), (x, y, z))
        # Joint positions alone may fit several poses; `inverse` says which they hold.
        scenes.append(wrist.bodies(wrist.inverse(pose, joints.tolist())))
    return Show(flight, scenes, window(scenes))


def moments(flight: Flight) -> dict[str, int]:
    """Return three moments of a flight by what they show: home, half bent, and the worst.

    The worst is the closest to lock; for a wrist that is closest at home, the furthest bent.
    """
    home = flight.hand_rotation[0]
    cosines = 0.5 * (np.einsum('nij,ij->n', flight.hand_rotation, home) - 1.0)
    bends = np.arccos(np.clip(cosines, -1.0, 1.0))
    worst, title = int(flight.margin.argmin()), 'at its worst'
    if worst == 0:
        worst, title = int(bends.argmax()), 'furthest bent'
    half = int((bends >= 0.5 * bends[worst]).argmax())
    return {'home': 0, 'half bent': half, title: worst}


def draw_moments(name: str, shown: Show) -> Figure:
    """Draw a wrist at home, half bent and at its worst, side by side."""
    figure = Figure(figsize=(3.0 * SIDE, SIDE), layout='constrained')
    for axes, (title, index) in zip(
        figure.subplots(1, 3), moments(shown.flight).items(), strict=True
    ):
        _draw(axes, shown, index)
        axes.set_title(f'{title}, margin {shown.flight.margin[index]:.2f}', fontsize=13)
    figure.suptitle(name, fontsize=15)
    return figure


def draw_moment(name: str, shown: Show, index: int) -> Figure:
    """Draw a wrist at one moment of its flight, and say what it does."""
    flight = shown.flight
    figure = Figure(figsize=(SIDE, SIDE))
    axes = figure.add_axes((0.0, 0.06, 1.0, 0.88))
    _draw(axes, shown, index)
    figure.text(0.03, 0.95, name, fontsize=13)
    figure.text(0.97, 0.95, _doing(flight, index), fontsize=11, ha='right')
    factor, margin = flight.scale_factor[_step(flight, index)], flight.margin[index]
    words = (
        f'{flight.time[index]:4.1f} s     speed {100.0 * factor:3.0f} %     margin {margin:.2f}'
    )
    figure.text(0.03, 0.03, words, fontsize=11)
    return figure


def _draw(axes: Axes, shown: Show, index: int) -> None:
    draw(axes, shown.scenes[index], shown.flight.tip[: index + 1])
    axes.set_xlim(shown.window[:2])
    axes.set_ylim(shown.window[2:])


def _step(flight: Flight, index: int) -> int:
    """Return the step that is made at a moment: none begins at the last, but one ends there."""
    return min(index, len(flight.time) - 2)


def _doing(flight: Flight, index: int) -> str:
    """Return what holds the hand back at a moment, in a few words."""
    limits = ', '.join(flight.limited[_step(flight, index)])
    if not flight.completed and index == len(flight.time) - 1:
        return f'cannot go on: {limits}' if limits else 'cannot go on'
    return f'slowed by {limits}' if limits else ''


def pixels(figure: Figure) -> Image.Image:
    """Return a figure as an image."""
    drawn = BytesIO()
    figure.savefig(drawn, format='png', dpi=DPI)
    return Image.open(drawn).convert('RGB')


def animate(name: str, shown: Show, path: Path) -> Path:
    """Write a flight as an animated WebP, in real time, and return where it is."""
    last = len(shown.scenes) - 1
    frames = [pixels(draw_moment(name, shown, i)) for i in (*range(0, last, EVERY), last)]
    period = round(1000.0 * EVERY / STEPS)
    frames[0].save(
        path,
        save_all=True,
        append_images=frames[1:],
        duration=[period] * (len(frames) - 1) + [round(1000.0 * LAST)],
        loop=0,
        quality=QUALITY,
        method=6,
    )
    return path


def main(arguments: Sequence[str] = ()) -> None:
    """Draw some wrists, or all; into a folder.

    Args:
        arguments: The folder, docs/gallery where none is given, and names of wrists.
    """
    folder, *names = arguments or ['docs/gallery']
    console = Console()
    for name in track(names or list(WRISTS), 'drawing', console=console):
        shown = show(name)
        still = save(draw_moments(name, shown), Path(folder) / f'{name}.png', DPI)
        moving = animate(name, shown, Path(folder) / f'{name}.webp')
        for path in (still, moving):
            console.print(f'{path}: {math.ceil(path.stat().st_size / 1024)} kB', soft_wrap=True)


if __name__ == '__main__':
    main(sys.argv[1:])
