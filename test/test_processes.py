"""Nodes as users run them: executables that end cleanly, and a demo that leaves nothing behind."""

import os
import signal
import subprocess
import time
from pathlib import Path

import pytest
from ament_index_python.packages import get_package_prefix

from wrist_control.graph.processes import NodeProcesses, config_file
from wrist_control.wrists import WRISTS

EXECUTABLES = Path(get_package_prefix('wrist_control')) / 'lib' / 'wrist_control'


def start(environment, executable, *arguments):
    command = [str(EXECUTABLES / executable), '--ros-args', *arguments]
    return subprocess.Popen(
        command, env=environment, stderr=subprocess.PIPE, text=True, start_new_session=True
    )


def stop(process, number):
    process.send_signal(number)
    try:
        _, said = process.communicate(timeout=10.0)
    except subprocess.TimeoutExpired:
        process.kill()
        raise
    return said


def test_every_executable_of_the_contract_is_installed():
    names = {path.name for path in EXECUTABLES.iterdir()}
    resolvers = {f'{wrist}_resolver' for wrist in WRISTS}
    others = {'operator', 'joint_simulator', 'physics_simulator', 'stewart_forward_kinematics'}
    others |= {'console', 'keyboard'}
    others |= {'rotary_stewart_forward_kinematics'}
    others |= {'recorder', 'replay', 'report'}
    assert others | resolvers <= names


@pytest.mark.parametrize('number', [signal.SIGINT, signal.SIGTERM, signal.SIGHUP])
@pytest.mark.parametrize('clock', ['false', 'true'])
@pytest.mark.parametrize(
    'executable',
    ['operator', 'three_gimbal_resolver', 'joint_simulator', 'stewart_forward_kinematics'],
)
def test_a_signal_ends_a_node_with_exit_code_0(
    process_environment, until_ready, executable, clock, number
):
    process = start(process_environment, executable, '-p', f'use_sim_time:={clock}')
    until_ready(process)
    said = stop(process, number)
    assert process.returncode == 0, said
    assert 'Traceback' not in said


def test_a_node_that_was_started_by_nohup_outlives_its_terminal(process_environment, until_ready):
    before = signal.signal(signal.SIGHUP, signal.SIG_IGN)  # as nohup leaves it to what it starts
    try:
        process = start(process_environment, 'operator')
    finally:
        signal.signal(signal.SIGHUP, before)
    process.send_signal(signal.SIGHUP)
    until_ready(process)
    process.send_signal(signal.SIGHUP)
    with pytest.raises(subprocess.TimeoutExpired):
        process.wait(0.5)
    stop(process, signal.SIGTERM)
    assert process.returncode == 0


def test_a_bad_parameter_ends_a_node_with_one_sentence(process_environment):
    process = start(process_environment, 'four_gimbal_resolver', '-p', 'gain:=-1.0')
    _, said = process.communicate(timeout=30.0)
    assert process.returncode == 2
    assert '[four_gimbal_resolver]: Cannot start: gain is -1.0; valid is' in said
    assert len(said.strip().splitlines()) == 1


def test_a_node_that_is_asked_for_security_and_has_none_does_not_start(
    process_environment, tmp_path
):
    (tmp_path / 'enclaves').mkdir()
    asked = {
        'ROS_SECURITY_ENABLE': 'true',
        'ROS_SECURITY_STRATEGY': 'Enforce',
        'ROS_SECURITY_KEYSTORE': str(tmp_path),
    }
    process = start(process_environment | asked, 'three_gimbal_resolver')
    _, said = process.communicate(timeout=30.0)
    assert process.returncode == 1
    assert 'security' in said


@pytest.mark.parametrize('wrist', WRISTS)
def test_every_wrist_has_a_ready_parameter_file_that_its_nodes_accept(
    process_environment, until_ready, wrist
):
    file = str(config_file(f'{wrist}.yaml'))
    nodes = [
        start(process_environment, executable, '--params-file', file)
        for executable in (f'{wrist}_resolver', 'joint_simulator')
    ]
    for node in nodes:
        until_ready(node)
        said = stop(node, signal.SIGTERM)
        assert node.returncode == 0, said
        assert 'Traceback' not in said


def demo(environment, *arguments):
    """Start the demo in the foreground: what a shell starts with & does not hear Ctrl-C."""
    return subprocess.Popen(
        ['python3', '-m', 'wrist_control.demo', *arguments],
        env=environment,
        stdout=subprocess.PIPE,
        text=True,
        start_new_session=True,
        preexec_fn=lambda: signal.signal(signal.SIGINT, signal.default_int_handler),
    )


def test_the_demo_draws_three_figures_and_says_paper_and_measured(
    process_environment, own_processes, tmp_path
):
    process = demo(process_environment, '--speed', '0', '--out', str(tmp_path))
    said, _ = process.communicate(timeout=100.0)
    assert process.returncode == 0
    for expected in ('paper', 'measured', '2.8125 s', '2880.0000 deg/s', '0.0677°'):
        assert expected in said
    for name in ('fig6.png', 'fig7.png', 'fig8.png'):
        assert (tmp_path / name).read_bytes().startswith(b'\x89PNG')
    assert own_processes() == []


@pytest.mark.parametrize('number', [signal.SIGINT, signal.SIGTERM])
def test_the_demo_leaves_no_process_behind_when_it_is_stopped(
    process_environment, own_processes, tmp_path, number
):
    process = demo(process_environment, '--speed', '0.2', '--out', str(tmp_path))
    end = time.monotonic() + 60.0
    while len(own_processes()) < 4 and time.monotonic() < end:
        time.sleep(0.2)
    assert len(own_processes()) >= 4
    time.sleep(1.0)
    os.kill(process.pid, number)
    process.communicate(timeout=30.0)
    assert process.returncode in (130, 143)
    assert own_processes() == []


@pytest.mark.parametrize(
    ('number', 'raised'), [(signal.SIGINT, KeyboardInterrupt), (signal.SIGTERM, SystemExit)]
)
def test_a_signal_while_a_node_begins_leaves_nothing_running(monkeypatch, number, raised):
    begun = []
    really_begin = subprocess.Popen

    def begin(*arguments, **options):
        begun.append(really_begin(*arguments, **options))
        signal.raise_signal(number)  # the node is there, and nobody has been told yet
        return begun[-1]

    monkeypatch.setattr(subprocess, 'Popen', begin)
    with pytest.raises(raised), NodeProcesses('held', []) as nodes:
        nodes.start('operator', {})
    assert begun[0].poll() is not None


@pytest.mark.parametrize(
    ('number', 'raised'), [(signal.SIGINT, KeyboardInterrupt), (signal.SIGTERM, SystemExit)]
)
def test_an_interruption_that_ros_has_made_something_else_of_is_one_again(number, raised):
    before = signal.getsignal(number)

    def call_into_ros():
        try:
            signal.raise_signal(number)
        except BaseException as interruption:
            raise RuntimeError('Unable to convert call argument') from interruption

    with pytest.raises(raised), NodeProcesses('held', []):
        call_into_ros()
    assert signal.getsignal(number) == before
