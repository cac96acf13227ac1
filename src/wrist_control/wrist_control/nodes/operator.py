"""The operator: a maneuver, a joystick or constant rates, as commands at a steady rate."""

from __future__ import annotations

import math
import sys
from collections.abc import Sequence
from pathlib import Path
from typing import Any

from geometry_msgs.msg import TwistStamped
from rclpy.time import Time
from sensor_msgs.msg import Joy
from std_msgs.msg import Header

from wrist_control.bags import check_installed
from wrist_control.errors import InvalidValueError, RefusedError
from wrist_control.operating.joystick import Joystick, JoystickWithTimeout
from wrist_control.operating.maneuvers import (
    BARKER_SPEED,
    MANEUVERS,
    ZERO_RATES,
    make_maneuver,
)
from wrist_control.operating.pilot import Pilot
from wrist_control.operating.recorded import RecordedCommands
from wrist_control.resolving.latest_message import LatestMessage
from wrist_control.ros import convert
from wrist_control.ros.diagnostics import OK, WARN, Diagnostics
from wrist_control.ros.guarded import GuardedNode
from wrist_control.ros.parameters import Spec
from wrist_control.ros.qos import NEWEST, OUTPUT
from wrist_control.ros.running import run
from wrist_interfaces.msg import WristStatus

SPECS = [
    Spec('rate', 50.0, 'Commands per second, from the node clock', 'Hz', 1.0, 1000.0),
    Spec(
        'maneuver',
        'hold',
        'What to fly; or "constant" for constant_rates, "joystick" for the topic joy, or '
        '"recording" for the commands of a recording',
        choices=(*MANEUVERS, 'constant', 'joystick', 'recording'),
    ),
    Spec('recording', '', 'Folder of the maneuver "recording", as the recorder makes it'),
    Spec('speed', BARKER_SPEED, 'Hand rate that a maneuver is flown at', 'rad/s', 1e-6, 100.0),
    Spec(
        'constant_rates',
        [0.0, 0.0, 0.0],
        'p, q, r of the maneuver "constant"',
        'rad/s',
        -100.0,
        100.0,
        live=True,
    ),
    Spec('listeners', 1, 'Subscribers of cmd_vel that a maneuver waits for', '', 0, 100),
    Spec('frame_id', '', 'Frame of the commands: the hand frame, the forearm frame, or empty'),
    Spec('joy_axes', [0, 1, 3], 'Numbers of the axes for p, q, r', '', 0, 100),
    Spec(
        'joy_scales',
        [-BARKER_SPEED, BARKER_SPEED, BARKER_SPEED],
        'p, q, r at full deflection; below 0 turns an axis round',
        'rad/s',
        -100.0,
        100.0,
    ),
    Spec('joy_deadzone', 0.05, 'Deflection that counts as none', '', 0.0, 0.9),
    Spec('joy_timeout', 0.5, 'Silence after which a joystick counts as released', 's', 0.01, 10.0),
    Spec('joy_expo', 0.0, '0: rates in proportion; 1: as the cube, finer in the middle', '', 0, 1),
    Spec('enable_button', 5, 'Button that must be held, -1 for none', '', -1, 100),
    Spec('turbo_button', -1, 'Button that changes the speed while held, -1 for none', '', -1, 100),
    Spec('turbo_factor', 2.0, 'Times as fast then; below 1 is slower', '', 0.01, 10.0),
]
TRIPLES = ('constant_rates', 'joy_axes', 'joy_scales')


