"""What runs on machines of others says what is here: it cannot be run here, but it can be read."""

import json
import re
from pathlib import Path

import pytest
import yaml

import machine
from apt_packages import needed

ROOT = Path(__file__).resolve().parents[1]
TEXT = (ROOT / '.github' / 'workflows' / 'ci.yml').read_text()
WORKFLOW = yaml.safe_load(TEXT)
JOBS = WORKFLOW['jobs']
DOCKERFILE = (ROOT / 'Dockerfile').read_text()


def steps(key):
    """Return what the steps of all jobs have under a key, with their jobs."""
    return [
        (name, step[key]) for name, job in JOBS.items() for step in job['steps'] if key in step
    ]


def instructions(word):
    """Return what follows an instruction, each time that the Dockerfile gives it."""
    return re.findall(rf'^{word} (.+)$', DOCKERFILE, re.MULTILINE)


def accepted_pythons():
    """Return the versions that scripts/setup accepts."""
    setup = (ROOT / 'scripts' / 'setup').read_text()
    (found,) = re.findall(r'not \(3, (\d+)\) <= .* <= \(3, (\d+)\)', setup)
    first, last = map(int, found)
    return [f'3.{minor}' for minor in range(first, last + 1)]


def test_the_workflow_says_first_that_it_has_not_run():
    head = TEXT[: TEXT.index('name:')]
    assert 'Not run yet' in head


def test_the_workflow_may_only_read():
    assert WORKFLOW['permissions'] == {'contents': 'read'}
    assert not any('permissions' in job for job in JOBS.values())
    checkouts = [step for job in JOBS.values() for step in job['steps'] if 'checkout' in str(step)]
    assert len(checkouts) == len(JOBS)
    assert all(step['with']['persist-credentials'] is False for step in checkouts)


@pytest.mark.parametrize('job', JOBS)
def test_a_job_runs_on_ubuntu_24_04_and_ends(job):
    assert JOBS[job]['runs-on'] == 'ubuntu-24.04'
    assert JOBS[job]['timeout-minutes'] <= 120


def test_every_action_is_pinned_to_a_commit_and_says_its_version():
    pinned = re.findall(r'uses: [\w-]+/[\w-]+@[0-9a-f]{40}  # v\d+\.\d+\.\d+$', TEXT, re.MULTILINE)
    assert len(pinned) == len(steps('uses')) > 0


def test_the_whole_ci_runs_where_jazzy_is_sourced_and_on_plain_python():
    whole = {job: command for job, command in steps('run') if command.endswith('.ci/run')}
    assert whole == {
        'jazzy': f'. /opt/ros/{machine.DISTRO}/setup.sh && .ci/run',
        'wheels': '.ci/run',
    }


def test_every_python_that_setup_accepts_is_tried():
    matrices = {job: JOBS[job]['strategy']['matrix'] for job in ('wheels', 'library')}
    assert matrices == {job: {'python': accepted_pythons()} for job in matrices}
    versions = [given['python-version'] for _, given in steps('with') if 'python-version' in given]
    assert versions == ['${{ matrix.python }}'] * 2


def test_the_library_is_installed_alone_and_flies():
    commands = [command for job, command in steps('run') if job == 'library']
    assert commands == [
        'python -m pip install ./src/wrist_control',
        'python -m wrist_control',
        'python examples/lost_in_lock.py',
    ]


def test_every_file_that_a_step_names_is_there():
    commands = ' '.join(command for _, command in steps('run'))
    named = re.findall(r'(?<![\w/.])(?:\./)?((?:src|scripts|examples|\.ci)/[\w./]+)', commands)
    assert {'.ci/run', 'scripts/apt_packages.py', 'src/wrist_control'} <= set(named)
    assert [name for name in named if not (ROOT / name).exists()] == []


def test_the_image_is_the_one_of_the_workflow():
    assert instructions('FROM') == [JOBS['jazzy']['container']]
    assert machine.DISTRO in JOBS['jazzy']['container']


def test_what_the_image_copies_is_there():
    copied = [line.split() for line in instructions('COPY')]
    sources = [one for line in copied for one in line[:-1] if not one.startswith('--')]
    assert '.' in sources
    assert [source for source in sources if not (ROOT / source).exists()] == []


def test_the_image_is_built_and_run_by_somebody_without_rights():
    user = DOCKERFILE.index('USER ubuntu')
    assert user < DOCKERFILE.index('make setup') < DOCKERFILE.index('ENTRYPOINT')
    assert instructions('USER') == ['ubuntu']


def test_the_image_puts_ros_and_the_workspace_around_what_it_runs():
    (folder,) = instructions('WORKDIR')
    (entrypoint,) = map(json.loads, instructions('ENTRYPOINT'))
    assert entrypoint == ['/ros_entrypoint.sh', f'{folder}/env']
    assert f'mkdir {folder}' in instructions('RUN')


def test_what_git_leaves_out_the_image_leaves_out():
    left_out = (ROOT / '.dockerignore').read_text().splitlines()
    ignored = (ROOT / '.gitignore').read_text().splitlines()
    patterns = [line for line in ignored if line and not line.startswith('#')]
    everywhere = [line if line.startswith('/') else f'**/{line}' for line in patterns]
    assert {'/.git/', *everywhere} <= set(left_out)


def test_the_development_container_is_the_image():
    container = json.loads((ROOT / '.devcontainer' / 'devcontainer.json').read_text())
    build = container['build']
    assert (ROOT / '.devcontainer' / build['dockerfile']).resolve() == ROOT / 'Dockerfile'
    assert (ROOT / '.devcontainer' / build['context']).resolve() == ROOT
    assert container['remoteUser'] in instructions('USER')
    assert f'. /opt/ros/{machine.DISTRO}/setup.sh && make setup' in container['postCreateCommand']


def test_every_package_that_setup_would_ask_for_is_installed_there():
    tables = [machine.APT_OF_MODULE, machine.APT_OF_PROGRAM, machine.APT_OF_ROS_PACKAGE]
    assert {package for table in tables for package in table.values()} <= set(needed())
    source = (ROOT / 'scripts' / 'machine.py').read_text()
    assert {'build-essential', 'python3-dev'} <= set(needed()) & set(re.findall(r'[\w-]+', source))
