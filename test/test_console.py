"""The console's page, in a real browser before a real graph: what it shows and what it moves."""

import math
import signal
import subprocess
import time
from pathlib import Path

import pytest
from ament_index_python.packages import get_package_share_directory

from wrist_control.graph.processes import executable_file
from wrist_interfaces.msg import WristStatus

from .console_stage import Console, needs_browser, press


@pytest.fixture
def start(graph, process_environment):
    """Start a console; it is ended with the test."""
    made = []

    def begin(**parameters):
        made.append(Console(graph, process_environment, **parameters))
        return made[-1]

    yield begin
    for console in made:
        console.end(signal.SIGKILL)


@pytest.fixture
def browser(browser):
    """A browser whose pages must not complain of anything."""
    yield browser
    browser.leave()
    assert browser.problems == []


def held_until_moving(console, hold, let_go):
    """Hold something, again where a slow page loses it; return the steady rates of the hand."""
    for _ in range(20):
        hold()
        for _ in range(10):
            console.watch(0.2)
            last = [console.rates(status) for _, status in console.statuses[-10:]]
            if any(last[0]) and all(one == pytest.approx(last[0], abs=1e-6) for one in last):
                let_go()
                console.rests(time.time(), spin=0.5)
                return last[-1]
        let_go()
    raise AssertionError(f'no steady rate: {last}, {console.statuses[-1][1].message}')


@needs_browser
@pytest.mark.parametrize(
    ('key', 'axis', 'sign'),
    [('w', 1, 1), ('s', 1, -1), ('d', 0, 1), ('a', 0, -1), ('q', 2, 1), ('e', 2, -1)],
)
def test_every_key_turns_about_its_axis_alone(start, browser, key, axis, sign):
    console = start()
    page = browser.open(console.address)
    rates = held_until_moving(
        console, lambda: page.keyboard.down(key), lambda: page.keyboard.up(key)
    )
    expected = [0.0, 0.0, 0.0]
    expected[axis] = sign * math.radians(32.0)
    assert rates == pytest.approx(expected, abs=1e-6)


@needs_browser
def test_the_pad_and_the_slide_turn_by_how_far_they_are_pushed(start, browser):
    console = start()
    page = browser.open(console.address)
    p, q, r = held_until_moving(
        console, lambda: press(page, across=0.5 + 0.19, up=0.5), page.mouse.up
    )
    assert (q, r) == pytest.approx((0.0, 0.0), abs=1e-6)
    assert p == pytest.approx(math.radians(16.0), rel=0.03)
    slide = page.locator('.slide').bounding_box()

    def push():
        page.mouse.move(slide['x'] + 2.0, slide['y'] + 0.5 * slide['height'])
        page.mouse.down()

    assert held_until_moving(console, push, page.mouse.up)[2] == pytest.approx(
        math.radians(32.0), abs=1e-6
    )


GAMEPAD = """
window.pad = {mapping: 'standard', axes: [0, 0, 0, 0],
              buttons: Array.from({length: 17}, () => ({pressed: false}))};
navigator.getGamepads = () => [window.pad];
"""


@needs_browser
def test_a_gamepad_drives_only_while_its_shoulder_button_is_held(start, browser):
    console = start()
    page = browser.open(console.address)
    page.evaluate(f'() => {{{GAMEPAD}}}')
    page.evaluate('pad.axes = [0, -1, 0, 0]')
    console.rests(time.time(), spin=0.5)
    rates = held_until_moving(
        console,
        lambda: page.evaluate('pad.buttons[5].pressed = true'),
        lambda: page.evaluate('pad.buttons[5].pressed = false'),
    )
    assert rates == pytest.approx((0.0, math.radians(32.0), 0.0), abs=1e-6)


@needs_browser
def test_a_maneuver_is_flown_while_its_button_is_held(start, browser):
    console = start(speed=1.5)
    page = browser.open(console.address)
    fly = page.locator('.fly').bounding_box()
    page.mouse.move(fly['x'] + 20.0, fly['y'] + 20.0)
    held = held_until_moving(console, page.mouse.down, page.mouse.up)
    assert held[1] > 0.0  # it pitches first
    assert held[0] == held[2] == 0.0


@needs_browser
def test_another_wrist_is_chosen_and_one_beside_it(start, browser):
    console = start()
    page = browser.open_whole(console.address)
    page.get_by_label('Beside it').click()
    page.get_by_role('option', name='double_hooke', exact=True).click()
    page.locator('.card.second .figures').get_by_text('double_hooke').wait_for()
    page.get_by_label('Wrist', exact=True).click()
    page.get_by_role('option', name='carpal', exact=True).click()
    page.locator('.card .figures').get_by_text('carpal').wait_for()
    console.until(WristStatus.IDLE)
    assert held_until_moving(console, lambda: press(page), page.mouse.up)[1] > 0.0
    figures = page.locator('.card .figures').all_inner_texts()
    assert all('s late' in text for text in figures)
    assert any('★' in text for text in figures)


def drag(page, slider, share):
    """Put a slider to a share of its way."""
    box = slider.bounding_box()
    page.mouse.click(box['x'] + share * box['width'], box['y'] + 0.5 * box['height'])


