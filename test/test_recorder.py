"""The recorder as people run it, and its files as other programs read them."""

import os
import random
import re
import resource
import signal
import subprocess
import time

import pytest
import yaml
from diagnostic_msgs.msg import DiagnosticArray
from geometry_msgs.msg import TwistStamped
from rclpy.serialization import deserialize_message
from sensor_msgs.msg import JointState
from std_msgs.msg import Empty, String

from wrist_control.nodes.resolver import Resolver
from wrist_control.ros.qos import LASTING
from wrist_interfaces.msg import LimitAtWork, WristStatus

from .recordings import Recorded, by_mcap, by_rosbags, file_of


def command(number):
    message = TwistStamped()
    message.header.stamp.sec = number
    message.header.frame_id = 'händ' * (number % 7)
    message.twist.angular.x = 0.1 * number
    return message


def status(number):
    limits = [LimitAtWork(joint=f'joint_{k}', kind=k, asked=1.0 / (k + 1)) for k in range(number)]
    return WristStatus(state=3, scale_factor=1.0 / (number + 1), limits=limits, message='Slowed.')


def publish_numbers(graph, recorded_messages):
    """Publish some messages, each on its topic, and return what was published by topic."""
    published = {}
    for topic, kind, message in recorded_messages:
        if topic not in published:
            published[topic] = graph.publisher(kind, topic), []
        published[topic][0].publish(message)
        published[topic][1].append(message)
        graph.spin(0.002)
    return {topic: messages for topic, (_, messages) in published.items()}


def run_of(count):
    for number in range(count):
        yield 'cmd_vel', TwistStamped, command(number)
        yield 'wrist_status', WristStatus, status(number % 5)
        yield 'stop', Empty, Empty()


def assert_same(found, published):
    for topic, messages in published.items():
        kind = type(messages[0])
        read = [deserialize_message(data, kind) for data in found[topic]]
        assert read == messages


def test_a_recording_holds_all_that_was_published_by_two_readers_that_are_not_ours(
    graph, tmp_path
):
    recorded = Recorded(graph, tmp_path / 'run', '-r', '__ns:=/left')
    names = [(f'/left/{topic}', kind, message) for topic, kind, message in run_of(100)]
    names += [('/right/cmd_vel', TwistStamped, command(1))]
    others = graph.outside.create_subscription(TwistStamped, '/right/cmd_vel', lambda _: None, 10)
    published = publish_numbers(graph, names)
    graph.spin(0.2)
    code, said = recorded.end()
    assert code == 0, said
    assert 'Traceback' not in said
    assert f' 0 lost: {tmp_path}/run (' in said
    del published['/right/cmd_vel'], others
    assert_same(by_mcap(tmp_path / 'run'), published)
    read = by_rosbags(tmp_path / 'run')
    assert '/right/cmd_vel' not in read
    assert_same({topic: [data for _, data, _ in read[topic]] for topic in read}, published)
    # And by the definitions in the file alone:
    statuses = [message for _, _, message in read['/left/wrist_status']]
    assert [one.scale_factor for one in statuses] == [1.0 / (n % 5 + 1) for n in range(100)]
    assert [limit.joint for limit in statuses[3].limits] == ['joint_0', 'joint_1', 'joint_2']
    times = [when for when, _, _ in read['/left/cmd_vel']]
    assert times == sorted(times)


def test_its_folder_is_as_rosbag2_makes_it(graph, tmp_path):
    recorded = Recorded(graph, tmp_path / 'run')
    published = publish_numbers(graph, run_of(20))
    graph.spin(0.2)
    assert recorded.end()[0] == 0
    assert {path.name for path in (tmp_path / 'run').iterdir()} == {'metadata.yaml', 'run_0.mcap'}
    facts = yaml.safe_load((tmp_path / 'run' / 'metadata.yaml').read_text())
    facts = facts['rosbag2_bagfile_information']
    assert (facts['version'], facts['storage_identifier']) == (9, 'mcap')
    assert facts['relative_file_paths'] == ['run_0.mcap']
    topics = {each['topic_metadata']['name']: each for each in facts['topics_with_message_count']}
    assert facts['message_count'] == sum(each['message_count'] for each in topics.values())
    for topic, messages in published.items():
        assert topics[f'/{topic}']['message_count'] == len(messages)
    told = topics['/wrist_status']['topic_metadata']
    assert told['type'] == 'wrist_interfaces/msg/WristStatus'
    assert told['serialization_format'] == 'cdr'
    (publisher,) = graph.outside.get_publishers_info_by_topic('wrist_status')
    assert told['type_description_hash'] == str(publisher.topic_type_hash)
    assert told['type_description_hash'].startswith('RIHS01_')


