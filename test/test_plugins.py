"""A wrist of another package: found, held to every law, driven, and no harm to the others."""

import os
import subprocess
import sys
from pathlib import Path

import pytest
from geometry_msgs.msg import Twist
from sensor_msgs.msg import JointState
from visualization_msgs.msg import MarkerArray

from wrist_control.nodes.resolver import Resolver

EXAMPLE = Path(__file__).resolve().parents[1] / 'examples' / 'pan_tilt'


def installed(folder, name, module, code, entry):
    """Put a package as pip leaves it into a folder."""
    (folder / f'{module}.py').write_text(code)
    facts = folder / f'{name}-0.1.dist-info'
    facts.mkdir()
    (facts / 'METADATA').write_text(f'Metadata-Version: 2.1\nName: {name}\nVersion: 0.1\n')
    (facts / 'entry_points.txt').write_text(f'[wrist_control.wrists]\n{entry}\n')


@pytest.fixture(scope='module')
def plugged(tmp_path_factory):
    """Return a folder with the example as pip installs it, and two broken packages beside it."""
    folder = tmp_path_factory.mktemp('site')
    pip = [sys.executable, '-m', 'pip', 'install', '--quiet', '--disable-pip-version-check']
    alone = ['--no-deps', '--no-build-isolation', '--no-index', '--target', str(folder)]
    source = tmp_path_factory.mktemp('source') / 'pan_tilt'
    source.mkdir()
    for file in EXAMPLE.iterdir():
        if file.is_file():
            (source / file.name).write_bytes(file.read_bytes())
    subprocess.run([*pip, *alone, str(source)], check=True, timeout=110.0)
    installed(
        folder, 'broken', 'broken_wrist', 'import no_such_module\n', 'broken = broken_wrist:W'
    )
    installed(folder, 'plain', 'plain_thing', 'class Plain: ...\n', 'plain = plain_thing:Plain')
    installed(folder, 'thief', 'thief', 'class Gimbal: ...\n', 'three_gimbal = thief:Gimbal')
    return folder


@pytest.fixture
def python(plugged, process_environment):
    """Run Python where the packages are installed, and return what it prints."""
    path = os.pathsep.join([str(plugged), process_environment.get('PYTHONPATH', '')])
    environment = {**process_environment, 'PYTHONPATH': path}

    def run(*arguments):
        done = subprocess.run(
            [sys.executable, *arguments],
            env=environment,
            capture_output=True,
            text=True,
            timeout=110.0,
        )
        assert done.returncode == 0, done.stdout + done.stderr
        return done.stdout.strip()

    run.environment = environment
    return run


def test_a_wrist_of_another_package_is_found_by_its_name(python):
    assert 'pan_tilt' in python('-m', 'wrist_control')
    code = 'from wrist_control import make_wrist; print(type(make_wrist("pan_tilt")).__name__)'
    assert python('-c', code) == 'PanTilt'


@pytest.mark.timeout(120)
def test_the_example_keeps_every_law(python):
    code = (
        'from wrist_control import make_wrist\n'
        'from wrist_control.testing import check_wrist\n'
        'check_wrist(make_wrist("pan_tilt"))\n'
    )
    assert not python('-c', code)


def test_it_flies(python):
    code = 'from wrist_control import fly; print(fly("pan_tilt", "pitch_then_roll").margin.min())'
    assert float(python('-c', code)) == pytest.approx(0.766, abs=0.01)  # a pitch of 40°


@pytest.mark.parametrize(
    ('name', 'sentence'),
    [
        ('broken', "The wrist 'broken' of broken cannot be imported (ModuleNotFoundError: "),
        ('plain', 'plain_thing:Plain of plain is no wrist; its entry point '),
        ('nowhere', "There is no wrist 'nowhere'; the wrists are three_gimbal, "),
    ],
)
def test_a_package_that_brings_no_wrist_is_named(python, name, sentence):
    code = (
        'from wrist_control import InvalidValueError, make_wrist\n'
        f'try: make_wrist({name!r})\n'
        'except InvalidValueError as error: print(error)\n'
    )
    assert python('-c', code).startswith(sentence)


