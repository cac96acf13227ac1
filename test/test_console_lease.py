"""Whatever becomes of the page that holds the stick, the hand comes to rest and stays there."""

import signal
import time
from urllib.error import HTTPError
from urllib.request import Request, urlopen

import pytest

from wrist_interfaces.msg import WristStatus

from .console_stage import Console, Forwarder, needs_browser, press

pytestmark = needs_browser


@pytest.fixture
def console(graph, process_environment):
    made = Console(graph, process_environment)
    made.until(WristStatus.IDLE)
    yield made
    made.end()


@pytest.fixture
def page(console, browser):
    """A page whose stick is held, and whose hand moves."""
    opened = browser.open(console.address)
    take(console, opened)
    return opened


def take(console, page):
    """Press the pad until the hand moves: the first time a slow browser may be too late."""
    for _ in range(5):
        page.mouse.up()
        since = time.time()
        press(page)
        console.watch(1.0)
        if any(console.moves(*one, since) for one in console.statuses):
            return
    raise AssertionError('the hand never moved')


def hide(page):
    page.evaluate(
        """() => {
        Object.defineProperty(document, 'hidden', {value: true, configurable: true});
        document.dispatchEvent(new Event('visibilitychange'));
        }"""
    )


ENDS = {
    'let go': lambda page: page.mouse.up(),
    'blur': lambda page: page.evaluate('window.dispatchEvent(new Event("blur"))'),
    'hide': hide,
    'close': lambda page: page.close(),
    'navigate away': lambda page: page.goto('about:blank'),
    'reload': lambda page: page.reload(),
}


@pytest.mark.parametrize('how', ENDS)
def test_whoever_leaves_the_page_has_let_go(console, page, how):
    since = time.time()
    ENDS[how](page)
    console.rests(since)


@pytest.mark.parametrize('how', ['blur', 'hide'])
def test_what_is_still_pressed_counts_only_when_it_is_pressed_anew(console, page, how):
    ENDS[how](page)
    since = time.time()
    page.mouse.move(600.0, 500.0)
    console.rests(since)
    page.evaluate("Object.defineProperty(document, 'hidden', {value: false})")
    take(console, page)


def test_a_browser_that_is_stopped_holds_nothing_and_nothing_comes_late(console, browser, page):
    browser.signal(signal.SIGSTOP)
    since = time.time()
    try:
        console.rests(since)
    finally:
        since = time.time() - 0.6  # from now on: it rests already
        browser.signal(signal.SIGCONT)
    console.rests(since, spin=2.0)
    take(console, page)


def test_a_server_that_is_stopped_moves_nothing_and_does_not_go_on(console, page):
    since = time.time()
    console.process.send_signal(signal.SIGSTOP)
    try:
        console.rests(since)
    finally:
        since = time.time() - 0.6
        console.process.send_signal(signal.SIGCONT)
    console.rests(since, spin=2.0)
    take(console, page)


@pytest.fixture
def forwarder(console):
    made = Forwarder(int(console.address.rpartition(':')[2]))
    yield made
    made.close()


@pytest.fixture
def distant(console, browser, forwarder):
    """A page beyond a connection that can be cut, whose stick is held."""
    opened = browser.open(f'http://127.0.0.1:{forwarder.port}')
    take(console, opened)
    return opened


def test_what_a_stalled_connection_delivers_later_moves_nothing(console, distant, forwarder):
    since = time.time()
    forwarder.passes.clear()
    console.rests(since, spin=0.5)
    distant.mouse.move(620.0, 560.0)
    since = time.time() - 0.6
    forwarder.passes.set()
    console.rests(since, spin=2.0)
    take(console, distant)


def test_a_connection_that_breaks_and_is_made_again_moves_nothing(console, distant, forwarder):
    since = time.time()
    forwarder.break_off()
    console.rests(since, spin=3.0)
    distant.wait_for_function('window.socket?.connected')
    take(console, distant)


def test_one_page_drives_and_the_other_looks(console, browser, page):
    other = browser.open(console.address)
    told = other.get_by_text('Another page holds the stick')
    for _ in range(5):  # a slow browser may lose the stick again
        take(console, page)
        console.watch(0.3)
        if told.is_visible():
            break
    press(other, up=0.15)
    console.watch(0.5)
    assert not any(status.achieved.angular.y < 0.0 for _, status in console.statuses)
    since = time.time()
    page.mouse.up()
    console.rests(since)
    since = time.time()
    press_again(console, other)
    assert console.until_moving(since)[1] < 0.0


def press_again(console, page):
    page.mouse.up()
    console.watch(0.3)
    press(page, up=0.15)


def test_stop_works_while_the_stick_is_held_and_after_it(console, page):
    page.keyboard.press('Space')
    console.until(WristStatus.DISABLED)
    page.mouse.up()
    since = time.time()
    press(page)
    console.rests(since)
    page.mouse.up()
    page.get_by_role('button', name='Enable').click()
    console.until(WristStatus.IDLE)
    take(console, page)


def test_stop_works_where_the_connection_of_the_page_is_gone(console, browser):
    page = browser.open(console.address)
    page.evaluate('window.socket.disconnect()')
    page.locator('button.stop').dispatch_event('pointerdown')
    console.until(WristStatus.DISABLED)


def test_anybody_who_looks_can_stop_who_drives(console, browser, page):
    other = browser.open(console.address)
    other.locator('button.stop').click()
    console.until(WristStatus.DISABLED)
    page.locator('.state[data-state=DISABLED]').wait_for()


def test_a_page_of_somebody_elses_is_not_served(console):
    """Neither by a name that leads here nor from another origin."""
    port = console.address.rpartition(':')[2]
    for path, header, value in (
        ('', 'Host', f'evil.example:{port}'),
        ('/_nicegui_ws/socket.io/?EIO=4&transport=polling', 'Origin', 'http://evil.example'),
    ):
        with pytest.raises(HTTPError, match='400'):
            urlopen(Request(console.address + path, headers={header: value}))
