"""[Nguyen1991]: what is printed, what is right, and the proof. docs/errata.md."""

import math

import numpy as np
import pytest

from wrist_control.studies.nguyen_angles import (
    PaperAngles,
    partial_derivatives,
    rotation_matrix,
)
from wrist_control.studies.nguyen_cases import (
    BASE,
    CASES,
    CIRCLE,
    HEIGHT,
    LINE,
    PLATFORM,
    circle,
    newton_raphson,
    pose_errors,
    printed_misfit,
    squares,
    straight_line,
    summary,
    velocity_errors,
)

TILTED = PaperAngles(0.5, -0.4, 0.3)
LEVEL = PaperAngles(0.0, 0.0, 0.0)
POSITION = (2.0, -3.0, 17.0)
COLUMN = {'alpha': 3, 'beta': 4, 'gamma': 5}


def lengths_squared(a):
    arms = PLATFORM @ rotation_matrix(PaperAngles(*a[3:])).T
    return ((a[:3] + arms - BASE) ** 2).sum(axis=1)


def difference(angles, column, h=1e-5):
    at, e = np.array([*POSITION, *angles]), h * np.eye(6)[column]
    return (lengths_squared(at + e) - lengths_squared(at - e)) / (2 * h)


def symbols(angles):
    """The paper's x̄, ȳ, z̄, u, v, w, R, p and the sines and cosines."""
    r = rotation_matrix(angles)
    return (*(np.array(POSITION) - BASE).T, *(PLATFORM @ r.T).T, r, PLATFORM.T)


def test_equation_16_is_right_at_tilted_poses():
    x, y, z = POSITION
    r = rotation_matrix(TILTED)
    (px, py, _), (bx, by, _) = PLATFORM.T, BASE.T
    printed = (
        x**2 + y**2 + z**2 + 10.441**2 + 13.838**2
        + 2 * (r[0, 0] * px + r[0, 1] * py) * (x - bx)
        + 2 * (r[1, 0] * px + r[1, 1] * py) * (y - by)
        + 2 * (r[2, 0] * px + r[2, 1] * py) * z
        - 2 * (x * bx + y * by)
    )  # fmt: skip
    assert lengths_squared(np.array([*POSITION, *TILTED])) == pytest.approx(printed)


def test_equations_20_to_22_are_right_at_tilted_poses():
    *_, u, v, w, r, (px, py, _) = symbols(TILTED)
    (sa, sb, sg), (ca, cb, _) = np.sin(TILTED), np.cos(TILTED)
    printed = {
        'alpha': (-v, u, 0 * w),
        'beta': (ca * w, sa * w, -(cb * px + sb * sg * py)),
        'gamma': (py * r[0, 2], py * r[1, 2], py * r[2, 2]),
    }
    for column, (name, columns) in enumerate(printed.items()):
        e = 1e-6 * np.eye(3)[column]
        ahead, behind = (
            PLATFORM @ rotation_matrix(PaperAngles(*(np.array(TILTED) + s * e))).T for s in (1, -1)
        )
        assert pytest.approx((ahead - behind) / 2e-6, abs=1e-8) == np.array(columns).T, name


def test_equation_27_lacks_a_product_and_a_minus_sign():
    xb, yb, _, u, v, *_ = symbols(TILTED)
    true = difference(TILTED, COLUMN['alpha'])
    assert 2 * (xb + v + yb * u) != pytest.approx(true, rel=0.1)
    assert 2 * (-xb * v + yb * u) == pytest.approx(true, abs=1e-6)


@pytest.mark.parametrize('angles', [TILTED, PaperAngles(0.0, 0.4, 0.3)], ids=['tilted', 'α = 0'])
def test_equation_28_has_a_wrong_sign_and_lambda_for_gamma(angles):
    xb, yb, zb, _, _, w, _, (px, py, _) = symbols(angles)
    (sa, sb, sg), (ca, cb, _) = np.sin(angles), np.cos(angles)
    true = difference(angles, COLUMN['beta'])
    arm = px * cb + py * sb * sg
    assert 2 * ((-xb * ca + yb * sa) * w - arm * zb) != pytest.approx(true, rel=0.05)
    assert 2 * ((xb * ca + yb * sa) * w - arm * zb) == pytest.approx(true, abs=1e-6)
    # With λ_i, the angle of the anchor, for γ it would be wrong as well.
    sine = np.sin(np.arctan2(py, px))
    with_lambda = 2 * ((xb * ca + yb * sa) * w - (px * cb + py * sb * sine) * zb)
    assert with_lambda != pytest.approx(true, rel=0.05)


