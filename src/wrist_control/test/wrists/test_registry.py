"""The list of wrists: setup.py reads it where nothing is installed, people choose from it."""

import runpy

import pytest

from wrist_control import InvalidValueError, make_wrist
from wrist_control.wrists import registry, wrist_class


def test_the_file_can_be_run_alone():
    assert runpy.run_path(registry.__file__)['WRISTS'] == registry.WRISTS


@pytest.mark.parametrize('name', [*registry.WRISTS, *registry.DESCRIBED])
def test_every_name_is_the_module_of_a_wrist_whose_class_is_called_alike(name):
    kind = wrist_class(name)
    assert kind.__module__ == f'wrist_control.wrists.{name}'
    assert kind.__name__ == name.title().replace('_', '')
    assert name in registry.DESCRIBED or type(make_wrist(name)) is kind


def test_a_name_that_is_not_there_is_refused_with_all_that_are():
    with pytest.raises(InvalidValueError, match=r"no wrist 'elbow'; the wrists are three_gimbal,"):
        make_wrist('elbow')
