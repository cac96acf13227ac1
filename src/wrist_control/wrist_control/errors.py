"""Every error this package raises on purpose, under one root."""


class WristError(Exception):
    """Root of all errors of this package."""


class InvalidValueError(WristError, ValueError):
    """A parameter, limit or start that cannot be used; the text says what is valid."""


class UnreachableError(WristError, ValueError):
    """A pose, or a set of joint positions, that the mechanism cannot take.

    Attributes:
        limit: What holds the hand, in a word or two, as the operator knows it: 'cone', 'equator'.
    """

    def __init__(self, sentence: str, limit: str = 'edge of the workspace') -> None:
        super().__init__(sentence)
        self.limit = limit


class UnstableError(WristError, ArithmeticError):
    """Physics whose step is too long for what moves; the mechanism has to start again."""


class RefusedError(WristError, ValueError):
    """A message that does not count; nothing has changed.

    Attributes:
        reason: What was wrong in a word or two, the same for every message of that kind.
    """

    def __init__(self, reason: str, sentence: str) -> None:
        super().__init__(sentence)
        self.reason = reason
