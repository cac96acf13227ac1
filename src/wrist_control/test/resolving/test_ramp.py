import pytest

from wrist_control import make_wrist
from wrist_control.resolving import start
from wrist_control.resolving.period import SupervisorSettings
from wrist_control.resolving.ramp import PAUSE, Ramp, after_a_pause, scaled

SETTINGS = SupervisorSettings(0.01, 0.25, 0.1, (0.0, 0.0, 0.0), (0.1, 0.1, 0.1))


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


@pytest.mark.parametrize('pause', [0.5, 2.0])
def test_over_a_pause_a_step_of_motion_is_as_much_slower_as_the_pause_is_longer(pause):
    moving = start(make_wrist('three_gimbal'))._replace(joint_rates=(0.4, 0.0, -0.8))
    state, ramp = after_a_pause(moving, Ramp(0.7, 'then', 'why'), SETTINGS, pause)
    assert state.joint_rates == pytest.approx((0.4 * 0.01 / pause, 0.0, -0.8 * 0.01 / pause))
    assert ramp == Ramp(0.0, 'then', 'why')
    assert after_a_pause(moving, None, SETTINGS, pause) == (state, None)


def test_what_is_not_much_more_than_a_step_is_no_pause():
    moving = start(make_wrist('three_gimbal'))._replace(joint_rates=(0.4, 0.0, -0.8))
    ramp = Ramp(0.7, 'then', 'why')
    assert after_a_pause(moving, ramp, SETTINGS, 0.99 * (PAUSE + 0.01)) == (moving, ramp)