@needs_browser
def test_a_limit_and_the_speed_are_set_from_the_page(start, browser):
    console = start()
    page = browser.open(console.address)
    speed, limit = (page.get_by_role('slider').nth(index) for index in range(2))
    for slider in (speed, limit):
        drag(page, slider, 0.0)
    page.locator('.value').get_by_text('5 %').wait_for()
    page.locator('.value').get_by_text('1 deg/s').wait_for()
    rates = held_until_moving(
        console, lambda: page.keyboard.down('w'), lambda: page.keyboard.up('w')
    )
    assert rates[1] == pytest.approx(math.radians(1.0), abs=1e-6)
    page.get_by_label('Wrist', exact=True).click()
    page.get_by_role('option', name='four_gimbal', exact=True).click()
    page.locator('.card .figures').get_by_text('four_gimbal').wait_for()
    drag(page, speed, 0.98)
    rates = held_until_moving(
        console, lambda: page.keyboard.down('w'), lambda: page.keyboard.up('w')
    )
    assert rates[1] == pytest.approx(math.radians(0.05 * 32.0), abs=1e-6)


@needs_browser
@pytest.mark.parametrize('size', [(1280, 720), (390, 844)])
def test_nothing_jumps_when_the_text_changes(start, browser, size):
    console = start()
    page = browser.open_whole(console.address, viewport={'width': size[0], 'height': size[1]})
    parts = ['.top', '.saying', '.scenes', '.controls', 'section.strips', '.stop']
    boxes = [page.locator(part).bounding_box() for part in parts]
    page.evaluate("document.querySelector('.sentence').textContent = 'A long word. '.repeat(60)")
    page.evaluate("document.querySelector('.who').textContent = 'Somebody '.repeat(60)")
    assert [page.locator(part).bounding_box() for part in parts] == boxes
    assert page.evaluate('document.documentElement.scrollWidth') <= size[0]
    if size[0] == 1280:
        assert page.evaluate('document.documentElement.scrollHeight') <= size[1]


PANDA = Path(get_package_share_directory('wrist_control')) / 'urdf' / 'panda.urdf'


@needs_browser
@pytest.mark.parametrize(
    ('resolver', 'parameters', 'name'),
    [
        ('pitch_yaw_resolver', {}, 'pitch_yaw'),
        ('urdf_resolver', {'robot_description': PANDA, 'tip_link': 'panda_link8'}, 'urdf'),
    ],
)
def test_it_joins_the_graph_that_is_there(
    start, browser, graph, process_environment, resolver, parameters, name
):
    environment = {**process_environment, 'ROS_DOMAIN_ID': str(graph.domain)}
    given = [part for item in parameters.items() for part in ('-p', '{}:={}'.format(*item))]
    commands = ([resolver, '--ros-args', *given], ['joint_simulator'])
    nodes = [
        subprocess.Popen([str(executable_file(name)), *arguments], env=environment)
        for name, *arguments in commands
    ]
    try:
        console = start(start='none')
        console.until(WristStatus.IDLE)
        page = browser.open_whole(console.address)
        page.locator('.figures').get_by_text(name).wait_for()
        assert page.get_by_label('Beside it').count() == 0
        held_until_moving(console, lambda: press(page), page.mouse.up)
    finally:
        for node in nodes:
            node.terminate()
            node.wait(10.0)


@pytest.mark.parametrize('number', [signal.SIGINT, signal.SIGTERM])
def test_it_ends_at_once_with_all_that_it_has_started(start, own_processes, number):
    console = start(second='carpal')
    console.until(WristStatus.IDLE)
    assert len(own_processes()) == 5
    code, said = console.end(number)
    assert code == 0
    assert 'Traceback' not in said
    assert own_processes() == []


@needs_browser
def test_it_ends_at_once_while_a_page_is_open(start, browser):
    console = start()
    page = browser.open(console.address)
    code, said = console.end()
    assert code == 0
    assert 'Traceback' not in said
    page.close()
    browser.problems.clear()  # that its server is gone


def test_even_a_killed_console_leaves_nothing_running(start, own_processes, graph):
    console = start()
    console.until(WristStatus.IDLE)
    console.end(signal.SIGKILL)
    graph.until(lambda: own_processes() == [])


@pytest.mark.parametrize(
    ('parameters', 'words'),
    [
        ({'host': 'nowhere'}, "host is 'nowhere'; give an address of this machine"),
        ({'host': '203.0.113.1'}, 'cannot be served at 203.0.113.1'),
        ({'start': 'elbow'}, 'start is'),
        ({'start': 'none', 'second': 'carpal'}, 'give start too'),
    ],
)
def test_what_cannot_be_served_is_said(process_environment, parameters, words):
    given = [part for item in parameters.items() for part in ('-p', '{}:={}'.format(*item))]
    done = subprocess.run(
        [str(executable_file('console')), '--ros-args', *given],
        env=process_environment,
        capture_output=True,
        text=True,
        check=False,
        timeout=60.0,
    )
    assert done.returncode == 2
    assert 'Cannot start: ' in done.stderr
    assert words in done.stderr
    assert 'Traceback' not in done.stderr


def test_a_port_that_is_taken_is_said(start, process_environment):
    console = start()
    port = console.address.rpartition(':')[2]
    done = subprocess.run(
        [str(executable_file('console')), '--ros-args', '-p', f'port:={port}'],
        env=process_environment,
        capture_output=True,
        text=True,
        check=False,
        timeout=60.0,
    )
    assert done.returncode == 2
    assert 'choose another port' in done.stderr
