"""docs/first-steps.md, to the letter: every command is run, and shows what the page says."""

import shlex
import signal
import subprocess
import time
from pathlib import Path

import pytest

from .documents import FIRST_STEPS, ROOT, blocks, printed


class Terminal:
    """One command of the page, and all that it has printed."""

    def __init__(self, command, log, environment):
        self._log = log
        self._seen = 0
        with log.open('w') as output:
            self.process = subprocess.Popen(
                shlex.split(command), cwd=ROOT, env=environment, stdout=output, stderr=output
            )

    def turn_page(self):
        """Look from here on at what is printed later."""
        self._seen = len(self._log.read_text())

    @property
    def page(self):
        return self._log.read_text()[self._seen :]

    def shows(self, pattern):
        return pattern.search(self.page)

    def end(self):
        if self.process.poll() is None:
            self.process.send_signal(signal.SIGTERM)
        assert self.process.wait(timeout=20.0) == 0, self._log.read_text()


def wait_until_shown(shown, terminals, limit=60.0):
    end = time.monotonic() + limit
    while not any(terminal.shows(printed(shown)) for terminal in terminals):
        assert time.monotonic() < end, '\n---\n'.join([shown, *(t.page for t in terminals)])
        time.sleep(0.1)


@pytest.mark.timeout(400)
def test_every_step_shows_what_the_page_says(process_environment, tmp_path):
    terminals = {}
    try:
        for language, content in blocks(FIRST_STEPS, 'sh', 'output'):
            if language == 'output':
                wait_until_shown(content, terminals.values())
            elif not content.startswith('make '):
                name = next(word for word in content.split()[1:] if word != 'python')
                if name in terminals:
                    terminals[name].end()
                for terminal in terminals.values():
                    terminal.turn_page()
                log = tmp_path / f'{Path(name).stem}.txt'
                terminals[name] = Terminal(content, log, process_environment)
        assert len(terminals) == 6
        for terminal in terminals.values():
            terminal.end()
    finally:
        for terminal in terminals.values():
            terminal.process.kill()


def test_a_block_that_shows_something_else_is_found():
    assert printed('a\n…\nb … c\n').search('x\na\n1\n2\nb 3 c\n')
    assert not printed('a\nb\n').search('a\n1\nb\n')
    assert not printed('a\n').search('ba\n')
