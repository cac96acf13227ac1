"""The comparison of all wrists: what it measures, and what it shows."""

import dataclasses
import math
from io import StringIO

import numpy as np
import pytest
from matplotlib.text import Text
from rich.console import Console

from wrist_control import WRISTS, fly, make_wrist
from wrist_control.operating.maneuvers import BARKER_SPEED, Maneuver, Segment, make_maneuver, turn
from wrist_control.studies.compare import HEADINGS, draw, main, markdown, notes, rows, table
from wrist_control.studies.comparison import (
    JOINT_SPEEDS,
    MANEUVERS,
    Performance,
    about_approach,
    approach_axis,
    compare,
    first_stop,
    path_error,
)

LIMIT = JOINT_SPEEDS['revolute']
SHORT = Maneuver('short', (turn(1, 0.2, BARKER_SPEED), turn(2, 0.1, BARKER_SPEED)))


@pytest.mark.parametrize('name', WRISTS)
def test_every_wrist_can_be_compared(name):
    (performance,) = compare([name], [SHORT])
    assert performance.completed
    assert 0.0 < performance.peak_rate <= 1.0 + 1e-9
    assert performance.free_peak_rate >= performance.peak_rate * (1.0 - 1e-9)
    assert performance.path_error < 1e-6
    assert performance.stopped_by == ''


def test_the_comparison_is_the_same_each_time():
    pairs = []

    def listed(flights):
        pairs.extend(flights)
        return flights

    performances = compare(
        ['three_gimbal', 'carpal'], [SHORT, make_maneuver('basic_test')], listed
    )
    assert [(o.wrist, o.maneuver) for o in performances] == [(w, m.name) for w, m in pairs]
    assert len(performances) == 4
    again = compare(['three_gimbal', 'carpal'], [SHORT])
    assert rows(again) == rows(performances[:2])


def test_the_approach_axis_leads_away_from_the_wrist():
    axes = {name: approach_axis(make_wrist(name)) for name in WRISTS}
    assert axes['three_gimbal'] == axes['roll_pitch_roll'] == axes['double_hooke'] == 0
    assert axes['carpal'] == axes['five_bar'] == axes['stewart'] == 2


def test_a_maneuver_is_turned_with_the_approach_axis_and_stays_right_handed():
    maneuver = Maneuver('m', (Segment((1.0, 2.0, 3.0), 0.5),), waits=False)
    turned = about_approach(maneuver, 2)
    assert turned.segments == (Segment((2.0, 3.0, 1.0), 0.5),)
    assert (turned.name, turned.waits) == ('m', False)
    assert about_approach(maneuver, 0) == maneuver
    axes = np.array(
        [
            about_approach(Maneuver('', (Segment(tuple(e), 1.0),)), 2).segments[0].rates
            for e in np.eye(3)
        ]
    )
    assert np.linalg.det(axes) == pytest.approx(1.0)


def test_time_lost_is_no_path_error():
    slow = fly('four_gimbal', 'basic_test', joint_rate_limits=math.radians(20.0))
    assert slow.time_lost[-1] > 1.0
    assert path_error(slow) < 1e-9


def test_path_error_sees_a_hand_that_leaves_its_path_and_returns():
    flight = fly('double_hooke', SHORT)
    aside = flight.hand_rotation.copy()
    s, c = math.sin(0.03), math.cos(0.03)
    aside[5] = np.array([[1.0, 0.0, 0.0], [0.0, c, s], [0.0, -s, c]]) @ aside[5]
    assert path_error(flight) < 1e-9
    assert path_error(dataclasses.replace(flight, hand_rotation=aside)) == pytest.approx(0.03)


def test_path_error_of_a_pointer_does_not_ask_for_its_roll():
    roll = Maneuver('roll', (turn(0, 0.3, 0.5), Segment((0.1, 0.2, 0.5), 1.0)))
    flight = fly('pitch_yaw', roll, 100.0)
    assert path_error(flight) < 1e-4
    aside = flight.hand_rotation.copy()
    s, c = math.sin(0.03), math.cos(0.03)
    about_x = np.array([[1.0, 0.0, 0.0], [0.0, c, s], [0.0, -s, c]])
    aside[5] = about_x @ aside[5]
    wrong = path_error(dataclasses.replace(flight, hand_rotation=aside))
    assert wrong == pytest.approx(0.03, rel=1e-3)


def test_the_first_limit_of_the_mechanism_itself_is_named_with_its_time():
    cone = fly('single_hooke', 'basic_test', joint_rate_limits=LIMIT, patience=0.5)
    assert first_stop(cone) == ('cone', pytest.approx(45.0 / 32.0, abs=1.0 / 32.0))
    lock = fly('three_gimbal', 'basic_test', joint_rate_limits=LIMIT)
    assert first_stop(lock) == ('lock', pytest.approx(90.0 / 32.0, abs=1.0 / 32.0))
    name, when = first_stop(fly('double_hooke', 'basic_test', joint_rate_limits=LIMIT))
    assert name == ''
    assert math.isnan(when)


def test_lock_costs_the_three_gimbal_wrist_what_the_paper_says_and_the_double_hooke_nothing():
    three, four, double = compare(
        ['three_gimbal', 'four_gimbal', 'double_hooke'], [make_maneuver('basic_test')]
    )
    assert three.time_lost == pytest.approx(2.8, abs=0.05)
    assert four.free_peak_rate == pytest.approx(1.787, abs=1e-3)
    assert double.time_lost == 0.0
    assert double.free_peak_rate == pytest.approx(1.0)


