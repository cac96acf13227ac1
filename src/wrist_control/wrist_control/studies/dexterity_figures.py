"""The pictures of the dexterity study: [Canfield1997], chapter 4, and maps of every wrist."""

from __future__ import annotations

import math
from collections.abc import Sequence
from typing import Any

import numpy as np
from matplotlib import colormaps
from matplotlib.axes import Axes
from matplotlib.figure import Figure
from matplotlib.patheffects import withStroke
from matplotlib.projections.polar import PolarAxes

from wrist_control.dexterity import determinant, disc, principal, singular_ratio, sweep
from wrist_control.studies.canfield_closure import PrintedCarpal, closure_edge, fold, singular_edge
from wrist_control.studies.canfield_pointing import (
    Pointer,
    Reading,
    hemisphere,
    pointing_jacobians,
)
from wrist_control.studies.pictures import COLOURS as LINE_COLOURS
from wrist_control.wrists.carpal import Carpal
from wrist_control.wrists.wrist import Wrist

# Few colours read off more easily than many, and make small pictures; what lies beyond a scale has
# a colour that is not on it.
COLOURS = colormaps['viridis'].resampled(16).with_extremes(over=LINE_COLOURS[1])
# A few places near an edge can be a hundred times the others: a scale ends at so many medians.
MEDIANS = 3.0
AXES = 'xyz'
RATES = 'pqr'
# Figure 4.4 goes this far, rad: its wrist reaches 107°.
EDGE_OF_VIEW = math.radians(110.0)
# What the angles of the maps are.
TILTS = 'around: azimuth α; outward: tilt β, in degrees; blank: out of reach'
TURNS = 'around: axis of the turn; blank: out of reach\noutward: angle of the turn, in degrees'
TURNS_X_Y = TURNS.replace(';', ', x of the hand at 0° and y at 90°;')
EVENNESS = 'σ min / σ max: slowest over fastest direction'
# R_b of figures 4.3 to 4.5, and of Table 4.2.
BASE_RATIO = 0.75


def carpal(plunge_ratio: float) -> Carpal:
    """Return the Carpal wrist of the figures with a unit leg, R_d as given."""
    return PrintedCarpal(BASE_RATIO, 1.0, plunge_ratio)


def edges() -> Figure:
    """Draw figure 4.3: where closure ends and where det J is 0, over R_d and over α."""
    figure = Figure(figsize=(10.0, 4.8), layout='constrained')
    figure.suptitle('Figure 4.3: how far the Carpal wrist tilts, $R_b$ = 0.75')
    over_plunge, around = figure.subplots(1, 2)
    ratios = np.append(np.linspace(0.05, 0.66, 30), np.linspace(0.6615, 0.95, 80))
    places = [(carpal(ratio), -0.5 * math.pi) for ratio in ratios]
    _edge_lines(over_plunge, ratios, places, places[31::6])
    over_plunge.annotate('no edge before half a turn', (0.05, 176.0), va='top', fontsize=9)
    over_plunge.set(xlabel='$R_d$', ylabel='β at the edge, °', title='towards α = −90°')
    alphas = np.linspace(0.0, math.tau, 145)
    places = [(carpal(0.7), alpha) for alpha in alphas]
    _edge_lines(around, np.degrees(alphas), places, places[::6])
    around.set(
        xlabel='α, °',
        xticks=range(0, 361, 60),
        ylabel='β at the edge, °',
        title='all around, $R_d$ = 0.70',
    )
    figure.legend(*around.get_legend_handles_labels(), loc='outside lower center', ncols=3)
    return figure


def _edge_lines(
    axes: Axes,
    x: np.ndarray,
    places: list[tuple[Carpal, float]],
    marked: list[tuple[Carpal, float]],
) -> None:
    reach = [math.degrees(fold(wrist, alpha)) for wrist, alpha in places]
    axes.plot(x, reach, color='0.7', linewidth=4, label='closed form')
    at = [x[places.index(place)] for place in marked]
    closed = [math.degrees(closure_edge(*place)) for place in marked]
    singular = [math.degrees(singular_edge(*place)) for place in marked]
    axes.plot(at, closed, 'o', markersize=8, markerfacecolor='none', label='closure lost')
    axes.plot(at, singular, 'x', label='det J = 0')


