"""Every example runs as a user runs it, leaves nothing behind, and says the library's numbers."""

import math
import re
import signal
import subprocess
import sys
import time
from pathlib import Path

import pytest

from wrist_control import fly, make_wrist
from wrist_control.operating.maneuvers import BARKER_SPEED, Maneuver, turn

from .documents import FIRST_STEPS

PANDA = Path(__file__).resolve().parents[1] / 'src' / 'wrist_control' / 'urdf' / 'panda.urdf'
FOLDER = Path(__file__).resolve().parents[1] / 'examples'
SCRIPTS = sorted(FOLDER.glob('*.py'))
# These need somebody's resolver: test_first_steps.py runs them beside one.
BESIDE_A_RESOLVER = ('stop_wrist', 'watch_wrist')
ALONE = [script for script in SCRIPTS if script.stem not in BESIDE_A_RESOLVER]


def numbers(said, pattern):
    """Return the groups of the only place that fits a pattern."""
    (found,) = re.findall(pattern, said)
    return [float(one) for one in ([found] if isinstance(found, str) else found)]


def lost_in_lock(said):
    for line in said.splitlines():
        limit, lost = numbers(line, r'at ([\d.]+) deg/s: +([\d.]+) s')
        flight = fly('three_gimbal', joint_rate_limits=math.radians(limit))
        assert lost == pytest.approx(flight.time_lost[-1], abs=0.005)


def fly_and_plot(said):
    long, lost = numbers(said, r'([\d.]+) s long, ([\d.]+) s of it lost')
    flight = fly('three_gimbal', joint_rate_limits=BARKER_SPEED)
    assert [long, lost] == pytest.approx([flight.time[-1], flight.time_lost[-1]], abs=0.005)
    assert Path('out/fly_and_plot.png').read_bytes().startswith(b'\x89PNG')


def choose_a_wrist(said):
    able, others = said.split('not able:')
    lost = {name: float(x) for name, x in re.findall(r'(\w+) +([\d.]+) s +[\d.]+ deg', able)}
    assert list(lost.values()) == sorted(lost.values())
    angles = {1: 80.0, 2: 90.0, 0: 180.0}
    turns = (turn(axis, math.radians(angle), BARKER_SPEED) for axis, angle in angles.items())
    flight = fly('four_gimbal', Maneuver('task', tuple(turns)), joint_rate_limits=BARKER_SPEED)
    assert lost['four_gimbal'] == pytest.approx(flight.time_lost[-1], abs=0.005)
    assert lost['double_hooke'] == lost['omni_wrist'] == 0.0
    for points_only in ('carpal', 'pitch_yaw', 'five_bar'):
        assert re.search(rf'{points_only} +points only', others)


def your_urdf(said):
    panda = make_wrist('urdf', description=str(PANDA), tip='panda_link8')
    for joint in panda.joints:
        upper, rate = numbers(said, rf'{joint.name} +-?\d+°  +(\d+)°  +(\d+)°/s')
        assert math.radians(upper) == pytest.approx(joint.upper, abs=0.01)
        assert math.radians(rate) == pytest.approx(joint.rate_limit, abs=0.01)
    margin, late = numbers(said, r'at 20% of its speed: closest to lock (\S+), (\S+) s late')
    limits = [0.2 * joint.rate_limit for joint in panda.joints]
    flight = fly(panda, joint_rate_limits=limits)
    assert margin == pytest.approx(flight.margin.min(), abs=5e-4)
    assert late == pytest.approx(flight.time_lost[-1], abs=0.005)
    assert late > 0.1


def stewart_with_proof(said):
    wrist = make_wrist('stewart')
    answer = wrist.forward_kinematics.solve(numbers(said, 'lengths: ' + 6 * r'([\d.]+) '))
    position = numbers(said, 'position: ' + 3 * r'([\d.-]+) ')
    assert answer.pose.position == pytest.approx(position, abs=5e-4)  # lengths are rounded, too
    assert position == pytest.approx([0.02, 0.0, wrist.home_height + 0.05], abs=1e-6)
    (bound,), (radius,) = numbers(said, r'within (\S+) m of'), numbers(said, r'within (\S+) mm')
    assert 0.0 < bound < 1e-12
    assert radius == pytest.approx(1000.0 * answer.unique_radius, rel=0.01)
    assert 'UNREACHABLE' in said


