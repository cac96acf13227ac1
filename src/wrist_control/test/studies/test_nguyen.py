"""The study of [Nguyen1991] runs and says what docs/results/stewart.md says."""

import pytest

from wrist_control.studies import nguyen as stewart_study


def test_the_six_figures_are_drawn(tmp_path):
    drawn = stewart_study.figures(tmp_path)
    assert [path.name for path in drawn] == [f'figure_{number:02d}.png' for number in range(6, 12)]
    assert all(path.stat().st_size > 10_000 for path in drawn)


def test_a_free_attitude_is_fitted_level_at_17_inches():
    height, angles = stewart_study.fitted_attitude()
    assert height == pytest.approx(17.0, abs=0.005)
    assert angles == pytest.approx((0.0, 0.0, 0.0), abs=1e-3)


def test_table_1_has_a_row_for_each_of_its_twelve_errors():
    assert stewart_study.table_1().row_count == 12
