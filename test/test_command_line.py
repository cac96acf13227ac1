"""What people type: `--help`, names that nobody knows, files for others, and what ROS refuses."""

import os
import re
import signal
import subprocess

import pytest
from geometry_msgs.msg import PoseStamped, TwistStamped
from rcl_interfaces.msg import Log
from rclpy.qos import DurabilityPolicy, QoSProfile

from wrist_control import WRISTS, make_wrist
from wrist_control.graph.processes import config_file, executable_file
from wrist_control.nodes.joint_simulator import JointSimulator
from wrist_control.nodes.keyboard import Keyboard
from wrist_control.nodes.operator import Operator
from wrist_control.nodes.physics_simulator import PhysicsSimulator
from wrist_control.nodes.recorder import Recorder
from wrist_control.nodes.resolver import Resolver
from wrist_control.nodes.rotary_stewart_forward_kinematics import (
    RotaryStewartForwardKinematics,
)
from wrist_control.nodes.stewart_forward_kinematics import StewartForwardKinematics
from wrist_control.ros.command_line import what_is_wrong
from wrist_interfaces.msg import WristStatus

OTHERS = {
    'joint_simulator': JointSimulator,
    'keyboard': Keyboard,
    'operator': Operator,
    'physics_simulator': PhysicsSimulator,
    'rotary_stewart_forward_kinematics': RotaryStewartForwardKinematics,
    'recorder': Recorder,
    'stewart_forward_kinematics': StewartForwardKinematics,
}
EXECUTABLES = [*OTHERS, *(f'{wrist}_resolver' for wrist in WRISTS)]


def start(graph, executable, *arguments):
    return subprocess.Popen(
        [str(executable_file(executable)), *arguments],
        env={**os.environ, 'ROS_DOMAIN_ID': str(graph.domain)},
        stdout=subprocess.PIPE,
        stderr=subprocess.PIPE,
        text=True,
    )


def said_at_start(graph, executable, *arguments):
    """Return what a node says of its command line before it is ready."""
    running = start(graph, executable, '--ros-args', *arguments)
    said = ''
    for line in running.stderr:
        said += line
        if 'Ready' in line:
            break
    running.terminate()
    running.communicate(timeout=20.0)
    assert 'Ready' in said
    return said


def refused(graph, executable, *arguments):
    """Return what is said by a node that does not start."""
    running = start(graph, executable, '--ros-args', *arguments)
    _, said = running.communicate(timeout=30.0)
    assert running.returncode == 2, said
    assert 'Traceback' not in said
    return said


def test_whoever_stops_reading_the_help_sees_no_traceback(graph):
    running = start(graph, 'three_gimbal_resolver', '--help')
    running.stdout.close()  # as `| head -0` does
    assert running.wait(timeout=30.0) == -signal.SIGPIPE
    assert running.stderr.read() == ''


@pytest.mark.parametrize('executable', EXECUTABLES)
def test_help_names_every_parameter_topic_and_service(graph, executable):
    running = start(graph, executable, '--help')
    told, said = running.communicate(timeout=30.0)
    assert running.returncode == 0, said
    kind = OTHERS.get(executable)
    wrist = executable.removesuffix('_resolver')
    node = graph.start(kind) if kind else graph.start(Resolver, wrist)
    for name in set(node.get_parameters_by_prefix('')) - {'start_type_description_service'}:
        assert name == 'use_sim_time' or re.search(rf'^  {name}( \*)? = ', told, re.M), name
    name, space = node.get_name(), node.get_namespace()
    topics = [
        *node.get_subscriber_names_and_types_by_node(name, space),
        *node.get_publisher_names_and_types_by_node(name, space),
        *node.get_service_names_and_types_by_node(name, space),
    ]
    for topic, (kind,) in topics:
        if kind.startswith(('rcl_interfaces', 'type_description')):
            assert topic not in told
        else:
            assert re.search(rf'^  {topic} +{kind}$', told, re.M), topic
    assert told.startswith(f'usage: {executable} ')


@pytest.mark.parametrize(
    ('executable', 'given', 'meant'),
    [
        ('three_gimbal_resolver', 'raet:=50.0', 'did you mean rate?'),
        ('operator', 'manoeuvre:=hold', 'did you mean maneuver?'),
        ('joint_simulator', 'xyz:=[1]', 'valid are rate, joints, initial_positions'),
        ('stewart_forward_kinematics', 'gap_limits:=1.0', 'did you mean gap_limit?'),
    ],
)
def test_a_parameter_that_nobody_knows_is_named(graph, executable, given, meant):
    name = given.partition(':')[0]
    said = said_at_start(graph, executable, '-p', given)
    assert f'{name} is no parameter of {executable} and changes nothing; {meant}' in said


def test_a_shipped_file_says_nothing_to_a_node_with_another_name_and_that_is_named(graph):
    file = str(config_file('three_gimbal.yaml'))
    arguments = ['-r', '__ns:=/left', '--params-file', file]
    assert 'changes nothing' not in said_at_start(graph, 'three_gimbal_resolver', *arguments)
    said = said_at_start(graph, 'three_gimbal_resolver', *arguments, '-r', '__node:=wrist')
    assert f'{file} has parameters of /**/three_gimbal_resolver, /**/joint_simulator' in said
    assert 'and none of /left/wrist: it changes nothing here; put them under /left/wrist' in said


