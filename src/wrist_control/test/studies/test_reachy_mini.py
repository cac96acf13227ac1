"""The comparison with a Reachy Mini's maker: our half of it, and without the maker's packages."""

import sys

import numpy as np
import pytest

from wrist_control import InvalidValueError
from wrist_control.rotations import Pose, turned
from wrist_control.studies import reachy_mini
from wrist_control.studies.reachy_mini import LOWER, UPPER, asleep, judged, path, places, table
from wrist_control.wrists.rotary_stewart import RotaryStewart

WRIST = RotaryStewart()
CHOSEN = places(WRIST, 20)


def test_places_are_within_the_makers_limits_and_the_same_in_every_run():
    for _, angles in CHOSEN:
        assert np.all(angles >= LOWER)
        assert np.all(angles <= UPPER)
    assert places(WRIST, 5) == CHOSEN[:5]
    assert np.ptp([angles for _, angles in CHOSEN], axis=0).min() > 0.5


def test_a_transform_is_that_of_the_maker_from_the_foot():
    """At home the maker's head is 0.177 m above it, and not turned."""
    expected = np.eye(4)
    expected[2, 3] = 0.177
    np.testing.assert_allclose(reachy_mini.transform(WRIST.home_pose), expected, atol=1e-12)
    tilted = Pose(turned(WRIST.home_pose.quaternion, (0.0, 0.3, 0.0), 1.0))
    assert reachy_mini.transform(tilted)[0, 2] == pytest.approx(np.sin(0.3))


def test_the_head_sleeps_nodding():
    nod = reachy_mini.transform(asleep())
    np.testing.assert_allclose(nod[:3, :3], np.array(reachy_mini.SLEEP), atol=2e-3)
    np.testing.assert_allclose(nod[:3, :3] @ nod[:3, :3].T, np.eye(3), atol=1e-12)
    assert nod[2, 3] == pytest.approx(0.133)


@pytest.mark.parametrize('seed', [WRIST.home_pose, asleep()], ids=['home', 'sleep'])
def test_all_of_our_answers_are_right(seed):
    row = judged('ours', 'x', CHOSEN, lambda angles: reachy_mini._ours(WRIST, seed, angles))
    assert row.right == 1.0
    assert row.worst < 1e-12


def test_wrong_answers_and_none_are_counted():
    answers = iter([None, np.eye(4), *[reachy_mini.transform(pose) for pose, _ in CHOSEN[2:]]])
    row = judged('half', 'home', CHOSEN, lambda _: next(answers))
    assert row.right == pytest.approx(0.9)
    assert '| half | home | 90.0 % | 0 µm |' in table([row])


def test_a_path_is_followed_from_reading_to_reading():
    followed = reachy_mini._Followed(WRIST)
    assert judged('ours', 'before', path(WRIST, 50), followed).right == 1.0


def test_without_the_makers_packages_a_sentence_says_how_to_get_them(monkeypatch, capsys):
    monkeypatch.setattr(sys, 'argv', ['reachy_mini'])
    monkeypatch.setattr(sys, 'path', [*sys.path])
    monkeypatch.setitem(sys.modules, 'reachy_mini_rust_kinematics', None)
    if reachy_mini.find_spec('reachy_mini') is None:
        with pytest.raises(InvalidValueError, match='make reachy'):
            reachy_mini.Maker()
    assert reachy_mini.main() == 2
    assert 'make reachy' in capsys.readouterr().err