def test_it_is_compared_and_those_that_cannot_be_made_are_named_and_left_out(python):
    code = (
        'from wrist_control.studies.comparison import compare, wrists_here\n'
        'from wrist_control.operating.maneuvers import make_maneuver\n'
        'names = wrists_here(print)\n'
        'print(names)\n'
        'print([one.completed for one in compare(["pan_tilt"], [make_maneuver("stick")])])\n'
    )
    *told, names, completed = python('-c', code).splitlines()
    assert [line.partition(' cannot ')[0] for line in told] == [
        "The wrist 'broken' of broken",
        "plain_thing:Plain of plain is no wrist; its entry point 'plain' must name a class "
        'that is derived from wrist_control.wrists.Wrist.',
    ]
    assert "'pan_tilt'" in names
    assert 'plain' not in names
    assert completed == '[True]'


def test_nobody_takes_the_name_of_a_wrist_that_is_here(python):
    code = 'from wrist_control import make_wrist; print(type(make_wrist("three_gimbal")).__name__)'
    assert python('-c', code) == 'ThreeGimbal'


RESOLVER = """
import sys
from wrist_control.nodes.resolver import main
sys.argv = ['wrist_resolver', *sys.argv[1:]]
main('wrist')
"""


def test_its_hand_turns_as_commanded(graph, plugged, monkeypatch):
    """Yaw from the horizon is pan; the resolver has all that every resolver has."""
    monkeypatch.syspath_prepend(str(plugged))
    node = graph.start(Resolver, wrist='pan_tilt', command_timeout=10.0)
    assert node.get_name() == 'wrist_resolver'
    commands = graph.listen(JointState, 'joint_command')
    markers = graph.listen(MarkerArray, 'markers')
    publisher = graph.publisher(Twist, 'cmd_vel_unstamped')

    def pans():
        twist = Twist()
        twist.angular.z = 0.2
        publisher.publish(twist)
        return commands and commands[-1].velocity[0] > 0.199

    graph.until(pans)
    assert list(commands[-1].name) == ['pan', 'tilt']
    assert commands[-1].velocity[0] == pytest.approx(0.2)
    assert commands[-1].position[1] == 0.0
    graph.until(lambda: markers)
    assert {'fork', 'joint pan', 'joint tilt'} <= {marker.ns for marker in markers[-1].markers}


def resolver(python, *arguments):
    return subprocess.run(
        [sys.executable, '-c', RESOLVER, *arguments],
        env=python.environment,
        capture_output=True,
        text=True,
        timeout=60.0,
    )


def test_its_resolver_names_its_joints_and_every_wrist_that_there_is(python):
    done = resolver(python, '--help')
    assert done.returncode == 0, done.stderr
    assert 'wrist = three_gimbal' in done.stdout
    assert 'one of three_gimbal, ' in done.stdout
    assert 'pan_tilt' in done.stdout


def test_a_wrist_that_cannot_be_made_does_not_start(python):
    done = resolver(python, '--ros-args', '-p', 'wrist:=broken')
    assert done.returncode == 2
    assert "Cannot start: The wrist 'broken' of broken cannot be imported" in done.stderr
    done = resolver(python, '--ros-args', '-p', 'wrist:=nowhere')
    assert done.returncode == 2
    assert "Cannot start: wrist is 'nowhere'; valid is one of three_gimbal, " in done.stderr


@pytest.mark.timeout(120)
def test_the_physics_of_the_example_is_that_of_its_kinematics(python):
    code = (
        'from wrist_control import make_wrist\n'
        'from wrist_control.studies.judgement import judge\n'
        'print(judge(make_wrist("pan_tilt"), 5).worst)\n'
    )
    assert float(python('-c', code)) < 1e-6


@pytest.mark.timeout(120)
def test_the_simulator_of_the_physics_takes_it(python):
    code = 'from wrist_control.nodes.physics_settings import WRIST; print(WRIST.choices)'
    choices = python('-c', code)
    assert "'pan_tilt'" in choices
    assert "'broken'" not in choices
