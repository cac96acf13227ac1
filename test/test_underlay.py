"""What the wheels of ROS 2 lack is built beside them; it is what ROS has, and hides nothing."""

import os
import subprocess
from pathlib import Path

import pytest
from geometry_msgs.msg import TransformStamped
from tf2_msgs.msg import TFMessage

from .faked_setup import Machine

ROOT = Path(__file__).resolve().parents[1]
UNDERLAY = ROOT / 'underlay'
BUILT = ['underlay/tf2_msgs', 'src/wrist_interfaces', 'src/wrist_control']
# As `ros2 topic info --verbose /tf` prints it where Jazzy is installed, and rosbag2 records it.
HASH_OF_JAZZY = 'e369d0f05a23ae52508854b66f6aa0437f3449d652e8cbf22d5abe85d020f087'


@pytest.fixture
def machine(tmp_path):
    return Machine(tmp_path)


def built(machine):
    return [call.split('--base-paths ')[1].split()[0] for call in machine.calls('colcon')]


def test_frames_are_published_and_heard(graph):
    heard = graph.listen(TFMessage, '/tf')
    publisher = graph.publisher(TFMessage, '/tf')
    sent = TransformStamped(child_frame_id='hand')
    sent.header.frame_id = 'forearm'
    sent.transform.translation.x = 0.25
    publisher.publish(TFMessage(transforms=[sent]))
    graph.until(lambda: heard)
    assert heard[0].transforms == [sent]


def test_it_is_the_type_that_ros_itself_has(graph):
    graph.publisher(TFMessage, '/tf', listeners=0)
    graph.until(lambda: graph.outside.count_publishers('/tf'))
    (info,) = graph.outside.get_publishers_info_by_topic('/tf')
    assert info.topic_type == 'tf2_msgs/msg/TFMessage'
    assert bytes(info.topic_type_hash.value).hex() == HASH_OF_JAZZY


def test_where_ros_comes_from_wheels_it_is_built_once_and_says_so(machine):
    _, sentences = machine.set_up()
    assert 'setup: building tf2_msgs\n' in sentences
    assert machine.set_up() == (0, '')
    assert built(machine) == BUILT


@pytest.mark.parametrize(
    ('changed', 'again'),
    [
        ('underlay/tf2_msgs/msg/TFMessage.msg', BUILT[:1]),
        ('src/wrist_interfaces/cmake/headers_of_wheels.cmake', BUILT),
        ('src/wrist_interfaces/msg/WristStatus.msg', BUILT[1:]),
    ],
)
def test_it_is_built_again_when_what_it_is_made_of_has_changed(machine, changed, again):
    machine.set_up()
    with (machine.checkout / changed).open('a') as file:
        file.write('# changed\n')
    machine.set_up()
    assert built(machine)[3:] == again


def test_where_ros_is_sourced_its_own_is_used_and_an_earlier_build_of_ours_taken_away(machine):
    machine.set_up()
    installed = machine.checkout / 'install' / 'tf2_msgs'
    assert installed.exists()
    present, variables = machine.present, machine.sourced()
    assert machine.set_up(**variables)[0] == 0
    assert built(machine)[3:] == BUILT[1:]
    assert not installed.exists()
    assert machine.set_up(**variables) == (0, '')
    machine.present = present
    machine.set_up()
    assert built(machine)[5:] == BUILT
    assert installed.exists()


def test_a_sourced_ros_without_it_is_told_which_package_has_it(machine):
    variables = machine.sourced()
    machine.present = machine.present.replace('tf2_msgs', '')
    code, sentences = machine.set_up(**variables)
    assert code == 1
    assert 'lacks tf2_msgs: run `sudo apt install ros-jazzy-tf2-msgs`' in sentences
    assert built(machine) == []


def test_colcon_finds_it_only_where_it_is_named():
    def found(*base_paths):
        command = ['colcon', '--log-base', os.devnull, 'list', '--names-only', '--base-paths']
        done = subprocess.run([*command, *base_paths], cwd=ROOT, capture_output=True, text=True)
        return done.stdout.split()

    assert found('.') == found('src') == ['wrist_control', 'wrist_interfaces']
    assert found(BUILT[0]) == ['tf2_msgs']


def test_the_wheels_still_lack_all_of_it():
    """What the wheels bring one day shall be removed here."""
    pinned = ''.join(path.read_text() for path in ROOT.glob('requirements*.txt'))
    lacked = [one.name.replace('_', '-') for one in UNDERLAY.iterdir() if one.is_dir()]
    assert lacked == ['tf2-msgs']
    assert [name for name in lacked if f'ros-jazzy-{name}==' in pinned] == []
