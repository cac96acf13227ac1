"""The figures of the four-gimbal wrist: the numbers behind them, and that they are drawn."""

import math

import numpy as np
import pytest

from wrist_control.studies import barker_four_gimbal as gimbal_figures
from wrist_control.studies.barker_four_gimbal import SPEEDS, main, peak_rate, peak_rates


def test_figure_11_has_a_row_for_each_speed_and_a_column_for_each_gain():
    peaks = peak_rates((0.8, 2.0))
    assert peaks.shape == (2, 2)
    assert peaks[1, 0] == peak_rate(0.8, SPEEDS[1])
    np.testing.assert_allclose(np.degrees(peaks), [[57.17, 68.06], [31.84, 44.07]], atol=0.01)


def test_the_gain_of_the_paper_is_where_the_upper_curve_is_lowest():
    gains = np.arange(0.6, 1.21, 0.1)
    peaks = peak_rates(tuple(gains), (math.radians(32.0),))[0]
    assert gains[np.argmin(peaks)] == pytest.approx(0.8)


def test_all_three_figures_are_drawn(tmp_path, monkeypatch):
    monkeypatch.setattr(gimbal_figures, 'GAINS', (0.6, 1.0))
    monkeypatch.setattr(gimbal_figures, 'peak_rates', lambda tracked: peak_rates((0.6, 1.0)))
    main(tmp_path)
    sizes = [(tmp_path / f'barker-figure-{n}.png').stat().st_size for n in (9, 10, 11)]
    assert all(10_000 < size < 150_000 for size in sizes)
