"""The figures of the four-gimbal wrist: the numbers behind them, and that they are drawn."""

import math

import numpy as np
import pytest

from wrist_control import fly
from wrist_control.operating.maneuvers import extended_test
from wrist_control.studies.barker_four_gimbal import SPEEDS, draw, main, peak_rate, peak_rates


def test_figure_11_has_a_row_for_each_speed_and_a_column_for_each_gain():
    peaks = peak_rates((0.8, 2.0))
    assert peaks.shape == (2, 2)
    assert peaks[1, 0] == peak_rate(0.8, SPEEDS[1])
    np.testing.assert_allclose(np.degrees(peaks), [[57.17, 68.06], [31.84, 44.07]], atol=0.01)


def test_the_gain_of_the_paper_is_where_the_upper_curve_is_lowest():
    gains = np.arange(0.6, 1.21, 0.1)
    peaks = peak_rates(tuple(gains), (math.radians(32.0),))[0]
    assert gains[np.argmin(peaks)] == pytest.approx(0.8)


@pytest.fixture(scope='module')
def figures():
    basic, extended = (fly('four_gimbal', name) for name in ('basic_test', 'extended_test'))
    gains = (0.6, 0.8, 1.0)
    return (basic, extended), draw(basic, extended, gains, peak_rates(gains))


@pytest.mark.parametrize(('number', 'maneuver'), [(9, 'basic'), (10, 'extended')])
def test_figures_9_and_10_show_the_four_gimbals_of_their_flight(figures, curves, number, maneuver):
    flights, drawn = figures
    flight = flights[number - 9]
    title = f'Figure {number}: four-gimbal wrist, {maneuver} test maneuver, K = 0.8'
    assert drawn[number].get_suptitle() == title
    shown = curves(drawn[number].axes[3])
    assert list(shown) == ['ψ', 'θ', 'φ', 'α']
    for (time, angle), column in zip(shown.values(), flight.joint_positions.T, strict=True):
        np.testing.assert_allclose(time, flight.time)
        np.testing.assert_allclose(np.radians(angle), column, atol=1e-12)


def test_figure_11_shows_the_peak_rate_of_each_gain_and_where_the_paper_is(
    figures, curves, uncovered
):
    uncovered(figures[1][11])
    (axes,) = figures[1][11].axes
    shown = curves(axes)
    assert list(shown) == ['hand 32 deg/s', 'hand 16 deg/s']
    for (gains, peaks), speed in zip(shown.values(), (32.0, 16.0), strict=True):
        assert list(gains) == [0.6, 0.8, 1.0]
        for gain, peak in zip(gains, peaks, strict=True):
            flight = fly('four_gimbal', extended_test(math.radians(speed)), gain=gain)
            increments = np.abs(np.diff(flight.joint_positions, axis=0))
            assert peak == pytest.approx(np.degrees(32.0 * increments).max())
    unnamed = [line.get_xydata() for line in axes.get_lines() if line.get_label()[0] == '_']
    marks = [tuple(points[0]) for points in unnamed if len(points) == 1]
    assert marks == [(0.8, pytest.approx(shown[hand][1][1])) for hand in shown]
    upright = [
        points[0, 0] for points in unnamed if len(points) == 2 and np.ptp(points[:, 0]) == 0
    ]
    assert np.degrees(upright) == pytest.approx([32.0, 16.0])
    assert axes.get_xlabel() == 'gain K (rad/s)'
    assert axes.get_ylabel() == 'peak gimbal angle rate (deg/s)'
    assert axes.get_ylim()[0] == 0.0


def test_all_three_figures_are_written(tmp_path):
    main(tmp_path, (0.6, 1.0))
    names = [f'barker-figure-{number}.png' for number in (10, 11, 9)]
    assert sorted(path.name for path in tmp_path.iterdir()) == names
