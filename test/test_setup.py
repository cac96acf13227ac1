"""Setup in every circumstance that was thought of: a sentence, an exit code, never a traceback."""

import shutil
import signal

import pytest

import machine as wanted

from .faked_setup import Machine, content, is_alive, said, until

# What pip says, shortened.
UNREACHABLE = "Retrying after connection broken by 'NewConnectionError: Network is unreachable'"
OTHER_HASH = """ERROR: THESE PACKAGES DO NOT MATCH THE HASHES FROM THE REQUIREMENTS FILE. If
    numpy==2.4.6 from file:///wheels/numpy-2.4.6.whl (from -r requirements.txt (line 8)):
        Expected sha256 0000
             Got        1111
"""
FULL = 'ERROR: Could not install packages due to an OSError: [Errno 28] No space left on device'


@pytest.fixture
def machine(tmp_path):
    return Machine(tmp_path)


def failing(output):
    return f"cat <<'END'\n{output}\nEND\nexit 1"


def installed(machine):
    return [call.split('-r ')[1].rsplit('/', 1)[1] for call in machine.calls('pip')]


def test_setup_makes_everything_and_says_what(machine):
    code, sentences = machine.set_up()
    assert code == 0
    assert installed(machine) == ['requirements-build.txt', 'requirements.txt']
    assert len(machine.calls('colcon')) == 3
    for done in ('making .venv', 'installing ROS 2', 'building wrist_control', 'done in'):
        assert f'setup: {done}' in sentences


def test_every_package_is_checked_against_its_hash(machine):
    machine.set_up('test')
    assert len(machine.calls('pip')) == 3
    assert all(' --require-hashes --no-deps ' in call for call in machine.calls('pip'))


def test_nothing_is_done_twice(machine):
    machine.set_up('test')
    before = [len(machine.calls(name)) for name in ('venv', 'pip', 'colcon')]
    assert machine.set_up('test') == (0, '')
    assert machine.set_up() == (0, '')
    assert [len(machine.calls(name)) for name in ('venv', 'pip', 'colcon')] == before


def test_an_extra_is_added_to_what_is_there(machine):
    machine.set_up()
    code, sentences = machine.set_up('docs')
    assert code == 0
    assert 'installing what `docs` needs' in sentences
    assert installed(machine)[2:] == ['requirements-docs.txt']
    assert (len(machine.calls('venv')), len(machine.calls('colcon'))) == (1, 3)


def test_a_changed_extra_alone_is_installed_again(machine):
    machine.set_up('docs', 'test')
    with (machine.checkout / 'requirements-test.txt').open('a') as file:
        file.write('# changed\n')
    machine.set_up('docs', 'test')
    assert installed(machine)[4:] == ['requirements-test.txt']
    assert (len(machine.calls('venv')), len(machine.calls('colcon'))) == (1, 3)


def test_a_changed_base_makes_everything_again(machine):
    machine.set_up('test')
    with (machine.checkout / 'requirements.txt').open('a') as file:
        file.write('# changed\n')
    machine.set_up('test')
    assert installed(machine)[3:] == installed(machine)[:3]
    assert (len(machine.calls('venv')), len(machine.calls('colcon'))) == (2, 6)


@pytest.mark.parametrize('folder', ['config', 'foxglove', 'launch', 'rviz'])
def test_a_new_file_that_comes_with_the_package_is_installed(machine, folder):
    machine.set_up()
    file = machine.checkout / 'src' / 'wrist_control' / folder / 'new.file'
    file.parent.mkdir()
    file.touch()
    machine.set_up()
    (again,) = machine.calls('colcon')[3:]
    assert 'wrist_control' in again


def test_a_venv_that_was_removed_comes_back_with_its_extras(machine):
    machine.set_up('test')
    shutil.rmtree(machine.checkout / '.venv')
    machine.set_up('test')
    assert installed(machine)[3:] == installed(machine)[:3]


def test_half_of_a_change_that_is_taken_back_is_not_taken_for_the_whole(machine):
    machine.set_up('test')
    requirements = machine.checkout / 'requirements-test.txt'
    before = requirements.read_text()
    requirements.write_text(f'{before}# changed\n')
    machine.fake('pip', failing(UNREACHABLE))
    machine.set_up('test')
    requirements.write_text(before)
    machine.mend('pip')
    machine.set_up('test')
    assert installed(machine)[4:] == ['requirements-test.txt']


def test_an_extra_that_is_none_is_refused(machine):
    code, sentences = machine.set_up('tset')
    assert code == 1
    assert "there is no extra 'tset': choose from " in sentences
    assert 'docs' in sentences
    assert 'build' not in sentences


@pytest.fixture
def sourced(machine):
    return machine.sourced()


def test_where_ros_is_sourced_nothing_is_installed(machine, sourced):
    machine.present += ' ' + ' '.join(wanted.APT_OF_EXTRA['test'])
    code, sentences = machine.set_up('test', **sourced)
    assert code == 0
    assert 'building wrist_control' in sentences
    assert machine.calls('venv') + machine.calls('pip') == []
    assert machine.set_up('test', **sourced) == (0, '')


def test_where_ros_is_sourced_what_an_extra_lacks_is_said(machine, sourced):
    assert machine.set_up(**sourced)[0] == 0
    code, sentences = machine.set_up('test', **sourced)
    assert code == 1
    assert 'ROS 2 jazzy is sourced, so nothing is installed, but ' in sentences
    assert (
        'lacks coverage, hypothesis, pytest, pytest_timeout, scipy, xdist: run `sudo apt'
        in sentences
    )