def test_the_wrong_sign_of_equation_28_does_not_show_on_a_level_platform():
    xb, yb, zb, _, _, w, _, (px, _, _) = symbols(LEVEL)
    assert 2 * (-xb * w - px * zb) == pytest.approx(difference(LEVEL, COLUMN['beta']), abs=1e-6)
    assert yb.size == 6


def test_equation_29_is_right_at_tilted_poses():
    xb, yb, zb, *_, r, (_, py, _) = symbols(TILTED)
    printed = 2 * py * (xb * r[0, 2] + yb * r[1, 2] + zb * r[2, 2])
    assert printed == pytest.approx(difference(TILTED, COLUMN['gamma']), abs=1e-6)


def test_the_corrected_derivatives_are_all_six_right():
    found = partial_derivatives(PLATFORM, BASE, POSITION, TILTED)
    for column in range(6):
        assert found[:, column] == pytest.approx(difference(TILTED, column), abs=1e-6)


def test_equation_34_cannot_be_differentiated_into_36_but_35_can():
    """2 l l̇ is the derivative of l², which is (35); (34) is already a rate."""
    at, velocity, h = np.array([*POSITION, *TILTED]), np.arange(1.0, 7.0) / 10, 1e-6
    length = np.sqrt(lengths_squared(at))
    rate = (
        np.sqrt(lengths_squared(at + h * velocity)) - np.sqrt(lengths_squared(at - h * velocity))
    ) / (2 * h)
    right_of_36 = partial_derivatives(PLATFORM, BASE, POSITION, TILTED) @ velocity
    assert 2 * length * rate == pytest.approx(right_of_36, abs=1e-6)


def test_step_6_without_absolute_values_stops_at_once_at_a_wrong_answer():
    """From 1 in. above, the step is −1 in.: its plain sum is below any tolerance."""
    truth = np.array([0.0, 0.0, HEIGHT, 0.0, 0.0, 0.0])
    guess = truth + np.eye(6)[2]
    found, derivative = squares(guess)
    step = np.linalg.solve(derivative, lengths_squared(truth) - found)
    assert step.sum() < 1e-6  # the printed test: stop, and take the guess as the solution
    assert np.abs(step).sum() > 0.9
    answer, _ = newton_raphson(np.sqrt(lengths_squared(truth)), guess)
    assert answer == pytest.approx(truth, abs=1e-5)


def test_not_every_guess_in_the_workspace_leads_to_the_pose():
    """Section 4 expects it of any nonzero guess: these lengths have two poses above the base."""
    truth = np.array([3.26, 0.878, 20.0, 0.44, -0.16, -0.19])
    lengths = np.sqrt(lengths_squared(truth))
    rng = np.random.default_rng(0)
    other = 0
    for _ in range(60):
        guess = truth + rng.uniform(-1, 1, 6) * np.array([8, 8, 14, 1.2, 1.2, 1.2])
        answer, _ = newton_raphson(lengths, guess)
        fits = np.abs(np.sqrt(lengths_squared(answer)) - lengths).max() < 1e-4
        other += bool(fits and np.abs(answer - truth)[:3].max() > 1.0)
    assert other > 0


def test_equation_44_needs_a_whole_turn_for_the_angle_to_go_on():
    beta, t1, t2, t3 = 2 * math.pi / 9, 1.0, 9.0, 10.0
    end_of_2 = 0.5 * beta * t1**2 + beta * t1 * (t2 - t1)
    start_of_3 = -0.5 * beta * (t3 - t2) ** 2
    assert end_of_2 - start_of_3 == pytest.approx(2 * math.pi)
    # The positions are the same, so nothing that the paper measured is touched.
    xy, rates = circle(np.array([t2 - 1e-9, t2 + 1e-9]))
    assert xy[0] == pytest.approx(xy[1], abs=1e-6)
    assert rates[0] == pytest.approx(rates[1], abs=1e-6)


