"""Small faults that a program may have, made in its text one at a time.

Left alone is what no test can tell apart, or should: documentation, the texts of messages, type
hints, logging, and whether `zip` counts its arguments.
"""

from __future__ import annotations

import ast
import copy
import itertools
from collections.abc import Iterator
from typing import Any, NamedTuple


class Mutant(NamedTuple):
    """One fault in one place.

    Attributes:
        file: Path below the package's folder.
        line: Number of the line where it is.
        before: The text that is replaced.
        after: What replaces it.
        start: Where the text begins, in bytes.
    """

    file: str
    line: int
    before: str
    after: str
    start: int

    def applied(self, source: bytes) -> bytes:
        """Return the file with the fault in it."""
        end = self.start + len(self.before.encode())
        return source[: self.start] + self.after.encode() + source[end:]

    def __str__(self) -> str:
        before, after = (' '.join(text.split()) for text in (self.before, self.after))
        return f'{self.file}:{self.line}: {before} -> {after}'


COMPARISONS: dict[type, tuple[type, ...]] = {
    ast.Lt: (ast.LtE, ast.GtE),
    ast.LtE: (ast.Lt, ast.Gt),
    ast.Gt: (ast.GtE, ast.LtE),
    ast.GtE: (ast.Gt, ast.Lt),
    ast.Eq: (ast.NotEq,),
    ast.NotEq: (ast.Eq,),
    ast.Is: (ast.IsNot,),
    ast.IsNot: (ast.Is,),
    ast.In: (ast.NotIn,),
    ast.NotIn: (ast.In,),
}
ARITHMETIC: dict[type, type] = {
    ast.Add: ast.Sub,
    ast.Sub: ast.Add,
    ast.Mult: ast.Div,
    ast.Div: ast.Mult,
    ast.Pow: ast.Mult,
    ast.FloorDiv: ast.Div,
    ast.Mod: ast.Mult,
}
OTHER_NAMES = {
    'min': 'max',
    'max': 'min',
    'sin': 'cos',
    'cos': 'sin',
    'any': 'all',
    'all': 'any',
    'sqrt': 'abs',
}
# Of these calls neither the order of the arguments nor what is in them is worth a question.
PLAIN_CALLS = {'isinstance', 'getattr', 'TypeVar'}
# Of these the order of the arguments does not matter.
SYMMETRIC_CALLS = {'min', 'max', 'hypot', 'dist'}
UNOBSERVED = ('get_logger', 'gc.')
UNTOUCHED_FIELDS = {'annotation', 'returns', 'decorator_list', 'bases', 'type_params'}
UNTOUCHED_KEYWORDS = {'strict', 'throttle_duration_sec', 'kw_only', 'bound'}
UNORDERED = (ast.Subscript, ast.Compare, ast.ExceptHandler)
UNTOUCHED_NODES = (ast.JoinedStr, ast.Assert, ast.Import, ast.ImportFrom)


def points(file: str, source: bytes) -> list[list[Mutant]]:
    """Return every place of a file where a fault can be, with the faults that can be there."""
    starts = [0, *itertools.accumulate(map(len, source.splitlines(keepends=True)))]
    found = []
    for node, function in _nodes(ast.parse(source)):
        for piece, texts in _faults(node, function):
            start = starts[piece.lineno - 1] + piece.col_offset
            end = starts[(piece.end_lineno or 0) - 1] + (piece.end_col_offset or 0)
            before = source[start:end].decode()
            found.append([Mutant(file, piece.lineno, before, after, start) for after in texts])
    return [point for point in found if point]


def _nodes(node: Any, function: Any = None) -> Iterator[tuple[Any, Any]]:
    """Return every node that may be changed, with the function that it is in."""
    if isinstance(node, UNTOUCHED_NODES) or _is_unobserved(node):
        return
    yield node, function
    if isinstance(node, ast.Raise) or (isinstance(node, ast.Call) and _name(node) in PLAIN_CALLS):
        return
    inside = node if isinstance(node, ast.FunctionDef) else function
    for field, value in ast.iter_fields(node):
        if field in UNTOUCHED_FIELDS:
            continue
        for part in value if isinstance(value, list) else [value]:
            if isinstance(part, ast.Tuple) and isinstance(node, UNORDERED):
                # An index does not survive a change of order, and a set of choices has none.
                for item in part.elts:
                    yield from _nodes(item, inside)
            elif isinstance(part, ast.AST):
                yield from _nodes(part, inside)


def _is_unobserved(node: ast.AST) -> bool:
    if isinstance(node, ast.keyword):
        return node.arg in UNTOUCHED_KEYWORDS
    if isinstance(node, ast.Assign):
        return ast.unparse(node.targets[0]) == '__all__'
    if isinstance(node, ast.Expr):
        text = ast.unparse(node)
        return any(name in text for name in UNOBSERVED)
    return False


