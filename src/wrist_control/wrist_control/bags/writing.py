"""A recording that is being written: a folder in rosbag2's layout, complete all along."""

from __future__ import annotations

from pathlib import Path
from typing import IO, Any, NamedTuple, cast

import yaml
from mcap.writer import CompressionType, Writer

from wrist_control.bags.complete_file import CompleteFile
from wrist_control.errors import InvalidValueError

# Of rosbag2's layout, as Jazzy writes it.
VERSION, DISTRO, STORAGE = 9, 'jazzy', 'mcap'
METADATA = 'metadata.yaml'
# A chunk that is larger is closed before the next flush.
CHUNK_BYTES = 512 * 1024


class Topic(NamedTuple):
    """What is recorded of one topic beside its messages.

    Attributes:
        name: Its absolute name.
        type: Its type, as `std_msgs/msg/Empty`.
        definition: The definition of that type, with all that it is made of.
        hash: The hash of that type, `RIHS01_…`; empty where it is not known.
        qos: What its publishers offer, one for each, in rosbag2's words.
    """

    name: str
    type: str
    definition: str
    hash: str
    qos: list[dict[str, Any]]


class Span(NamedTuple):
    """From the first message to the last, ns."""

    begin: int
    end: int


def check_free(folder: Path) -> None:
    """See that a folder can be made.

    Raises:
        InvalidValueError: It cannot; the sentence says why.
    """
    if folder.exists():
        raise InvalidValueError(
            f'{folder} is there already; valid is a folder that is not, so that no recording is '
            'lost.'
        )
    try:
        folder.mkdir(parents=True)
        folder.rmdir()  # whoever only asks shall leave nothing
    except OSError as error:
        raise InvalidValueError(
            f'{folder} cannot be made ({error.strerror}); valid is a folder where you may write.'
        ) from error


class BagWriter:
    """Writes a recording.

    Attributes:
        folder: Where it is.
        counts: How many messages of each topic are in it, by name.
    """

    def __init__(self, folder: Path) -> None:
        """Make the folder, with a file that has no message yet.

        Raises:
            InvalidValueError: It is there already, or cannot be made.
            OSError: It cannot be written.
        """
        check_free(folder)
        folder.mkdir(parents=True)
        self.folder = folder
        self.counts: dict[str, int] = {}
        self._topics: list[Topic] = []
        self._schemas: dict[str, int] = {}
        self._span: Span | None = None
        self._name = f'{folder.absolute().name}_0.{STORAGE}'
        self._file = CompleteFile(folder / self._name)
        self._writer = Writer(
            cast(IO[Any], self._file),
            chunk_size=CHUNK_BYTES,
            compression=CompressionType.ZSTD,
        )
        self._writer.start(profile='ros2', library='wrist_control')
        self.flush()

    @property
    def messages(self) -> int:
        """How many messages are in it."""
        return sum(self.counts.values())

    @property
    def size(self) -> int:
        """How large its file is."""
        return self._file.tell()

    @property
    def duration(self) -> float:
        """Time from the first message to the last, s."""
        return 0.0 if self._span is None else 1e-9 * (self._span.end - self._span.begin)

    def add(self, topic: Topic) -> int:
        """Begin to record a topic; return its number for `write`."""
        if topic.type not in self._schemas:
            self._schemas[topic.type] = self._writer.register_schema(
                topic.type, 'ros2msg', topic.definition.encode()
            )
        self._topics.append(topic)
        self.counts[topic.name] = 0
        return self._writer.register_channel(
            topic.name,
            'cdr',
            self._schemas[topic.type],
            {
                'offered_qos_profiles': yaml.safe_dump(topic.qos),
                'topic_type_hash': topic.hash,
            },
        )

    def write(self, channel: int, data: bytes, log_time: int, sent: int, number: int) -> None:
        """Take a message.

        Args:
            channel: Its topic, as `add` has returned it.
            data: As it came, CDR.
            log_time: When it came, ns.
            sent: When it was sent, ns.
            number: Which of its publisher's messages it is; 0 where that is not known.
        """
        self._writer.add_message(channel, log_time, data, sent, number)
        self.counts[self._topics[channel - 1].name] += 1
        begin, end = self._span or (log_time, log_time)
        self._span = Span(min(begin, log_time), max(end, log_time))

    def flush(self) -> None:
        """See that all that was taken can be read, whatever happens next.

        Raises:
            OSError: It does not fit on the disk; what was flushed before can be read.
        """
        self._writer.flush()
        self._write_metadata()

    def close(self) -> None:
        """Write the index, by which readers find what they look for sooner.

        Raises:
            OSError: It does not fit on the disk; what was flushed before can be read.
        """
        self._writer.finish()
        self._file.close()
        self._write_metadata()

    def _write_metadata(self) -> None:
        text = yaml.safe_dump({'rosbag2_bagfile_information': self._metadata()}, sort_keys=False)
        new = self.folder / f'.{METADATA}.new'
        new.write_text(text, encoding='utf-8')
        new.replace(self.folder / METADATA)  # nobody ever sees half of it

    def _metadata(self) -> dict[str, Any]:
        begin, end = self._span or (0, 0)
        extent = {
            'duration': {'nanoseconds': end - begin},
            'starting_time': {'nanoseconds_since_epoch': begin},
            'message_count': self.messages,
        }
        topics = [
            {
                'topic_metadata': {
                    'name': topic.name,
                    'type': topic.type,
                    'serialization_format': 'cdr',
                    'offered_qos_profiles': topic.qos,
                    'type_description_hash': topic.hash,
                },
                'message_count': self.counts[topic.name],
            }
            for topic in self._topics
        ]
        return {
            'version': VERSION,
            'storage_identifier': STORAGE,
            **extent,
            'topics_with_message_count': topics,
            'compression_format': '',
            'compression_mode': '',
            'relative_file_paths': [self._name],
            'files': [{'path': self._name, **extent}],
            'custom_data': None,
            'ros_distro': DISTRO,
        }
