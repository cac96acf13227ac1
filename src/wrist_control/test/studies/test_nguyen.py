"""The study of [Nguyen1991] runs and says what docs/results/stewart.md says."""

import numpy as np
import pytest

from wrist_control.studies import nguyen
from wrist_control.studies.nguyen_cases import CASES, pose_errors, times, velocity_errors


def test_the_six_figures_show_the_errors_of_both_cases_over_time(curves, uncovered):
    figures = dict(nguyen.figures())
    assert list(figures) == [6, 7, 8, 9, 10, 11]
    for case, numbers in zip(CASES, ((6, 7, 8), (9, 10, 11)), strict=True):
        for number in numbers:
            uncovered(figures[number])
        panels = [figures[number].axes[0] for number in numbers]
        shown = [curve for axes in panels for curve in curves(axes).values()]
        errors = np.hstack([pose_errors(case)[0], velocity_errors(case)])
        for (t, y), column in zip(shown, errors.T, strict=True):
            np.testing.assert_allclose(t, times(case))
            np.testing.assert_allclose(y, column)
        assert [axes.get_ylabel() for axes in panels] == [
            'error of the position (µin.)',
            'error of the angles (µrad)',
            'error of the leg rates (in./s)',
        ]
        titles = [f'Fig. {number}. {case.name}' for number in numbers]
        assert [axes.get_title() for axes in panels] == titles
        assert {axes.get_xlabel() for axes in panels} == {'time (s)'}


def test_the_peaks_of_figures_8_and_11_are_those_of_table_1(curves):
    figures = dict(nguyen.figures())
    for number, case in zip((8, 11), CASES, strict=True):
        shown = curves(figures[number].axes[0])
        assert list(shown) == [f'$l_{leg}$' for leg in range(1, 7)]
        printed = np.abs(case.max_error[6:])
        printed[printed == 0.4919] = 0.0419  # docs/errata.md
        peaks = [np.abs(y).max() for _, y in shown.values()]
        np.testing.assert_allclose(peaks, printed, atol=2e-4)


def test_the_files_are_called_by_the_numbers_of_the_figures(tmp_path, monkeypatch):
    monkeypatch.setattr(nguyen, 'search', lambda progress: [])
    nguyen.main(['--out', str(tmp_path)])
    assert sorted(path.name for path in tmp_path.iterdir()) == [
        f'figure_{number:02d}.png' for number in range(6, 12)
    ]


def test_a_free_attitude_is_fitted_level_at_17_inches():
    height, angles = nguyen.fitted_attitude()
    assert height == pytest.approx(17.0, abs=0.005)
    assert angles == pytest.approx((0.0, 0.0, 0.0), abs=1e-3)


def test_table_1_has_a_row_for_each_of_its_twelve_errors():
    assert nguyen.table_1().row_count == 12
