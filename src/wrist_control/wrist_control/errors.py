"""Every error this package raises on purpose, under one root."""


class WristError(Exception):
    """Root of all errors of this package."""


class InvalidValueError(WristError, ValueError):
    """A parameter, limit or start that cannot be used; the text says what is valid."""


class UnreachableError(WristError, ValueError):
    """A pose, or a set of joint positions, that the mechanism cannot take."""