@pytest.mark.parametrize(
    ('arguments', 'sentence'),
    [
        (['--params-file', 'nowhere.yaml'], 'nowhere.yaml cannot be used (there is no such file)'),
        (['-r', 'a:=:b'], '-r a:=:b cannot be used; valid is <name>:=<another name>'),
        (['-r', '__ns:=a//b'], '-r __ns:=a//b cannot be used; valid is'),
        (['-p', 'rate'], '-p rate cannot be used; valid is <parameter>:=<value>'),
        (['--log-level', 'loud'], 'valid is debug, info, warn, error or fatal'),
        (['--loud'], "['--loud']; valid after --ros-args are --params-file, -p, -r, --log-level"),
    ],
)
def test_what_ros_refuses_is_one_sentence(graph, arguments, sentence):
    said = refused(graph, 'operator', *arguments)
    assert 'Cannot start: ' in said
    assert sentence in said


def test_a_file_that_is_no_parameter_file_is_one_sentence(graph, tmp_path):
    file = tmp_path / 'list.yaml'
    file.write_text('rate: 5.0\n')
    said = refused(graph, 'operator', '--params-file', str(file))
    assert f'Cannot start: --params-file {file} cannot be used (Cannot have a value before' in said
    assert 'valid is a YAML file with ros__parameters under the name of a node' in said


def test_what_is_said_of_an_error_without_a_rule_is_the_error():
    assert what_is_wrong(RuntimeError('no such thing')) == 'no such thing.'


def test_a_log_that_cannot_be_kept_is_one_sentence(graph, monkeypatch):
    monkeypatch.setenv('ROS_LOG_DIR', '/proc/nowhere')
    assert (
        'Cannot start: ROS cannot keep its log in /proc/nowhere; set ROS_LOG_DIR to a folder of '
        'yours.'
    ) in refused(graph, 'operator')


def test_why_a_node_cannot_start_is_heard_on_rosout(graph):
    logs = []
    lasting = QoSProfile(depth=100, durability=DurabilityPolicy.TRANSIENT_LOCAL)
    graph.outside.create_subscription(Log, '/rosout', logs.append, lasting)
    sentence = 'Cannot start: speed is -1.0; valid is 1e-06 to 100 rad/s'

    def found():
        return [log for log in logs if log.msg.startswith(sentence)]

    for _ in range(5):  # a node that ends soon may be gone before a busy machine has found it
        running = start(graph, 'operator', '--ros-args', '-p', 'speed:=-1.0', '-r', '__ns:=/left')
        while running.poll() is None:
            graph.spin(0.05)
        assert running.returncode == 2
        graph.spin(0.2)
        if found():
            break
    (log,) = found()
    assert log.name == 'left.operator'
    assert log.level == 50  # FATAL


def test_default_frames_do_not_collide_between_namespaces(graph):
    frames = {}
    for space in ('', '/left', '/a/b'):
        graph.start(Resolver, 'three_gimbal', namespace=space)
        poses = graph.listen(PoseStamped, f'{space}/hand_pose')
        statuses = graph.listen(WristStatus, f'{space}/wrist_status')
        graph.until(lambda poses=poses, statuses=statuses: poses and statuses)
        frames[space] = (poses[0].header.frame_id, statuses[0].header.frame_id)
    assert frames == {
        '': ('forearm', 'hand'),
        '/left': ('left/forearm', 'left/hand'),
        '/a/b': ('a/b/forearm', 'a/b/hand'),
    }
    platform = graph.start(StewartForwardKinematics, namespace='/left')
    assert platform.get_parameter('base_frame').value == 'left/forearm'
    assert platform.get_parameter('platform_frame').value == 'left/hand'
    named = graph.start(Resolver, 'carpal', namespace='/right', hand_frame='tool')
    assert named.get_parameter('hand_frame').value == 'tool'


@pytest.mark.parametrize('wrist', WRISTS)
def test_linear_commands_to_a_wrist_that_only_turns_are_named(graph, wrist):
    graph.start(Resolver, wrist)
    statuses = graph.listen(WristStatus, 'wrist_status')
    publisher = graph.publisher(TwistStamped, 'cmd_vel')
    message = TwistStamped()
    message.twist.linear.x = 0.01
    moves = make_wrist(wrist).twist_size == 6
    left_out = 'the linear part of the command is left out, for this wrist only turns.'

    def sent():
        message.header.stamp = graph.outside.get_clock().now().to_msg()
        publisher.publish(message)
        graph.spin(0.02)
        moved = statuses and statuses[-1].achieved.linear.x
        return moved or any(status.message.endswith(left_out) for status in statuses)

    graph.until(sent)
    assert bool(statuses[-1].achieved.linear.x) == moves
    assert any(s.message.endswith(left_out) for s in statuses) != moves
    message.twist.linear.x = 0.0
    message.twist.angular.x = 0.01
    if not moves:
        graph.until(lambda: sent() and not statuses[-1].message.endswith(left_out))


def test_an_operator_that_only_turns_is_not_told_so(graph):
    graph.start(Resolver, 'three_gimbal')
    statuses = graph.listen(WristStatus, 'wrist_status')
    graph.start(Operator, maneuver='constant', constant_rates=[0.1, 0.0, 0.0])
    graph.until(lambda: statuses and statuses[-1].state == WristStatus.TRACKING)
    assert not any('linear' in status.message for status in statuses)