def measures() -> Figure:
    """Draw figure 4.4: determinant and singular-value ratio, R_b = 0.75, R_d = 0.70."""
    alpha, beta, stack = _paper_jacobians(carpal(0.7))
    figure = Figure(figsize=(9.0, 4.5), layout='constrained')
    left, right = figure.subplots(1, 2, subplot_kw={'projection': 'polar'})
    beta, stack = beta[beta < EDGE_OF_VIEW], stack[:, beta < EDGE_OF_VIEW]
    size, ratio = determinant(stack), singular_ratio(stack)
    _map(left, alpha, beta, size, 'size: determinant', (0.0, robust_top(size)))
    _bar(figure, left, 'det J / l')
    _map(right, alpha, beta, ratio, 'evenness: singular values', (1.0, robust_top(ratio)))
    _bar(figure, right, 'σ max / σ min')
    _explain(figure, 'Figure 4.4: Carpal wrist, $R_b$ = 0.75, $R_d$ = 0.70', TILTS)
    return figure


def plunges() -> Figure:
    """Draw figure 4.5: the determinant for several R_d."""
    figure = Figure(figsize=(11.0, 7.6), layout='constrained')
    panels = figure.subplots(2, 3, subplot_kw={'projection': 'polar'})
    for axes, ratio in zip(panels.flat, (0.3, 0.45, 0.6, 0.7, 0.8, 0.9), strict=True):
        alpha, beta, stack = _paper_jacobians(carpal(ratio))
        _map(axes, alpha, beta, determinant(stack), f'$R_d$ = {ratio:g}', (0.0, 0.12))
    _bar(figure, panels, 'det J / l')
    _explain(figure, 'Figure 4.5: determinant of the Carpal wrist, $R_b$ = 0.75', TILTS)
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
            _map(axes, alpha, beta, least, f'{pointer.name}, {reading}', (0.0, 1.25))
    _bar(figure, panels, 'least principal dexterity, hand rate / joint rate')
    _explain(figure, 'Figures 4.8 to 4.10: least principal dexterity of the pointers', TILTS)
    return figure


def workspace(name: str, wrist: Wrist, headings: int = 90, turns: int = 60) -> Figure:
    """Draw the two measures over turns from home about axes between two that are followed."""
    free = wrist.followed_axes
    planes = [plane for plane in ((0, 1), (1, 2), (2, 0)) if set(plane) <= set(free)]
    figure = Figure(figsize=(2.0 + 3.1 * len(planes), 8.0), layout='constrained')
    upper, lower = figure.subplots(
        2, len(planes), subplot_kw={'projection': 'polar'}, squeeze=False
    )
    heading = np.linspace(0.0, math.tau, headings, endpoint=False)
    angle = np.linspace(0.0, math.pi, turns)
    stacks = [disc(wrist, plane, heading.tolist(), angle.tolist()) for plane in planes]
    top = robust_top(np.array([determinant(stack) for stack in stacks]))
    for above, below, plane, stack in zip(upper, lower, planes, stacks, strict=True):
        about = f'about {AXES[plane[0]]} (0°) and {AXES[plane[1]]} (90°)'
        _map(above, heading, angle, determinant(stack), f'determinant\n{about}', (0.0, top))
        ratio = 1.0 / singular_ratio(stack)
        _map(below, heading, angle, ratio, f'σ min / σ max\n{about}', (0.0, 1.0))
    _bar(figure, upper, f'determinant{_unit(wrist)}')
    _bar(figure, lower, EVENNESS)
    rates = ', '.join(RATES[axis] for axis in free)
    _explain(figure, f'{name}: {rates} over joint rates', TURNS)
    return figure


