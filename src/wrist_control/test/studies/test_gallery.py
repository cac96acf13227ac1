"""The gallery: what it shows is the flight, and what it writes are pictures that move."""

import math

import numpy as np
import pytest
from PIL import Image

from wrist_control import WRISTS, make_wrist
from wrist_control.rotations import rates_between
from wrist_control.studies import gallery
from wrist_control.studies.gallery import (
    EVERY,
    LAST,
    STEPS,
    draw_moment,
    draw_moments,
    moments,
    show,
)


@pytest.mark.parametrize('name', WRISTS)
def test_every_wrist_is_shown_where_it_flies(name):
    shown = show(name)
    flight, wrist = shown.flight, make_wrist(name)
    assert len(shown.scenes) == len(flight.time)
    names = [seen.name for seen in wrist.bodies(wrist.home)]
    for index in range(0, len(flight.time), 10):
        scene = shown.scenes[index]
        assert [seen.name for seen in scene] == names
        hand = scene[-1].pose
        np.testing.assert_allclose(hand.rotation, flight.hand_rotation[index], atol=1e-9)
        np.testing.assert_allclose(hand.point(wrist.probe), flight.tip[index], atol=1e-9)
    found = moments(flight)
    home, half, worst = found.values()
    assert home == 0 < half < worst
    lowest = flight.margin.min()
    assert lowest == flight.margin[worst if 'at its worst' in found else home]

    def bend(index):
        away = rates_between(
            shown.scenes[0][-1].pose.quaternion, shown.scenes[index][-1].pose.quaternion, 1.0
        )
        return math.hypot(*away)

    assert bend(half) == pytest.approx(0.5 * bend(worst), abs=0.02)


def test_a_moment_says_what_the_flight_does():
    shown = show('three_gimbal')
    flight = shown.flight
    slowed = int(flight.scale_factor.argmin())
    figure = draw_moment('three_gimbal', shown, slowed)
    said = ' '.join(text.get_text() for text in figure.texts)
    assert 'three_gimbal' in said
    assert f'{flight.time[slowed]:4.1f} s' in said
    assert f'margin {flight.margin[slowed]:.2f}' in said
    assert 'slowed by psi' in said


def test_a_hand_that_cannot_go_on_says_so_and_why():
    shown = show('single_hooke')
    figure = draw_moment('single_hooke', shown, len(shown.scenes) - 1)
    said = ' '.join(text.get_text() for text in figure.texts)
    assert 'cannot go on: cone' in said
    assert 'speed   0 %' in said


def test_three_moments_stand_side_by_side_in_one_scale():
    shown = show('carpal')
    figure = draw_moments('carpal', shown)
    assert [axes.get_title().split(',')[0] for axes in figure.axes] == [
        'home',
        'half bent',
        'at its worst',
    ]
    assert len({(*axes.get_xlim(), *axes.get_ylim()) for axes in figure.axes}) == 1


def test_pictures_are_written_and_move_in_real_time(tmp_path, capsys):
    gallery.main([str(tmp_path), 'pitch_yaw'])
    said = capsys.readouterr().out
    assert 'pitch_yaw.png' in said
    assert 'pitch_yaw.webp' in said
    flight = show('pitch_yaw').flight
    with Image.open(tmp_path / 'pitch_yaw.webp') as moving:
        assert moving.n_frames == math.ceil((len(flight.time) - 1) / EVERY) + 1
        durations = []
        for frame in range(moving.n_frames):
            moving.seek(frame)
            moving.load()
            durations.append(moving.info['duration'])
    assert durations[:-1] == [round(1000.0 * EVERY / STEPS)] * (len(durations) - 1)
    assert durations[-1] == round(1000.0 * LAST)
    with Image.open(tmp_path / 'pitch_yaw.png') as still:
        assert still.width > 2.9 * still.height
        assert len(set(still.convert('RGB').getdata())) > 50
