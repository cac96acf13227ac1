"""The curves in the pictures of flights are the flights'."""

import math

import numpy as np
import pytest
from matplotlib.text import Text

from wrist_control import fly
from wrist_control.operating.maneuvers import Maneuver, Segment
from wrist_control.studies.flight_figures import draw_flight, draw_tip

SPEED = math.radians(32.0)
DEGREES = 180.0 / math.pi


@pytest.fixture(scope='module')
def scaled():
    return fly('three_gimbal', 'basic_test', joint_rate_limits=SPEED)


def tip_mm(flight):
    """Return where the end of the 6-in. probe is, from what is known of the hand alone."""
    return flight.hand_position * 1000.0 + 152.4 * flight.hand_rotation[:, 0]


def assert_shows(axes, curves, expected, title, unit):
    """Check names, numbers, title and unit of one panel; `expected` has a column for each."""
    found = curves(axes)
    names = list(found)
    flown = [curve for name, curve in found.items() if not name.startswith('limit')]
    for (time, values), column in zip(flown, expected.T, strict=True):
        np.testing.assert_allclose(time, np.arange(len(column)) / 32.0, atol=1e-12)
        np.testing.assert_allclose(values, column, atol=1e-9)
    assert [text.get_text() for text in axes.get_legend().get_texts()] == names
    assert axes.get_title(loc='left') == title
    assert axes.get_ylabel() == unit
    looks = {(line.get_color(), line.get_linestyle()) for line in axes.get_lines()}
    assert len(looks) == len(names)
    return names


def test_the_tip_is_drawn_in_mm_over_time_with_the_papers_inches_beside_it(scaled, curves):
    figure = draw_tip(scaled, 'Where the tip is')
    (axes,) = figure.axes
    names = assert_shows(axes, curves, tip_mm(scaled), 'Where the tip is', 'mm')
    assert names == ['x tip', 'y tip', 'z tip']
    assert axes.get_xlabel() == 'time, s'
    figure.draw_without_rendering()
    (beside,) = axes.child_axes
    assert beside.get_ylabel() == 'in.'
    np.testing.assert_allclose(np.multiply(beside.get_ylim(), 25.4), axes.get_ylim())


def test_the_four_panels_are_those_of_figure_7(scaled, curves):
    figure = draw_flight(scaled, 'A flight')
    assert figure.get_suptitle() == 'A flight'
    inputs, tip, rates, angles = figure.axes
    effective = DEGREES * scaled.command * scaled.scale_factor[:, None]
    names = assert_shows(inputs, curves, effective, '(a) Effective operator inputs', 'deg/s')
    assert names == ['p', 'q', 'r']
    assert_shows(tip, curves, tip_mm(scaled), '(b) Probe tip in forearm axes', 'mm')
    increments = np.vstack([np.diff(scaled.joint_positions, axis=0) * 32.0, np.zeros(3)])
    names = assert_shows(rates, curves, DEGREES * increments, '(c) Joint rates', 'deg/s')
    assert names == ['ψ rate', 'θ rate', 'φ rate (lies on ψ)', 'limit ±32 deg/s']
    positions = DEGREES * scaled.joint_positions
    names = assert_shows(angles, curves, positions, '(d) Joint angles', 'deg')
    assert names == ['ψ', 'θ', 'φ (lies on ψ)']
    assert [axes.get_xlabel() for axes in figure.axes] == ['', '', 'time, s', 'time, s']


def test_what_holds_from_row_to_row_is_drawn_in_steps_and_positions_are_not(scaled):
    styles = [
        {line.get_drawstyle() for line in axes.get_lines() if len(line.get_xdata()) > 2}
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
    assert_shows(tip, curves, tip_mm(flight), '(b) Probe tip in forearm axes', 'mm')
    assert_shows(rates, curves, increments, '(c) Joint rates', 'm/s')
    names = assert_shows(positions, curves, flight.joint_positions, '(d) Joint positions', 'm')
    assert names == [
        *('leg_1', 'leg_2', 'leg_3'),
        *('leg_4 (lies on leg_3)', 'leg_5 (lies on leg_2)', 'leg_6 (lies on leg_1)'),
    ]


def test_curves_that_part_anywhere_are_not_said_to_coincide(curves):
    _, tip, rates, angles = draw_flight(fly('four_gimbal', 'basic_test', gain=0.8), '').axes
    named = [name for axes in (tip, rates, angles) for name in curves(axes)]
    assert len(named) == 3 + 4 + 4
    assert not [name for name in named if 'lies on' in name]


def levels(axes):
    """Return the heights of the lines that are the same all the way, and of no curve."""
    return sorted(line.get_ydata()[0] for line in axes.get_lines() if len(line.get_xdata()) == 2)


def test_the_rate_limit_is_drawn_at_both_signs_where_there_is_one(scaled):
    assert levels(draw_flight(scaled, '').axes[2]) == pytest.approx([-32.0, 32.0])
    assert levels(draw_flight(fly('three_gimbal', 'basic_test'), '').axes[2]) == []
    pitch = Maneuver('pitch', (Segment((0.0, 0.2, 0.0), 0.5),))
    legs = fly('stewart', pitch, joint_rate_limits=[0.04, 0.04, 0.05, 0.05, math.inf, math.inf])
    rates = draw_flight(legs, '').axes[2]
    assert levels(rates) == pytest.approx([-0.05, -0.04, 0.04, 0.05])
    names = [text.get_text() for text in rates.get_legend().get_texts()]
    assert names[-2:] == ['limit ±0.04 m/s', 'limit ±0.05 m/s']


@pytest.mark.parametrize('wrist', ['three_gimbal', 'four_gimbal', 'stewart'])
def test_no_legend_lies_on_a_curve_a_title_or_another_panel(wrist, scaled, uncovered):
    pitch = Maneuver('pitch', (Segment((0.0, 0.2, 0.0), 0.5),))
    for flight in (fly(wrist, pitch, joint_rate_limits=0.3), scaled):
        uncovered(draw_tip(flight, 'A flight'))
        figure = draw_flight(flight, 'A flight')
        uncovered(figure)
        for axes in figure.axes:
            box = axes.get_legend().get_window_extent().padded(-0.5)
            words = [
                word for word in axes.findobj(Text) if word.get_text() == axes.get_title('left')
            ]
            assert words
            others = [one.get_window_extent() for one in (*figure.axes, *words)]
            assert not any(box.overlaps(other) for other in others)
