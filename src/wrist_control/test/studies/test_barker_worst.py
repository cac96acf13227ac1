"""Barker's "worst-type" condition is not the worst: the curves drawn, flown one by one."""

import math

import numpy as np
import pytest

from wrist_control import fly
from wrist_control.operating.maneuvers import BARKER_SPEED, Maneuver, Segment, turn
from wrist_control.studies import barker_worst
from wrist_control.studies.barker_figure_5 import peak_rates
from wrist_control.studies.barker_worst import (
    ANY,
    AXES,
    draw,
    main,
    peaks,
    pitches,
    plane,
    same_from,
    spread,
    table,
    worst,
)


def flown(degrees, direction):
    """Give the peak of one maneuver by the package's own wrist and step, in hand rates."""
    up = [turn(1, math.radians(degrees), BARKER_SPEED)] if degrees else []
    p, q, r = (BARKER_SPEED * float(x) for x in direction)
    order = Maneuver('one', (*up, Segment((p, q, r), math.tau / BARKER_SPEED)))
    flight = fly('four_gimbal', order)
    return np.abs(np.diff(flight.joint_positions, axis=0)).max() * 32.0 / BARKER_SPEED


@pytest.fixture(scope='module')
def drawn():
    pitch = pitches(15.0)
    found, around = barker_worst.curves(pitch, 40), plane(pitch, 9)
    return pitch, found, around, draw(pitch, found, around)


@pytest.mark.parametrize(
    ('degrees', 'axis', 'peak'), [(46.0, '+r', 74.91), (35.0, '−r', 103.22), (90.0, '+r', 57.17)]
)
def test_the_extended_test_maneuver_is_not_the_worst_one(degrees, axis, peak):
    assert 32.0 * flown(degrees, AXES[axis]) == pytest.approx(peak, abs=0.01)
    found = peaks(np.radians([degrees]), np.array([AXES[axis]]))
    assert 32.0 * found[0, 0] == pytest.approx(peak, abs=0.01)


@pytest.mark.parametrize(
    ('degrees', 'axis', 'ratio'),
    [(37.0, '+r', 3.41), (41.0, '−r', 3.81), (21.0, '+p', 2.94), (33.0, '−p', 3.02)],
)
def test_the_worst_pitches_of_the_table_need_what_it_says(degrees, axis, ratio):
    assert flown(degrees, AXES[axis]) == pytest.approx(ratio, abs=0.005)


def test_the_worst_axis_of_the_table_needs_almost_five_times_the_hands_rate():
    axis = np.array([-0.300798327628355, -0.2984107908249105, -0.9057987447635575])
    assert 32.0 * flown(47.0, axis) == pytest.approx(155.9, abs=0.05)


def test_the_two_figures_do_not_hang_on_the_step():
    axes = np.array([AXES['+r'], AXES['−r']])
    found = np.degrees(peak_rates(np.radians([46.0, 35.0]), axes, step=1.0 / 320.0))
    assert found == pytest.approx([75.53, 103.25], abs=0.02)


@pytest.mark.parametrize('gain', [0.6, 0.8, 1.0, 1.5, 2.0, 3.0])
def test_no_gain_brings_every_peak_to_twice_the_hands_rate(gain):
    pitch = np.radians(np.arange(0.0, 90.1, 2.0))
    found = [
        peak_rates(pitch, np.tile(axis, (len(pitch), 1)), gain=gain).max()
        for axis in AXES.values()
    ]
    assert max(found) > 2.8 * BARKER_SPEED


def test_the_curves_drawn_are_what_the_flights_need(drawn, curves, uncovered):
    _, found, _, figure = drawn
    uncovered(figure)
    left = figure.axes[0]
    shown = curves(left)
    assert list(shown) == ['+r', '−r', '+p', '−p', ANY]
    for name, axis in AXES.items():
        degrees, peak = shown[name]
        assert list(degrees) == pytest.approx([0, 15, 30, 45, 60, 75, 90])
        assert peak == pytest.approx([flown(x, axis) for x in degrees], rel=1e-9)
    assert list(shown[ANY][1]) == list(found[ANY])
    marks = [line.get_xydata() for line in left.get_lines() if line.get_label()[0] == '_']
    assert [tuple(points[0]) for points in marks if len(points) == 1] == [
        (90.0, pytest.approx(57.17 / 32.0, abs=1e-3))
    ]
    assert [points[0, 1] for points in marks if len(points) == 2] == [2.0]
    assert left.get_xlabel() == 'pitch before the turn (deg)'
    assert left.get_ylabel() == 'peak gimbal rate / hand rate'


def test_where_all_turns_need_the_same_the_picture_says_so(drawn):
    pitch, found, _, figure = drawn
    assert same_from(pitch, found) == pytest.approx(75.0)
    said = [text.get_text() for text in figure.axes[0].texts]
    assert 'extended test maneuver\n+r, −r, +p, −p are one from 75° on' in said
    assert same_from(pitch, {**found, '+p': found['+p'] + 0.02}) is None
    assert same_from(pitch, dict.fromkeys(AXES, found['+r'])) == 0.0


def test_the_map_has_p_and_r_where_its_axis_says(drawn):
    _, found, around, figure = drawn
    (mesh,) = figure.axes[1].collections[:1]
    shown = np.asarray(mesh.get_array()).reshape(9, 7)
    labels = [text.get_text() for text in figure.axes[1].get_yticklabels()]
    assert labels == ['−p', '−r', '+p', '+r', '−p']
    for row, name in zip((0, 2, 4, 6, 8), labels, strict=True):
        assert shown[row] == pytest.approx(found[name], rel=1e-6)
    assert np.degrees(around.heading[[2, 6]]) == pytest.approx([-90.0, 90.0])


def test_the_worst_axis_found_needs_what_is_said_and_no_lattice_axis_more():
    axis, peak = worst(math.radians(30.0), 40)
    assert np.linalg.norm(axis) == pytest.approx(1.0)
    assert flown(30.0, axis) == pytest.approx(peak, rel=1e-9)
    assert peak >= peaks(np.radians([30.0]), spread(40)).max()


def test_the_lattice_is_of_unit_axes_that_share_the_sphere():
    axes = spread(500)
    assert np.linalg.norm(axes, axis=1) == pytest.approx(1.0)
    assert np.abs(axes.mean(axis=0)).max() < 1e-2
    assert np.linalg.eigvalsh(axes.T @ axes / 500) == pytest.approx(1.0 / 3.0, abs=1e-2)


def test_the_table_says_where_each_curve_is_highest_and_where_it_is_above_twice(drawn):
    pitch, found, *_ = drawn
    cells = [list(column.cells) for column in table(pitch, found).columns]
    row = [column[0] for column in cells]
    assert row[:2] == ['+r', '30']
    assert row[3:] == [f'{found["+r"][2]:.2f}', '30 to 45']
    assert float(row[2]) == pytest.approx(32.0 * flown(30.0, AXES['+r']), abs=0.06)


def test_the_picture_is_written(tmp_path, monkeypatch):
    monkeypatch.setattr(barker_worst, 'track', lambda angles, *_, **__: angles)
    main(tmp_path, 30.0, 12, 5)
    assert [path.name for path in tmp_path.iterdir()] == ['barker-worst-maneuver.png']
