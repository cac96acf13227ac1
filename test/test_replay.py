"""Runs that were recorded, made again: the same joint commands, to the last bit."""

import math
import re
import signal
import struct
import time

import pytest
from geometry_msgs.msg import Twist
from mcap.reader import make_reader
from rcl_interfaces.srv import SetParameters
from rclpy.parameter import Parameter
from rclpy.serialization import deserialize_message
from sensor_msgs.msg import JointState
from std_msgs.msg import Bool, Empty
from std_srvs.srv import SetBool, Trigger

from wrist_control.nodes.joint_simulator import JointSimulator
from wrist_control.nodes.operator import Operator
from wrist_control.nodes.resolver import Resolver
from wrist_interfaces.msg import WristStatus

from .recordings import Recorded, Stick, by_rosbags, file_of, rewrite, run, stamp

SAME = 'joint commands are the same to the last bit.'


@pytest.mark.parametrize('wrist', ['four_gimbal', 'pitch_yaw', 'stewart', 'carpal'])
def test_a_live_run_is_made_again_to_the_last_bit(graph, tmp_path, wrist):
    stick = Stick(graph, tmp_path / 'run', wrist)
    stick.turn(1.0, q=0.4)
    stick.turn(0.5, p=0.3, q=-0.2, r=0.1)
    graph.spin(0.6)  # silence: a ramp to a stop
    stick.turn(0.5, p=-0.2)
    stick.end()
    code, said = run('replay', tmp_path / 'run')
    assert code == 0, said
    assert SAME in said
    count = len(joint_commands(tmp_path / 'run'))
    compared = int(re.search(r'All (\d+) joint commands', said)[1])
    assert compared >= 100
    # Those of before the recorder had found step_inputs, too.
    assert count - 50 < compared <= count
    if compared < count:
        assert f'{count - compared} joint commands are of steps that are not in the' in said


def test_steps_that_come_late_are_made_again_as_they_came(graph, tmp_path):
    patient = {'command_timeout': 5.0, 'feedback_timeout': 5.0}
    stick = Stick(graph, tmp_path / 'run', 'three_gimbal', **patient)
    for _ in range(3):
        stick.turn(0.3, q=0.4)
        time.sleep(0.3)  # the resolver is in this process: it makes no step, either
        stick.turn(0.2, q=-0.3)
    stick.end()
    code, said = run('replay', tmp_path / 'run')
    assert code == 0, said
    assert SAME in said


@pytest.mark.parametrize('clock', ['false', 'true'])
def test_a_run_on_a_simulated_clock_is_made_again_too(graph, tmp_path, clock):
    ticks = graph.lockstep(1.0 / 32.0)
    on_it = {'use_sim_time': True, 'rate': 32.0}
    graph.start(Resolver, 'three_gimbal', require_joint_states=True, **on_it)
    graph.start(JointSimulator, **on_it)
    ticks.listen({'wrist_status': WristStatus, 'joint_command': JointState})
    recorded = Recorded(graph, tmp_path / 'run', '-p', f'use_sim_time:={clock}')
    graph.until(lambda: graph.outside.count_subscribers('step_inputs'))
    ticks.begin()
    graph.start(Operator, maneuver='basic_test', speed=2.0, **on_it)
    graph.until(lambda: graph.outside.count_publishers('cmd_vel'))
    for _ in range(120):
        ticks.tick()
    graph.spin(0.5)
    code, said = recorded.end()
    assert code == 0, said
    code, said = run('replay', tmp_path / 'run')
    assert code == 0, said
    assert int(re.search(r'All (\d+) joint commands', said)[1]) >= 110
    ours = {stamp(one): one.position for one in joint_commands(tmp_path / 'run')}
    theirs = {stamp(one): one.position for one in ticks.heard['joint_command']}
    both = ours.keys() & theirs.keys()
    assert len(both) >= 100
    assert [ours[when] for when in both] == [theirs[when] for when in both]
    times = [when for when, _, _ in by_rosbags(tmp_path / 'run')['/joint_command']]
    assert (max(times) < 10**12) == (clock == 'true')  # on a clock that began at 10 s


