"""The curves in the pictures of flights are the flights'."""

import math

import numpy as np
import pytest

from wrist_control import fly
from wrist_control.operating.maneuvers import Maneuver, Segment
from wrist_control.studies.flight_figures import draw_flight, draw_tip

SPEED = math.radians(32.0)
DEGREES = 180.0 / math.pi


@pytest.fixture(scope='module')
def scaled():
    return fly('three_gimbal', 'basic_test', joint_rate_limits=SPEED)


def tip_inches(flight):
    """Return where the end of the 6-in. probe is, from what is known of the hand alone."""
    return flight.hand_position / 0.0254 + 6.0 * flight.hand_rotation[:, 0]


def assert_shows(axes, curves, expected, title, unit):
    """Check names, numbers, title and unit of one panel; `expected` has a column for each."""
    found = curves(axes)
    names = list(found)
    for (time, values), column in zip(found.values(), expected.T, strict=True):
        np.testing.assert_allclose(time, np.arange(len(column)) / 32.0, atol=1e-12)
        np.testing.assert_allclose(values, column, atol=1e-9)
    assert [text.get_text() for text in axes.get_legend().get_texts()] == names
    assert axes.get_title(loc='left') == title
    assert axes.get_ylabel() == unit
    looks = {(line.get_color(), line.get_linestyle()) for line in axes.get_lines()}
    assert len(looks) == len(names)
    return names


def test_the_tip_is_drawn_in_inches_over_time(scaled, curves):
    figure = draw_tip(scaled, 'Where the tip is')
    (axes,) = figure.axes
    names = assert_shows(axes, curves, tip_inches(scaled), 'Where the tip is', 'in.')
    assert names == ['x tip', 'y tip', 'z tip']
    assert axes.get_xlabel() == 'time, s'


def test_the_four_panels_are_those_of_figure_7(scaled, curves):
    figure = draw_flight(scaled, 'A flight')
    assert figure.get_suptitle() == 'A flight'
    inputs, tip, rates, angles = figure.axes
    effective = DEGREES * scaled.command * scaled.scale_factor[:, None]
    names = assert_shows(inputs, curves, effective, '(a) Effective operator inputs', 'deg/s')
    assert names == ['p', 'q', 'r']
    assert_shows(tip, curves, tip_inches(scaled), '(b) Probe tip in forearm axes', 'in.')
    increments = np.vstack([np.diff(scaled.joint_positions, axis=0) * 32.0, np.zeros(3)])
    names = assert_shows(rates, curves, DEGREES * increments, '(c) Joint rates', 'deg/s')
    assert names == ['ψ rate', 'θ rate', 'φ rate']
    positions = DEGREES * scaled.joint_positions
    assert assert_shows(angles, curves, positions, '(d) Joint angles', 'deg') == ['ψ', 'θ', 'φ']
    assert [axes.get_xlabel() for axes in figure.axes] == ['', '', 'time, s', 'time, s']


def test_what_holds_from_row_to_row_is_drawn_in_steps_and_positions_are_not(scaled):
    styles = [
        {line.get_drawstyle() for line in axes.get_lines()}
        for axes in draw_flight(scaled, '').axes
    ]
    assert styles == [{'steps-post'}, {'default'}, {'steps-post'}, {'default'}]


def test_a_rate_that_would_hide_all_others_is_cut_off_and_written_down(scaled):
    rates = draw_flight(fly('three_gimbal', 'basic_test'), '').axes[2]
    (note,) = rates.texts
    assert note.get_text() == 'off the scale: 2880 deg/s'
    assert note.xy[0] == 90 / 32.0
    assert rates.get_ylim() == pytest.approx((-80.0, 80.0))
    assert not draw_flight(scaled, '').axes[2].texts


def test_legs_are_drawn_in_metres(curves):
    pitch = Maneuver('pitch', (Segment((0.0, 0.2, 0.0), 0.5),))
    flight = fly('stewart', pitch)
    _, tip, rates, positions = draw_flight(flight, '').axes
    increments = np.vstack([np.diff(flight.joint_positions, axis=0) * 32.0, np.zeros(6)])
    assert_shows(tip, curves, tip_inches(flight), '(b) Probe tip in forearm axes', 'in.')
    assert_shows(rates, curves, increments, '(c) Joint rates', 'm/s')
    names = assert_shows(positions, curves, flight.joint_positions, '(d) Joint positions', 'm')
    assert names == [f'leg_{leg}' for leg in range(1, 7)]
