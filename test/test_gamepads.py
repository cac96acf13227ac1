"""Each gamepad's file in config/ makes of its messages what docs/driving.md says."""

from pathlib import Path

import numpy as np
import pytest
import yaml
from geometry_msgs.msg import TwistStamped
from sensor_msgs.msg import Joy

from wrist_control.graph.processes import config_file
from wrist_control.nodes.operator import Operator

DEVICES = sorted((Path(__file__).parent / 'joy_messages').glob('*.yaml'))
every_device = pytest.mark.parametrize('device', DEVICES, ids=[one.stem for one in DEVICES])


def settings(file):
    return yaml.safe_load(config_file(file).read_text())['/**/operator']['ros__parameters']


@every_device
def test_every_message_of_a_device_asks_for_the_rates_it_should(graph, device):
    played = yaml.safe_load(device.read_text())
    clock = graph.lockstep(0.02)
    graph.start(Operator, use_sim_time=True, **settings(played['config']))
    clock.listen({'cmd_vel': TwistStamped})
    clock.begin()
    publisher = graph.publisher(Joy, 'joy')
    for message in played['messages']:
        publisher.publish(Joy(axes=message['axes'], buttons=message['buttons']))
        graph.spin(0.1)
        clock.tick()
        turn = clock.heard['cmd_vel'][-1].twist.angular
        np.testing.assert_allclose(
            (turn.x, turn.y, turn.z), message['asks'], atol=1e-6, err_msg=message['does']
        )


@every_device
def test_the_messages_of_a_device_move_every_axis_both_with_and_without_turbo(device):
    played = yaml.safe_load(device.read_text())
    asks = np.array([message['asks'] for message in played['messages']])
    assert (asks != 0.0).any(axis=0).all()
    speeds = np.unique(np.abs(asks).max(axis=1).round(6))
    assert speeds[-1] == pytest.approx(2.0 * speeds[-2], abs=1e-5)


def test_a_file_for_every_device_has_messages():
    named = {yaml.safe_load(device.read_text())['config'] for device in DEVICES}
    configs = config_file('xbox.yaml').parent.glob('*.yaml')
    joysticks = {one.name for one in configs if 'maneuver: joystick' in one.read_text()}
    assert named == joysticks


@every_device
def test_no_file_follows_a_trigger_and_every_file_has_a_dead_man_button(device):
    """At rest a trigger reads 1, or 0 before it was touched: no rate can be had from it."""
    given = settings(yaml.safe_load(device.read_text())['config'])
    triggers = {'xbox': {2, 5}, 'playstation': {2, 5}, 'game_controller': {4, 5}}
    assert not set(given['joy_axes']) & triggers.get(device.stem, set())
    assert given['enable_button'] >= 0


@pytest.mark.parametrize('name', ['enable_button', 'turbo_button'])
def test_the_number_of_a_button_is_whole_however_it_is_given(graph, name):
    node = graph.start(Operator, maneuver='joystick', **{name: 5.0})
    value = node.get_parameter(name).value
    assert (value, type(value)) == (5, int)
    graph.end(node)
    with pytest.raises(ValueError, match=f'{name} is 5.5; valid is a whole number, -1 to 100'):
        graph.start(Operator, maneuver='joystick', **{name: 5.5})
