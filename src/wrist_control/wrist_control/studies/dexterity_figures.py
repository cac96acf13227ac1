"""The pictures of the dexterity study: [Canfield1997], chapter 4, and maps of every wrist."""

from __future__ import annotations

import math
from collections.abc import Sequence
from typing import Any

import numpy as np
from matplotlib import colormaps
from matplotlib.axes import Axes
from matplotlib.collections import QuadMesh
from matplotlib.figure import Figure
from matplotlib.patheffects import withStroke

from wrist_control.dexterity import determinant, disc, principal, singular_ratio, sweep
from wrist_control.studies.canfield_closure import closure_edge, singular_edge
from wrist_control.studies.canfield_pointing import (
    Pointer,
    Reading,
    hemisphere,
    pointing_jacobians,
)
from wrist_control.wrists.carpal import Carpal
from wrist_control.wrists.wrist import Wrist

# Few colours read off more easily than many, and make small pictures.
COLOURS = colormaps['viridis'].resampled(16)
AXES = 'xyz'
RATES = 'pqr'
# Figure 4.4 goes this far, rad: its wrist reaches 107°.
EDGE_OF_VIEW = math.radians(110.0)
# R_b of figures 4.3 to 4.5, and of Table 4.2.
BASE_RATIO = 0.75


def carpal(plunge_ratio: float) -> Carpal:
    """Return the Carpal wrist of the figures with a unit leg, R_d as given."""
    return Carpal(BASE_RATIO, 1.0, plunge_ratio)


def edges() -> Figure:
    """Draw figure 4.3: where closure ends and where det J is 0, over R_d and over α."""
    figure = Figure(figsize=(10.0, 4.2), layout='constrained')
    over_plunge, around = figure.subplots(1, 2)
    ratios = np.append(np.linspace(0.05, 0.66, 30), np.linspace(0.6615, 0.95, 80))
    places = [(carpal(ratio), -0.5 * math.pi) for ratio in ratios]
    _edge_lines(over_plunge, ratios, places, places[31::6])
    over_plunge.legend(fontsize='small', loc='lower left')
    over_plunge.set(
        xlabel='$R_d$', ylabel='β at the edge, °', title='slice α = -90°, $R_b$ = 0.75'
    )
    alphas = np.linspace(0.0, math.tau, 145)
    places = [(carpal(0.7), alpha) for alpha in alphas]
    _edge_lines(around, np.degrees(alphas), places, places[::6])
    around.set(
        xlabel='α, °', xticks=range(0, 361, 60), title='all around, $R_b$ = 0.75, $R_d$ = 0.70'
    )
    return figure


def _edge_lines(
    axes: Axes,
    x: np.ndarray,
    places: list[tuple[Carpal, float]],
    marked: list[tuple[Carpal, float]],
) -> None:
    reach = [math.degrees(wrist.reach(alpha)) for wrist, alpha in places]
    axes.plot(x, reach, color='0.7', linewidth=4, label='closed form')
    at = [x[places.index(place)] for place in marked]
    closed = [math.degrees(closure_edge(*place)) for place in marked]
    singular = [math.degrees(singular_edge(*place)) for place in marked]
    axes.plot(at, closed, 'o', markersize=8, markerfacecolor='none', label='closure lost')
    axes.plot(at, singular, 'x', label='det J = 0')


def measures() -> Figure:
    """Draw figure 4.4: determinant and singular-value ratio, R_b = 0.75, R_d = 0.70."""
    alpha, beta, stack = _paper_jacobians(carpal(0.7))
    figure = Figure(figsize=(9.0, 4.2), layout='constrained')
    left, right = figure.subplots(1, 2, subplot_kw={'projection': 'polar'})
    beta, stack = beta[beta < EDGE_OF_VIEW], stack[:, beta < EDGE_OF_VIEW]
    _bar(figure, _map(left, alpha, beta, determinant(stack), 'det J / l'), left)
    ratio = np.minimum(singular_ratio(stack), 20.0)
    _bar(figure, _map(right, alpha, beta, ratio, 'σ max / σ min, cut at 20'), right)
    return figure


def plunges() -> Figure:
    """Draw figure 4.5: the determinant for several R_d."""
    figure = Figure(figsize=(11.0, 7.0), layout='constrained')
    panels = figure.subplots(2, 3, subplot_kw={'projection': 'polar'})
    for axes, ratio in zip(panels.flat, (0.3, 0.45, 0.6, 0.7, 0.8, 0.9), strict=True):
        alpha, beta, stack = _paper_jacobians(carpal(ratio))
        title = f'det J / l at $R_d$ = {ratio:g}'
        mesh = _map(axes, alpha, beta, determinant(stack), title, top=0.12)
    _bar(figure, mesh, panels)
    return figure


