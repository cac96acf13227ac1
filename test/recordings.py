"""Recordings that tests make: the recorder as a process, and independent readers of its files."""

import os
import signal
import subprocess
from pathlib import Path

from mcap.reader import make_reader
from rosbags.highlevel import AnyReader

from wrist_control.graph.processes import executable_file


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


def by_mcap(folder):
    """Return the bytes of all messages by topic, read by mcap's own reader."""
    found = {}
    with file_of(folder).open('rb') as stream:
        for _, channel, message in make_reader(stream, validate_crcs=True).iter_messages():
            found.setdefault(channel.topic, []).append(message.data)
    return found