class Operator(GuardedNode):
    """Publishes `cmd_vel`, and watches `wrist_status` as a person watches the hand."""

    def __init__(self, **node_options: Any) -> None:
        """Declare the parameters and start publishing.

        Args:
            node_options: Passed on to rclpy.

        Raises:
            WristError: A parameter cannot be used; the sentence says why.
        """
        super().__init__('operator', **node_options)
        self._values = self.declare(SPECS)
        self._check(self._values)
        self._period = 1.0 / self._values['rate']
        self._pilot: Pilot | None = None
        self._joystick: JoystickWithTimeout | None = None
        self._recorded: RecordedCommands | None = None
        self._times_lost: LatestMessage[float] = LatestMessage()
        self._wrist_is_up = False
        self.watch(self._check, self._values.update)
        self._diagnostics = Diagnostics(self, self._health)
        self._publisher = self.create_publisher(TwistStamped, 'cmd_vel', OUTPUT)
        self._take_up(self._values['maneuver'])
        self.create_timer(self._period, self._tick)

    def _take_up(self, maneuver: str) -> None:
        if maneuver == 'joystick':
            self._joystick = JoystickWithTimeout(self._mapping(), self._values['joy_timeout'])
            self.create_subscription(Joy, 'joy', self._on_joy, NEWEST)
        elif maneuver == 'recording':
            self._recorded = self._recorded_commands()
            self.create_subscription(WristStatus, 'wrist_status', self._on_status, NEWEST)
        elif maneuver != 'constant':
            self._pilot = Pilot(make_maneuver(maneuver, self._values['speed']), self._period)
            self.create_subscription(WristStatus, 'wrist_status', self._on_status, NEWEST)

    def _recorded_commands(self) -> RecordedCommands:
        check_installed()
        from wrist_control.bags.commands import Flown

        flown = Flown(Path(self._values['recording'] or "''").expanduser())
        if flown.cut:
            self.get_logger().warning(flown.cut)
        if flown.in_forearm and not self._values['frame_id']:
            raise InvalidValueError(
                'frame_id is not given, but the recorded commands are in the axes of the forearm: '
                "valid is the name of the forearm's frame."
            )
        return flown.commands

    def _mapping(self) -> Joystick:
        x, y, z = self._values['joy_axes']
        p, q, r = self._values['joy_scales']
        return Joystick(
            axes=(x, y, z),
            scales=(p, q, r),
            deadzone=self._values['joy_deadzone'],
            enable_button=self._values['enable_button'],
            expo=self._values['joy_expo'],
            turbo_button=self._values['turbo_button'],
            turbo_factor=self._values['turbo_factor'],
        )

    @staticmethod
    def _check(values: dict[str, Any]) -> None:
        for name in TRIPLES:
            if name in values and len(values[name]) != 3:
                raise InvalidValueError(
                    f'{name} has {len(values[name])} values; give three: for p, q and r.'
                )

    def _on_status(self, message: WristStatus) -> None:
        self._wrist_is_up = message.state != WristStatus.WAITING
        if math.isfinite(message.time_lost):
            self._times_lost.put(convert.seconds(message.header.stamp), message.time_lost)

    def _on_joy(self, message: Joy) -> None:
        assert self._joystick is not None
        try:
            self._joystick.take(message.axes, message.buttons, self._now())
        except RefusedError as error:
            self._diagnostics.refuse('joy', error)

    def _now(self) -> float:
        return convert.seconds_of(self.get_clock().now().nanoseconds)

    def _tick(self) -> None:
        if self._values['maneuver'] == 'hold':
            return  # who only holds shall not keep others from leading the hand
        now = self.get_clock().now()
        seconds = convert.seconds_of(now.nanoseconds)
        if self._recorded is None:
            self._publish(now, self._rates(seconds))
        else:
            self._fly(self._recorded, now, seconds)

    def _fly(self, recorded: RecordedCommands, now: Time, seconds: float) -> None:
        if recorded.began is None and not self._is_heard():
            self._publish(now, ZERO_RATES)
            return
        flying = not recorded.done
        twist = recorded.twist(seconds)
        self._publish(now, twist[3:], twist[:3])
        if flying and recorded.done:
            self.get_logger().info('The recording is flown.')

    def wind_down(self) -> None:
        """Ask for no motion: whoever follows need not wait for a timeout."""
        self._publish(self.get_clock().now(), ZERO_RATES)

    def _publish(
        self, now: Time, rates: Sequence[float], travel: Sequence[float] = ZERO_RATES
    ) -> None:
        header = Header(stamp=now.to_msg(), frame_id=self._values['frame_id'])
        self._publisher.publish(convert.command_message(header, rates, travel))

    def _rates(self, now: float) -> Sequence[float]:
        if self._joystick is not None:
            return self._joystick.rates(now)
        if self._pilot is None:
            rates: Sequence[float] = self._values['constant_rates']
            return rates
        if self._pilot.began is None and not self._is_heard():
            return ZERO_RATES
        flying = not self._pilot.done
        rates = self._pilot.rates(now, self._times_lost.at(now) or 0.0)
        if flying and self._pilot.done:
            self.get_logger().info(f'{self._pilot.maneuver.name} is flown.')
        return rates

    def _is_heard(self) -> bool:
        if self._publisher.get_subscription_count() < self._values['listeners']:
            return False
        # A wrist that waits for its joints would miss the beginning.
        return self._wrist_is_up or not self.count_publishers('wrist_status')

    def _health(self) -> tuple[bytes, str, dict[str, str]]:
        if self._joystick is not None and self._joystick.must_let_go:
            return WARN, 'The joystick does not count yet: let go of its sticks once.', {}
        if self._joystick is not None:
            return OK, 'Following the joystick.', {}
        if self._recorded is not None:
            if self._recorded.began is None:
                return OK, 'Waiting for somebody to listen to cmd_vel.', {}
            return OK, f'{"Flown" if self._recorded.done else "Flying"} a recording.', {}
        if self._pilot is None:
            return OK, f'Publishing constant rates {self._values["constant_rates"]}.', {}
        if self._pilot.began is None:
            return OK, 'Waiting for somebody to listen to cmd_vel.', {}
        doing = 'Flown' if self._pilot.done else 'Flying'
        return OK, f'{doing} {self._pilot.maneuver.name}.', {}


def main() -> None:
    """Run the operator."""
    sys.exit(run(Operator))
