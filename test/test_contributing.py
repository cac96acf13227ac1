"""Whoever carries on is told the truth: files, targets and settings are those that are used."""

import configparser
import re
from pathlib import Path

import pytest
import yaml

ROOT = Path(__file__).resolve().parents[1]
GUIDE = (ROOT / 'CONTRIBUTING.md').read_text()
MAKEFILE = (ROOT / 'Makefile').read_text()
SETTINGS = (ROOT / 'pyproject.toml').read_text()
MADE = ('build', 'install', 'log', 'out')
TEXTS = ('.cfg', '.in', '.json', '.md', '.msg', '.py', '.rst', '.toml', '.xml', '.yaml', '.yml')


def texts():
    """Return every text file of the repository that a person has written."""
    rooms = [one for one in ROOT.iterdir() if one.is_dir() and one.name not in MADE]
    ours = [room for room in rooms if not room.name.startswith('.')]
    files = [file for room in [*ours, ROOT / '.github'] for file in room.rglob('*')]
    return [file for file in [*ROOT.glob('*'), *files] if file.suffix in TEXTS]


@pytest.fixture
def editors():
    parser = configparser.ConfigParser()
    parser.read_string('[top]\n' + (ROOT / '.editorconfig').read_text())
    return parser


def test_editors_lay_out_python_as_ruff_does(editors):
    (columns,) = re.findall(r'^line-length = (\d+)', SETTINGS, re.MULTILINE)
    assert 'indent-width' not in SETTINGS  # then it is 4
    assert dict(editors['*.py']) == {'indent_size': '4', 'max_line_length': columns}
    assert editors['Makefile']['indent_style'] == 'tab'
    assert editors['top']['root'] == 'true'


def test_every_text_is_as_editors_are_told(editors):
    files = texts()
    assert len(files) > 200
    rules = editors['*']
    assert rules['insert_final_newline'] == rules['trim_trailing_whitespace'] == 'true'
    for file in files:
        text = file.read_bytes().decode(rules['charset'])
        assert '\r' not in text, file
        assert not text or text.endswith('\n'), file
        assert [line for line in text.splitlines() if line != line.rstrip()] == [], file


def test_before_a_commit_runs_what_make_lint_runs():
    (repository,) = yaml.safe_load((ROOT / '.pre-commit-config.yaml').read_text())['repos']
    (hook,) = repository['hooks']
    # Local, and by ./env: nothing is downloaded, and the versions are those of setup.
    assert (repository['repo'], hook['language']) == ('local', 'system')
    assert hook['entry'].startswith('./env ')
    assert f'\t@{hook["entry"]}\n' in MAKEFILE
    assert hook['pass_filenames'] is False


def test_every_target_that_the_guide_names_is_there():
    targets = set(re.findall(r'^([a-z]+):', MAKEFILE, re.MULTILINE))
    named = set(re.findall(r'(?:^|`)make ([a-z]+)', GUIDE, re.MULTILINE))
    assert {'setup', 'test', 'lint', 'format', 'coverage'} <= named <= targets


def test_every_place_that_the_guide_names_is_there():
    named = [name for name in re.findall(r'`([\w./-]+)`', GUIDE) if '/' in name or '.' in name]
    assert len(named) > 15
    made = ('./env', '.venv', 'out/coverage/')
    assert [name for name in named if name not in made and not (ROOT / name).exists()] == []


def test_coverage_writes_only_where_results_go():
    paths = re.findall(r"^(?:data_file|directory) = '(.*)'", SETTINGS, re.MULTILINE)
    assert len(paths) == 2
    assert all(path.startswith('out/coverage') for path in paths)
