"""Attacks by those who command: nonsense, floods, lateness, losses, two at once, stop, deadman."""

from __future__ import annotations

import time
from collections import deque
from collections.abc import Callable
from typing import Any

import rclpy
from geometry_msgs.msg import Twist, TwistStamped
from sensor_msgs.msg import JointState
from std_msgs.msg import Bool, Empty
from std_srvs.srv import SetBool

from hostile.messages import (
    honest,
    hostile_joints,
    hostile_stamped,
    refused_joints,
    refused_stamped,
    refused_twist,
    stamp,
)
from hostile.stage import DT, WRIST, Stage
from wrist_control.testing.places import Random

# Messages per second of an attack that shall be heard, and of an operator.
PACE, OPERATOR = 1500.0, 50.0
# Of the commands that must be refused all are sent while the hand rests, up to this share.
AT_REST = 0.5


def paced(count: int, pace: float = PACE) -> Any:
    """Yield numbers, so many in a second."""
    began = time.monotonic()
    for number in range(count):
        ahead = began + number / pace - time.monotonic()
        if ahead > 0.0:
            time.sleep(ahead)
        yield number


def stamped_commands(stage: Stage, random: Random, count: int) -> None:
    """Send commands that must be refused to a hand at rest, and then any between good ones."""
    _commands(stage, random, count, 'cmd_vel', refused_stamped)


def unstamped_commands(stage: Stage, random: Random, count: int) -> None:
    """Do the same on the topic without stamps."""
    _commands(stage, random, count, 'cmd_vel_unstamped', refused_twist)


def _commands(
    stage: Stage, random: Random, count: int, topic: str, refused: Callable[[Random], Any]
) -> None:
    stamped = topic == 'cmd_vel'
    stage.hand()
    stage.until_held()
    publisher = stage.publisher(TwistStamped if stamped else Twist, topic)
    for number in paced(count):
        if number < AT_REST * count:
            publisher.publish(refused(random))
        else:
            stage.judge.allow()
            good = random.random() < 0.3
            message = honest(random) if good else hostile_stamped(random)
            publisher.publish(message if stamped else message.twist)
        stage.sent()


def joint_states(stage: Stage, random: Random, count: int) -> None:
    """Lie about the joints, at rest and under way."""
    stage.hand()
    stage.until_held()
    names = [joint.name for joint in stage.joints]
    lies = stage.publisher(JointState, 'joint_states')
    commands = stage.publisher(TwistStamped, 'cmd_vel')
    for number in paced(count):
        if number < AT_REST * count:
            lies.publish(refused_joints(names, random))
        else:
            if number % round(PACE / OPERATOR) == 0:
                stage.judge.allow()
                commands.publish(honest(random))
            near = list(stage.states.position) if stage.states else [0.0] * len(names)
            near = near if len(near) == len(names) else [0.0] * len(names)
            lies.publish(hostile_joints(names, near, random))
        stage.sent()


def flood(stage: Stage, random: Random, count: int) -> None:
    """Send as fast as possible: commands, true and false joint states, calls of services."""
    stage.hand()
    stage.until_held()
    names = [joint.name for joint in stage.joints]
    commands = stage.publisher(TwistStamped, 'cmd_vel')
    joints = stage.publisher(JointState, 'joint_states')
    enable = stage.client(SetBool, f'{WRIST}_resolver/enable')
    pending: deque[Any] = deque(maxlen=50)
    for number in range(count):
        kind = number % 20
        if kind < 12:
            stage.judge.allow()
            commands.publish(honest(random))
        elif kind < 19:
            joints.publish(refused_joints(names, random))
        elif len(pending) < 50 or pending[0].done():
            pending.append(enable.call_async(SetBool.Request(data=True)))
        stage.sent()
        if number % 500 == 0:
            time.sleep(0.05)  # the machine has others to serve


def late_bursts(stage: Stage, random: Random, count: int) -> None:
    """Keep commands back, and send a burst of them, in any order, some far too late."""
    stage.hand()
    stage.until_held()
    publisher = stage.publisher(TwistStamped, 'cmd_vel')
    while count > 0:
        burst = [honest(random) for _ in range(int(random.integers(5, 200)))]
        now = time.time()
        for message in burst:
            message.header.stamp = stamp(now - float(random.uniform(0.0, 0.6)))
        time.sleep(float(random.choice([0.02, 0.1, 0.5])))
        stage.judge.allow()
        for message in burst:
            publisher.publish(message)
        stage.sent(len(burst))
        count -= len(burst)
        time.sleep(0.02)


