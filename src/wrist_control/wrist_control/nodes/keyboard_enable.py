"""How the keyboard asks a resolver to go on after a stop: by whoever says `wrist_status` here."""

from __future__ import annotations

from typing import Any

from std_srvs.srv import SetBool

from wrist_control.ros.guarded import GuardedNode
from wrist_control.ros.publishers import publishing
from wrist_control.ros.shown import SENTENCE, shown

# How long an answer is waited for, s.
PATIENCE = 3.0


class Enabling:
    """Asks for `~/enable`, one call at a time, without ever waiting.

    Attributes:
        said: What came of it, one sentence.
    """

    def __init__(self, node: GuardedNode, status_topic: str) -> None:
        """Ask nobody yet.

        Args:
            node: Whoever asks.
            status_topic: Its topic `wrist_status`, with its namespace.
        """
        self.said = ''
        self._node = node
        self._topic = status_topic
        self._client: Any = None
        self._answer: Any = None
        self._end = 0.0

    def ask(self, now: float) -> None:
        """Begin to ask; what was asked before is forgotten.

        Args:
            now: s, on a clock that never jumps.
        """
        self.forget()
        resolvers = sorted(publishing(self._node, self._topic))
        if len(resolvers) != 1:
            found = shown(', '.join(resolvers)) or 'nobody'
            self.said = f'Enables nothing: {self._topic} comes from {found}, not one resolver.'
            return
        self.said = f'Asks {resolvers[0]} to go on.'
        self._client = self._node.create_client(SetBool, f'{resolvers[0]}/enable')
        self._end = now + PATIENCE

    def look(self, now: float) -> None:
        """Go on with what was asked for: send it once the resolver is found, take its answer."""
        if self._client is None:
            return
        if self._answer is None and self._client.service_is_ready():
            self._answer = self._client.call_async(SetBool.Request(data=True))
        if self._answer is not None and self._answer.done():
            answer = self._answer.result()
            self.said = shown(answer.message, SENTENCE) or 'It goes on.'
        elif now > self._end:
            self.said = f'{self._client.srv_name} does not answer.'
        else:
            return
        self.forget()

    def forget(self) -> None:
        """Wait for no answer any more."""
        if self._client is not None:
            self._node.destroy_client(self._client)
        self._client = self._answer = None
