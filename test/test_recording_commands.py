"""What people do with recordings: replay, report and operator, of good ones and of bad ones."""

import re
import shutil
import signal
import subprocess
import time
from itertools import pairwise

import pytest
from geometry_msgs.msg import TwistStamped
from rosbags.rosbag2 import StoragePlugin
from rosbags.rosbag2 import Writer as Rosbag2Writer
from rosbags.typesys import Stores, get_typestore

from wrist_control.graph.processes import executable_file
from wrist_control.nodes.operator import Operator
from wrist_control.ros.convert import twist_values

from .recordings import Stick, a_run, commands_of, file_of, rewrite, run

COMMANDS = ('replay', 'report')


@pytest.fixture(scope='module')
def good(tmp_path_factory):
    return a_run(tmp_path_factory.mktemp('recorded') / 'run')


def strangers(folder, plugin=StoragePlugin.MCAP):
    """Write a recording of somebody else's robot."""
    store = get_typestore(Stores.ROS2_JAZZY)
    text = store.types['std_msgs/msg/String']
    with Rosbag2Writer(folder, version=9, storage_plugin=plugin) as writer:
        topic = writer.add_connection('/chatter', text.__msgtype__, typestore=store)
        writer.write(topic, 1, store.serialize_cdr(text(data='hello'), text.__msgtype__))
    return folder


def not_there(folder, _):
    return folder / 'nothing'


def no_files(folder, _):
    return folder


def empty_file(folder, _):
    (folder / 'run_0.mcap').touch()
    return folder


def some_text(folder, _):
    (folder / 'notes.txt').write_text('pitch, then roll')
    return folder / 'notes.txt'


def of_another_robot(folder, _):
    return strangers(folder / 'theirs')


def in_sqlite(folder, _):
    return strangers(folder / 'theirs', StoragePlugin.SQLITE3)


def cut_at_once(folder, good):
    (folder / 'run_0.mcap').write_bytes(file_of(good).read_bytes()[:60])
    return folder


def of_an_unknown_wrist(folder, good):
    def other(_, data):
        return data.replace(b'"wrist": "three_gimbal"', b'"wrist": "three_cymbal"')

    rewrite(file_of(good), folder / 'run_0.mcap', other, '/step_inputs')
    return folder


BAD = [
    (not_there, 'nothing is not there; valid is the folder of a recording in MCAP'),
    (no_files, 'has no .mcap file in it; valid is'),
    (empty_file, 'run_0.mcap is empty; valid is'),
    (some_text, 'notes.txt is no recording: it does not begin as MCAP; valid is'),
    (of_another_robot, 'theirs holds no message that is looked for; its topics are /chatter.'),
    (in_sqlite, 'theirs is a recording in sqlite3, which is not read; `rosbags-convert'),
    (cut_at_once, 'is cut off or damaged after '),
]
UNKNOWN = "is of the wrist 'three_cymbal', which is not known here; the wrists are "


@pytest.mark.parametrize('command', COMMANDS)
@pytest.mark.parametrize(('make', 'sentence'), [*BAD, (of_an_unknown_wrist, UNKNOWN)])
def test_what_is_no_run_is_refused_in_a_sentence(tmp_path, good, command, make, sentence):
    code, said = run(command, make(tmp_path, good))
    assert code == 2
    assert said.strip().startswith(f'Cannot {command}: {tmp_path}')
    assert sentence in said
    assert len(said.strip().splitlines()) == 1
    assert not list(tmp_path.glob('*.html'))


@pytest.mark.parametrize(('make', 'sentence'), BAD)
def test_the_operator_does_not_start_with_what_is_no_run(
    process_environment, tmp_path, good, make, sentence
):
    arguments = ['-p', 'maneuver:=recording', '-p', f'recording:={make(tmp_path, good)}']
    done = subprocess.run(
        [str(executable_file('operator')), '--ros-args', *arguments],
        env=process_environment,
        capture_output=True,
        text=True,
        timeout=60.0,
        check=False,
    )
    assert done.returncode == 2
    assert 'Cannot start: ' in done.stderr
    assert sentence in done.stderr
    assert 'Traceback' not in done.stderr


@pytest.mark.parametrize('command', COMMANDS)
def test_one_that_is_cut_off_is_used_up_to_the_cut(tmp_path, good, command):
    data = file_of(good).read_bytes()
    (tmp_path / 'run_0.mcap').write_bytes(data[: round(0.6 * len(data))])
    code, said = run(command, tmp_path)
    assert code == 0, said
    assert f'{tmp_path}/run_0.mcap is cut off or damaged after ' in said + page_of(tmp_path)
    whole, part = run('replay', good)[1], run('replay', tmp_path)[1]
    assert 50 < steps_of(part) < steps_of(whole)