def test_no_compiler(machine):
    machine.without('cc', 'c++')
    code, sentences = machine.set_up()
    assert code == 1
    assert 'no compiler found for C (looked for cc, gcc, clang) and C++' in sentences
    assert 'apt install build-essential' in sentences


@pytest.mark.parametrize(
    ('absent', 'named'), [('venv', 'venv'), ('ensurepip', 'ensurepip and pip')]
)
def test_no_venv(machine, absent, named):
    machine.absent = absent
    code, sentences = machine.set_up()
    assert code == 1
    assert f'comes without {named}: install it' in sentences
    assert machine.calls('venv') == []


def test_all_that_is_missing_is_said_at_once(machine):
    machine.without('c++')
    machine.absent = 'venv'
    _, sentences = machine.set_up()
    assert 'comes without venv' in sentences
    assert 'no compiler found for C++' in sentences


def test_the_wrong_python(machine):
    machine.fake('python3', 'case "$2" in *print*) echo 3.9.18 ;; *) exit 1 ;; esac')
    code, sentences = machine.set_up()
    assert code == 1
    assert 'needs Python 3.10 to 3.13, but python3 is 3.9.18' in sentences


def test_no_python(machine):
    machine.without('python3')
    code, sentences = machine.set_up()
    assert code == 1
    assert 'needs Python 3.10 to 3.13, but there is no python3' in sentences


def test_a_named_python_that_is_not_there(machine):
    code, sentences = machine.set_up(PYTHON='/no/python3.12')
    assert code == 1
    assert 'there is no /no/python3.12' in sentences


@pytest.mark.parametrize(
    ('output', 'sentence'),
    [
        (UNREACHABLE, 'could not be downloaded'),
        (OTHER_HASH, 'what was downloaded as numpy==2.4.6 is not what was reviewed'),
        (FULL, 'no space left on a disk'),
        ('ERROR: it rains', 'says "ERROR: it rains"'),
        ('', 'says "nothing about why"'),
    ],
    ids=['no network', 'another hash', 'a full disk', 'another error', 'silence'],
)
@pytest.mark.parametrize('extra', [(), ('test',)], ids=['base', 'extra'])
def test_what_pip_could_not_do_is_said_and_heals(machine, output, sentence, extra):
    if extra:
        machine.set_up()
    machine.fake('pip', failing(output))
    code, sentences = machine.set_up(*extra)
    assert code == 1
    assert sentence in sentences
    machine.mend('pip')
    assert machine.set_up(*extra)[0] == 0
    assert machine.set_up(*extra) == (0, '')


@pytest.mark.parametrize('command', ['venv', 'colcon'])
def test_a_full_disk_is_said_whoever_meets_it(machine, command):
    machine.fake(command, failing('OSError: [Errno 28] No space left on device'))
    code, sentences = machine.set_up()
    assert code == 1
    assert 'setup: there is no space left on a disk' in sentences


def test_a_full_disk_that_setup_itself_meets(machine):
    machine.fake('pip', 'ln -sf /dev/full .venv/made_with')  # which setup writes
    code, sentences = machine.set_up()
    assert code == 1
    assert 'No space left on device' in sentences


def test_a_folder_that_cannot_be_written(machine):
    (machine.checkout / '.setup.lock').mkdir()  # permissions would not stop root
    code, sentences = machine.set_up()
    assert code == 1
    assert 'setup: [Errno 21] Is a directory' in sentences


def test_a_package_that_does_not_build_is_shown(machine):
    machine.fake('colcon', failing('fatal error: no such file'))
    code, sentences = machine.set_up()
    assert code == 1
    assert 'fatal error: no such file' in sentences
    assert 'setup: tf2_msgs could not be built' in sentences


def test_a_path_with_blanks(tmp_path):
    machine = Machine(tmp_path, 'my robot')
    code, sentences = machine.set_up()
    assert code == 1
    assert "path has a blank in it, '" in sentences
    assert machine.calls('venv') == []


@pytest.mark.parametrize('number', [signal.SIGINT, signal.SIGTERM, signal.SIGHUP])
@pytest.mark.parametrize('command', ['pip', 'colcon'])
def test_interrupted_it_ends_with_all_that_it_started_and_heals(machine, number, command):
    pid = machine.checkout / 'pid'
    # A child in the background of a shell hears no SIGINT.
    machine.fake(command, f'sleep 60 &\necho $! > {pid}\nwait')
    process = machine.start()
    until(lambda: content(pid))
    process.send_signal(number)
    code, sentences = said(process)
    assert code == 130
    assert 'setup: interrupted; run the same command again' in sentences
    until(lambda: not is_alive(int(content(pid))))
    machine.mend(command)
    assert machine.set_up()[0] == 0
    assert machine.set_up() == (0, '')


def test_two_setups_at_once_do_the_work_once(machine):
    begun, go = machine.checkout / 'begun', machine.checkout / 'go'
    machine.fake('pip', f'echo 1 > {begun}\nwhile [ ! -e {go} ]; do sleep 0.02; done')
    first = machine.start()
    until(begun.exists)
    second = machine.start()
    waiting = 'setup: another setup is running here; waiting for it to end\n'
    assert second.stdout.readline() == waiting
    go.touch()
    assert said(first)[0] == 0
    assert said(second) == (0, '')
    assert len(machine.calls('venv')) == 1
