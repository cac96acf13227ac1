"""Write docs/licences.md: every distribution that setup may install, with its licence.

Licences are read from what is installed, so run this where every name that is pinned is there:
with Python 3.10 and every extra.  Another file to write may be named as the argument.
"""

from __future__ import annotations

import re
import sys
from importlib import metadata
from pathlib import Path
from xml.etree import ElementTree

ROOT = Path(__file__).resolve().parent.parent
DOCUMENT = ROOT / 'docs' / 'licences.md'
PIN = re.compile(r'^(\S+)==(\S+)', re.MULTILINE)
COPYLEFT = re.compile(r'GPL|MPL|Mozilla|EPL|EUPL')
# Where no metadata say it, only the text of the licence does.
APACHE = 'Apache License 2.0'
BY_THEIR_TEXT = {'ros-fastcdr': APACHE, 'ros-fastrtps': APACHE, 'setuptools': 'MIT'}
LONGEST = 60  # characters of a licence's name; more is its text

HEAD = """# Licences of what setup installs

Made by `scripts/licences.py` from the metadata of what is installed.
Of several versions, each is for other versions of Python.
wrist_control itself is under the Apache License 2.0, and contains none of these.

Copyleft, each for its own files or as one choice of several: {copyleft}.
Some wheels bring libraries of others along, with their licences: NumPy and SciPy the Fortran
runtime of GCC (GPL with the runtime exception, and LGPL), Fast DDS OpenSSL 1.1.1 and TinyXML-2.

| distribution | version | licence |
| --- | --- | --- |
"""


def pinned() -> dict[str, list[str]]:
    """Return the versions of every distribution that a requirements file pins."""
    versions: dict[str, list[str]] = {}
    for file in ROOT.glob('requirements*.txt'):
        for name, version in PIN.findall(file.read_text()):
            if version not in versions.setdefault(name, []):
                versions[name].append(version)
    return versions


def licence(name: str) -> str:
    """Return the licence of an installed distribution."""
    said = metadata.metadata(name)
    told = (said.get_all('License-Expression') or said.get_all('License') or [''])[0]
    if told and told != 'UNKNOWN' and len(told) <= LONGEST:
        return told
    classifiers = said.get_all('Classifier') or []
    names = [one.split(' :: ')[-1] for one in classifiers if one.startswith('License ::')]
    return ', '.join(names) or BY_THEIR_TEXT.get(name) or ros_licence(name)


def ros_licence(name: str) -> str:
    """Return the licence of a ROS package, which says it in its package.xml."""
    package = name.removeprefix('ros-').removeprefix('jazzy-').replace('-', '_')
    file = Path(sys.prefix) / 'share' / package / 'package.xml'
    return ', '.join(one.text or '' for one in ElementTree.parse(file).iter('license'))


def main(document: Path) -> None:
    """Write the document."""
    versions = pinned()
    licences = {name: licence(name) for name in sorted(versions)}
    copyleft = [name for name, said in licences.items() if COPYLEFT.search(said)]
    rows = [
        f'| {name} | {", ".join(versions[name])} | {said} |\n' for name, said in licences.items()
    ]
    document.write_text(HEAD.format(copyleft=', '.join(copyleft)) + ''.join(rows))


if __name__ == '__main__':
    main(Path(sys.argv[1]) if sys.argv[1:] else DOCUMENT)
