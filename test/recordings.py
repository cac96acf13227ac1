"""Recordings that tests make: the recorder as a process, and readers that are not ours."""

import os
import signal
import subprocess
from pathlib import Path

from geometry_msgs.msg import TwistStamped
from mcap.reader import make_reader
from mcap.writer import Writer
from rosbags.highlevel import AnyReader

from wrist_control.graph.processes import executable_file
from wrist_control.nodes.joint_simulator import JointSimulator
from wrist_control.nodes.resolver import Resolver
from wrist_control.resolving.witness import Kind
from wrist_interfaces.msg import WristStatus

from .conftest import Graph


class Recorded:
    """A recorder as a process of its own."""

    def __init__(self, graph, folder, *arguments, **options):
        self.folder = Path(folder)
        self.process = subprocess.Popen(
            [
                str(executable_file('recorder')),
                '--ros-args',
                *('-p', f'folder:={folder}'),
                *arguments,
            ],
            env={**os.environ, 'ROS_DOMAIN_ID': str(graph.domain)},
            stdout=subprocess.PIPE,
            stderr=subprocess.PIPE,
            text=True,
            **options,
        )
        graph.processes.append(self.process)

    def end(self, number=signal.SIGINT):
        """End it; return its exit code and what it said."""
        self.process.send_signal(number)
        return self.wait()

    def wait(self):
        try:
            _, said = self.process.communicate(timeout=30.0)
        finally:
            self.process.kill()
        return self.process.returncode, said


def file_of(folder):
    return next(Path(folder).glob('*.mcap'))


def by_rosbags(folder):
    """Return all messages by topic, decoded by rosbags, with their bytes."""
    with AnyReader([Path(folder)]) as reader:
        found = {each.topic: [] for each in reader.connections}
        for connection, when, data in reader.messages():
            found[connection.topic].append(
                (when, bytes(data), reader.deserialize(data, connection.msgtype))
            )
    return found


def stamp(message):
    """Return when a message is stamped, ns."""
    return message.header.stamp.sec * 10**9 + message.header.stamp.nanosec


def commands_of(folder):
    """Return when each command that counted came, s, and its twist."""
    return [
        (one.receipt_time, tuple(one.values.tolist()))
        for _, _, inputs in by_rosbags(folder)['/step_inputs']
        for one in inputs.heard
        if one.kind == Kind.COMMAND
    ]


def by_mcap(folder):
    """Return the bytes of all messages by topic, read by mcap's own reader."""
    found = {}
    with file_of(folder).open('rb') as stream:
        for _, channel, message in make_reader(stream, validate_crcs=True).iter_messages():
            found.setdefault(channel.topic, []).append(message.data)
    return found


class Stick:
    """Somebody who commands a resolver, beside whom a recorder listens."""

    def __init__(self, graph, folder, wrist, **parameters):
        self.graph = graph
        self.node = f'{wrist}_resolver'
        self.statuses = graph.listen(WristStatus, 'wrist_status')
        graph.start(Resolver, wrist, require_joint_states=True, **parameters)
        graph.start(JointSimulator)
        self.recorded = Recorded(graph, folder)
        self.commands = graph.publisher(TwistStamped, 'cmd_vel', listeners=2)
        graph.until(lambda: graph.outside.count_subscribers('step_inputs'))
        graph.until(lambda: self.statuses and self.statuses[-1].state != WristStatus.WAITING)
        graph.spin(1.5)  # so that all parameters were said once more

    def turn(self, seconds, p=0.0, q=0.0, r=0.0, x=0.0):
        for _ in range(round(50 * seconds)):
            message = TwistStamped()
            message.header.stamp = self.graph.outside.get_clock().now().to_msg()
            message.twist.angular.x, message.twist.angular.y = p, q
            message.twist.angular.z, message.twist.linear.x = r, x
            self.commands.publish(message)
            self.graph.spin(0.02)

    def end(self):
        self.graph.spin(0.3)
        code, said = self.recorded.end()
        assert code == 0, said


def a_run(folder):
    """Record a run of a three-gimbal wrist, which pitches, rests, and rolls back."""
    graph = Graph()
    try:
        stick = Stick(graph, folder, 'three_gimbal')
        stick.turn(0.8, q=0.4)
        stick.turn(0.4)
        stick.turn(0.4, p=-0.2, r=0.1)
        stick.end()
    finally:
        graph.close()
    return folder


def run(command, *arguments):
    """Return the exit code of a command, and all that it said."""
    done = subprocess.run(
        [str(executable_file(command)), *map(str, arguments)],
        env=os.environ,
        capture_output=True,
        text=True,
        timeout=100.0,
        check=False,
    )
    assert 'Traceback' not in done.stderr, done.stderr
    return done.returncode, done.stdout + done.stderr


def rewrite(source, target, change, topic='/joint_command', space=''):
    """Write a recording again, with other messages on a topic: index and data to data."""
    with source.open('rb') as stream, target.open('wb') as new:
        writer = Writer(new)
        writer.start('ros2')
        schemas, channels, index = {}, {}, 0
        for schema, channel, message in make_reader(stream).iter_messages():
            if schema.id not in schemas:
                schemas[schema.id] = writer.register_schema(
                    schema.name, schema.encoding, schema.data
                )
            if channel.id not in channels:
                channels[channel.id] = writer.register_channel(
                    space + channel.topic, 'cdr', schemas[schema.id], channel.metadata
                )
            data = message.data
            if channel.topic == topic:
                data = change(index, data)
                index += 1
            writer.add_message(channels[channel.id], message.log_time, data, message.publish_time)
        writer.finish()
