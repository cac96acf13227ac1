"""Faults that the tests must find, each with what it would do to whoever stands beside the robot.

A text is there once in its file; where it is not any more, `make mutants` says so.
"""

from __future__ import annotations

from typing import NamedTuple

from chosen_of_motion import MOTION


class Chosen(NamedTuple):
    """One fault.

    Attributes:
        file: Path below the package's folder.
        text: The text that is replaced.
        replacement: What replaces it.
        why: What would go wrong.
    """

    file: str
    text: str
    replacement: str
    why: str


NODE = 'nodes/resolver.py'
SETTINGS = 'nodes/resolver_settings.py'
OUTPUTS = 'nodes/resolver_outputs.py'
OPERATOR = 'nodes/operator.py'
SUPERVISOR = 'resolving/supervisor.py'
FEEDBACK = 'resolving/feedback.py'
INPUTS = 'nodes/resolver_inputs.py'
JOYSTICK = 'operating/joystick.py'
KEYS = 'operating/keys.py'
CLOCK = 'nodes/resolver_clock.py'
GUARDED = 'ros/guarded.py'
STEADY = 'return convert.seconds_of(self._node.steady.now().nanoseconds)'
CAUGHT = '            except Exception as error:\n                return'
MISSED = CAUGHT.replace('Exception', 'KeyError')
FIRST = "self.__dict__.setdefault('_first', self._values['command_timeout'])"
LOOK = 'if publisher.topic_type != kind:'
QOS = 'ros/qos.py'
RECORDING = 'graph/recording.py'
UNSURE = 'OUTPUT = QoSProfile(depth=10, reliability=ReliabilityPolicy.BEST_EFFORT)'

