"""Recordings on disk: MCAP in rosbag2's layout, written and read without ROS.

Needs the extra `record`; nothing but those who record, replay and report import this room.
"""

from importlib.util import find_spec

from wrist_control.errors import InvalidValueError

NEEDED = ('mcap', 'rosbags')


def check_installed() -> None:
    """See that recordings can be written and read here.

    Raises:
        InvalidValueError: They cannot; the sentence says what is missing.
    """
    if absent := [name for name in NEEDED if find_spec(name) is None]:
        raise InvalidValueError(
            f'{" and ".join(absent)}, which recordings need, cannot be imported here; '
            '`make setup-record` gets them.'
        )