def test_killed_in_the_middle_it_can_be_read_up_to_the_cut(graph, tmp_path):
    recorded = Recorded(graph, tmp_path / 'run')
    published = publish_numbers(graph, run_of(100))
    graph.spin(1.0)  # longer than it keeps anything to itself
    publish_numbers(graph, [('later', String, String(data='x' * 1000))] * 20)
    code, _ = recorded.end(signal.SIGKILL)
    assert code == -signal.SIGKILL
    topics = {f'/{topic}': messages for topic, messages in published.items()}
    assert_same(by_mcap(tmp_path / 'run'), topics)
    read = by_rosbags(tmp_path / 'run')
    assert_same({topic: [data for _, data, _ in read[topic]] for topic in read}, topics)


@pytest.mark.parametrize('count', [120, 157, 194])
def test_killed_at_any_moment_it_leaves_whole_messages(graph, tmp_path, count):
    recorded = Recorded(graph, tmp_path / 'run')
    publish_numbers(graph, run_of(count))
    recorded.end(signal.SIGKILL)
    found = by_mcap(tmp_path / 'run')['/cmd_vel']
    numbers = [deserialize_message(data, TwistStamped).header.stamp.sec for data in found]
    assert numbers == list(range(len(numbers)))
    assert len(numbers) > 10
    assert len(by_rosbags(tmp_path / 'run')['/cmd_vel']) == len(numbers)


def test_what_it_missed_is_counted(graph, tmp_path):
    """Held up for longer than messages wait for it, it loses some, and knows how many."""
    recorded = Recorded(graph, tmp_path / 'run')
    publisher = graph.publisher(String, 'noise')
    publisher.publish(String(data='first'))
    graph.spin(0.5)
    recorded.process.send_signal(signal.SIGSTOP)
    for number in range(3000):
        publisher.publish(String(data=str(number)))
        if number % 50 == 0:
            graph.spin(0.005)
    recorded.process.send_signal(signal.SIGCONT)
    graph.spin(1.0)
    publisher.publish(String(data='last'))
    graph.spin(0.5)
    code, said = recorded.end()
    assert code == 0, said
    lost = int(re.search(r', (\d+) lost: ', said)[1])
    kept = [message.data for _, _, message in by_rosbags(tmp_path / 'run')['/noise']]
    assert (kept[0], kept[-1]) == ('first', 'last')
    assert lost > 0
    assert len(kept) + lost == 3002


def test_it_hears_what_was_said_before_it_came(graph, tmp_path):
    publisher = graph.outside.create_publisher(JointState, 'initial_joints', LASTING)
    publisher.publish(JointState(name=['psi']))
    recorded = Recorded(graph, tmp_path / 'run')
    publish_numbers(graph, run_of(10))
    graph.spin(0.3)
    assert recorded.end()[0] == 0
    ((_, _, message),) = by_rosbags(tmp_path / 'run')['/initial_joints']
    assert message.name == ['psi']


