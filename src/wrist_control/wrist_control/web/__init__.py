"""The console: a page in the browser that holds the stick, and shows what the wrist does.

Needs the extra `console`; nothing but its executable imports this room.
"""

from importlib.util import find_spec

if find_spec('nicegui') is None:
    raise ImportError(
        "wrist_control.web needs NiceGUI: pip install 'wrist_control[console]', or in its "
        'repository make console.'
    )