def two_operators(stage: Stage, random: Random, count: int) -> None:
    """Let two, and then four, command against each other, by both topics."""
    stage.hand()
    stage.until_held()
    other = rclpy.create_node('other', context=stage.node.context)
    try:
        publishers = [
            stage.publisher(TwistStamped, 'cmd_vel'),
            other.create_publisher(TwistStamped, 'cmd_vel', 10),
            stage.publisher(Twist, 'cmd_vel_unstamped'),
            other.create_publisher(Twist, 'cmd_vel_unstamped', 10),
        ]
        for number in paced(count, 8.0 * OPERATOR):
            pairs = ([0, 1], [2, 3], [0, 2], [0, 1, 2, 3])
            who = publishers[int(random.choice(pairs[4 * number // count]))]
            message = honest(random)
            if publishers.index(who) % 2:
                message.twist.angular.x *= -1.0
                message.twist.angular.y *= -1.0
            stage.judge.allow()
            who.publish(message if who.msg_type is TwistStamped else message.twist)
            stage.sent()
    finally:
        other.destroy_node()


def loss_and_delay(stage: Stage, random: Random, count: int) -> None:
    """Lose 30 % of the commands, and deliver the others up to 0.2 s late, out of order."""
    stage.hand()
    stage.until_held()
    publisher = stage.publisher(TwistStamped, 'cmd_vel')
    on_the_way: list[tuple[float, TwistStamped]] = []
    for _ in paced(count, 4.0 * OPERATOR):
        if random.random() > 0.3:
            late = 0.2 * float(random.choice([1.0, random.random()]))
            on_the_way.append((time.time() + late, honest(random)))
        now = time.time()
        for due in [one for one in on_the_way if one[0] <= now]:
            stage.judge.allow()
            publisher.publish(due[1])
            on_the_way.remove(due)
        stage.sent()


def stops(stage: Stage, random: Random, count: int) -> None:
    """Stop the hand by `stop` and `~/enable`, over and over, while commands go on."""
    stage.hand()
    stage.until_held()
    commands = stage.publisher(TwistStamped, 'cmd_vel')
    stop = stage.publisher(Empty, 'stop', 2)
    enable = stage.client(SetBool, f'{WRIST}_resolver/enable')
    going, until = True, 0
    stage.judge.allow()  # the first commands may be there before the first stop is
    for number in paced(count, 200.0):
        if number >= until and going:
            going, until = False, number + int(random.integers(100, 500))
            stage.judge.forbid(stopped=True)
            if random.random() < 0.3:
                enable.call_async(SetBool.Request(data=False))
            for _ in range(int(random.choice([1, 1, 50]))):
                stop.publish(Empty())
                stage.sent()
        elif number >= until:
            going, until = True, number + int(random.integers(100, 300))
            stage.judge.go_on()
            enable.call_async(SetBool.Request(data=True))
        stage.judge.allow()
        commands.publish(honest(random))
        stage.sent()


def deadman(stage: Stage, random: Random, count: int) -> None:
    """Press and release the dead-man's switch, or let it fall silent, while commands go on."""
    stage.hand(require_deadman=True)
    stage.until_held()
    commands = stage.publisher(TwistStamped, 'cmd_vel')
    switch = stage.publisher(Bool, 'deadman')
    way, until = 'silent', 0
    for number in paced(count, 2.0 / DT):
        if number >= until:
            way = str(random.choice(['pressed', 'released', 'silent', 'both']))
            until = number + int(random.integers(100, 500))
            if way in ('released', 'silent'):
                stage.judge.forbid()
        if way in ('pressed', 'both'):
            stage.judge.allow()
            switch.publish(Bool(data=True))
        if way == 'released' or (way == 'both' and random.random() < 0.5):
            switch.publish(Bool(data=False))
        commands.publish(honest(random))
        stage.sent(2)
    stage.follows_again(lambda: switch.publish(Bool(data=True)))