def _paper_jacobians(wrist: Carpal) -> tuple[np.ndarray, np.ndarray, np.ndarray]:
    alpha, beta = hemisphere(math.radians(178.0), 120, 89)
    stack = np.full((len(alpha), len(beta), 3, 3), np.nan)
    for row, azimuth in enumerate(alpha.tolist()):
        axis = (-math.sin(azimuth), math.cos(azimuth), 0.0)
        for column, positions in enumerate(sweep(wrist, axis, beta.tolist())):
            stack[row, column] = wrist.normal_jacobian(positions)
    return alpha, beta, stack


def pointing(pointers: Sequence[Pointer], readings: Sequence[Reading]) -> Figure:
    """Draw figures 4.8 to 4.10: the least principal dexterity of the three pointers."""
    figure = Figure(figsize=(3.7 * len(pointers), 3.5 * len(readings)), layout='constrained')
    panels = figure.subplots(
        len(readings), len(pointers), subplot_kw={'projection': 'polar'}, squeeze=False
    )
    alpha, beta = hemisphere(math.radians(89.5), 90, 60)
    for row, reading in zip(panels, readings, strict=True):
        for axes, pointer in zip(row, pointers, strict=True):
            least = principal(pointing_jacobians(pointer, alpha, beta, reading))[..., -1]
            mesh = _map(axes, alpha, beta, least, f'{pointer.name}, {reading}', top=1.25)
    _bar(figure, mesh, panels)
    return figure


def workspace(name: str, wrist: Wrist, headings: int = 90, turns: int = 60) -> Figure:
    """Draw the two measures over turns from home about axes between two that are followed."""
    free = wrist.followed_axes
    planes = [plane for plane in ((0, 1), (1, 2), (2, 0)) if set(plane) <= set(free)]
    figure = Figure(figsize=(3.6 * len(planes), 7.0), layout='constrained')
    panels = figure.subplots(2, len(planes), subplot_kw={'projection': 'polar'}, squeeze=False)
    heading = np.linspace(0.0, math.tau, headings, endpoint=False)
    angle = np.linspace(0.0, math.pi, turns)
    for (upper, lower), plane in zip(panels.T, planes, strict=True):
        stack = disc(wrist, plane, heading.tolist(), angle.tolist())
        about = f'turns about {AXES[plane[0]]} (0°) and {AXES[plane[1]]} (90°)'
        _bar(
            figure, _map(upper, heading, angle, determinant(stack), f'determinant\n{about}'), upper
        )
        ratio = 1.0 / singular_ratio(stack)
        _bar(figure, _map(lower, heading, angle, ratio, 'σ min / σ max', top=1.0), lower)
    rates = ', '.join(RATES[axis] for axis in free)
    figure.suptitle(f'{name}: {rates} over joint rates')
    return figure


def overview(wrists: dict[str, Wrist], headings: int = 72, turns: int = 45) -> Figure:
    """Draw σ min / σ max of every wrist over turns about the hand's axes x and y."""
    columns = 5
    rows = -(-len(wrists) // columns)
    figure = Figure(figsize=(2.4 * columns, 2.6 * rows), layout='constrained')
    panels = figure.subplots(rows, columns, subplot_kw={'projection': 'polar'}, squeeze=False)
    heading = np.linspace(0.0, math.tau, headings, endpoint=False)
    angle = np.linspace(0.0, math.pi, turns)
    for axes in panels.ravel()[len(wrists) :]:
        axes.set_visible(False)
    for axes, (name, wrist) in zip(panels.ravel(), wrists.items(), strict=False):
        stack = disc(wrist, (0, 1), heading.tolist(), angle.tolist())
        mesh = _map(axes, heading, angle, 1.0 / singular_ratio(stack), name, top=1.0)
    _bar(figure, mesh, panels)
    return figure


def _map(
    axes: Axes,
    around: np.ndarray,
    outward: np.ndarray,
    values: np.ndarray,
    title: str,
    top: float | None = None,
) -> QuadMesh:
    """Draw values over an angle around and an angle outward, rad; NaN stays blank."""
    closed = np.append(around, around[0] + math.tau)
    shown = np.append(values, values[:1], axis=0)
    mesh = axes.pcolormesh(
        closed, np.degrees(outward), shown.T, cmap=COLOURS, shading='nearest', vmin=0.0, vmax=top
    )
    axes.set_ylim(0.0, math.degrees(outward[-1]))
    axes.set_title(title, fontsize='medium')
    rings = [round(math.degrees(outward[-1]) * part / 3.0) for part in (1, 2, 3)]
    # A light edge, so that they are read on dark colours too.
    edge = [withStroke(linewidth=2.0, foreground='white')]
    axes.set_yticks(rings, [f'{ring}°' for ring in rings], path_effects=edge)
    axes.tick_params(labelsize='x-small')
    axes.grid(alpha=0.3)
    return mesh


def _bar(figure: Figure, mesh: QuadMesh, panels: Any) -> None:
    """Draw what the colours of one panel, or of several, stand for."""
    figure.colorbar(mesh, ax=panels, shrink=0.7)
