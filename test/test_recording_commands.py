"""What people do with recordings: replay, report and operator, of good ones and of bad ones."""

import html.parser
import re
import shutil
import signal
import subprocess
import time

import pytest
from geometry_msgs.msg import TwistStamped
from rosbags.rosbag2 import StoragePlugin
from rosbags.rosbag2 import Writer as Rosbag2Writer
from rosbags.typesys import Stores, get_typestore

from wrist_control.graph.processes import executable_file
from wrist_control.nodes.operator import Operator

from .conftest import Graph
from .recordings import Stick, by_rosbags, file_of, rewrite, run

COMMANDS = ('replay', 'report')


@pytest.fixture(scope='module')
def good(tmp_path_factory):
    """Return a folder with a run of a three-gimbal wrist: it pitches, rests, and rolls back."""
    graph, folder = Graph(), tmp_path_factory.mktemp('recorded') / 'run'
    try:
        stick = Stick(graph, folder, 'three_gimbal')
        stick.turn(0.8, q=0.4)
        stick.turn(0.4)
        stick.turn(0.4, p=-0.2, r=0.1)
        stick.end()
    finally:
        graph.close()
    return folder


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


class Page(html.parser.HTMLParser):
    """What is in a page."""

    def __init__(self, text):
        super().__init__()
        self.tags, self.addresses, self.words, self.open = [], [], [], []
        self.feed(text)

    def handle_starttag(self, tag, attributes):
        self.tags.append(tag)
        if tag not in ('meta', 'img', 'use', 'path', 'br'):
            self.open.append(tag)
        self.addresses += [
            value
            for name, value in attributes
            if name in ('src', 'href', 'xlink:href', 'srcset', 'data', 'action')
        ]

    def handle_endtag(self, tag):
        if tag not in ('meta', 'img', 'use', 'path', 'br'):
            assert self.open.pop() == tag

    def handle_data(self, data):
        self.words.append(data)


def test_a_report_is_one_page_that_loads_nothing(tmp_path, good):
    code, said = run('report', good, '--out', tmp_path / 'pages' / 'run.html')
    assert code == 0, said
    assert f'written: {tmp_path}/pages/run.html' in said
    text = (tmp_path / 'pages' / 'run.html').read_text()
    found = Page(text)
    assert found.open == []
    assert all(one.startswith(('#', 'data:image/png;base64,')) for one in found.addresses)
    assert not {'script', 'link', 'iframe', 'object', 'embed'} & set(found.tags)
    assert 'url(' not in re.sub(r'url\(#\w+', '', text)
    assert '@import' not in text
    assert found.tags.count('svg') == 6
    assert 'prefers-color-scheme: dark' in text
    words = ' '.join(found.words)
    for word in (
        'three_gimbal: ',
        'Closest to lock',
        'Limits at work',
        'Following the command.',
        'Ready: no motion is commanded.',
        'change of rate',
        'joint_rate_limits',
    ):
        assert word in words, word


def test_its_numbers_are_those_that_were_recorded(tmp_path, good):
    assert run('report', good, '--out', tmp_path / 'run.html')[0] == 0
    words = ' '.join(Page((tmp_path / 'run.html').read_text()).words)
    read = by_rosbags(good)
    stamps = {stamp(one) for _, _, one in read['/step_inputs']}
    statuses = [one for _, _, one in read['/wrist_status'] if stamp(one) in stamps]
    closest = min(statuses, key=lambda one: one.margin)
    at = 1e-9 * (stamp(closest) - stamp(statuses[0]))
    assert f' smallest margin, at 0:{at:04.1f} {closest.margin:.3f} ' in words
    lost = statuses[-1].time_lost - statuses[0].time_lost
    assert lost > 0.05
    assert f' lost by slowing down {lost:.2f} s ' in words
    asked = [one for one in statuses if any(vars(one.commanded.angular).values())]
    share = 100.0 * sum(one.scale_factor for one in asked) / len(asked)
    assert f' of the commanded rates was followed {share:.0f} % ' in words
    told = [one.message for one in statuses]
    assert {'Ready: no motion is commanded.', 'Following the command.'} <= set(told)


def stamp(message):
    return message.header.stamp.sec * 10**9 + message.header.stamp.nanosec


def test_nobody_s_words_become_part_of_a_page(tmp_path, good):
    """A recording may come from anybody."""

    def other(_, data):
        return data.replace(b'Following the command.', b'<script>alert(1)</scri')

    rewrite(file_of(good), tmp_path / 'run_0.mcap', other, '/wrist_status')
    assert run('report', tmp_path, '--out', tmp_path / 'run.html')[0] == 0
    text = (tmp_path / 'run.html').read_text()
    assert '<script' not in text
    assert '&lt;script&gt;alert(1)' in text


def test_where_no_page_can_be_written_it_says_so(tmp_path, good):
    (tmp_path / 'file').touch()
    code, said = run('report', good, '--out', tmp_path / 'file' / 'run.html')
    assert code == 2
    assert 'run.html cannot be written (' in said
    assert 'say another place with --out.' in said


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


def test_the_operator_gives_the_recorded_commands_again(graph, good):
    clock = graph.lockstep(1.0 / 50.0)
    graph.start(Operator, use_sim_time=True, rate=50.0, maneuver='recording', recording=str(good))
    clock.listen({'cmd_vel': TwistStamped})
    clock.begin()
    graph.until(lambda: graph.outside.count_publishers('cmd_vel'))
    for _ in range(150):
        clock.tick()
    turns = [one.twist.angular for one in clock.heard['cmd_vel']]
    asked = [(turn.x, turn.y, turn.z) for turn in turns]
    spells = [asked[0]]
    for one in asked:
        if one != spells[-1]:
            spells.append(one)
    still = (0.0, 0.0, 0.0)
    wanted = [(0.0, 0.4, 0.0), still, (-0.2, 0.0, 0.1), still]
    assert spells[-4:] == wanted
    assert spells[:-4] in ([], [still])
    pitching = sum(one == (0.0, 0.4, 0.0) for one in asked) / 50.0
    assert pitching == pytest.approx(0.8, rel=0.5)