def _faults(node: Any, function: Any) -> Iterator[tuple[Any, list[str]]]:
    """Return the pieces of a node to replace, each with all that may stand there instead."""
    match node:
        case ast.Compare():
            yield node, [_with_item(node, 'ops', i, o) for i, o in _comparisons(node)]
        case ast.BinOp(op=ast.MatMult()):
            yield node, [_with(node, left=node.right, right=node.left)]
        case ast.BinOp(left=left, right=right) if not (_is_text(left) or _is_text(right)):
            other = ARITHMETIC.get(type(node.op))
            yield node, [_with(node, op=other())] if other else []
        case ast.BoolOp():
            other = ast.Or if isinstance(node.op, ast.And) else ast.And
            rest = [
                _with(node, values=[v for v in node.values if v is not x]) for x in node.values
            ]
            yield node, [_with(node, op=other()), *(rest if len(node.values) > 2 else [])]
        case ast.UnaryOp(op=ast.Not() | ast.USub()):
            yield node, [f'({ast.unparse(node.operand)})']
        case ast.Constant(value=bool(value)):
            yield node, [str(not value)]
        case ast.Constant(value=int(value) | float(value)):
            yield node, _other_numbers(value)
        case ast.Call():
            yield from _calls(node)
        case ast.Tuple(ctx=ast.Load()):
            yield node, _swaps(node, 'elts')
        case ast.If() | ast.IfExp():
            yield node.test, [f'(not ({ast.unparse(node.test)}))', 'True', 'False']
        case ast.Return(value=ast.expr() as value):
            yield value, _other_returns(value, function)
        case ast.Expr(value=ast.Call()) | ast.AugAssign() | ast.Raise():
            yield node, ['pass']
        case ast.Continue() | ast.Break():
            yield node, ['pass']
        case ast.Assign(targets=[ast.Attribute() | ast.Subscript(), *_]):
            # Without what its constructor makes an object fails at once: that is no question.
            yield node, [] if function and function.name == '__init__' else ['pass']


def _comparisons(node: ast.Compare) -> Iterator[tuple[int, Any]]:
    for index, operator in enumerate(node.ops):
        for other in COMPARISONS[type(operator)]:
            yield index, other()


def _calls(node: ast.Call) -> Iterator[tuple[Any, list[str]]]:
    name, plain = _name(node), not any(isinstance(a, ast.Starred) for a in node.args)
    ordered = plain and name not in PLAIN_CALLS | SYMMETRIC_CALLS
    swaps = _swaps(node, 'args') if ordered else []
    if name == 'abs' and plain:
        swaps.append(f'({ast.unparse(node.args[0])})')
    other = OTHER_NAMES.get(name)
    if other and isinstance(node.func, ast.Name):
        swaps.append(_with(node, func=ast.Name(other)))
    elif other and isinstance(node.func, ast.Attribute) and other != 'abs':
        swaps.append(_with(node, func=_copy(node.func, attr=other)))
    yield node, swaps


def _swaps(node: Any, field: str) -> list[str]:
    """Return a node with each two neighbours of a list swapped, where both are of one kind.

    Of different kinds they are taken for each other at once, by whatever is done with them.
    """
    found, items = [], getattr(node, field)
    for i in range(len(items) - 1):
        alike = type(items[i]) is type(items[i + 1])
        if alike and ast.dump(items[i]) != ast.dump(items[i + 1]):
            swapped = [*items[:i], items[i + 1], items[i], *items[i + 2 :]]
            found.append(_with(node, **{field: swapped}))
    return found


def _other_returns(value: ast.expr, function: ast.FunctionDef) -> list[str]:
    text, kind = ast.unparse(value), function.returns and ast.unparse(function.returns)
    if isinstance(value, ast.Tuple):
        return []
    if kind == 'bool':
        return [f'not ({text})', 'True', 'False']
    if kind == 'float':
        return [f'-({text})', '0.0']
    return [] if text == 'None' else ['None']


def _other_numbers(value: float) -> list[str]:
    less = value // 10 if isinstance(value, int) else value / 10.0
    others = dict.fromkeys((10 * value, less, value + 1, value - 1, -value, 0 * value))
    return [f'({other})' for other in others if other != value]


def _is_text(node: ast.expr) -> bool:
    return isinstance(node, ast.JoinedStr) or (
        isinstance(node, ast.Constant) and isinstance(node.value, str)
    )


def _name(call: ast.Call) -> str:
    return ast.unparse(call.func).rpartition('.')[2]


def _copy(node: Any, **fields: Any) -> Any:
    other = copy.copy(node)
    for field, value in fields.items():
        setattr(other, field, value)
    return other


def _with(node: Any, **fields: Any) -> str:
    text = ast.unparse(_copy(node, **fields))
    return text if isinstance(node, ast.Tuple) else f'({text})'


def _with_item(node: Any, field: str, index: int, item: Any) -> str:
    items = [*getattr(node, field)]
    items[index] = item
    return _with(node, **{field: items})