def test_table_and_markdown_show_every_outcome():
    performances = compare(['three_gimbal', 'carpal'], [SHORT])
    assert table(performances).row_count == 3
    lines = markdown(performances).splitlines()
    assert lines[0] == '| ' + ' | '.join(HEADINGS) + ' |'
    assert '| short | carpal * |' in lines[3]


def test_an_unfinished_maneuver_shows_what_stopped_it(tmp_path):
    main(tmp_path, ['single_hooke', 'double_hooke'], [make_maneuver('basic_test')])
    assert (tmp_path / 'compare.png').read_bytes().startswith(b'\x89PNG')
    single, double = (tmp_path / 'compare.md').read_text(encoding='utf-8').splitlines()[2:4]
    assert '| stopped |' in single
    assert single.endswith('| cone | 1.4 |')
    assert '| 0.00 |' in double


GOOD = Performance('a', 'basic_test', True, 0.0, 1.0, 1.0, 0.0, 1.0, '', math.nan, True)
WORSE = GOOD._replace(wrist='b', time_lost=1.24, free_peak_rate=7.0, margin=0.3, path_error=0.001)
STUCK = GOOD._replace(wrist='c', follows_roll=False, stopped_by='cone', stopped_at=1.44)
LOST = {'time_lost': 30.0, 'free_peak_rate': 200.0, 'margin': 0.0, 'path_error': 1.0}
CELLS = [GOOD, WORSE, STUCK._replace(completed=False, **LOST)]


@pytest.mark.parametrize('limit', ['the legs near lock', 'closure of leg 2', ''])
def test_a_terminal_of_80_columns_has_room_for_every_heading_and_cell(limit):
    wide = GOOD._replace(stopped_by=limit, stopped_at=59.99, free_peak_rate=90.0)
    every = [
        wide._replace(wrist=wrist, maneuver=maneuver.name, follows_roll=False, completed=done)
        for maneuver in MANEUVERS
        for wrist in WRISTS
        for done in (True, False)
    ]
    console = Console(width=80, file=StringIO())
    console.print(table(every))
    lines = console.file.getvalue().splitlines()
    assert '…' not in console.file.getvalue()
    headings = [word for heading in HEADINGS[1:] for word in heading.split()]
    rule = next(at for at, line in enumerate(lines) if line.startswith('─'))
    assert sorted(word for line in lines[1:rule] for word in line.split()) == sorted(headings)
    shown = [line.split() for line in lines[rule + 1 :]]
    for row in rows(every):
        assert ' '.join(row[1:]).split() in shown
    for maneuver in MANEUVERS:
        assert [maneuver.name] in shown


@pytest.fixture(scope='module')
def picture():
    other = [one._replace(maneuver='stick') for one in CELLS]
    return draw([*CELLS, *other])


@pytest.fixture(scope='module')
def panels(picture):
    return picture.axes[:3]


def test_the_picture_has_a_row_for_each_wrist_and_a_column_for_each_maneuver(panels):
    assert [axes.get_title() for axes in panels] == [
        'time lost (s), or what stopped the hand',
        'peak joint rate without a limit, divided by the limit',
        'closest margin, 0 at lock: compare within a row',
    ]
    for axes in panels[::2]:
        assert [text.get_text() for text in axes.get_yticklabels()] == ['a', 'b', 'c *']
    for axes in panels:
        assert [text.get_text() for text in axes.get_xticklabels()] == ['basic\ntest', 'stick']


def test_the_picture_says_what_its_marks_are_and_who_left_the_path(picture):
    (said,) = (text.get_text() for text in picture.axes[3].texts)
    marks, errors = said.split('\n\n')
    assert '†  stopped before the end' in marks
    assert '*  points only' in marks
    assert errors.splitlines() == [
        'Path error: less than 0.001° everywhere, but',
        '    b: up to 0.057°',
        '    c: up to 57.296°',
    ]
    assert notes([GOOD]).endswith('\nPath error: less than 0.001° everywhere.')
    drawn = [text.get_text() for text in picture.findobj(Text)]
    assert not [text for text in drawn if '×' in text]


@pytest.mark.parametrize(
    ('panel', 'written'),
    [
        (0, ['0.00', '1.24', 'cone at 1.4 s']),
        (1, ['1.0', '7.0', '200.0 †']),
        (2, ['1.00', '0.30', '0.00 †']),
    ],
)
def test_every_cell_says_its_number_and_is_darker_the_worse_it_is(panels, panel, written):
    texts = {text.get_position(): text.get_text() for text in panels[panel].texts}
    rows_of_two = {(x, y): said for y, said in enumerate(written) for x in (0, 1)}
    assert texts == rows_of_two
    (image,) = panels[panel].get_images()
    shades = np.asarray(image.get_array())
    assert shades.shape == (3, 2)
    assert (shades[:, 0] == shades[:, 1]).all()
    assert shades[0, 0] == 0.0
    assert 0.1 < shades[1, 0] < 0.95
    assert shades[2, 0] == 1.0
    colours = {text.get_position()[1]: text.get_color() for text in panels[panel].texts}
    assert (colours[0], colours[2]) == ('black', 'white')