def test_it_records_a_resolver_and_says_how_it_does(graph, tmp_path):
    heard = graph.listen(DiagnosticArray, '/diagnostics')
    graph.start(Resolver, 'three_gimbal')
    recorded = Recorded(graph, tmp_path / 'run', '-p', 'leave_out:=[markers]')
    graph.until(
        lambda: any(
            one.name == 'recorder: state' and 'Recording: ' in one.message
            for array in heard
            for one in array.status
        )
    )
    graph.spin(1.0)
    code, said = recorded.end()
    assert code == 0, said
    found = by_rosbags(tmp_path / 'run')
    topics = {topic for topic, messages in found.items() if messages}
    for topic in ('joint_command', 'wrist_status', 'hand_pose', 'diagnostics', 'tf'):
        assert f'/{topic}' in topics
    assert '/markers' not in found
    names = {message.header.frame_id for _, _, message in found['/hand_pose']}
    assert names == {'forearm'}


def test_a_folder_that_is_there_is_left_alone(graph, tmp_path):
    (tmp_path / 'run').mkdir()
    code, said = Recorded(graph, tmp_path / 'run').wait()
    assert code == 2
    assert f'Cannot start: {tmp_path}/run is there already; valid is a folder' in said
    assert list((tmp_path / 'run').iterdir()) == []


@pytest.mark.parametrize('place', ['file/run', 'closed/run', '/proc/run'])
def test_where_nothing_may_be_written_it_says_so(graph, tmp_path, place):
    (tmp_path / 'file').write_text('')
    (tmp_path / 'closed').mkdir(mode=0o500)
    if place.startswith('closed') and os.access(tmp_path / 'closed', os.W_OK):
        pytest.skip('whoever may write everywhere is never refused')
    code, said = Recorded(graph, tmp_path / place).wait()
    assert code == 2
    assert f'Cannot start: {tmp_path / place} cannot be made (' in said
    assert 'valid is a folder where you may write.' in said


def test_a_full_disk_ends_the_recording_with_a_sentence_and_keeps_what_fitted(graph, tmp_path):
    heard = graph.listen(DiagnosticArray, '/diagnostics')
    size = 3_000_000

    def no_larger_files():
        resource.setrlimit(resource.RLIMIT_FSIZE, (size, size))

    recorded = Recorded(graph, tmp_path / 'run', preexec_fn=no_larger_files)
    publisher = graph.publisher(String, 'noise')
    noise = [os.urandom(50_000).hex() for _ in range(5)]

    def ended():
        publisher.publish(String(data=noise[0]))
        noise.append(noise.pop(0))
        return any(
            one.name == 'recorder: state' and one.level == one.ERROR
            for array in heard
            for one in array.status
        )

    graph.until(ended, limit=60.0)
    code, said = recorded.end()
    assert code == 0, said
    assert said.count('has ended (File too large): what was written before can be read') == 1
    assert 'Traceback' not in said
    texts = {message.data for _, _, message in by_rosbags(tmp_path / 'run')['/noise']}
    assert texts <= set(noise)
    assert len(by_mcap(tmp_path / 'run')['/noise']) > 10
    assert file_of(tmp_path / 'run').stat().st_size <= size


@pytest.mark.parametrize('clock', ['false', 'true'])
@pytest.mark.parametrize('number', [signal.SIGINT, signal.SIGTERM])
def test_it_ends_well_whenever_it_is_stopped(graph, tmp_path, clock, number):
    for attempt, delay in enumerate((0.3, 0.9, random.uniform(0.5, 2.0))):
        folder = tmp_path / f'run_{attempt}'
        recorded = Recorded(graph, folder, '-p', f'use_sim_time:={clock}')
        time.sleep(delay)
        code, said = recorded.end(number)
        assert code == 0, said
        assert 'Traceback' not in said
        if folder.exists():
            by_rosbags(folder)


def test_without_the_extra_it_says_how_to_get_it(process_environment):
    code = (
        'import importlib.util as u; find = u.find_spec; '
        'u.find_spec = lambda name, *more: None if name == "mcap" else find(name, *more); '
        'import sys; sys.argv = ["recorder"]; '
        'from wrist_control.nodes.recorder import main; main()'
    )
    done = subprocess.run(
        ['python3', '-c', code],
        env=process_environment,
        capture_output=True,
        text=True,
        timeout=60.0,
    )
    assert done.returncode == 2
    assert 'mcap, which recordings need, cannot be imported here; `make setup-record`' in (
        done.stderr
    )
