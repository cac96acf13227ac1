"""A recording read from disk, up to where it ends or is cut off, by anybody's writer of MCAP.

Messages are decoded by the definitions that the recording itself holds.
"""

from __future__ import annotations

from collections.abc import Callable, Iterator
from pathlib import Path
from typing import Any, NamedTuple

from mcap.records import Channel, Message, Schema
from mcap.stream_reader import StreamReader
from rosbags.typesys import Stores, get_types_from_msg, get_typestore
from rosbags.typesys.store import Typestore

from wrist_control.errors import InvalidValueError

MAGIC = b'\x89MCAP0\r\n'
# No record of a wrist's is larger; of a damaged file one may seem to be.
LARGEST = 256 * 2**20
HOW = 'valid is the folder of a recording in MCAP, as `recorder` makes it, or its .mcap file.'


class Stamped(NamedTuple):
    """A message and when it came, ns."""

    time: int
    message: Any


class Recording:
    """What a recording holds.

    Attributes:
        path: Where it is.
        types: The type of each topic, by name.
        cut: What is wrong with its end, one sentence; empty where nothing is.
    """

    def __init__(
        self,
        path: Path,
        wanted: Callable[[str, str], bool] = lambda topic, kind: True,
        tell: Callable[[float], None] = lambda share: None,
    ) -> None:
        """Read it.

        Args:
            path: Its folder, or its file.
            wanted: Whether the messages of a topic of a type are wanted.
            tell: Called now and then with the share that is read, 0 to 1.

        Raises:
            InvalidValueError: There is nothing to be read; the sentence says why.
        """
        self.path = path
        self.types: dict[str, str] = {}
        self.cut = ''
        self._wanted = wanted
        self._data: dict[str, list[tuple[int, bytes]]] = {}
        self._store: Typestore = get_typestore(Stores.EMPTY)
        files = _files(path)
        total = max(1, sum(file.stat().st_size for file in files))
        done = 0
        for file in files:
            for at in self._read(file):
                tell((done + at) / total)
            done += file.stat().st_size
        tell(1.0)
        if not any(self._data.values()):
            raise InvalidValueError(
                f'{path} holds no message{f": {self.cut}" if self.cut else "."} {HOW}'
                if not self.types
                else f'{path} holds no message that is looked for; its topics are '
                f'{", ".join(sorted(self.types))}.'
            )

    def messages(self, topic: str) -> list[Stamped]:
        """Return the messages of a topic, decoded, in the order they came.

        Raises:
            InvalidValueError: One of them is not of the type that the recording says.
        """
        kind = self.types.get(topic, '')
        try:
            return [
                Stamped(when, self._store.deserialize_cdr(data, kind))
                for when, data in self._data.get(topic, ())
            ]
        except Exception as error:
            raise InvalidValueError(
                f'{self.path} has a message on {topic} that is no {kind}; record it anew.'
            ) from error

    def _read(self, file: Path) -> Iterator[int]:
        """Read a file, and yield now and then how far."""
        schemas: dict[int, Schema] = {}
        topics: dict[int, str] = {}
        with file.open('rb') as stream:
            try:
                reader = StreamReader(stream, validate_crcs=True, record_size_limit=LARGEST)
                for record in reader.records:
                    if isinstance(record, Message):
                        if record.channel_id in topics:
                            topic = topics[record.channel_id]
                            self._data[topic].append((record.log_time, record.data))
                    elif isinstance(record, Schema):
                        schemas[record.id] = record
                    elif isinstance(record, Channel):
                        self._take_up(record, schemas.get(record.schema_id), topics)
                    else:
                        yield stream.tell()
            except Exception:  # what is damaged may make its readers raise anything
                self.cut = (
                    f'{file} is cut off or damaged after {stream.tell()} bytes; what was before '
                    'that is read.'
                )

    def _take_up(self, channel: Channel, schema: Schema | None, topics: dict[int, str]) -> None:
        if schema is None or channel.id in topics:
            return
        self.types[channel.topic] = schema.name
        if schema.encoding != 'ros2msg' or not self._wanted(channel.topic, schema.name):
            return
        if schema.name not in self._store.fielddefs:
            text = schema.data.decode(errors='replace')
            try:
                found = get_types_from_msg(text, schema.name)
            except Exception:
                return  # nothing of ours has a definition that cannot be read
            known = self._store.fielddefs
            self._store.register({name: one for name, one in found.items() if name not in known})
        topics[channel.id] = channel.topic
        self._data.setdefault(channel.topic, [])


def _files(path: Path) -> list[Path]:
    """Return the files of a recording, in order.

    Raises:
        InvalidValueError: There are none.
    """
    if not path.exists():
        raise InvalidValueError(f'{path} is not there; {HOW}')
    files = [path]
    if path.is_dir():
        # `name_0.mcap`, `name_1.mcap` and so on, where a recording has been split.
        files = sorted(path.glob('*.mcap'), key=lambda file: (len(file.name), file.name))
        if not files and list(path.glob('*.db3')):
            raise InvalidValueError(
                f'{path} is a recording in sqlite3, which is not read; `rosbags-convert --src '
                f'{path} --dst NEW --dst-storage mcap` makes one in MCAP of it.'
            )
        if not files:
            raise InvalidValueError(f'{path} has no .mcap file in it; {HOW}')
    for file in files:
        try:
            with file.open('rb') as stream:
                begin = stream.read(len(MAGIC))
        except OSError as error:
            raise InvalidValueError(f'{file} cannot be read ({error.strerror}).') from error
        if not begin:
            raise InvalidValueError(f'{file} is empty; {HOW}')
        if begin != MAGIC:
            raise InvalidValueError(f'{file} is no recording: it does not begin as MCAP; {HOW}')
    return files
