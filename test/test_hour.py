"""The short form of `make hour`: 20 s of simulated stick motion for each wrist."""

import pytest

import hour
from wrist_control import WRISTS
from wrist_control.resolving import state


@pytest.mark.parametrize('name', WRISTS)
def test_nothing_drifts_and_nothing_grows(name):
    drift = hour.held_for(name, 20.0)
    assert drift.good, drift


def test_a_hand_that_does_a_little_more_than_it_says_is_seen(monkeypatch):
    twist_between = state.twist_between

    def less(*arguments):
        return tuple((1.0 - 1e-8) * x for x in twist_between(*arguments))

    monkeypatch.setattr(state, 'twist_between', less)
    assert not hour.held_for('three_gimbal', 20.0).good
