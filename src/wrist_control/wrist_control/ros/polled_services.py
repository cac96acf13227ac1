"""Services that are looked at now and then, so that a flood of calls cannot stop the control loop.

An executor serves every call before it comes to what arrived after it, and each answer costs. Here
the calls wait in the middleware, and no more of them are answered than there is time for.
"""

from __future__ import annotations

import time
from collections.abc import Sequence
from typing import Any

from rclpy.clock import Clock, ClockType
from rclpy.node import Node
from rclpy.service import Service

# How often calls are looked at, s, and for how long at most: a tenth of one core.
PERIOD = 0.01
BUDGET = 0.001
# The middleware waits for 0.1 s for one who has asked and is gone: it is he if it took this long.
NOBODY = 0.05


class PolledServices:
    """Answers the calls of a node whose services no executor sees."""

    def __init__(self, node: Node, services: Sequence[Service]) -> None:
        """Look at the calls from now on, whatever simulated time does.

        Args:
            node: The node.
            services: All of its services.
        """
        self._services = services
        self._next = 0
        node.create_timer(PERIOD, self._look, clock=Clock(clock_type=ClockType.STEADY_TIME))

    def _look(self) -> None:
        """Answer one call of each service in turn, until none waits or the time is up."""
        end = time.monotonic() + BUDGET
        unasked = len(self._services)
        while unasked and time.monotonic() < end:
            self._next = (self._next + 1) % len(self._services)
            answered = self._answer(self._services[self._next])
            unasked = len(self._services) if answered else unasked - 1

    def _answer(self, service: Service) -> bool:
        """Answer one call, if there is one."""
        request, header = self._taken(service)
        if header is None:
            return False
        response = service.callback(request, service.srv_type.Response())
        began = time.monotonic()
        service.send_response(response, header)
        if time.monotonic() - began > NOBODY:
            while self._taken(service)[1] is not None:
                pass  # whoever asked in vain asks again; each of these may cost as much
        return True

    @staticmethod
    def _taken(service: Service) -> tuple[Any, Any]:
        with service.handle:
            taken: tuple[Any, Any] = service.handle.service_take_request(service.srv_type.Request)
        return taken
