"""The maps of dexterity show what the wrists do at the places that they stand for."""

import math

import numpy as np
import pytest
from scipy.spatial.transform import Rotation

from wrist_control import make_wrist
from wrist_control.studies.canfield_closure import fold
from wrist_control.studies.canfield_pointing import pitch_yaw
from wrist_control.studies.dexterity_figures import (
    edges,
    measures,
    overview,
    plunges,
    pointing,
    workspace,
)
from wrist_control.wrists.carpal import Carpal

HEADINGS, TURNS = 8, 7
PLACES = [
    (row, column, math.tau * column / HEADINGS, math.pi * row / (TURNS - 1))
    for row in range(TURNS)
    for column in range(HEADINGS)
]


def maps_of(figure):
    """Return the values of each map of a figure, by title: a row for each ring."""
    return {
        axes.get_title(): axes.collections[0].get_array().filled(np.nan)
        for axes in figure.axes
        if axes.name == 'polar' and axes.get_visible()
    }


@pytest.fixture(scope='module')
def three_gimbal():
    return workspace('three_gimbal', make_wrist('three_gimbal'), HEADINGS, TURNS)


def test_the_determinant_of_the_three_gimbal_wrist_is_the_cosine_of_its_middle_angle(three_gimbal):
    assert three_gimbal.get_suptitle() == 'three_gimbal: p, q, r over joint rates'
    values = maps_of(three_gimbal)['determinant\nabout x (0°) and y (90°)']
    assert values.shape == (TURNS, HEADINGS + 1)
    np.testing.assert_array_equal(values[:, 0], values[:, -1])  # all the way round
    for row, column, heading, angle in PLACES:
        turned = Rotation.from_rotvec([angle * math.cos(heading), angle * math.sin(heading), 0.0])
        sine = turned.as_matrix()[2, 0]
        assert values[row, column] == pytest.approx(math.sqrt(1.0 - sine**2), abs=1e-7)


def bars_of(figure):
    """Return what each colour bar of a figure says that it stands for."""
    return [axes.get_ylabel() for axes in figure.axes if axes.name != 'polar']


def test_every_map_has_degrees_outward_and_one_scale_is_beside_each_row(three_gimbal):
    polar = [axes for axes in three_gimbal.axes if axes.name == 'polar']
    assert len(polar) == 6
    for row in (polar[:3], polar[3:]):
        assert len({axes.collections[0].get_clim() for axes in row}) == 1
    evenness = 'σ min / σ max: slowest over fastest direction'
    assert bars_of(three_gimbal) == ['determinant', evenness]
    assert three_gimbal.get_supxlabel().endswith('outward: angle of the turn, in degrees')
    for axes in polar:
        assert axes.get_ylim() == (0.0, pytest.approx(180.0))
        rings = [text.get_text() for text in axes.get_yticklabels()]
        assert rings == ['60°', '120°', '180°']


def test_outside_the_workspace_a_map_is_blank_and_inside_it_is_not():
    wrist = Carpal()
    values = maps_of(workspace('carpal', wrist, HEADINGS, TURNS))[
        'σ min / σ max\nabout x (0°) and y (90°)'
    ]
    home = wrist.forward(wrist.home)
    for row, column, heading, angle in PLACES:
        reach = fold(wrist, heading - 0.5 * math.pi)  # turned about the axis 90° before
        if angle < reach - 0.1:
            axis = (angle * math.cos(heading), angle * math.sin(heading), 0.0)
            there = wrist.inverse(wrist.target_pose(home, axis, 1.0), wrist.home)
            largest, least = np.linalg.svd(wrist.jacobian(there)[:2])[1]
            assert values[row, column] == pytest.approx(least / largest, abs=1e-9)
        elif angle > reach:
            assert math.isnan(values[row, column])


def test_the_overview_has_a_map_for_every_wrist_and_one_scale_for_all():
    names = ['pitch_yaw', 'three_gimbal', 'stewart']
    figure = overview({name: make_wrist(name) for name in names}, HEADINGS, TURNS)
    shown = maps_of(figure)
    assert list(shown) == names
    assert bars_of(figure) == ['σ min / σ max: slowest over fastest direction']
    assert figure.get_suptitle() == 'How evenly each wrist turns the hand, by where the hand is'
    assert figure.get_supxlabel().endswith('outward: angle of the turn, in degrees')
    assert {axes.collections[0].get_clim() for axes in figure.axes[:3]} == {(0.0, 1.0)}
    for row, column, heading, angle in PLACES:
        turned = Rotation.from_rotvec([angle * math.cos(heading), angle * math.sin(heading), 0.0])
        if abs(turned.as_matrix()[2, 0]) < 0.9:
            # σ of ψ, θ, φ with sin θ = s: 1 and √(1 ± |s|).
            sine = abs(turned.as_matrix()[2, 0])
            expected = math.sqrt((1.0 - sine) / (1.0 + sine))
            assert shown['three_gimbal'][row, column] == pytest.approx(expected, abs=1e-7)


