"""A wrist of one joint, steps that follow each other, and a supervisor with a clock."""

import math

import numpy as np
import pytest

from wrist_control import UnreachableError, make_wrist
from wrist_control.resolving import State
from wrist_control.resolving import step as resolver_step
from wrist_control.resolving.commands import Command
from wrist_control.resolving.period import SupervisorSettings
from wrist_control.resolving.supervisor import Supervisor
from wrist_control.wrists import Clearance, Joint, Wrist

GIMBALS = make_wrist('three_gimbal')


class Rail(Wrist):
    """One joint that turns the hand about x: everywhere, unless a subclass says otherwise.

    Attributes:
        gap: Between these two positions it cannot be assembled, rad.
        reach: Poses beyond this are out of reach, rad.
        fence: Where its clearance is used up, rad.
    """

    default_joints = (Joint('phi'),)
    gap = (math.inf, math.inf)
    reach = math.inf
    fence = math.inf

    def forward(self, positions):
        if self.gap[0] < positions[0] < self.gap[1]:
            raise UnreachableError('There the rail cannot be assembled.')
        return GIMBALS.forward((0.0, 0.0, positions[0]))

    def inverse(self, pose, near):
        phi = GIMBALS.inverse(pose, (0.0, 0.0, near[0]))[2]
        if abs(phi) > self.reach:
            raise UnreachableError('Here the rail ends.', 'end of the rail')
        return (phi,)

    def jacobian(self, positions):
        return np.array([[1.0], [0.0], [0.0]])

    def rates(self, positions, twist):
        return (twist[0],)

    def margin(self, positions):
        return 1.0

    def clearances(self, positions):
        return (Clearance('fence', self.fence - positions[0]),)


class Nowhere(Rail):
    """A rail whose inverse leads nowhere."""

    def inverse(self, pose, near):
        return (math.nan,)

    def forward(self, positions):
        return GIMBALS.forward((0.0, 0.0, 0.0))


@pytest.fixture(scope='session')
def rail():
    """The class of a wrist with one joint, to be varied."""
    return Rail


@pytest.fixture(scope='session')
def nowhere():
    return Nowhere()


@pytest.fixture(scope='session')
def at():
    """Make the state at rest at any positions, lock included."""
    return lambda wrist, positions: State(tuple(positions), wrist.forward(positions))


@pytest.fixture(scope='session')
def steps():
    """Make the steps of a command that is held, one after the other."""

    def held(wrist, state, twist, count, dt=1.0 / 32.0):
        for _ in range(count):
            made = resolver_step(wrist, state, twist, dt)
            yield made
            state = made.state

    return held


class Clocked:
    """A supervisor with a clock that advances by one period at each tick.

    Attributes:
        initial: Joint positions where it starts, rad.
        dt: Its period, s; a command is ramped to a stop in 0.1 s after its time is out.
    """

    initial = (0.1, 0.2, 0.3)
    dt = 0.01

    def __init__(self, wrist=None, initial=initial, **settings):
        wrist = wrist or GIMBALS.with_limits(rates=0.5, lower=-2.0, upper=2.0)
        chosen = SupervisorSettings(
            dt=self.dt,
            command_timeout=0.25,
            stop_time=0.1,
            initial_positions=initial,
            tracking_tolerance=(0.1,) * len(wrist.joints),
            require_joint_states=False,
        )
        self.supervisor = Supervisor(wrist, chosen._replace(**settings))
        self.count = 0

    @property
    def now(self):
        return self.dt * self.count

    @property
    def positions(self):
        return self.supervisor.state.positions

    def command(self, twist, in_forearm=False):
        self.supervisor.take_command(Command(tuple(twist), in_forearm, None, self.now))

    def measure(self, positions, names=('psi', 'theta', 'phi')):
        self.supervisor.take_measured(names, positions, self.now)

    def rest(self, positions, names=('psi', 'theta', 'phi')):
        """Measure joints that rest: three times the same, a period apart."""
        for _ in range(3):
            self.tick()
            self.measure(positions, names)

    def enable(self, wanted):
        return self.supervisor.enable(wanted, receipt_time=self.now)

    def tick(self):
        self.count += 1
        return self.supervisor.tick(stamp_time=self.now, receipt_time=self.now)

    def follow(self, twist):
        """Return what a command brings in its first period."""
        self.command(twist)
        return self.tick()

    def ticks(self, seconds, twist=None):
        """Return what each period brings, a command being sent before each if there is one."""
        periods = range(round(seconds / self.dt))
        return [self.tick() if twist is None else self.follow(twist) for _ in periods]


@pytest.fixture
def clocked():
    """The class of a supervisor with a clock."""
    return Clocked


@pytest.fixture
def wrist():
    """A three-gimbal wrist under a supervisor, its joints held to 0.5 rad/s and ±2 rad."""
    return Clocked()
