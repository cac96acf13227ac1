"""Wrists of other packages: names that are found, and entry points that lead nowhere."""

from importlib import metadata

import pytest

from wrist_control import WRISTS, InvalidValueError, make_wrist
from wrist_control.wrists import plugins, wrist_names
from wrist_control.wrists.carpal import Carpal
from wrist_control.wrists.registry import DESCRIBED


def point(name, value):
    return metadata.EntryPoint(name, value, plugins.GROUP)


@pytest.fixture
def installed(monkeypatch):
    """Let some entry points be there, beside those of real packages."""

    def install(*points):
        monkeypatch.setattr(plugins.metadata, 'entry_points', lambda group: points)

    return install


def test_what_is_plugged_in_stands_behind_the_wrists_that_are_here(installed):
    installed(point('mine', 'wrist_control.wrists.carpal:Carpal'))
    assert wrist_names() == (*WRISTS, *DESCRIBED, 'mine')
    assert make_wrist('mine', plunge=0.05) == Carpal(plunge=0.05)


def test_a_name_that_is_taken_stays_with_its_wrist(installed):
    taken = [point(name, 'wrist_control.wrists.carpal:Carpal') for name in ('stewart', 'urdf')]
    installed(*taken)
    assert wrist_names() == (*WRISTS, *DESCRIBED)
    assert type(make_wrist('stewart')).__name__ == 'Stewart'


@pytest.mark.parametrize(
    ('value', 'sentence'),
    [
        ('no_such_module:Wrist', r'cannot be imported \(ModuleNotFoundError: .*; mend that'),
        ('wrist_control.wrists.carpal:NoSuchClass', r'cannot be imported \(AttributeError: '),
        ('wrist_control.wrists.carpal:AZIMUTHS', 'is no wrist; its entry point .mine. must name'),
        ('wrist_control.wrists.joint:Joint', 'is no wrist; '),
    ],
)
def test_an_entry_point_that_leads_to_no_wrist_is_named(installed, value, sentence):
    installed(point('mine', value))
    with pytest.raises(InvalidValueError, match=sentence):
        make_wrist('mine')
