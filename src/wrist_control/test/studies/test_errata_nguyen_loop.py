"""[Nguyen1991], section 4: the anchors it starts from, and when its loop stops. docs/errata.md."""

import numpy as np
import pytest

from wrist_control.studies.nguyen_cases import (
    BASE,
    CASES,
    HEIGHT,
    PLATFORM,
    TOLERANCE,
    pose_errors,
    squares,
    stored,
    summary,
    times,
)

METRES = 0.0254


def test_equations_1_and_2_give_angles_to_x_of_the_six_anchors():
    for anchors, theta in ((PLATFORM, 99.20), (BASE, 16.0)):
        angles = {}
        for i in (1, 3, 5):
            angles[i] = 60.0 * i - 0.5 * theta
            angles[i + 1] = angles[i] + theta
        found = np.degrees(np.arctan2(anchors[:, 1], anchors[:, 0])) % 360.0
        assert found == pytest.approx([angles[i] % 360.0 for i in range(1, 7)])


def printed_loop(case):
    """Return pose errors and mean steps, µin. and µrad: section 4 with |δa|, as it is printed."""
    xy, _ = case.path(times(case))
    truth = stored(np.insert(np.pad(xy, ((0, 0), (0, 3))), 2, HEIGHT, axis=1))
    a, errors, steps = truth[0], np.zeros_like(truth), 0
    for row, wanted in enumerate(truth):
        lengths = stored(np.sqrt(squares(wanted)[0]))
        while True:
            found, derivative = squares(a)
            if np.abs(found - lengths**2).sum() < TOLERANCE:
                break
            steps += 1
            change = np.linalg.solve(derivative, lengths**2 - found)
            if np.abs(change).sum() < TOLERANCE:
                break
            a = stored(a + change)
        errors[row] = 1e6 * (a - wanted)
    return errors, steps / len(truth)


@pytest.mark.parametrize(
    ('case', 'steps', 'z_missed'), [(CASES[0], 1.980, 963.2), (CASES[1], 1.975, 896.5)]
)
def test_steps_6_and_7_as_printed_drop_a_correction_that_table_1_has(case, steps, z_missed):
    """At the tolerance that takes the paper's 2 steps: errors 500 times those of Table 1."""
    errors, taken = printed_loop(case)
    assert taken == pytest.approx(steps, abs=1e-3)
    assert np.abs(errors[:, 2]).max() == pytest.approx(z_missed, abs=0.1)
    assert np.abs(errors[:, 2]).max() > 400.0 * abs(case.max_error[2])
    corrected, taken = pose_errors(case)
    assert taken == pytest.approx(steps, abs=1e-3)
    assert np.abs(corrected[:, 2]).max() < 2.01 * abs(case.max_error[2])


def test_the_circles_rms_error_of_z_is_the_printed_one_by_a_single_sample():
    """Two last places once are √4 of one: Table 1 has the same RMS, and half the maximum."""
    line, circle = (pose_errors(case)[0] for case in CASES)
    _, rms = summary(circle)
    assert rms[2] == pytest.approx(CASES[1].rms_error[2], abs=0.5e-4)
    assert list(circle[circle[:, 2] != 0.0, 2]) == pytest.approx([2e6 * 2.0**-19])
    assert not line[:, 2].any()


def test_steps_5_and_6_stop_elsewhere_in_another_unit_of_length():
    """A step of 0.001 in. and 10 µrad, and its residuals, summed in inches and in metres."""
    change = np.array([0.0, 0.0, 1e-3, 0.0, 0.0, 1e-5])
    truth = np.array([0.0, 0.0, HEIGHT, 0.0, 0.0, 0.0])
    residuals = squares(truth + change)[0] - squares(truth)[0]
    in_metres = change * [METRES, METRES, METRES, 1.0, 1.0, 1.0]
    assert np.abs(change).sum() > TOLERANCE > 20.0 * np.abs(in_metres).sum()
    assert np.abs(residuals).sum() > 100.0 * TOLERANCE
    assert np.abs(residuals).sum() * METRES**2 < TOLERANCE


@pytest.mark.parametrize('x', [-3.5, 0.0, 5.0])
@pytest.mark.parametrize('alpha', [0.0, 0.3])
def test_a_level_guess_at_z_0_is_singular_though_it_is_not_zero(x, alpha):
    """The legs lie in one plane: no length tells of what leaves it."""
    guess, h = np.array([x, -2.0, 0.0, alpha, 0.0, 0.0]), 1e-6
    for column in (2, 4, 5):
        e = h * np.eye(6)[column]
        slope = (squares(guess + e)[0] - squares(guess - e)[0]) / (2.0 * h)
        assert slope == pytest.approx(np.zeros(6), abs=1e-8)
    assert np.linalg.matrix_rank(squares(guess)[1], tol=1e-9) == 3
    above = guess + np.array([0.0, 0.0, HEIGHT, 0.0, 0.0, 0.0])
    assert np.linalg.matrix_rank(squares(above)[1], tol=1e-9) == 6
