"""What an attack has done, and what it has found."""

from __future__ import annotations

from collections.abc import Iterable
from dataclasses import dataclass, field

# Of each attack the first few findings are told; the others are counted.
MOST_EXAMPLES = 5


@dataclass
class Verdict:
    """The row of one attack.

    Attributes:
        attack: Its name.
        count: Hostile steps or messages.
        limits: How often a limit was broken: of a rate, its change, a position or a clearance.
        nonfinite: How often something was not finite.
        dead: How often something had ended, did not answer, or raised what nobody expected.
        uncommanded: How often something moved that nobody had told to move.
        examples: The first findings, one sentence each.
    """

    attack: str
    count: int = 0
    limits: int = 0
    nonfinite: int = 0
    dead: int = 0
    uncommanded: int = 0
    examples: list[str] = field(default_factory=list)

    @property
    def good(self) -> bool:
        """Whether nothing was found."""
        return not (self.limits or self.nonfinite or self.dead or self.uncommanded)

    def find(self, kind: str, sentence: str) -> None:
        """Count a finding.

        Args:
            kind: Name of the attribute that counts it.
            sentence: What was found, and how to find it again.
        """
        setattr(self, kind, getattr(self, kind) + 1)
        self._tell([f'{kind}: {sentence}'])

    def add(self, other: Verdict) -> None:
        """Take in what another part of the same attack has found."""
        for kind in ('count', 'limits', 'nonfinite', 'dead', 'uncommanded'):
            setattr(self, kind, getattr(self, kind) + getattr(other, kind))
        self._tell(other.examples)

    def _tell(self, sentences: Iterable[str]) -> None:
        self.examples = [*self.examples, *sentences][:MOST_EXAMPLES]
