import pytest

from wrist_control.resolving.ramp import Ramp, scaled


def test_the_share_goes_down_evenly_and_is_nothing_after_the_stop_time():
    ramp, shares = Ramp(1.0, 'then', 'why'), []
    for _ in range(5):
        ramp = ramp.after(0.01, 0.05)
        shares.append(ramp.share)
    assert shares == pytest.approx([0.8, 0.6, 0.4, 0.2, 0.0])
    assert shares[-1] == 0.0
    assert (ramp.then, ramp.message) == ('then', 'why')


def test_a_stop_that_is_shorter_than_a_step_takes_one_step():
    assert Ramp(1.0, None, '').after(0.01, 0.001).share == 0.0


def test_every_component_of_the_motion_is_made_in_the_same_share():
    assert scaled(0.5, (1.0, 2.0, 3.0, 4.0, 5.0, -6.0)) == (0.5, 1.0, 1.5, 2.0, 2.5, -3.0)
