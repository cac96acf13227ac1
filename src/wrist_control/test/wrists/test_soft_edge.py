"""An edge that the hand nears slowly: where it stops, and how slowly it arrives."""

import numpy as np
import pytest

from wrist_control import make_wrist
from wrist_control.resolving import start, step
from wrist_control.wrists.wrist import soft_edge

DT = 0.01


def remaining_on_the_way(name, twist, seconds):
    wrist = make_wrist(name)
    state, remaining = start(wrist), []
    for _ in range(round(seconds / DT)):
        state = step(wrist, state, twist, DT).state
        remaining.append(min(one.remaining for one in wrist.clearances(state.positions)))
    return wrist, state, np.array(remaining)


@pytest.mark.parametrize(
    ('name', 'twist'),
    [('five_bar', (0.0, 1.0, 0.0)), ('five_bar', (1.0, 0.0, 0.0)), ('carpal', (1.0, 0.0, 0.0))],
)
def test_the_hand_stops_at_two_hundredths_and_loses_a_tenth_of_the_rest_each_10_ms(name, twist):
    wrist, state, remaining = remaining_on_the_way(name, twist, 4.0)
    assert wrist.margin(state.positions) == pytest.approx(0.02, abs=1e-4)
    near = remaining[(remaining < 0.03) & (remaining > 1e-5)]
    assert len(near) > 50
    shares = near[1:] / near[:-1]
    assert shares.min() > 0.9 - 1e-6
    np.testing.assert_allclose(shares[-20:], 0.9, atol=1e-3)


def test_a_soft_edge_says_what_is_left_to_where_the_hand_stops():
    edge = soft_edge('rim', 0.5)
    assert (edge.name, edge.remaining, edge.horizon) == ('rim', pytest.approx(0.48), 0.1)
    assert soft_edge('rim', 0.5, 0.1, 2.0)[1:] == (pytest.approx(0.4), 2.0)