@pytest.mark.parametrize('path', [straight_line, circle])
def test_the_rates_of_the_paths_are_their_differences(path):
    t, h = np.array([0.3, 0.7, 2.2, 4.9, 9.4]), 1e-6
    ahead, behind = path(t + h)[0], path(t - h)[0]
    assert path(t)[1] == pytest.approx((ahead - behind) / (2 * h), abs=1e-6)


# Table 1


@pytest.mark.parametrize('case', CASES, ids=lambda case: case.name)
def test_table_1_length_velocities_are_reproduced_to_the_last_digit(case):
    most, rms = summary(velocity_errors(case))
    printed = np.array(case.max_error[6:])
    if case is CIRCLE:
        printed[5] = 0.0419
    assert most == pytest.approx(printed, abs=1.1e-4)  # one in the last digit
    assert rms == pytest.approx(np.abs(case.rms_error[6:]), abs=0.6e-4)


def test_no_other_height_or_difference_scheme_gives_table_1():
    misfit = {
        (scheme, height): np.abs(printed_misfit(height, scheme=scheme)).max()
        for scheme in ('backward', 'forward', 'central')
        for height in np.arange(10.0, 25.0, 0.25)
    }
    best = min(misfit, key=misfit.get)
    assert best == ('backward', 17.0)
    del misfit[best]
    assert min(misfit.values()) > 15 * np.abs(printed_misfit(17.0)).max()


@pytest.mark.parametrize('axis', range(3))
@pytest.mark.parametrize('angle', [-0.02, 0.02])
def test_a_platform_that_is_not_level_does_not_give_table_1(axis, angle):
    tilted = PaperAngles(*(angle * np.eye(3)[axis]))
    level = np.abs(printed_misfit(17.0)).max()
    assert np.abs(printed_misfit(17.0, tilted)).max() > 4 * level


def test_the_circles_l6_has_misplaced_digits():
    most, _ = summary(velocity_errors(CIRCLE))
    assert CIRCLE.max_error[11] == 0.4919
    assert most[5] == pytest.approx(0.0419, abs=0.5e-4)
    # The text says that the largest is −0.049, in the fifth: 0.4919 would be ten times that.
    assert np.abs(most).argmax() == 4


def test_rms_errors_cannot_be_negative_as_printed():
    _, rms = summary(velocity_errors(LINE))
    assert LINE.rms_error[8] == -0.0177
    assert LINE.rms_error[11] == -0.0166
    assert rms[[2, 5]] == pytest.approx([0.0177, 0.0166], abs=0.5e-4)


def test_the_text_misplaces_the_point_of_the_lines_rms_error_in_roll():
    """0.623 µrad in the text, 0.0623 in Table 1: an RMS error is not above the largest, 0.156."""
    assert LINE.rms_error[3] < LINE.max_error[3] < 0.623


def test_the_errors_in_z_are_two_and_four_roundings_of_single_precision():
    last_place = 2.0**-19  # in., of single precision from 16 to 32 in.: so 16 <= z0 < 32
    assert 1e6 * last_place == pytest.approx(1.907, abs=5e-4)
    for case, wrong, samples in ((LINE, 2, 101), (CIRCLE, 4, 201)):
        rms = 1e6 * last_place * math.sqrt(wrong / samples)
        assert case.rms_error[2] == pytest.approx(rms, abs=1e-4)


@pytest.mark.parametrize('case', CASES, ids=lambda case: case.name)
def test_storing_in_single_precision_explains_the_size_of_the_pose_errors(case):
    errors, steps = pose_errors(case)
    _, rms = summary(errors)
    assert steps == pytest.approx(2.0, abs=0.3)  # 'the average number of iterations is 2'
    assert rms[:2] == pytest.approx(case.rms_error[:2], rel=0.2)
    assert rms[3:] == pytest.approx(case.rms_error[3:6], rel=0.4)
