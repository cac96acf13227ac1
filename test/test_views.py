"""What RViz and Foxglove are told to show is what a wrist says, under its own names."""

import json
import re
import shlex
import subprocess
from pathlib import Path

import pytest
import yaml
from diagnostic_msgs.msg import DiagnosticArray
from sensor_msgs.msg import JointState
from tf2_msgs.msg import TFMessage
from visualization_msgs.msg import MarkerArray

from wrist_control import WRISTS, make_wrist
from wrist_control.nodes.resolver import Resolver
from wrist_control.nodes.resolver_settings import specs
from wrist_interfaces.msg import WristStatus

ROOT = Path(__file__).resolve().parents[1]
CONTROL = ROOT / 'src' / 'wrist_control'
LAYOUT = CONTROL / 'foxglove' / 'wrist.json'
RVIZ = yaml.safe_load((CONTROL / 'rviz' / 'wrist.rviz').read_text())
FOXGLOVE = json.loads(LAYOUT.read_text())
PANELS = FOXGLOVE['configById']
FRAMES = {one.default for one in specs(make_wrist('three_gimbal')) if one.name.endswith('_frame')}
# By their names without a namespace; no namespace changes /tf, and /diagnostics.
TYPES = {
    '/diagnostics': DiagnosticArray,
    '/joint_command': JointState,
    '/markers': MarkerArray,
    '/tf': TFMessage,
    '/wrist_status': WristStatus,
}


def displays():
    found = RVIZ['Visualization Manager']['Displays']
    return {one['Class'].rpartition('/')[2]: one for one in found}


def paths():
    """Return every message path that a panel of Foxglove shows."""
    found = [path['value'] for panel in PANELS.values() for path in panel.get('paths', [])]
    found += [panel['topicPath'] for panel in PANELS.values() if 'topicPath' in panel]
    return found


def in_layout(part):
    if isinstance(part, str):
        return [part]
    return in_layout(part['first']) + in_layout(part['second'])


def test_rviz_shows_the_markers_the_frames_and_a_grid_in_the_forearm_frame():
    assert set(displays()) == {'Grid', 'MarkerArray', 'TF'}
    assert all(one['Enabled'] and one['Value'] for one in displays().values())
    assert RVIZ['Visualization Manager']['Global Options']['Fixed Frame'] == 'forearm'
    assert 'forearm' in FRAMES


def test_the_topic_of_rviz_is_relative_so_that_it_follows_a_namespace():
    topic = displays()['MarkerArray']['Topic']
    assert f'/{topic["Value"]}' in TYPES
    assert topic['Reliability Policy'] == 'Reliable'


def test_every_panel_of_foxglove_is_in_its_layout_and_the_other_way_round():
    assert sorted(in_layout(FOXGLOVE['layout'])) == sorted(PANELS)


def test_foxglove_follows_the_forearm_and_shows_both_frames():
    panel = PANELS['3D!wrist']
    shown = {name.removeprefix('frame:') for name in panel['transforms']}
    assert shown == FRAMES
    assert panel['followTf'] == 'forearm'
    assert set(panel['topics']) == {'/markers', '/tf'}


@pytest.mark.parametrize('path', paths())
def test_every_path_of_foxglove_leads_to_a_field(path):
    topic, field = re.fullmatch(r'(/\w+)\.(\w+)(?:\[\d\])?', path).groups()
    assert field in TYPES[topic].get_fields_and_field_types()


def test_every_joint_of_every_wrist_has_a_line():
    plotted = [path for path in paths() if path.startswith('/joint_command.velocity')]
    assert len(plotted) == max(len(make_wrist(wrist).joints) for wrist in WRISTS)


def test_a_resolver_publishes_what_is_shown_by_these_names(graph):
    graph.start(Resolver, 'three_gimbal')
    shown = {path.partition('.')[0] for path in paths()} | set(PANELS['3D!wrist']['topics'])
    shown |= {panel['topicToRender'] for panel in PANELS.values() if 'topicToRender' in panel}
    assert shown == set(TYPES)
    topics = {topic: kind for topic, kind in TYPES.items() if topic != '/tf'}
    graph.until(lambda: all(graph.outside.count_publishers(topic) for topic in topics))
    published = dict(graph.outside.get_topic_names_and_types())
    for topic, kind in topics.items():
        package = kind.__module__.partition('.')[0]
        assert published[topic] == [f'{package}/msg/{kind.__name__}']


def test_the_documented_command_makes_a_layout_for_a_namespace():
    document = (ROOT / 'docs' / 'interfaces.md').read_text()
    (command,) = re.findall(r'^(sed .*) > left\.json$', document, re.MULTILINE)
    done = subprocess.run(
        shlex.split(command), cwd=LAYOUT.parent, capture_output=True, text=True, check=True
    )
    panel = json.loads(done.stdout)['configById']['3D!wrist']
    assert panel['followTf'] == panel['layers']['grid']['frameId'] == 'left/forearm'
    assert set(panel['transforms']) == {'frame:left/forearm', 'frame:left/hand'}
    named = set(re.findall(r'"(/[\w/]+)', done.stdout))
    absolute = {'/tf', '/diagnostics'}
    assert named == absolute | {f'/left{topic}' for topic in set(TYPES) - absolute}