def determinants_of(figure):
    """Return every determinant of a figure, each place once."""
    named = maps_of(figure).items()
    return np.array([shown[:, :-1] for title, shown in named if 'determinant' in title])


def test_a_few_large_values_do_not_darken_a_map_and_are_said_to_be_beyond_its_scale():
    figure = workspace('stewart', make_wrist('stewart'), HEADINGS, TURNS)
    values = determinants_of(figure)
    mesh = figure.axes[0].collections[0]
    top = mesh.get_clim()[1]
    assert top == pytest.approx(3.0 * np.nanmedian(values))
    largest = np.nanmax(values)
    assert largest > 5.0 * top
    assert bars_of(figure)[0] == f'determinant, m$^{{-3}}$\norange: {top:.3g} to {largest:.0f}'
    assert mesh.colorbar.extend == 'max'
    over = mesh.cmap(2.0)
    assert over not in [mesh.cmap(share) for share in np.linspace(0.0, 1.0, 100)]


def test_a_scale_that_holds_every_value_says_nothing_of_what_is_beyond_it(three_gimbal):
    mesh = three_gimbal.axes[0].collections[0]
    assert mesh.get_clim() == (0.0, np.nanmax(determinants_of(three_gimbal)))
    assert mesh.colorbar.extend == 'neither'


def test_figures_4_4_and_4_5_say_what_lies_beyond_their_scales():
    size, ratio = measures().axes[2:]
    assert (size.get_ylabel(), ratio.get_ylabel()) == (
        'det J / l',
        'σ max / σ min\norange: 4.04 to 14.2',
    )
    figure = plunges()
    assert bars_of(figure) == ['det J / l\norange: 0.12 to 1.05']
    assert max(np.nanmax(values) for values in maps_of(figure).values()) == pytest.approx(
        1.05, abs=0.005
    )
    assert {axes.collections[0].get_clim() for axes in figure.axes[:6]} == {(0.0, 0.12)}
    assert figure.axes[0].collections[0].colorbar.extend == 'max'


def test_figure_4_3_has_closure_and_singularity_on_the_closed_form(curves, uncovered):
    figure = edges()
    uncovered(figure)
    over_plunge, around = figure.axes
    for axes in (over_plunge, around):
        shown = curves(axes)
        assert list(shown) == ['closed form', 'closure lost', 'det J = 0']
        (x, closed), lost, singular = shown.values()
        np.testing.assert_array_equal(lost[0], singular[0])
        np.testing.assert_allclose(lost[1], np.interp(lost[0], x, closed), atol=1e-5)
        np.testing.assert_allclose(singular[1], lost[1], atol=1e-5)
    ratios, reach = curves(over_plunge)['closed form']
    for ratio, degrees in list(zip(ratios, reach, strict=True))[::10]:
        wrist = Carpal(0.075, 0.1, 0.1 * ratio)
        assert degrees == pytest.approx(math.degrees(fold(wrist, -0.5 * math.pi)))
    assert over_plunge.get_xlabel() == '$R_d$'
    assert over_plunge.get_ylabel() == 'β at the edge, °'
    assert around.get_xlabel() == 'α, °'
    (legend,) = figure.legends
    box = legend.get_window_extent()
    assert not any(box.overlaps(axes.get_tightbbox()) for axes in figure.axes)
    named = [text.get_text() for text in legend.get_texts()]
    assert named == ['closed form', 'closure lost', 'det J = 0']


def test_the_least_dexterity_of_the_pitch_yaw_pointer_is_the_cosine_of_theta_1():
    figure = pointing([pitch_yaw()], ['coordinate-free'])
    ((title, values),) = maps_of(figure).items()
    assert title == 'pitch-yaw, coordinate-free'
    mesh = figure.axes[0].collections[0]
    corners = mesh.get_coordinates()
    centres = 0.25 * (
        corners[1:, 1:] + corners[:-1, 1:] + corners[1:, :-1] + corners[:-1, :-1]
    )  # azimuth in rad, tilt in degrees
    y = np.sin(np.radians(centres[..., 1])) * np.sin(centres[..., 0])
    np.testing.assert_allclose(values, np.sqrt(1.0 - y * y), atol=2e-3)