def joint_commands(folder):
    with file_of(folder).open('rb') as stream:
        found = make_reader(stream).iter_messages(topics=['/joint_command'])
        return [deserialize_message(message.data, JointState) for _, _, message in found]


def test_all_that_people_do_in_between_is_made_again_too(graph, tmp_path):
    stick = Stick(graph, tmp_path / 'run', 'three_gimbal', require_deadman=True)
    deadman, stop = graph.publisher(Bool, 'deadman'), graph.publisher(Empty, 'stop')
    deadman.publish(Bool(data=True))
    stick.turn(0.2, q=0.5)
    deadman.publish(Bool(data=True))
    stick.turn(0.5, q=0.5)  # until the dead-man switch has been silent for too long
    narrower = Parameter('joint_rate_limits', value=[0.2, 0.2, 0.2]).to_parameter_msg()
    for _ in range(3):
        deadman.publish(Bool(data=True))
        stick.turn(0.1, r=0.5)
        service = f'{stick.node}/set_parameters'
        answer = graph.call(SetParameters, service, SetParameters.Request(parameters=[narrower]))
        assert answer.results[0].successful
    stop.publish(Empty())
    graph.until(lambda: stick.statuses[-1].state == WristStatus.DISABLED)
    stick.turn(0.1, p=0.5)
    graph.until(
        lambda: graph.call(SetBool, f'{stick.node}/enable', SetBool.Request(data=True)).success
    )
    deadman.publish(Bool(data=True))
    stick.turn(0.2, p=0.5)
    for _ in range(20):
        deadman.publish(Bool(data=True))
        graph.call(Trigger, f'{stick.node}/reset', Trigger.Request())
        graph.spin(0.05)
    stick.end()
    states = {status.state for status in stick.statuses}
    assert {WristStatus.STALE, WristStatus.DISABLED, WristStatus.SCALED} <= states
    code, said = run('replay', tmp_path / 'run')
    assert code == 0, said
    assert SAME in said
    assert ' steps are not in the recording' not in said


def test_one_that_begins_and_ends_in_motion_is_made_again_from_where_the_hand_rests(
    graph, tmp_path
):
    graph.start(Resolver, 'three_gimbal', command_timeout=10.0)
    twists = graph.publisher(Twist, 'cmd_vel_unstamped')
    turning, still = Twist(), Twist()
    turning.angular.z = 0.3
    twists.publish(turning)
    recorded = Recorded(graph, tmp_path / 'run')
    graph.until(lambda: graph.outside.count_subscribers('step_inputs'))
    graph.spin(1.5)
    twists.publish(still)
    graph.spin(0.5)
    twists.publish(turning)
    graph.spin(1.5)
    assert recorded.end(signal.SIGKILL)[0] == -signal.SIGKILL
    code, said = run('replay', tmp_path / 'run')
    assert code == 0, said
    made, recorded_steps = (int(said.split()[at]) for at in (1, 3))
    assert 20 < made < recorded_steps - 20


def test_one_bit_is_a_difference(graph, tmp_path):
    stick = Stick(graph, tmp_path / 'run', 'three_gimbal')
    stick.turn(0.5, q=0.4)
    stick.end()
    changed = tmp_path / 'changed.mcap'
    bent = [abs(one.position[1]) > 0.05 for one in joint_commands(tmp_path / 'run')].index(True)

    def nudge(index, data):
        theta = deserialize_message(data, JointState).position[1]
        nudged = struct.pack('<d', math.nextafter(theta, math.inf))
        return data.replace(struct.pack('<d', theta), nudged, 1) if index == bent else data

    rewrite(file_of(tmp_path / 'run'), changed, nudge)
    code, said = run('replay', changed)
    assert code == 1, said
    assert re.search(r'\b1 of \d+ joint commands differ, first ', said)
    assert 'in theta; by at most ' in said
    rewrite(file_of(tmp_path / 'run'), tmp_path / 'same.mcap', lambda _, data: data)
    assert run('replay', tmp_path / 'same.mcap')[0] == 0
