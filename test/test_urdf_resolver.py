"""The resolver of a robot's own wrist: from its URDF through lock, and what is refused."""

import math
import os
import shlex
import subprocess

import pytest
import yaml
from geometry_msgs.msg import PoseStamped, TwistStamped
from rcl_interfaces.msg import Parameter, ParameterType, ParameterValue
from rcl_interfaces.srv import SetParametersAtomically
from sensor_msgs.msg import JointState
from std_msgs.msg import Float64MultiArray
from tf2_msgs.msg import TFMessage
from visualization_msgs.msg import MarkerArray

from wrist_control import WristError, make_wrist
from wrist_control.graph.processes import executable_file
from wrist_control.nodes.joint_simulator import JointSimulator
from wrist_control.nodes.operator import Operator
from wrist_control.nodes.resolver import Resolver
from wrist_control.nodes.resolver_settings import mechanism_specs
from wrist_interfaces.msg import LimitAtWork, WristStatus

from .documents import ROOT

URDF = ROOT / 'src' / 'wrist_control' / 'urdf'
PANDA = {'robot_description': str(URDF / 'panda.urdf'), 'tip_link': 'panda_link8'}
JACO = {'robot_description': str(URDF / 'jaco.urdf'), 'tip_link': 'end_effector'}
FINGERS = ['panda_finger_joint1', 'panda_finger_joint2']
RATE = 50.0


def flown(graph, robot, rates, begin):
    """Return a clock that drives a robot's wrist with constant hand rates and fast joints."""
    clock = graph.lockstep(1.0 / RATE)
    common = {'use_sim_time': True, 'rate': RATE}
    graph.start(
        Resolver,
        'urdf',
        **common,
        **robot,
        initial_positions=begin,
        require_joint_states=True,
    )
    graph.start(JointSimulator, **common, joint_rate_limits=[3.0])
    clock.listen(
        {'wrist_status': WristStatus, 'joint_command': JointState, 'joint_states': JointState}
    )
    clock.begin()
    graph.start(Operator, **common, maneuver='constant', constant_rates=rates, listeners=2.0)
    clock.listen({'cmd_vel': TwistStamped})
    clock.begin()
    return clock


def test_the_wrist_of_a_panda_passes_its_lock_and_says_so(graph):
    """Joint 6 turns about an axis of the hand, and locks at 180°, inside its range."""
    wrist = make_wrist('urdf', description=PANDA['robot_description'], tip=PANDA['tip_link'])
    begin = (0.0, math.pi - 0.1, 0.0)
    toward = (0.3 * wrist.jacobian(begin)[:, 1]).tolist()
    clock = flown(graph, PANDA, toward, list(begin))
    for _ in range(120):
        clock.tick()
    last = clock.heard['joint_states'][-1]
    assert list(last.name) == ['panda_joint5', 'panda_joint6', 'panda_joint7']
    assert last.position[1] > math.pi + 0.2
    states = clock.heard['wrist_status']
    locked = [status for status in states if status.state == WristStatus.SINGULAR]
    assert all('In lock: the hand cannot turn about its axis' in one.message for one in locked)
    assert min(status.margin for status in states) < 0.02
    assert all(abs(x) < 1e-6 for x in (last.position[0], last.position[2]))


def test_turning_about_what_is_lost_leads_through_lock_at_the_joints_own_limits(graph):
    begin = [0.0, math.pi - 0.02, 0.0]
    wrist = make_wrist('urdf', description=PANDA['robot_description'], tip=PANDA['tip_link'])
    lost = [0.2 * x for x in wrist.lost_axis(begin)]
    clock = flown(graph, PANDA, lost, begin)
    for _ in range(150):
        clock.tick()
    commands = clock.heard['joint_command']
    fastest = max(abs(rate) for command in commands for rate in command.velocity)
    assert 2.0 < fastest <= 2.61 * (1.0 + 1e-6)  # those of the description
    assert any(status.state == WristStatus.SCALED for status in clock.heard['wrist_status'])


