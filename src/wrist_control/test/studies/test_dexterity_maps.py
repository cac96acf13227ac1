"""The study: closure against singularity, Table 4.3 in three readings, and the pictures."""

import math
from functools import cache

import numpy as np
import pytest

from wrist_control import UnreachableError
from wrist_control.dexterity import principal
from wrist_control.studies.canfield_closure import closure_edge, fold, sample, singular_edge
from wrist_control.studies.canfield_pointing import (
    READINGS,
    carpal,
    five_bar,
    hemisphere,
    pitch_yaw,
    pointing_jacobians,
    pointing_measure,
    transform,
)
from wrist_control.studies.dexterity_maps import POINTERS, WORKSPACES, table_4_2, table_4_3
from wrist_control.wrists.carpal import Carpal

NEAREST, HEMISPHERIC, SERIAL, PARALLEL = POINTERS
SOLID, STEPS = WORKSPACES


@cache
def measured(pointer, reading, place=SOLID):
    return pointing_measure(
        pointer, reading, place.largest, place.by_solid_angle, azimuths=24, tilts=60
    )


@pytest.mark.parametrize('ratio', [0.7, 0.8, 0.9])
@pytest.mark.parametrize('azimuth', [0.0, 1.0, -0.5 * math.pi])
def test_closure_and_singularity_end_at_the_same_tilt(ratio, azimuth):
    wrist = Carpal(0.075, 0.1, 0.1 * ratio)
    assert closure_edge(wrist, azimuth) == pytest.approx(fold(wrist, azimuth), abs=1e-7)
    assert singular_edge(wrist, azimuth) == pytest.approx(fold(wrist, azimuth), abs=1e-7)


def test_beyond_closure_there_is_no_sample():
    with pytest.raises(UnreachableError, match='closure of leg'):
        sample(Carpal(), 1.0, math.radians(75.0))


def test_transform_is_the_finite_difference_of_the_direction():
    alpha, beta, h = 0.7, 0.9, 1e-6

    def flat(a, b):
        return np.array([math.sin(b) * math.cos(a), math.sin(b) * math.sin(a)])

    slopes = [
        (flat(alpha + h, beta) - flat(alpha - h, beta)) / (2 * h),
        (flat(alpha, beta + h) - flat(alpha, beta - h)) / (2 * h),
    ]
    T = transform(np.array(alpha), np.array(beta))
    np.testing.assert_allclose(T @ np.array(slopes).T, np.eye(2), atol=1e-8)


@pytest.mark.parametrize('pointer', [carpal(0.75, 0.5), pitch_yaw(), five_bar()])
def test_pointers_are_aimed_where_they_are_told(pointer):
    beta = np.linspace(0.2, 1.4, 7)
    for alpha in (0.3, 2.0, 4.0):
        for tilt, place in zip(beta, pointer.aim(alpha, beta.tolist()), strict=True):
            np.testing.assert_allclose(
                pointer.wrist.forward(place).rotation[2],
                [
                    math.sin(tilt) * math.cos(alpha),
                    math.sin(tilt) * math.sin(alpha),
                    math.cos(tilt),
                ],
                atol=1e-9,
            )


def test_corrected_reading_is_twice_the_printed_tilt_rate_of_the_carpal_wrist():
    pointer = carpal(0.75, 0.5)
    alpha, beta = hemisphere(1.2, 5, 4)
    printed = pointing_jacobians(pointer, alpha, beta, 'printed')
    corrected = pointing_jacobians(pointer, alpha, beta, 'corrected')
    np.testing.assert_allclose(corrected, printed * [[1.0], [2.0]], atol=1e-9)


def test_pitch_yaw_is_the_same_printed_and_corrected():
    alpha, beta = hemisphere(1.2, 5, 4)
    readings = [pointing_jacobians(pitch_yaw(), alpha, beta, r) for r in READINGS[:2]]
    np.testing.assert_allclose(*readings, atol=1e-9)


def test_coordinate_free_dexterity_does_not_depend_on_the_pole():
    """The pitch-yaw pointer has |cos θ1| everywhere, whatever α and β are measured from."""
    alpha, beta = hemisphere(1.2, 7, 5)
    least = principal(pointing_jacobians(pitch_yaw(), alpha, beta, 'coordinate-free'))[..., -1]
    y = np.sin(beta) * np.sin(alpha)[:, None]
    np.testing.assert_allclose(least, np.sqrt(1.0 - y * y), atol=1e-12)


@pytest.mark.parametrize(
    ('pointer', 'least', 'largest', 'deviation'),
    [(NEAREST, 0.45, 0.61, 0.0375), (SERIAL, 0.1, 1.0, 0.2047), (PARALLEL, 0.7, 1.2, 0.1249)],
)
def test_table_4_3_is_met_within_a_few_units_of_its_last_digits(
    pointer, least, largest, deviation
):
    found = measured(pointer, 'printed')
    assert found.least == pytest.approx(least, abs=0.015)
    assert found.largest == pytest.approx(largest, abs=0.025)
    assert found.deviation == pytest.approx(deviation, abs=0.003)


@pytest.mark.parametrize('place', WORKSPACES)
@pytest.mark.parametrize('reading', READINGS[1:])
@pytest.mark.parametrize('pointer', [NEAREST, HEMISPHERIC])
def test_carpal_wrist_stays_first_and_the_five_bar_loses_its_place(place, reading, pointer):
    first, second, third = (
        measured(p, reading, place).relative for p in (pointer, SERIAL, PARALLEL)
    )
    assert first < second < third


def test_without_the_five_bars_correction_the_carpal_wrist_is_not_ahead():
    """The two mistakes hide each other: T alone makes it a tie that the five-bar wins."""
    relative = measured(NEAREST, 'corrected').relative
    assert 0.9 < measured(PARALLEL, 'printed').relative / relative < 1.0


def test_tables_show_every_row():
    measures = {
        (SOLID.name, pointer.name, reading): measured(SERIAL, 'printed')
        for pointer in POINTERS
        for reading in READINGS
    }
    assert table_4_2().row_count == 8
    assert table_4_3(SOLID, measures).row_count == 15
