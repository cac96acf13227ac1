"""Write docs/licences.md: every distribution that setup may install, with its licence.

Licences are read from what is installed, so run this with every extra.  Some distributions are
for some versions of Python only: what is not installed here keeps what the document said of it.
"""

from __future__ import annotations

import re
import sys
from contextlib import suppress
from importlib import metadata
from pathlib import Path
from xml.etree import ElementTree

ROOT = Path(__file__).resolve().parent.parent
DOCUMENT = ROOT / 'docs' / 'licences.md'
ROW = re.compile(r'^\| (\S+) \| .* \| (.*) \|$', re.MULTILINE)
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
    for file in sorted(ROOT.glob('requirements*.txt')):
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


def main() -> int:
    """Write the document, and tell by the exit code whether every licence is known."""
    versions = pinned()
    licences = dict(ROW.findall(DOCUMENT.read_text())) if DOCUMENT.exists() else {}
    for name in versions:
        with suppress(metadata.PackageNotFoundError):
            licences[name] = licence(name)
    known = sorted(versions.keys() & licences.keys())
    copyleft = [name for name in known if COPYLEFT.search(licences[name])]
    rows = [f'| {name} | {", ".join(versions[name])} | {licences[name]} |\n' for name in known]
    DOCUMENT.write_text(HEAD.format(copyleft=', '.join(copyleft)) + ''.join(rows))
    unknown = sorted(versions.keys() - licences.keys())
    if unknown:
        print(f'licences: not installed here: {", ".join(unknown)}; use another Python for these')
    return bool(unknown)


if __name__ == '__main__':
    sys.exit(main())