def test_the_region_that_cannot_be_reached_is_named(graph):
    clock = flown(graph, JACO, [0.5, 0.0, 0.0], [0.0, -0.5, 0.0])
    while clock.heard['wrist_status'][-1].state != WristStatus.LIMITED:
        clock.tick()
    for _ in range(30):
        clock.tick()
    status = clock.heard['wrist_status'][-1]
    name = 'unreachable region against the first axis'
    assert (name, LimitAtWork.WORKSPACE) in [(one.joint, one.kind) for one in status.limits]
    assert status.message == f'The wrist is at its limit: {name}; move the other way.'


class Robot:
    """A whole arm and a gripper: tells all of its joints, and turns the wrist's at velocities."""

    def __init__(self, graph):
        self.positions = {f'panda_joint{number}': 0.1 * number for number in range(1, 8)}
        self.positions |= dict.fromkeys(FINGERS, 0.02) | {'panda_joint6': 1.5}
        self._publisher = graph.outside.create_publisher(JointState, 'joint_states', 10)
        self._node = graph.outside
        topic = '/wrist_velocity_controller/commands'
        graph.outside.create_subscription(Float64MultiArray, topic, self._move, 100)
        graph.outside.create_timer(0.02, self._tell)

    def _move(self, command):
        """Go on for a hundredth of a second: the resolver sends as many in a second."""
        for number, velocity in zip((5, 6, 7), command.data, strict=True):
            self.positions[f'panda_joint{number}'] += 0.01 * velocity

    def _tell(self):
        message = JointState(name=list(self.positions), position=list(self.positions.values()))
        message.header.stamp = self._node.get_clock().now().to_msg()
        self._publisher.publish(message)


def test_beside_an_arm_it_hears_what_servo_would_and_drives_the_wrist_alone(graph):
    """As docs/from-urdf.md has it: other topics, the links' own names, joints of a whole robot."""
    robot = Robot(graph)
    before = dict(robot.positions)
    page = (ROOT / 'docs' / 'from-urdf.md').read_text()
    (line,) = [one for one in page.splitlines() if 'delta_twist_cmds' in one and './env' in one]
    node = Resolver(
        'urdf',
        context=graph.context,
        cli_args=[*shlex.split(line)[2:], '-p', 'command_timeout:=5.0'],
        use_global_arguments=False,
    )
    graph.add(node)
    statuses = graph.listen(WristStatus, 'wrist_status')
    poses = graph.listen(PoseStamped, 'hand_pose')
    publisher = graph.publisher(TwistStamped, '/servo_node/delta_twist_cmds')
    message = TwistStamped()
    message.header.frame_id = 'panda_link8'
    message.twist.angular.z = 0.3

    def turned():
        message.header.stamp = graph.outside.get_clock().now().to_msg()
        publisher.publish(message)
        graph.spin(0.05)
        return robot.positions['panda_joint7'] > before['panda_joint7'] + 0.1

    graph.until(turned)
    ways = {name: abs(robot.positions[name] - position) for name, position in before.items()}
    assert {name for name, way in ways.items() if way} <= {f'panda_joint{n}' for n in (5, 6, 7)}
    assert [name for name, way in ways.items() if way > 1e-6] == ['panda_joint7']
    assert statuses[-1].state in (WristStatus.TRACKING, WristStatus.SCALED)
    assert statuses[-1].header.frame_id == 'panda_link8'
    assert poses[-1].header.frame_id == 'panda_link4'


def test_the_resolver_of_any_wrist_takes_a_urdf_too_and_joints_by_name(graph):
    text = (URDF / 'four_joints.urdf').read_text()
    node = graph.start(
        Resolver,
        wrist='urdf',
        robot_description=text,
        tip_link='tool',
        joints=['second', 'third', 'fourth'],
    )
    commands = graph.listen(JointState, 'joint_command')
    markers, frames = graph.listen(MarkerArray, 'markers'), graph.listen(TFMessage, '/tf')
    graph.until(lambda: commands and markers and frames)
    assert list(commands[-1].name) == ['second', 'third', 'fourth']
    assert list(node.get_parameter('joint_rate_limits').value) == [3.0, 3.0, 3.0]
    assert {'second_link', 'joint third'} <= {one.ns for one in markers[-1].markers}
    names = [one.child_frame_id for one in frames[-1].transforms]
    assert names == ['second_link', 'third_link', 'hand']


