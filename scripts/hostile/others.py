"""Attacks on the nodes beside the resolver: joints, forward kinematics, operator."""

from __future__ import annotations

import math
import time
from typing import Any

from geometry_msgs.msg import PoseWithCovarianceStamped, TwistStamped
from sensor_msgs.msg import JointState, Joy

from hostile.commanding import AT_REST, PACE, paced
from hostile.listening import Judge
from hostile.messages import (
    hostile_joints,
    hostile_joy,
    hostile_status,
    refused_joints,
    stamp,
)
from hostile.numbers import EDGES
from hostile.stage import DT, Stage
from wrist_control.ros.qos import LASTING
from wrist_control.testing.places import Random
from wrist_control.wrists import Joint, make_wrist
from wrist_interfaces.msg import ForwardKinematicsStatus, WristStatus

# Of the joints that are simulated alone: rad and rad/s.
REACH, RATE = 1.0, 0.7
# No joystick asks for more than its scales, rad/s.
FASTEST = math.radians(32.0) + 1e-9


def joint_simulator(stage: Stage, random: Random, count: int) -> None:
    """Send the joints commands that must be refused, and then any; their states are judged."""
    names = [joint.name for joint in stage.joints]
    joints = [Joint(name, lower=-REACH, upper=REACH, rate_limit=RATE) for name in names]
    judge = Judge(joints, DT, stage.verdict)
    stage.attacked.add('joint_command')
    stage.listen(JointState, 'joint_states', lambda message: judge.hear(message))
    stage.start(
        'joint_simulator',
        joints=names,
        joint_rate_limits=[RATE],
        joint_lower_limits=[-REACH],
        joint_upper_limits=[REACH],
    )
    stage.until(lambda: judge.heard > 0, 'no joint_states')
    commands = stage.publisher(JointState, 'joint_command')
    first = stage.publisher(JointState, 'initial_joints', qos=LASTING)
    far = 2.0 * math.pi / RATE  # s, the longest way that a joint may be on
    for number in paced(count):
        if number < AT_REST * count:
            message = refused_joints(names, random)
        else:
            judge.allow(far)
            message = hostile_joints(names, random.uniform(-2.0, 2.0, size=3).tolist(), random)
        (first if random.random() < 0.1 else commands).publish(message)
        stage.sent()
    before = judge.heard
    stage.until(lambda: judge.heard > before + 10, 'no joint_states any more')


def forward_kinematics(stage: Stage, random: Random, count: int) -> None:
    """Send leg lengths that must be refused, and then any; poses and proofs stay finite."""
    wrist = make_wrist('stewart')
    names = [joint.name for joint in wrist.joints]
    stage.finite(PoseWithCovarianceStamped, 'platform_pose')
    stage.finite(TwistStamped, 'platform_twist')
    stage.finite(ForwardKinematicsStatus, 'forward_kinematics_status')
    heard: list[float] = []
    stage.listen(ForwardKinematicsStatus, 'forward_kinematics_status', lambda _: _tick(heard))
    stage.start('stewart_forward_kinematics')
    publisher = stage.publisher(JointState, 'joint_states')
    home = [*wrist.home]
    for number in paced(count, PACE / 3.0):
        if number < AT_REST * count:
            message = refused_joints(names, random)
        else:
            near = [x + 0.01 * float(random.normal()) for x in home]
            message = hostile_joints(names, near, random)
            if random.random() < 0.2 and len(message.position) == len(names):
                message.position[int(random.integers(6))] = float(random.choice(EDGES))
        publisher.publish(message)
        stage.sent()
    heard.clear()
    good = JointState(name=names, position=home, velocity=[0.0] * 6)

    def answers() -> bool:
        good.header.stamp = stamp(time.time())
        publisher.publish(good)
        time.sleep(0.02)
        return len(heard) > 3

    stage.until(answers, 'no forward_kinematics_status any more')


def operator(stage: Stage, random: Random, count: int) -> None:
    """Attack an operator with a joystick, and one with a maneuver, that turn a hand."""
    stage.hand()
    stage.until_held()
    said: list[float] = []

    def hear(message: Any) -> None:
        rates = message.twist.angular
        fastest = max(abs(rates.x), abs(rates.y), abs(rates.z))
        _tick(said)
        if not math.isfinite(fastest):
            stage.verdict.find('nonfinite', f'cmd_vel: {rates}')
        elif fastest > FASTEST:
            stage.verdict.find('limits', f'cmd_vel: {rates}')

    stage.listen(TwistStamped, 'cmd_vel', hear)
    stage.start('operator', maneuver='joystick')
    joy = stage.publisher(Joy, 'joy')
    for _ in paced(count // 2):
        stage.judge.allow(2.0)
        joy.publish(hostile_joy(random))
        stage.sent()
    stage.judge.forbid()
    before = len(said)
    stage.until(lambda: len(said) > before + 10, 'no cmd_vel any more')
    stage.check()
    stage.end('operator')
    stage.start('operator', maneuver='extended_test')
    stage.attacked.add('wrist_status')
    stage.judge.allow(math.inf)
    status = stage.publisher(WristStatus, 'wrist_status')
    for _ in paced(count - count // 2):
        status.publish(hostile_status(random))
        stage.sent()
    before = len(said)
    stage.until(lambda: len(said) > before + 10, 'no cmd_vel any more')
    stage.check()
    stage.end('operator')
    stage.judge.forbid()


def _tick(times: list[float]) -> None:
    times.append(time.monotonic())
