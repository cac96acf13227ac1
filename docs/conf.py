"""How Sphinx makes a site of these pages: `make docs`."""

import sys
from inspect import getdoc
from pathlib import Path
from typing import Any

from sphinx.application import Sphinx

sys.path.insert(0, str(Path(__file__).parent))

project = 'wrist_control'
html_title = project
extensions = ['myst_parser', 'sphinx.ext.autodoc', 'sphinx.ext.napoleon', 'mathml']

# Markdown as GitHub shows it: the same links, and mathematics in dollars and blocks of `math`.
myst_enable_extensions = ['dollarmath']
myst_fence_as_directive = ['math']
myst_heading_anchors = 4

html_theme = 'furo'
html_static_path = ['_static']
html_css_files = ['site.css']
html_math_renderer = 'mathml'
# A page is read where it was built, beside its source.
html_copy_source = False
html_show_sphinx = False
html_show_copyright = False

autodoc_member_order = 'bysource'
autodoc_default_options = {'members': True, 'show-inheritance': True}
autodoc_typehints_format = 'short'
autodoc_preserve_defaults = True
napoleon_google_docstring = True
napoleon_use_ivar = True  # attributes stand in the docstring of their class, once
default_role = 'code'  # docstrings mark names with one backtick, as Markdown does
python_display_short_literal_types = True

ALIASES = {
    'rotations': ('Vector', 'Quaternion', 'DirectionCosines'),
    'wrists.wrist': ('Rates', 'Positions', 'SteeringState'),
    'wrists.body': ('Shape',),
    'wrists.joint': ('Kind', 'Limits'),
    'resolving.state': ('Twist',),
}
autodoc_type_aliases = {
    name: f'wrist_control.{module}.{name}' for module, names in ALIASES.items() for name in names
}
# Numpy has no page here, a literal is no type with one, and a type variable says nothing more;
# an older Sphinx, the last for Python 3.10, knows no way from a signature to an alias.
UNKNOWN = (
    r'(np|numpy|collections\.abc|abc|enum)\..*',
    r"\d|'\w+'|TypeAliasForwardRef|.*\.SomeWrist",
    rf'\'?(.*\.)?({"|".join(autodoc_type_aliases)})\'?',
)
nitpick_ignore_regex = [('py:.*', name) for name in UNKNOWN]


def as_written(
    app: Sphinx, what: str, name: str, obj: Any, options: Any, lines: list[str]
) -> None:
    """Keep a docstring as it is written where reStructuredText would read something else.

    Napoleon takes what stands before the first colon of a property for its type, and the bars of
    |ω| would name a substitution.
    """
    if what == 'property':
        lines[:] = (getdoc(obj) or '').splitlines()
    lines[:] = [line.replace('|', '\\|') for line in lines]


def skip_fields(
    app: Sphinx, what: str, name: str, obj: Any, skip: bool, options: Any
) -> bool | None:
    """Leave out the fields of named tuples: the docstring of the class has said what they are."""
    return True if type(obj).__name__ == '_tuplegetter' else None


def setup(app: Sphinx) -> None:
    """Connect the two."""
    app.connect('autodoc-process-docstring', as_written, priority=900)  # after Napoleon
    app.connect('autodoc-skip-member', skip_fields)