def _unit(wrist: Wrist) -> str:
    """Return the unit of a determinant of hand rates over joint rates, none where it is 1."""
    legs = all(joint.kind == 'prismatic' for joint in wrist.joints)
    return f', m$^{{-{len(wrist.followed_axes)}}}$' if legs else ''


def overview(wrists: dict[str, Wrist], headings: int = 72, turns: int = 45) -> Figure:
    """Draw σ min / σ max of every wrist over turns about the hand's axes x and y."""
    columns = 5
    rows = -(-len(wrists) // columns)
    figure = Figure(figsize=(2.4 * columns, 1.0 + 2.15 * rows), layout='constrained')
    panels = figure.subplots(rows, columns, subplot_kw={'projection': 'polar'}, squeeze=False)
    heading = np.linspace(0.0, math.tau, headings, endpoint=False)
    angle = np.linspace(0.0, math.pi, turns)
    for axes in panels.flat[len(wrists) :]:
        axes.set_visible(False)
    for axes, (name, wrist) in zip(panels.flat, wrists.items(), strict=False):
        stack = disc(wrist, (0, 1), heading.tolist(), angle.tolist())
        _map(axes, heading, angle, 1.0 / singular_ratio(stack), name, (0.0, 1.0))
    _bar(figure, panels, EVENNESS)
    _explain(figure, 'How evenly each wrist turns the hand, by where the hand is', TURNS_X_Y)
    return figure


def robust_top(values: np.ndarray) -> float:
    """Return where the scale of a map ends, so that a few large values do not darken the rest."""
    return float(min(np.nanmax(values), MEDIANS * np.nanmedian(values)))


def _map(
    axes: PolarAxes,
    around: np.ndarray,
    outward: np.ndarray,
    values: np.ndarray,
    title: str,
    scale: tuple[float, float],
) -> None:
    """Draw values over an angle around and an angle outward, rad; NaN stays blank."""
    closed = np.append(around, around[0] + math.tau)
    shown = np.append(values, values[:1], axis=0)
    axes.pcolormesh(
        closed,
        np.degrees(outward),
        shown.T,
        cmap=COLOURS,
        shading='nearest',
        vmin=scale[0],
        vmax=scale[1],
    )
    edge = math.degrees(outward[-1])
    axes.set_ylim(0.0, edge)
    axes.set_title(title, fontsize='medium')
    apart = 30 if edge < 120.0 else 60
    rings = range(apart, round(edge) + 1, apart)
    # A light edge, so that they are read on dark colours too.
    light = [withStroke(linewidth=2.0, foreground='white')]
    axes.set_yticks(rings, [f'{ring}°' for ring in rings], path_effects=light)
    # Steep, so that they do not run into each other on small maps.
    axes.set_rlabel_position(67.5)
    axes.set_xticks(np.radians(range(0, 360, 90)))
    axes.tick_params(labelsize='small', pad=1.0)
    axes.grid(alpha=0.3)


def _bar(figure: Figure, panels: Any, label: str) -> None:
    """Draw what the colours of panels of one scale stand for, and what lies beyond the scale."""
    meshes = [mesh for axes in np.ravel(panels) for mesh in axes.collections]
    largest = max(float(np.ma.masked_invalid(mesh.get_array()).max()) for mesh in meshes)
    top = meshes[0].get_clim()[1]
    beyond = largest > top
    figure.colorbar(
        meshes[0],
        ax=panels,
        shrink=0.8,
        extend='max' if beyond else 'neither',
        label=f'{label}\norange: {_short(top)} to {_short(largest)}' if beyond else label,
    )


def _short(value: float) -> str:
    return np.format_float_positional(value, precision=3, fractional=False, trim='-')


def _explain(figure: Figure, title: str, directions: str) -> None:
    """Say above the maps what they show, and below them what their angles are."""
    figure.suptitle(title)
    figure.supxlabel(directions, fontsize='medium')
