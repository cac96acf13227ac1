"""A supervisor that notes what it is told: whoever tells another one the same gets the same.

All that a supervisor does follows from what it is told and when, to the last bit. What it was
told between two steps, and where everything was before, is all that a replay needs; and at rest
where everything was is little.
"""

from __future__ import annotations

from collections.abc import Callable, Iterator, Sequence
from contextlib import contextmanager, suppress
from enum import IntEnum
from typing import NamedTuple

from wrist_control.errors import RefusedError, WristError
from wrist_control.resolving.commands import Command
from wrist_control.resolving.feedback import Remembered
from wrist_control.resolving.period import Mode, PeriodResult, SupervisorSettings
from wrist_control.resolving.state import State
from wrist_control.resolving.supervisor import Supervisor
from wrist_control.rotations import Pose
from wrist_control.wrists.wrist import Configuration, Positions, Wrist

# So much is noted between two steps; who is told more, while no steps are made, forgets it.
MOST = 1000


class Kind(IntEnum):
    """What a supervisor can be told; as the constants of `HeardInput`."""

    COMMAND = 0
    JOINTS = 1
    STOP = 2
    ENABLE = 3
    RESET = 4
    GIVE_UP = 5
    PARAMETERS = 6


class Heard(NamedTuple):
    """One thing that a supervisor was told; the fields are those of `HeardInput`."""

    kind: Kind
    receipt_time: float = 0.0
    stamp: float | None = None
    values: tuple[float, ...] = ()
    names: tuple[str, ...] = ()
    flag: bool = False
    text: str = ''
    then: str = ''


class Before(NamedTuple):
    """Where everything was after a step; the fields are those of `StepInputs`."""

    mode: Mode
    resting: bool
    adopted: bool
    state: State
    withheld_since: float | None
    joints: Remembered


class WitnessedSupervisor(Supervisor):
    """A supervisor that notes what it is told.

    Attributes:
        number: How many steps were made; one more for each time that too much was told.
        heard: What it was told since the last step, in order.
        before: Where everything was after that.
    """

    def __init__(self, wrist: Wrist, settings: SupervisorSettings) -> None:
        """Do as every supervisor."""
        super().__init__(wrist, settings)
        self.number = 0
        self.heard: list[Heard] = []
        self._inside = False
        self.before = self._where()

    def turn_over(self) -> None:
        """Begin to note what comes before the next step."""
        self.number += 1
        self.heard.clear()
        self.before = self._where()
        if self.before.resting and isinstance(self.state.positions, Configuration):
            # An equal pose, but another object: by it nobody knows how it was once found.
            self.state = self.state._replace(pose=Pose(*self.state.pose))

    def note_parameters(self, text: str) -> None:
        """Note that the wrist and the settings are others from here on."""
        self._note(Heard(Kind.PARAMETERS, text=text))

    def take_command(self, command: Command) -> None:
        """Do as every supervisor."""
        twist, in_forearm, stamp, receipt = command
        with self._noted(Heard(Kind.COMMAND, receipt, stamp, twist, flag=in_forearm)):
            super().take_command(command)

    def take_measured(
        self, names: Sequence[str], positions: Sequence[float], receipt_time: float
    ) -> None:
        """Do as every supervisor; joints of others are not noted."""
        own = {joint.name for joint in self.wrist.joints}
        # Whoever says more than that is refused, and shall cost nothing here.
        said = zip(names[:MOST], positions, strict=False)
        mine = [pair for pair in said if pair[0] in own]
        heard = Heard(
            Kind.JOINTS,
            receipt_time,
            values=tuple(float(position) for _, position in mine),
            names=tuple(name for name, _ in mine),
        )
        with self._noted(heard):
            super().take_measured(names, positions, receipt_time)

    def stop(self, message: str, then: Mode) -> None:
        """Do as every supervisor."""
        with self._noted(Heard(Kind.STOP, text=message, then=then.name)):
            super().stop(message, then)

    def enable(self, wanted: bool, *, receipt_time: float) -> str:
        """Do as every supervisor."""
        with self._noted(Heard(Kind.ENABLE, receipt_time, flag=wanted)):
            return super().enable(wanted, receipt_time=receipt_time)

    def reset(self) -> str:
        """Do as every supervisor."""
        with self._noted(Heard(Kind.RESET)):
            return super().reset()

    def give_up(self, reason: str) -> PeriodResult:
        """Do as every supervisor."""
        with self._noted(Heard(Kind.GIVE_UP, text=reason)):
            return super().give_up(reason)

    def tick(
        self, *, stamp_time: float, receipt_time: float, withheld: str = '', pause: float = 0.0
    ) -> PeriodResult:
        """Do as every supervisor."""
        self._inside = True
        try:
            return super().tick(
                stamp_time=stamp_time, receipt_time=receipt_time, withheld=withheld, pause=pause
            )
        finally:
            self._inside = False

    @contextmanager
    def _noted(self, heard: Heard) -> Iterator[None]:
        """Note what comes from outside, unless it is refused and so changes nothing."""
        if self._inside:
            yield
            return
        self._inside = True
        try:
            self._note(heard)
            yield
        except RefusedError:
            self.heard.pop()
            raise
        finally:
            self._inside = False

    def _note(self, heard: Heard) -> None:
        if len(self.heard) >= MOST:
            self.heard.clear()
            self.number += 1
        self.heard.append(heard)

    def _where(self) -> Before:
        asked = (self._commands.counting, self._commands.waiting)
        resting = (
            not self._moving
            and self._ramp is None
            and self.mode is not Mode.HOMING
            and not self.state.joint_rates
            and not self._feedback.lagging
            and not any(any(command.twist) for command in asked if command)
            and self._needs_no_past()
        )
        return Before(
            self.mode,
            resting,
            self._adopted,
            self.state,
            self._permission.since,
            self._feedback.remembered,
        )

    def _needs_no_past(self) -> bool:
        """Return whether where the joints are will be found without what was found before.

        A wrist whose positions fit several poses follows its pose from message to message while
        nobody moves it, and goes on from what it knows of the last.
        """
        follows = self.mode is not Mode.FOLLOWING or not self._adopted
        return not (follows and isinstance(self.state.positions, Configuration))

    def begin_where(self, before: Before) -> None:
        """Be where another supervisor was, at rest."""
        self.mode, _, self._adopted, self.state, self._permission.since, joints = before
        self._feedback.recall(joints)

    def hear(self, heard: Heard) -> None:
        """Be told what another supervisor was told; of parameters nothing is known here."""
        tell: dict[Kind, Callable[[], object]] = {
            Kind.COMMAND: lambda: self.take_command(
                Command(heard.values, heard.flag, heard.stamp, heard.receipt_time)
            ),
            Kind.JOINTS: lambda: self.take_measured(heard.names, heard.values, heard.receipt_time),
            Kind.STOP: lambda: self.stop(heard.text, Mode[heard.then]),
            Kind.ENABLE: lambda: self.enable(heard.flag, receipt_time=heard.receipt_time),
            Kind.RESET: self.reset,
            Kind.GIVE_UP: lambda: self.give_up(heard.text),
        }
        with suppress(WristError):  # as it was there: it changes nothing more
            tell[heard.kind]()


def positions_of(
    wrist: Wrist, positions: tuple[float, ...], pose: Pose, assembled: bool
) -> Positions:
    """Return joint positions as a supervisor had them.

    Args:
        wrist: The mechanism.
        positions: The plain numbers, rad or m.
        pose: The pose that they hold.
        assembled: Whether the wrist knew with them which pose that is.
    """
    return wrist.inverse(pose, positions) if assembled else positions