def teleoperate(said):
    bent, fastest = numbers(said, r'bent by ([\d.]+) deg\nfastest: ([\d.]+) deg/s')
    assert bent > math.degrees(0.7)
    assert fastest == pytest.approx(math.degrees(BARKER_SPEED), abs=0.05)
    assert 'theta would need 1 rad/s and may do 0.56' in said


def read_a_recording(said):
    fastest, margin = numbers(said, r'joint: (\S+) deg/s\nclosest to lock: margin (\S+)')
    flight = fly('three_gimbal', joint_rate_limits=BARKER_SPEED)
    # A busy machine may deliver a message a tick late, and the simulated joints then catch up.
    assert math.degrees(BARKER_SPEED) - 0.05 <= fastest < math.degrees(0.6) + 0.05
    assert margin == pytest.approx(flight.margin.min(), abs=0.02)
    axis = numbers(said, r'along \((\S+), (\S+), (\S+)\)')
    assert axis == pytest.approx(flight.hand_rotation[-1][0], abs=0.02)
    rows = Path('out/recording.csv').read_text().splitlines()
    assert rows[0] == 'time,psi,theta,phi'
    assert len(rows) > len(flight.time)


NUMBERS = {
    check.__name__: check
    for check in (
        lost_in_lock,
        fly_and_plot,
        choose_a_wrist,
        your_urdf,
        stewart_with_proof,
        teleoperate,
        read_a_recording,
    )
}


def start(script, environment):
    return subprocess.Popen(
        [sys.executable, script],
        env=environment,
        stdout=subprocess.PIPE,
        stderr=subprocess.PIPE,
        text=True,
        start_new_session=True,
    )


@pytest.mark.parametrize('script', ALONE, ids=lambda script: script.stem)
def test_an_example_runs_and_says_what_the_library_says(
    process_environment, own_processes, tmp_path, monkeypatch, script
):
    monkeypatch.chdir(tmp_path)
    process = start(script, process_environment)
    said, complained = process.communicate(timeout=100.0)
    assert process.returncode == 0, complained
    assert said
    assert own_processes() == []
    assert {path.name for path in tmp_path.iterdir()} <= {'out'}
    NUMBERS[script.stem](said)


@pytest.mark.parametrize('name', ['teleoperate', 'read_a_recording'])
def test_a_live_example_that_is_interrupted_leaves_no_process_behind(
    process_environment, own_processes, tmp_path, monkeypatch, name
):
    monkeypatch.chdir(tmp_path)
    process = start(FOLDER / f'{name}.py', process_environment)
    end = time.monotonic() + 60.0
    while len(own_processes()) < 3 and time.monotonic() < end:
        time.sleep(0.1)
    process.send_signal(signal.SIGINT)
    process.communicate(timeout=60.0)
    assert own_processes() == []


@pytest.mark.parametrize('name', BESIDE_A_RESOLVER)
def test_the_others_are_run_by_the_first_steps(name):
    assert f'./env python examples/{name}.py' in FIRST_STEPS.read_text()


def test_the_list_of_the_examples_is_the_folder():
    listed = re.findall(r'^\|.*\]\((\S+)\) \|', (FOLDER / 'README.md').read_text(), re.MULTILINE)
    packages = sorted(FOLDER.glob('*/pyproject.toml'))  # test_plugins.py installs them
    modules = [f'{file.parent.name}/{file.parent.name}.py' for file in packages]
    assert sorted(listed) == sorted([*modules, *(script.name for script in SCRIPTS)])


@pytest.mark.parametrize('script', SCRIPTS, ids=lambda script: script.stem)
def test_an_example_is_small_and_says_first_what_it_shows(script):
    text = script.read_text()
    assert text.startswith('"""')
    assert len(text.splitlines()) <= 75
