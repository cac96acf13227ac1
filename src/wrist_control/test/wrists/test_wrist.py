"""The contract: what a wrist must answer, and a configuration that knows its pose."""

import dataclasses

import numpy as np
import pytest

from wrist_control import make_wrist
from wrist_control.resolving import start
from wrist_control.rotations import IDENTITY, Pose
from wrist_control.wrists import Configuration, Wrist

LENGTHS = Configuration((0.4, 0.5, 0.6), Pose(IDENTITY, (0.0, 0.0, 0.3)))


def test_a_wrist_that_forgets_an_answer_is_refused_when_it_is_made():
    class Forgetful(Wrist):
        forward = inverse = rates = jacobian = lambda self, *_: None

    with pytest.raises(TypeError, match='margin'):
        Forgetful()


def test_a_wrist_without_joints_is_refused_when_it_is_made():
    class Jointless(Wrist):
        forward = inverse = rates = jacobian = margin = lambda self, *_: None

    with pytest.raises(TypeError, match='Jointless names no joints: give it default_joints'):
        Jointless()


def test_a_configuration_reads_as_a_sequence_of_its_positions():
    assert (len(LENGTHS), LENGTHS[1], LENGTHS[:2], 0.6 in LENGTHS) == (3, 0.5, (0.4, 0.5), True)
    np.testing.assert_array_equal(np.array(LENGTHS), [0.4, 0.5, 0.6])
    assert tuple(LENGTHS) == LENGTHS.positions


def test_a_configuration_cannot_be_changed_behind_its_pose():
    with pytest.raises(dataclasses.FrozenInstanceError):
        LENGTHS.positions = (1.0, 1.0, 1.0)


def test_a_start_keeps_the_pose_of_a_configuration():
    platform = make_wrist('stewart')
    low = platform.assembly_at(Pose(IDENTITY, (0.0, 0.0, 0.4)))
    assert start(platform, low).positions is low