CHOSEN = tuple(
    Chosen(*facts)
    for facts in (
        *MOTION,
        # A change of a live parameter that is accepted and then not followed.
        (NODE, 'self._supervisor.settings = settings(', 'settings(', 'live timeouts are dead'),
        (SETTINGS, "values['command_timeout']", '0.25', 'the hand runs on for another time'),
        (SETTINGS, "values['stop_time']", '0.1', 'the ramp to a stop takes another time'),
        (
            INPUTS,
            "timeout = self._values['command_timeout']",
            f'timeout = {FIRST}',
            'old commands count, or new not',
        ),
        (NODE, 'self._supervisor.wrist = limited(', 'limited(', 'live limits are dead'),
        (OPERATOR, 'self._check, self._values.update)', 'self._check, bool)', 'no live rates'),
        # Clocks: a system clock that is set must not keep the hand moving.
        (CLOCK, STEADY, 'return self.stamp_time()', 'no stop in silence'),
        (
            INPUTS,
            'stamp_time, now = self._clock.stamp_time(), self._clock.receipt_time()',
            'stamp_time, now = self._clock.stamp_time(), 0.0',
            'a command is old as soon as it comes',
        ),
        (NODE, 'receipt_time=now,', 'receipt_time=0.0,', 'ages'),
        (
            NODE,
            'now = self._step_clock.receipt_time()\n        try:',
            'now = 0.0\n        try:',
            'joint states are old as soon as they come',
        ),
        (NODE, 'withheld=withheld,', '', 'moves without the dead-man switch'),
        (INPUTS, 'self._sources.admit(origin, now, timeout)', 'pass', 'two operators shake it'),
        (INPUTS, 'self._on_stop, qos)', 'print, qos)', 'a stop is not heard'),
        (CLOCK, 'if self._watch.look(now, steady):', 'if False:', 'moves without a clock'),
        (CLOCK, 'if self._watch.stands and', 'if False and', 'moves without a clock'),
        (CLOCK, 'if self.timing.is_due(now):', 'if True:', 'too fast by stamp'),
        (CLOCK, 'return convert.seconds_of(self._watch.age', 'return 1e-9 * int', 'never stale'),
        (GUARDED, 'if len(data) > MOST_BYTES:', 'if False:', 'a message stops the loop'),
        (GUARDED, 'successful=not changed', 'successful=True', 'another clock on the way'),
        (
            GUARDED,
            '            except Exception as error:\n                return',
            MISSED,
            'ends moving',
        ),
        ('ros/running.py', '        node.wind_down()', '        pass', 'moves on for ever'),
        (SUPERVISOR, 'mode, None, False', 'mode, None, True', 'a stop at rest is a ramp again'),
        ('ros/convert.py', '        return None\n', '        return 0.0\n', 'no stamp is too old'),
        ('resolving/commands.py', 'CLOCK_SKEW = 0.05', 'CLOCK_SKEW = 0.5', 'the future counts'),
        # Stopping.
        ('resolving/commands.py', 'if age <= timeout:', 'if True:', 'the hand never stops'),
        (
            'resolving/commands.py',
            'max(0.0, 1.0 - (age - timeout) / stop_time)',
            '0.0',
            'the hand stops with a jerk',
        ),
        (
            OUTPUTS,
            'result.moving_allowed or self._was_allowed',
            'result.moving_allowed',
            'runs on',
        ),
        (OUTPUTS, '= result.moving_allowed\n', '= True\n', 'sends while it is disabled'),
        (OUTPUTS, 'if result.moving_allowed:', 'if True:', 'sends while it is disabled'),
        # Who is in charge.
        (
            SUPERVISOR,
            'FOLLOWING) and not self._adopted:',
            'FOLLOWING):',
            'what a servo settles at is taken over again and again: it creeps',
        ),
        (SUPERVISOR, 'feedback.forget_lag()', 'pass', 'a fault as soon as it is enabled'),
        (SUPERVISOR, ' = Mode.HOMING, 0.0', ' = Mode.HOMING, 1.0', 'a reset moves who may not'),
        (
            SUPERVISOR,
            'Mode.FOLLOWING\n        self._commands.clear()\n        feedback',
            'Mode.FOLLOWING\n        feedback',
            'an old command moves the hand as soon as it is enabled',
        ),
        (
            FEEDBACK,
            'if self.age(receipt_time) > longest:\n            raise',
            'if False:\n            raise',
            'it is enabled from where the joints were long ago',
        ),
        (
            FEEDBACK,
            'if not self.resting:',
            'if False:',
            'it is enabled from joints that move',
        ),
        (
            SUPERVISOR,
            'if self._moving and self._deaf(receipt_time):',
            'if False:',
            'the hand moves unseen',
        ),
        (
            SUPERVISOR,
            'Mode.WAITING if settings.require_joint_states else',
            '',
            'home is commanded before the joints were heard',
        ),
        (FEEDBACK, 'RESTING_MESSAGES = 3', 'RESTING_MESSAGES = 1', 'one message is believed'),
        (FEEDBACK, "'revolute': 0.005", "'revolute': 0.05", 'joints that move are taken over'),
        (FEEDBACK, "SAG = {'revolute': 0.02", "SAG = {'revolute': 0.2", 'a start far outside'),
        (FEEDBACK, 'FURTHEST = 1e4', 'FURTHEST = 1e400', 'an absurd place is commanded'),
        (
            SUPERVISOR,
            'self.mode = Mode.FOLLOWING\n            self._commands.clear()\n',
            'self.mode = Mode.FOLLOWING\n',
            'an old command moves the hand after a reset',
        ),
        (
            SUPERVISOR,
            'self._adopted, self._share = True, share',
            'self._share = share',
            'a reset jumps to what is measured',
        ),
        (
            SETTINGS,
            "BEHIND = {'revolute': 0.1",
            "BEHIND = {'revolute': 1.0",
            'stuck, and not seen',
        ),
        (SETTINGS, "'tracking_time', 0.25", "'tracking_time', 2.5", 'a stuck joint is seen late'),
        ('resolving/homing.py', "'revolute': 0.5", "'revolute': 5.0", 'a reset is a blow'),
        ('resolving/homing.py', "'prismatic': 0.02", "'prismatic': 0.2", 'a reset is a blow'),
        ('resolving/homing.py', '< 1e-9', '< 1e-3', 'a reset ends beside its goal'),
        # The operator.
        (OPERATOR, "< self._values['listeners']", '< 1', 'a maneuver begins without the joints'),
        (
            OPERATOR,
            'if self._pilot.began is None and',
            'if False and',
            'a maneuver begins unheard',
        ),
        (
            JOYSTICK,
            'if not self.is_enabled(buttons):',
            'if False:',
            'the hand moves without the dead-man button',
        ),
        (
            JOYSTICK,
            'max(0.0, min(1.0, abs(value)) - self.deadzone)',
            'abs(value)',
            'a stick at rest creeps',
        ),
        (JOYSTICK, ' or receipt_time - self._heard > self.timeout', '', 'a lost stick drives on'),
        (JOYSTICK, 'self._counts = at_rest or', 'self._counts = True or', 'a stuck stick drives'),
        (KEYS, 'now + LEASE', 'now + 10.0 * LEASE', 'a key that was let go drives on'),
        (KEYS, 'len(keys) > MOST_AT_ONCE', 'False', 'keys that were held up on their way count'),
        (
            JOYSTICK,
            'self._rates, self._heard = ZERO_RATES, receipt_time',
            'self._heard = receipt_time',
            'a stick that talks nonsense drives on',
        ),
        # What people and other nodes are told.
        ('resolving/report.py', 'NOTICEABLE = 1e-3', 'NOTICEABLE = 1e-2', 'a lost part is hidden'),
        ('ros/diagnostics.py', "'state', level", "'state', OK", 'a fault is shown green'),
        ('ros/diagnostics.py', 'WARN if total > self._seen else OK', 'OK', 'refusals are hidden'),
        ('ros/diagnostics.py', '        self._seen = total\n', '', 'one refusal warns for ever'),
        ('ros/wrong_types.py', LOOK, 'if False:', 'a publisher is unheard without a word'),
        (NODE, 'level = max(level, WARN)', 'pass', 'a publisher that is unheard is shown green'),
        (
            'ros/wrong_types.py',
            '        self.found[node_name, topic] = sentence\n',
            '',
            'a publisher is unheard without a name',
        ),
        (
            QOS,
            'OUTPUT = QoSProfile(depth=10, reliability=ReliabilityPolicy.RELIABLE)',
            UNSURE,
            'loss',
        ),
        (
            QOS,
            'NEWEST = QoSProfile(depth=1, ',
            'NEWEST = QoSProfile(depth=10, ',
            'old commands queue',
        ),
        (
            QOS,
            'NEWEST = QoSProfile(depth=1, reliability=ReliabilityPolicy.BEST_EFFORT)',
            'NEWEST = QoSProfile(depth=1, reliability=ReliabilityPolicy.RELIABLE)',
            'a best-effort publisher is not heard',
        ),
        (
            QOS,
            'EVERY = QoSProfile(depth=10, ',
            'EVERY = QoSProfile(depth=1, ',
            'positions are lost',
        ),
        (
            RECORDING,
            'followed[-n:][1:] == asked[:-1] and ',
            '',
            'a late command is shown as flown',
        ),
        (RECORDING, 'atol=1e-9', 'atol=1e9', 'joint states that came late are shown as flown'),
    )
)