def test_what_a_dump_has_of_it_starts_it_again(graph, tmp_path):
    """The whole XML, and an empty list of joints, as `ros2 param dump` writes them."""
    text = (URDF / 'panda.urdf').read_text()
    given = {**PANDA, 'robot_description': text, 'joints': []}
    file = tmp_path / 'dump.yaml'
    file.write_text(yaml.dump({'/urdf_resolver': {'ros__parameters': given}}))
    arguments = ['--ros-args', '--params-file', str(file)]
    node = Resolver('urdf', context=graph.context, cli_args=arguments, use_global_arguments=False)
    graph.add(node)
    assert node.get_parameter('robot_description').value == text
    assert list(node.get_parameter('joints').value) == []
    assert list(node.get_parameter('joint_rate_limits').value) == [2.61, 2.61, 2.61]


@pytest.mark.parametrize(
    ('robot', 'parameters', 'sentence'),
    [
        ({}, {}, 'There is no robot description; give the XML of a URDF'),
        (PANDA, {'robot_description': '/nowhere.urdf'}, "'/nowhere.urdf' cannot be read"),
        (PANDA, {'tip_link': 'panda_hand'}, "There is no link 'panda_hand' for the tip"),
        (PANDA, {'joints': ['panda_joint7']}, 'A wrist has two to four joints'),
        (PANDA, {'joints': ['panda_joint6', 'joint7']}, "There is no joint 'joint7' before"),
        (
            PANDA,
            {'joint_rate_limits': [5.0]},
            'joint_rate_limits is 5 for panda_joint5; valid is at most 2.61, as the mechanism',
        ),
        (
            PANDA,
            {'joint_upper_limits': [4.0]},
            'joint_upper_limits is 4 for panda_joint5; valid is at most 2.8973, as the mechanism',
        ),
        (
            PANDA,
            {'joint_lower_limits': [-0.5]},
            'joint_lower_limits is -0.5 for panda_joint6; valid is at least -0.0175, as the',
        ),
        (PANDA, {'initial_positions': [0.0, 0.0, 0.0]}, 'are at lock'),
    ],
)
def test_what_cannot_be_used_is_refused_at_the_start(graph, robot, parameters, sentence):
    with pytest.raises(WristError) as refused:
        graph.start(Resolver, 'urdf', **robot | parameters)
    assert sentence in str(refused.value)


def test_limits_below_those_of_the_description_may_change_while_it_runs(graph):
    graph.start(Resolver, 'urdf', **PANDA)

    def ask(*rates):
        value = ParameterValue(
            type=ParameterType.PARAMETER_DOUBLE_ARRAY, double_array_value=list(rates)
        )
        request = SetParametersAtomically.Request(
            parameters=[Parameter(name='joint_rate_limits', value=value)]
        )
        service = 'urdf_resolver/set_parameters_atomically'
        return graph.call(SetParametersAtomically, service, request).result

    assert ask(0.5).successful
    assert ask(2.61).successful
    refused = ask(2.0, 3.0, 2.0)
    assert not refused.successful
    assert (
        'joint_rate_limits is 3 for panda_joint6; while the node runs valid is' in refused.reason
    )


def test_every_parameter_of_the_description_is_in_the_documents():
    table = (ROOT / 'docs' / 'interfaces.md').read_text().partition('Parameters of urdf_resolver')
    for spec in mechanism_specs('urdf'):
        assert f'\n| `{spec.name}` |' in table[2], spec.name


def said(graph, *arguments):
    return subprocess.run(
        [str(executable_file('urdf_resolver')), *arguments],
        env={**os.environ, 'ROS_DOMAIN_ID': str(graph.domain)},
        capture_output=True,
        text=True,
        timeout=60.0,
    )


def test_the_executable_tells_its_parameters_and_needs_a_description(graph):
    told = said(graph, '--help')
    assert told.returncode == 0, told.stderr
    for name in ('robot_description', 'tip_link', 'joints', 'gain', 'joint_rate_limits'):
        assert f'\n  {name} ' in told.stdout, name
    refused = said(graph)
    assert refused.returncode == 2
    assert 'Cannot start: There is no robot description; give the XML' in refused.stderr
    assert len(refused.stderr.strip().splitlines()) == 1
