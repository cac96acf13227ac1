"""A person at a terminal: a pseudo-terminal with the keyboard's executable in it."""

import fcntl
import os
import pty
import re
import select
import signal
import struct
import subprocess
import termios
import threading
import time

ENTERED, LEFT = '\x1b[?1049h', '\x1b[?1049l'
REPEAT = 1.0 / 30.0
ESCAPES = re.compile(r'\x1b\[[0-?]*[ -/]*[@-~]')


class Typist:
    """Types keys to an executable that has a terminal of its own.

    Attributes:
        process: The executable.
        written: Everything that it wrote to the terminal.
        last_key: When the last key was typed, s since the epoch.
    """

    def __init__(self, environment, command, size=(24, 80), stderr=subprocess.PIPE, folder=None):
        self.person, self.terminal = pty.openpty()
        self.resize(*size)
        self.found = self.attributes()
        self.process = subprocess.Popen(
            command,
            env=environment,
            cwd=folder,
            stdin=self.terminal,
            stdout=self.terminal,
            stderr=self.terminal if stderr is None else stderr,
            preexec_fn=self._make_it_ours,
            text=True,
        )
        self.written = ''
        self.last_key = 0.0
        self._held = ''
        self._closed = False
        self._works = [threading.Thread(target=work) for work in (self._listen, self._repeat)]
        for work in self._works:
            work.start()

    @staticmethod
    def _make_it_ours():
        os.setsid()
        fcntl.ioctl(0, termios.TIOCSCTTY, 0)

    def attributes(self):
        """Return how the terminal is set, as far as a program sets it."""
        return termios.tcgetattr(self.terminal)

    def resize(self, rows, columns):
        fcntl.ioctl(self.terminal, termios.TIOCSWINSZ, struct.pack('4H', rows, columns, 0, 0))

    def type(self, text):
        self.last_key = time.time()
        os.write(self.person, text.encode())

    def hold(self, key):
        """Hold a key down, until `release`: it comes once, and repeats."""
        self._held = key

    def release(self):
        self._held = ''

    def page(self):
        """Return the lines of the page that was shown last."""
        return ESCAPES.sub('', self.written.rpartition('\x1b[H')[2]).split('\r\n')

    def has_left(self):
        """Return whether the last page was left again; what is typed then is echoed."""
        return LEFT in self.written.rpartition(ENTERED)[2]

    def is_stopped(self):
        with open(f'/proc/{self.process.pid}/stat') as stat:
            return stat.read().rpartition(')')[2].split()[0] == 'T'

    def hang_up(self):
        """Close the terminal as its window does."""
        self._closed = True
        for work in self._works:
            work.join()
        os.close(self.terminal)
        os.close(self.person)

    def close(self):
        self.release()
        if self.process.poll() is None:
            for number in (signal.SIGCONT, signal.SIGTERM):
                self.process.send_signal(number)
        try:
            self.process.wait(10.0)
        except subprocess.TimeoutExpired:
            self.process.kill()
            self.process.wait()
        if not self._closed:
            self.hang_up()

    def _listen(self):
        while not self._closed:
            if select.select([self.person], [], [], 0.05)[0]:
                self.written += os.read(self.person, 4096).decode(errors='replace')

    def _repeat(self):
        while not self._closed:
            if held := self._held:
                self.type(held)
            time.sleep(REPEAT)
