"""The documents are true: what they show runs, what they list exists, and nothing is left out."""

import re
import shlex
import signal
import subprocess
import sys
from importlib.util import find_spec

import pytest

from machine import APT_OF_EXTRA
from wrist_control.nodes import (
    joint_simulator,
    keyboard,
    operator,
    physics_settings,
    recorder,
    rotary_stewart_forward_kinematics,
    stewart_forward_kinematics,
)
from wrist_control.nodes.resolver import Resolver
from wrist_control.nodes.resolver_settings import mechanism_specs, specs
from wrist_control.wrists import WRISTS, make_wrist

from .documents import DOCUMENTS, FIRST_STEPS, ROOT, blocks, without_blocks
from .typing_hand import Typist

INTERFACES = (ROOT / 'docs' / 'interfaces.md').read_text()
PARAMETERS = INTERFACES + (ROOT / 'docs' / 'wrists.md').read_text()


LANGUAGES = {'sh', 'python', 'text', 'yaml', 'math', '{toctree}', '{eval-rst}'}
# A whole file of settings, under its name.
FILE = re.compile(r'`([\w/]+\.yaml)`:\n\n```yaml\n(.*?)```', re.DOTALL)


def commands(*documents):
    """Return every command that is run, with the document that it stands in."""
    return [
        pytest.param(line, document, id=f'{document.stem}: {line}')
        for document in documents
        for _, block in blocks(document, 'sh')
        for line in block.splitlines()
    ]


# What the first steps show is run by a test of their own.
COMMANDS = commands(*(document for document in DOCUMENTS if document != FIRST_STEPS))
TYPED = [one for one in COMMANDS if one.values[0].startswith('./env keyboard')]
NODES = [one for one in COMMANDS if '--ros-args' in one.values[0] and one not in TYPED]
PROGRAMS = [
    one for one in COMMANDS if one.values[0].startswith('./env') and one not in (*NODES, *TYPED)
]
SNIPPETS = [block for document in DOCUMENTS for _, block in blocks(document, 'python')]
TARGETS = re.findall(r'^(\w+):', (ROOT / 'Makefile').read_text(), re.MULTILINE)
TARGETS += [f'setup-{extra}' for extra in APT_OF_EXTRA]
HEADINGS = re.compile(r'^#+ (.*)$', re.MULTILINE)


def words(command, document, folder):
    """Return a command in words; a file of settings that its document shows is written first."""
    for name, content in FILE.findall(document.read_text()):
        (folder / name).parent.mkdir(parents=True, exist_ok=True)
        (folder / name).write_text(content)
        command = command.replace(f' {name}', f' {folder / name}')
    # Pages are served side by side where tests are.
    return shlex.split(command) + ['-p', 'port:=0'] * (' console ' in command)


@pytest.mark.parametrize(('command', 'document'), NODES)
def test_every_node_in_the_documents_starts_and_ends_cleanly(
    process_environment, until_ready, tmp_path, command, document
):
    process = subprocess.Popen(
        words(command, document, tmp_path),
        cwd=ROOT,
        env=process_environment,
        stderr=subprocess.PIPE,
        text=True,
    )
    until_ready(process)
    process.send_signal(signal.SIGTERM)
    _, said = process.communicate(timeout=10.0)
    assert process.returncode == 0, said


@pytest.mark.parametrize(('command', 'document'), TYPED)
def test_every_keyboard_in_the_documents_starts_in_a_terminal(
    process_environment, graph, tmp_path, command, document
):
    typist = Typist(process_environment, words(command, document, tmp_path), folder=ROOT)
    try:
        graph.until(lambda: 'Ctrl-C ends' in typist.written)
        typist.type('\x03')
        graph.until(lambda: typist.process.poll() is not None)
        assert typist.process.returncode == 0
    finally:
        typist.close()


@pytest.mark.parametrize(('command', 'document'), PROGRAMS)
def test_every_program_in_the_documents_runs(process_environment, tmp_path, command, document):
    subprocess.run(
        words(command, document, tmp_path),
        cwd=ROOT,
        env=process_environment,
        check=True,
        timeout=60.0,
    )


@pytest.mark.parametrize('snippet', SNIPPETS, ids=range(len(SNIPPETS)))
def test_every_snippet_in_the_documents_runs(snippet):
    subprocess.run([sys.executable, '-c', snippet], check=True, timeout=60.0)


def test_the_readme_starts_with_the_two_commands():
    first = [command.values[0] for command in COMMANDS[:2]]
    assert [line.split('#')[0].strip() for line in first] == ['make demo', 'make test']


def test_every_command_is_run_or_is_a_target_of_make():
    others = [one.values[0] for one in COMMANDS if one not in (*NODES, *PROGRAMS, *TYPED)]
    others += [line for _, block in blocks(FIRST_STEPS, 'sh') for line in block.splitlines()]
    assert {line.split()[0] for line in others} <= {'make', './env'}


@pytest.mark.parametrize('document', DOCUMENTS, ids=lambda p: p.stem)
def test_every_block_says_whether_it_is_run(document):
    """Only the first steps show output: their test compares it."""
    allowed = LANGUAGES | ({'output'} if document == FIRST_STEPS else set())
    assert {language for language, _ in blocks(document)} <= allowed


@pytest.mark.parametrize('document', DOCUMENTS, ids=lambda p: p.stem)
def test_every_target_and_module_that_a_document_names_is_there(document):
    spans = re.findall(r'`([^`\n]+)`', without_blocks(document))
    spans += [line for _, block in blocks(document, 'sh') for line in block.splitlines()]
    targets = {span.split()[1] for span in spans if re.match(r'make \w', span)}
    assert targets <= set(TARGETS)
    modules = {found[1] for span in spans if (found := re.search(r'python3? -m (\S+)', span))}
    assert {module for module in modules if find_spec(module) is None} == set()


def anchors(document):
    """Return the anchors of a document's headings, as GitHub makes them."""
    headings = HEADINGS.findall(without_blocks(document))
    return {re.sub(r'[^\w\- ]', '', heading.lower()).replace(' ', '-') for heading in headings}


@pytest.mark.parametrize('document', DOCUMENTS, ids=lambda p: p.stem)
def test_every_link_and_picture_of_a_document_is_there(document):
    for target in re.findall(r'\]\(([^)\s]+)\)', without_blocks(document)):
        path, _, anchor = target.partition('#')
        linked = document.parent / path if path else document
        assert linked.exists(), target
        assert not anchor or anchor in anchors(linked), target


@pytest.mark.parametrize('wrist', WRISTS)
def test_every_parameter_of_a_resolver_is_in_the_documents(wrist):
    missing = [
        spec.name
        for spec in [*mechanism_specs(wrist), *specs(make_wrist(wrist))]
        if f'`{spec.name}`' not in PARAMETERS
    ]
    assert missing == []


def test_the_document_of_the_wrists_is_what_the_code_says(tmp_path):
    written = tmp_path / 'wrists.md'
    script = ROOT / 'scripts' / 'wrist_table.py'
    subprocess.run([sys.executable, str(script), str(written)], check=True, timeout=60.0)
    assert written.read_text() == (ROOT / 'docs' / 'wrists.md').read_text(), 'run `make docs`'


@pytest.mark.parametrize(
    'node',
    [
        operator,
        keyboard,
        joint_simulator,
        physics_settings,
        recorder,
        stewart_forward_kinematics,
        rotary_stewart_forward_kinematics,
    ],
)
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
    absolute = {'/diagnostics', '/tf'}
    shown = [name if name in absolute else name.lstrip('/') for name in names]
    assert [name for name in shown if f'`{name}`' not in INTERFACES] == []


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
