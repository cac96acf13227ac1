"""The documents as the tests read them: their blocks, and what a block says is printed."""

import re
from pathlib import Path

ROOT = Path(__file__).resolve().parents[1]
DOCUMENTS = [
    *(ROOT / name for name in ('README.md', 'CONTRIBUTING.md', 'examples/README.md')),
    *sorted((ROOT / 'docs').glob('**/*.md')),
]
FIRST_STEPS = ROOT / 'docs' / 'first-steps.md'
BLOCK = re.compile(r'^```(\S*)\n(.*?)^```$', re.MULTILINE | re.DOTALL)


def blocks(document, *languages):
    """Return the blocks of a document in order, as (language, content)."""
    found = BLOCK.findall(document.read_text())
    return [block for block in found if block[0] in languages or not languages]


def without_blocks(document):
    return BLOCK.sub('', document.read_text())


def printed(shown):
    """Return a pattern for what a block shows; … differs, and alone it stands for any lines."""
    lines = shown.splitlines()
    parts = [
        r'(?:.*\n)*?' if line == '…' else rf'^{re.escape(line).replace("…", ".*")}\n'
        for line in lines
    ]
    return re.compile(''.join(parts), re.MULTILINE)
