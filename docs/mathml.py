"""Render mathematics as MathML while the site is built: a page then needs no script and no font.

Browsers show MathML by themselves. What `latex2mathml` leaves to do is done here: the spaces of
functions and signs, and matrices, dots and primes that look right without a mathematical font.
"""

import re
from typing import Any
from xml.etree.ElementTree import Element, fromstring, register_namespace, tostring

from docutils import nodes
from latex2mathml.converter import convert
from sphinx.application import Sphinx
from sphinx.writers.html5 import HTML5Translator

NAMESPACE = 'http://www.w3.org/1998/Math/MathML'
FUNCTIONS = {'cos', 'sin', 'tan', 'log', 'exp', 'det', 'sgn', 'diag', 'tr', 'atan2'}
DOT, PRIME, MINUS = '\u02d9', '\u2032', '\u2212'
ROWS = {'math', 'mrow', 'mtd', 'mstyle'}
# Operators whose spaces of their own are too wide for what they do here.
SPACES = {'|': '0', 'min': '0.167em', 'max': '0.167em', 'det': '0.1em'}
CLOSING = {')', ']', '|', '\u2016', PRIME}
# TeX that GitHub knows and the converter does not.
PLAINER = ((r'\\tag\{(.*?)\}', r'\\qquad\\text{(\1)}'), (r'\\operatorname\{', r'\\text{'))

register_namespace('', NAMESPACE)


def mathml(latex: str, display: str) -> str:
    """Return an equation as a <math> element; `display` is inline or block."""
    for pattern, plain in PLAINER:
        latex = re.sub(pattern, plain, latex)
    root = fromstring(convert(latex, display=display))
    for element in list(root.iter()):
        mend(element)
        if kind(element) in ROWS:
            space_functions(element)
    return tostring(root, encoding='unicode')


def mend(element: Element) -> None:
    """Change what would not look right without a mathematical font, and tell signs apart."""
    children = list(element)
    texts = [child.text for child in children]
    if kind(element) == 'mover' and texts[1:] == [DOT]:
        element.set('accent', 'true')
        children[1].set('class', 'dot')
    if kind(element) in ('msup', 'msubsup') and texts[-1] == PRIME:
        # The character is raised by itself: raised once more it would be out of sight.
        base, *below, prime = children
        element.tag = made('msub' if below else 'mrow').tag
        element[:] = [made('mrow', base, prime), *below]
    for place, child in enumerate(children):
        before = children[place - 1] if place else None
        after_operator = before is None or (kind(before) == 'mo' and before.text not in CLOSING)
        if child.text == MINUS and after_operator:
            child.set('form', 'prefix')
        if kind(child) == 'mo' and child.text in SPACES:
            child.set('lspace', SPACES[child.text])
            child.set('rspace', SPACES[child.text])
        if kind(child) == 'mtable' and before is not None and before.text == '[':
            child.set('class', 'matrix')
            element.remove(before)
            element.remove(children[place + 1])


def made(name: str, *children: Element, **attributes: str) -> Element:
    """Return a new element."""
    element = Element(f'{{{NAMESPACE}}}{name}', attributes)
    element.extend(children)
    return element


def space_functions(row: Element) -> None:
    """Put thin spaces around the names of functions in a row, as TeX does."""
    for child, after in zip(list(row), list(row)[1:], strict=False):
        operators = {kind(child), kind(after)} & {'mo', 'mspace'}
        if not operators and (is_function(child) or is_function(after)):
            row.insert(list(row).index(after), made('mspace', width='0.167em'))


def is_function(element: Element) -> bool:
    """Return whether an element names a function, perhaps with an exponent."""
    if kind(element) == 'msup':
        element = element[0]
    return element.text in FUNCTIONS


def kind(element: Element) -> str:
    """Return the name of an element's tag."""
    return element.tag.partition('}')[2]


def visit_inline(self: HTML5Translator, node: nodes.math) -> None:
    """Write an equation inside a sentence."""
    self.body.append(mathml(node.astext(), 'inline'))
    raise nodes.SkipNode


def visit_block(self: HTML5Translator, node: nodes.math_block) -> None:
    """Write an equation that stands alone."""
    self.body.append(f'<div class="math">{mathml(node.astext(), "block")}</div>\n')
    raise nodes.SkipNode


def setup(app: Sphinx) -> dict[str, Any]:
    """Offer the renderer to Sphinx."""
    app.add_html_math_renderer('mathml', (visit_inline, None), (visit_block, None))
    return {'parallel_read_safe': True, 'parallel_write_safe': True}