def steps_of(said):
    return int(re.search(r'Made (\d+) of', said)[1])


def page_of(folder):
    file = folder.with_suffix('.html')
    return file.read_text() if file.exists() else ''


@pytest.mark.parametrize('command', COMMANDS)
def test_one_that_is_damaged_in_the_middle_is_used_up_to_there(tmp_path, good, command):
    data = bytearray(file_of(good).read_bytes())
    data[len(data) // 2 : len(data) // 2 + 500] = bytes(500)
    (tmp_path / 'run_0.mcap').write_bytes(data)
    code, said = run(command, tmp_path)
    assert code == 0, said


def test_of_several_wrists_one_must_be_chosen(tmp_path, good):
    two = tmp_path / 'two'
    two.mkdir()
    shutil.copy(file_of(good), two / 'run_0.mcap')
    rewrite(file_of(good), two / 'run_1.mcap', lambda _, data: data, space='/left')
    code, said = run('replay', two)
    assert code == 2
    assert 'has the wrists of /, /left/; choose one of them with --namespace.' in said
    assert run('replay', two, '--namespace', '/left')[0] == 0
    assert run('replay', two, '--namespace', 'right')[0] == 2


@pytest.mark.parametrize('command', COMMANDS)
def test_help_says_what_it_does(command):
    code, said = run(command, '--help')
    assert code == 0
    assert f'usage: {command} [-h] ' in said
    assert '--namespace' in said


@pytest.mark.parametrize('command', COMMANDS)
def test_ctrl_c_ends_it_without_a_traceback(good, command):
    running = subprocess.Popen(
        [str(executable_file(command)), str(good)],
        stdout=subprocess.PIPE,
        stderr=subprocess.PIPE,
        text=True,
        preexec_fn=lambda: signal.signal(signal.SIGINT, signal.default_int_handler),
        start_new_session=True,
    )
    time.sleep(0.9)
    running.send_signal(signal.SIGINT)
    said = ''.join(running.communicate(timeout=30.0))
    assert 'Traceback' not in said
    assert running.returncode in (0, 130)


def flown(graph, folder):
    """Return (vx, vy, vz, p, q, r) at each of fifty ticks a second, until all is flown."""
    clock = graph.lockstep(1.0 / 50.0)
    chosen = {'maneuver': 'recording', 'recording': str(folder), 'namespace': 'again'}
    graph.start(Operator, use_sim_time=True, rate=50.0, **chosen)
    clock.listen({'again/cmd_vel': TwistStamped})
    clock.begin()
    given = commands_of(folder)
    for _ in range(round(50.0 * (given[-1][0] - given[0][0])) + 75):
        clock.tick()
    return [twist_values(one.twist) for one in clock.heard['again/cmd_vel']]


def test_the_operator_gives_the_recorded_commands_again(graph, good):
    asked = flown(graph, good)
    still = (0.0,) * 6
    moving = [one for one in asked if one != still]
    turned = {one: moving.count(one) for one in moving}
    pitch, roll = (0.0, 0.0, 0.0, 0.0, 0.4, 0.0), (0.0, 0.0, 0.0, -0.2, 0.0, 0.1)
    assert list(turned) == [pitch, roll]
    assert moving == [pitch] * turned[pitch] + [roll] * turned[roll]
    assert asked[-1] == still
    held = [when for when, twist in commands_of(good) if twist == pitch]
    assert turned[pitch] / 50.0 == pytest.approx(held[-1] - held[0], abs=0.3)


def test_the_operator_travels_too_and_holds_a_last_command_as_long_as_the_resolver_did(
    graph, tmp_path
):
    stick = Stick(graph, tmp_path / 'run', 'stewart', command_timeout=0.4)
    stick.turn(0.4, x=0.02)
    graph.spin(1.0)
    stick.turn(0.2, x=-0.02)
    stick.end()
    times = [when for when, twist in commands_of(tmp_path / 'run') if twist[0] == 0.02]
    held = sum(min(b - a, 0.4) for a, b in pairwise(times)) + 0.4
    travels = [one[0] for one in flown(graph, tmp_path / 'run')]
    assert travels.count(0.02) / 50.0 == pytest.approx(held, abs=0.1)
    last = len(travels) - 1 - travels[::-1].index(0.02)
    assert travels.index(-0.02) > last + 10
    assert travels[-1] == 0.0
