"""A console in a process of its own, and browsers in front of it, for the tests."""

import os
import re
import signal
import socket
import subprocess
import threading
import time
import uuid
from pathlib import Path

import pytest
from rclpy.qos import QoSProfile

from wrist_control.web.served import BROWSER, FLAGS, MISSING, console_command
from wrist_interfaces.msg import WristStatus

# The hand is at rest so long after the stick was let go, s, however it was.
REST = 0.6
WARNINGS_OF_GRAPHICS = ('GPU stall', 'GL Driver Message')


class Console:
    """A console's process, and what its first wrist says.

    Attributes:
        address: Where its page is.
        statuses: Every status of the wrist, with the time of its step, s, on the system's clock.
    """

    def __init__(self, graph, environment, **parameters):
        self.graph = graph
        self.process = subprocess.Popen(
            console_command(**parameters),
            env={**environment, 'ROS_DOMAIN_ID': str(graph.domain)},
            stderr=subprocess.PIPE,
            text=True,
        )
        self.said = []
        self._reader = threading.Thread(target=self._read, daemon=True)
        self._reader.start()
        self.statuses = []
        graph.outside.create_subscription(
            WristStatus, 'wrist_status', self._hear, QoSProfile(depth=1000)
        )
        graph.until(lambda: 'Ready' in ''.join(self.said) or self.process.poll() is not None)
        found = re.search(r'http://\S+', ''.join(self.said))
        assert found, self.said
        self.address = found[0]

    def _read(self):
        self.said.extend(self.process.stderr)

    def _hear(self, message):
        stamp = message.header.stamp
        self.statuses.append((stamp.sec + 1e-9 * stamp.nanosec, message))

    def until(self, state):
        """Wait until the wrist is in a state."""
        self.graph.until(lambda: self.statuses and self.statuses[-1][1].state == state, 30.0)

    def until_moving(self, since=None):
        """Wait until the hand moves after a moment, by default now; return its rates."""
        since = time.time() if since is None else since
        self.graph.until(lambda: self.statuses and self.moves(*self.statuses[-1], since), 30.0)
        return self.rates(self.statuses[-1][1])

    @staticmethod
    def rates(status):
        """Return p, q, r that the hand makes."""
        angular = status.achieved.angular
        return angular.x, angular.y, angular.z

    def moves(self, stamp, status, since):
        """Return whether the hand moved in a step that was made after a moment."""
        return stamp > since and any(self.rates(status))

    def watch(self, seconds):
        """Wait until what the wrist does in so long from now on has been heard."""
        end = time.time() + seconds
        self.graph.until(lambda: self.statuses and self.statuses[-1][0] >= end, 30.0 + seconds)

    def rests(self, since, spin=1.5):
        """Assert that the hand is at rest from `REST` after a moment on, for a while."""
        self.watch(max(0.0, since + REST - time.time()) + spin)
        later = [one for one in self.statuses if one[0] > since + REST]
        assert len(later) > 5
        moving = [round(t - since, 2) for t, status in later if self.moves(t, status, 0.0)]
        assert moving == [], f'it moved {moving} s after it was let go'

    def end(self, number=signal.SIGINT):
        """End it by a signal; return the exit code and what it said."""
        if self.process.poll() is None:
            self.process.send_signal(number)
        code = self.process.wait(20.0)
        self._reader.join(5.0)
        return code, ''.join(self.said)


class Browser:
    """A Chromium of a test's own.

    Attributes:
        problems: What its pages have complained of.
    """

    def __init__(self, playwright, mark):
        own = uuid.uuid4().hex
        self._mark = f'{mark}={own}'.encode()
        self._browser = playwright.chromium.launch(
            executable_path=BROWSER, args=FLAGS, env={**os.environ, mark: own}
        )
        self.problems = []

    def leave(self):
        """Close every page, for the next test."""
        for context in self._browser.contexts:
            context.close()

    def open(self, address, **options):
        """Return a page that shows an address, ready to be used.

        What is tried here is whether the stick is held: a page without pictures is fast enough
        for that on any machine.
        """
        return self._opened(f'{address}/?plain', **options)

    def open_whole(self, address, **options):
        """Return a page with its pictures."""
        page = self._opened(address, **options)
        page.wait_for_function('document.querySelector("canvas")')
        return page

    def _opened(self, address, **options):
        options = {'viewport': {'width': 1280, 'height': 720}, **options}
        page = self._browser.new_context(**options).new_page()
        page.on('console', self._note)
        page.on('pageerror', lambda error: self.problems.append(str(error)))
        page.goto(address)
        page.wait_for_selector('.pad')
        page.wait_for_function('window.socket?.connected')
        page.locator('.state:not([data-state=NOBODY])[data-state]').wait_for()
        return page

    def _note(self, message):
        of_graphics = any(words in message.text for words in WARNINGS_OF_GRAPHICS)
        if message.type in ('error', 'warning') and not of_graphics:
            self.problems.append(message.text)

    def signal(self, number):
        """Send a signal to all of its processes; the first has the mark, others came of it."""
        parents, own = {}, set()
        for folder in Path('/proc').glob('[0-9]*'):
            try:
                parents[int(folder.name)] = int((folder / 'stat').read_text().split()[-49])
                if self._mark in (folder / 'environ').read_bytes().split(b'\0'):
                    own.add(int(folder.name))
            except OSError:
                continue  # it has ended, or is somebody else's
        while more := {child for child, parent in parents.items() if parent in own} - own:
            own |= more
        for process in own:
            os.kill(process, number)

    def close(self):
        self._browser.close()


def press(page, across=0.5, up=0.85):
    """Take the pad and hold it, at a share of its width and height."""
    box = page.locator('.pad').bounding_box()
    page.mouse.move(box['x'] + 0.5 * box['width'], box['y'] + 0.5 * box['height'])
    page.mouse.down()
    page.mouse.move(box['x'] + across * box['width'], box['y'] + (1.0 - up) * box['height'])


class Forwarder:
    """What stands between a browser and a console, and can be cut.

    Attributes:
        port: Where the browser finds it.
    """

    def __init__(self, port):
        self._target = port
        self.passes = threading.Event()
        self.passes.set()
        self._listening = socket.create_server(('127.0.0.1', 0))
        self.port = self._listening.getsockname()[1]
        self._open = []
        threading.Thread(target=self._accept, daemon=True).start()

    def _accept(self):
        while True:
            try:
                near, _ = self._listening.accept()
            except OSError:
                return
            far = socket.create_connection(('127.0.0.1', self._target))
            self._open += [near, far]
            for one, other in ((near, far), (far, near)):
                threading.Thread(target=self._pass_on, args=(one, other), daemon=True).start()

    def _pass_on(self, one, other):
        try:
            while data := one.recv(65536):
                self.passes.wait()
                other.sendall(data)
            other.shutdown(socket.SHUT_WR)
        except OSError:
            return

    def break_off(self):
        """Close every connection that there is."""
        for one in self._open:
            with_reset = b'\1\0\0\0\0\0\0\0'
            one.setsockopt(socket.SOL_SOCKET, socket.SO_LINGER, with_reset)
            one.close()
        self._open.clear()

    def close(self):
        self._listening.close()
        self.passes.set()
        self.break_off()


needs_browser = pytest.mark.skipif(BROWSER is None, reason=f'the page is not tried: {MISSING}')
