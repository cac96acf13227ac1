"""Serves the page: NiceGUI, on a thread of its own."""

from __future__ import annotations

import logging
import socket
import threading
from ipaddress import ip_address
from typing import TYPE_CHECKING

import uvicorn
from fastapi import FastAPI
from nicegui import app, core, ui
from starlette.middleware.trustedhost import TrustedHostMiddleware

from wrist_control.errors import InvalidValueError
from wrist_control.web.page import build

if TYPE_CHECKING:
    from wrist_control.web.console import Console

TITLE = 'wrist_control'
# s that the server may take to end.
ENDS_WITHIN = 2.0


class Server:
    """The web server of a console; one in a process, for NiceGUI knows only one.

    Attributes:
        address: Where the page is.
    """

    def __init__(self, console: Console, host: str, port: int) -> None:
        """Serve from now on.

        Args:
            console: Whose page it is.
            host: Address to serve at.
            port: Port to serve at, 0 for any.

        Raises:
            InvalidValueError: It cannot be served there.
        """
        listening = _listening(host, port)
        port = listening.getsockname()[1]
        self.address = f'http://{host}:{port}'
        outer = FastAPI()
        if ip_address(host).is_loopback:
            # A page of somebody else's shall not drive the hand by way of this browser.
            outer.add_middleware(
                TrustedHostMiddleware, allowed_hosts=[host, 'localhost', '127.0.0.1']
            )
        core.sio.eio.cors_allowed_origins = None  # the page's own, and no other's

        @app.post('/stop')
        def stop() -> None:
            """Stop every wrist: also where the page's own connection is broken."""
            console.stop()

        ui.run_with(
            outer,
            root=lambda: build(console),
            title=TITLE,
            dark=None,
            favicon='🦾',
            show_welcome_message=False,
        )
        self._server = uvicorn.Server(
            uvicorn.Config(
                outer, log_level='warning', timeout_graceful_shutdown=1, ws='websockets-sansio'
            )
        )
        self._thread = threading.Thread(
            target=self._server.run, kwargs={'sockets': [listening]}, daemon=True
        )
        self._thread.start()

    def close(self) -> None:
        """Serve no more: pages that are open are cut off, and nothing is said of it."""
        logging.getLogger('uvicorn.error').setLevel(logging.CRITICAL)
        self._server.should_exit = self._server.force_exit = True
        self._thread.join(ENDS_WITHIN)


def _listening(host: str, port: int) -> socket.socket:
    """Return a socket that listens.

    Raises:
        InvalidValueError: There is no such address here, or the port is taken.
    """
    try:
        family = socket.AF_INET6 if ip_address(host).version == 6 else socket.AF_INET
    except ValueError as error:
        raise InvalidValueError(
            f'host is {host!r}; give an address of this machine, as 127.0.0.1, or 0.0.0.0 for all.'
        ) from error
    listening = socket.socket(family)
    listening.setsockopt(socket.SOL_SOCKET, socket.SO_REUSEADDR, 1)
    try:
        listening.bind((host, port))
    except OSError as error:
        listening.close()
        raise InvalidValueError(
            f'The page cannot be served at {host}, port {port} ({error.strerror}): choose another '
            'port, as -p port:=8081, or 0 for any that is free.'
        ) from error
    return listening
