"""The command line of a node: what is wrong with it, and which of its files say nothing."""

from __future__ import annotations

import itertools
import re
from collections.abc import Iterator, Mapping, Sequence
from pathlib import Path
from typing import Any

import yaml

# What is valid after each flag, beside the flag itself.
VALID = {
    '--params-file': 'a YAML file with ros__parameters under the name of a node, or under /**',
    '-p': '<parameter>:=<value>, for example rate:=50.0',
    '-r': '<name>:=<another name>, for example cmd_vel:=twist, or __ns:=/left',
    '--log-level': 'debug, info, warn, error or fatal',
}
LONG = {'--param': '-p', '--remap': '-r'}
REFUSED = re.compile(r"'((-\S+) (.*))'\. Error: (.*?)(?:\s*, at /.*)?$", re.DOTALL)
# Reasons that say how ROS reads, and not what it has read.
UNCLEAR = re.compile('lexeme|error not set')
LOGS = re.compile("Failed to create log directory '(.*?)'")
PARAMETERS = 'ros__parameters'


def what_is_wrong(error: Exception) -> str:
    """Return why ROS cannot start with a command line, as a sentence for whoever typed it."""
    if type(error).__name__ == 'UnknownROSArgsError':
        return f'{error}; valid after --ros-args are {", ".join(VALID)}.'
    if folder := LOGS.search(str(error)):
        return f'ROS cannot keep its log in {folder[1]}; set ROS_LOG_DIR to a folder of yours.'
    refused = REFUSED.search(str(error))
    if refused is None:
        return f'{error}.'
    given, flag, argument, reason = refused.groups()
    valid = VALID.get(LONG.get(flag, flag), 'what ROS 2 takes')
    if flag == '--params-file' and not Path(argument).is_file():
        reason = 'there is no such file'
    because = '' if UNCLEAR.search(reason) else f' ({reason})'
    return f'{given} cannot be used{because}; valid is {valid}.'


def silent_files(arguments: Sequence[str], node: str) -> Iterator[str]:
    """Yield a sentence for every parameter file that is meant for a node and does not reach it.

    One of several may be for other nodes: it is meant for this one if it names the executable.

    Args:
        arguments: The command line, which begins with the executable.
        node: The node's name with its namespace: `/left/operator`.
    """
    executable = Path(arguments[0]).name
    files = {
        file: list(_keys(yaml.safe_load(Path(file).read_text()) or {}))
        for flag, file in itertools.pairwise(arguments)
        if flag == '--params-file'
    }
    silent = [
        file
        for file, keys in files.items()
        if keys and not any(_matches(key, node) for key in keys)
    ]
    for file in silent:
        keys = files[file]
        if silent == [*files] or executable in {key.rpartition('/')[2] for key in keys}:
            yield (
                f'{file} has parameters of {", ".join(keys)}, and none of {node}: it changes '
                f'nothing here; put them under {node}, or under /** for every node.'
            )


def _keys(content: Mapping[str, Any], before: str = '') -> Iterator[str]:
    """Yield the names of nodes, with their wildcards, that a file has parameters for."""
    for name, value in content.items():
        key = f'{before}/{str(name).strip("/")}'
        if isinstance(value, Mapping):
            if PARAMETERS in value:
                yield key
            yield from _keys({k: v for k, v in value.items() if k != PARAMETERS}, key)


def _matches(key: str, node: str) -> bool:
    pattern = re.escape(key).replace(r'/\*\*', r'(/\w+)*').replace(r'\*', r'\w+')
    return re.fullmatch(pattern, node) is not None
