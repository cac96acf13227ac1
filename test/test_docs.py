"""The documents are true: what they show runs, what they list exists, and nothing is left out."""

import re
import signal
import subprocess
import sys
from pathlib import Path

import pytest

from wrist_control.nodes import joint_simulator, operator, stewart_forward_kinematics
from wrist_control.nodes.resolver import Resolver
from wrist_control.nodes.resolver_settings import specs
from wrist_control.wrists import WRISTS

ROOT = Path(__file__).resolve().parents[1]
README = (ROOT / 'README.md').read_text()
INTERFACES = (ROOT / 'docs' / 'interfaces.md').read_text()
PARAMETERS = INTERFACES + (ROOT / 'docs' / 'wrists.md').read_text()


def blocks(language):
    return re.findall(rf'```{language}\n(.*?)```', README, re.DOTALL)


COMMANDS = [line for block in blocks('sh') for line in block.splitlines()]
DOCUMENTS = [
    *(ROOT / name for name in ('README.md', 'CONTRIBUTING.md', 'examples/README.md')),
    *sorted((ROOT / 'docs').glob('**/*.md')),
]
NODES = [line for line in COMMANDS if '--ros-args' in line]
PROGRAMS = [line for line in COMMANDS if line.startswith('./env') and line not in NODES]


@pytest.mark.parametrize('command', NODES)
def test_every_node_in_the_readme_starts_and_ends_cleanly(
    process_environment, until_ready, command
):
    process = subprocess.Popen(
        command.split(), cwd=ROOT, env=process_environment, stderr=subprocess.PIPE, text=True
    )
    until_ready(process)
    process.send_signal(signal.SIGTERM)
    _, said = process.communicate(timeout=10.0)
    assert process.returncode == 0, said


@pytest.mark.parametrize('command', PROGRAMS)
def test_every_program_in_the_readme_runs(process_environment, command):
    subprocess.run(command.split(), cwd=ROOT, env=process_environment, check=True, timeout=60.0)


@pytest.mark.parametrize('snippet', blocks('python'))
def test_every_snippet_in_the_readme_runs(snippet):
    subprocess.run([sys.executable, '-c', snippet], check=True, timeout=60.0)


def test_the_readme_starts_with_the_two_commands():
    assert [line.split('#')[0].strip() for line in COMMANDS[:2]] == ['make demo', 'make test']


@pytest.mark.parametrize('document', DOCUMENTS, ids=lambda p: p.name)
def test_every_link_and_picture_of_a_document_is_there(document):
    for target in re.findall(r'\]\(([^)#\s]+)\)', document.read_text()):
        assert (document.parent / target).exists(), target


@pytest.mark.parametrize('wrist', WRISTS)
def test_every_parameter_of_a_resolver_is_in_the_documents(wrist):
    missing = [spec.name for spec in specs(wrist) if f'`{spec.name}`' not in PARAMETERS]
    assert missing == []


def test_the_document_of_the_wrists_is_what_the_code_says(tmp_path):
    written = tmp_path / 'wrists.md'
    script = ROOT / 'scripts' / 'wrist_table.py'
    subprocess.run([sys.executable, str(script), str(written)], check=True, timeout=60.0)
    assert written.read_text() == (ROOT / 'docs' / 'wrists.md').read_text(), 'run `make docs`'


@pytest.mark.parametrize('node', [operator, joint_simulator, stewart_forward_kinematics])
def test_every_other_parameter_is_in_the_documents(node):
    missing = [spec.name for spec in node.SPECS if f'`{spec.name}`' not in PARAMETERS]
    assert missing == []


def test_every_maneuver_is_in_the_interfaces_document():
    choices = next(spec.choices for spec in operator.SPECS if spec.name == 'maneuver')
    assert [name for name in choices if f'`{name}`' not in INTERFACES] == []


def test_every_topic_of_a_resolver_is_in_the_interfaces_document(graph):
    node = graph.start(Resolver, 'three_gimbal')
    ours = (
        *graph.outside.get_publisher_names_and_types_by_node(node.get_name(), '/'),
        *graph.outside.get_subscriber_names_and_types_by_node(node.get_name(), '/'),
    )
    foreign = {'/rosout', '/parameter_events', '/clock'}
    names = {name for name, _ in ours} - foreign
    assert {'/cmd_vel', '/joint_command', '/wrist_status', '/diagnostics'} <= names
    missing = [name for name in names if f'`{name.lstrip("/")}`' not in INTERFACES]
    assert [name for name in missing if name != '/diagnostics'] == []


@pytest.mark.parametrize('document', DOCUMENTS, ids=lambda p: p.name)
def test_every_file_of_the_code_that_a_document_names_is_there(document):
    """By the end of its path; the wrist of the guide is not there until it is added."""
    there = [path.as_posix() for path in ROOT.glob('**/*.py') if '.venv' not in path.parts]
    named = re.findall(r'`(?:\./env )?(?:python3? )?([\w./-]+\.py)', document.read_text())
    missing = [name for name in named if not any(path.endswith(f'/{name}') for path in there)]
    assert [name for name in missing if 'pitch_roll_yaw' not in name] == []


def test_every_erratum_is_proved_by_a_test_that_exists():
    tests = ''.join(path.read_text() for path in ROOT.glob('src/wrist_control/test/**/test_*.py'))
    errata = (ROOT / 'docs' / 'errata.md').read_text()
    named = re.findall(r'`(test_\w+)`', errata)
    assert len(named) > 50
    assert [name for name in named if f'def {name}(' not in tests] == []
    rows = [row for row in errata.splitlines() if row.startswith('|') and '---' not in row]
    proofs = [row.rstrip('| ').rsplit('|', 1)[-1] for row in rows if 'as printed |' not in row]
    others = {proof.strip() for proof in proofs if '`test_' not in proof}
    assert others <= {'the same', 'notation, nothing to compute'}
