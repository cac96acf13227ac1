"""Which function makes the mechanism of which wrist."""

from __future__ import annotations

from collections.abc import Callable
from importlib import metadata
from typing import Any

from wrist_control.errors import InvalidValueError
from wrist_control.physics import carpal, five_bar, gimbals, hooke, rotary_stewart, stewart
from wrist_control.physics.mechanism import Mechanism, Settings
from wrist_control.wrists import Wrist, wrist_class
from wrist_control.wrists.plugins import plugged_in_mechanisms

Model = Callable[[Any, Settings], Mechanism]
# By the names of the registry of wrists, which are those of the modules that they are in.
MODELS: dict[str, Model] = {
    'three_gimbal': gimbals.three_gimbal,
    'four_gimbal': gimbals.four_gimbal,
    'roll_pitch_roll': gimbals.roll_pitch_roll,
    'single_hooke': gimbals.single_hooke,
    'double_hooke': hooke.double_hooke,
    'omni_wrist': hooke.omni_wrist,
    'carpal': carpal.carpal,
    'pitch_yaw': gimbals.pitch_yaw,
    'five_bar': five_bar.five_bar,
    'stewart': stewart.stewart,
    'rotary_stewart': rotary_stewart.rotary_stewart,
}
DEFAULTS = Settings()


def build(wrist: Wrist, settings: Settings = DEFAULTS) -> Mechanism:
    """Return the mechanism of a wrist at its joints' zero, or where its loops are drawn.

    Raises:
        InvalidValueError: There is no mechanism for such a wrist, or that of another package
            cannot be imported.
    """
    name = type(wrist).__module__.rpartition('.')[2]
    if name in MODELS:
        return MODELS[name](wrist, settings)
    others = plugged_in_mechanisms()
    for other, point in others.items():
        if isinstance(wrist, wrist_class(other)):
            return _loaded(point)(wrist, settings)
    raise InvalidValueError(
        f'There is no mechanism for {type(wrist).__name__}; there is one for each of '
        f'{", ".join([*MODELS, *others])}.'
    )


def _loaded(point: metadata.EntryPoint) -> Model:
    try:
        model: Model = point.load()
    except Exception as error:  # whatever a stranger's module does
        raise InvalidValueError(
            f'The mechanism {point.value} of the wrist {point.name!r} cannot be imported '
            f'({type(error).__name__}: {error}); mend that package, or remove it.'
        ) from error
    return model
