"""How well the hand follows: what the study says is what the mechanism does."""

import io
import math

import pytest

pytest.importorskip('mujoco', reason='`make setup-physics` gets it')

from rich.console import Console

from wrist_control import make_wrist
from wrist_control.operating.maneuvers import BARKER_SPEED
from wrist_control.studies.following import CASES, Case, Errors, flown, follow, table


@pytest.fixture(scope='module')
def flight():
    return flown(make_wrist('three_gimbal'), 4.0)


def test_the_flight_is_of_the_stick_within_the_limits_of_a_resolver(flight):
    assert flight.time[-1] == pytest.approx(4.0, abs=0.2)
    assert 0.5 * BARKER_SPEED < abs(flight.joint_rates).max() < 1.001 * BARKER_SPEED


def test_a_stiff_servo_without_load_or_delay_is_where_it_is_told(flight):
    assert follow(flight, Case(bandwidth=1000.0, payload=0.0)).turn < 1e-4


def test_a_delay_costs_at_most_what_the_hand_turns_in_it_and_nearly_that(flight):
    soon, late = (follow(flight, Case(bandwidth=300.0, delay=delay)) for delay in (0.0, 0.03))
    assert 0.5 * 0.03 * BARKER_SPEED < late.turn - soon.turn < 1.05 * 0.03 * BARKER_SPEED


@pytest.mark.parametrize(
    ('better', 'worse'),
    [
        (Case(bandwidth=300.0), Case()),
        (Case(), Case(bandwidth=30.0)),
        (Case(), Case(payload=5.0)),
        (Case(by_rates=True), Case()),
    ],
)
def test_what_makes_it_better_does(flight, better, worse):
    assert follow(flight, better).turn < follow(flight, worse).turn


def test_a_wrist_whose_hand_stays_in_place_has_no_error_there(flight):
    assert follow(flight, Case()).place == 0.0


def test_the_tables_have_room_in_80_columns_and_say_what_diverged():
    errors = dict.fromkeys(CASES, Errors(0.1234, 0.0))
    found = {'roll_pitch_roll': errors, 'stewart': {**errors, 'rates': None}}
    moved = {**found, 'carpal': dict.fromkeys(CASES, Errors(math.pi / 4.0, 0.05))}
    for what in ('turn', 'place'):
        written = io.StringIO()
        Console(file=written, width=80).print(table(moved, what))
        text = written.getvalue()
        assert '…' not in text
        assert 'carpal' in text
        assert ('—' in text) == ('stewart' in text) == (what == 'turn')
