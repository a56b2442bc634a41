# SPDX-License-Identifier: GPL-3.0-or-later

"""Coefficients as muParser expressions in named parameters.

Operators are + - * / ^, functions sin, cos, tan, exp, log and ln (natural), sqrt and abs; _pi is pi.
"""

import ast
import functools
import math
import operator
import re

import mpmath
from mpmath import iv

from squeal.errors import Error

FUNCTIONS = {"sin": math.sin, "cos": math.cos, "tan": math.tan, "exp": math.exp, "log": math.log, "ln": math.log, "sqrt": math.sqrt, "abs": abs}
OPERATORS = {ast.Add: operator.add, ast.Sub: operator.sub, ast.Mult: operator.mul, ast.Div: operator.truediv, ast.Pow: operator.pow}
CONSTANTS = {"_pi": math.pi}
TOKEN = re.compile(r"\s*(?:(?P<number>(?:\d+\.?\d*|\.\d+)(?:[eE][+-]?\d+)?)|(?P<name>[A-Za-z_]\w*)|(?P<operator>[-+*/^()]))", re.ASCII)
NAME = re.compile(r"[A-Za-z_]\w*", re.ASCII)
CHANGE = "use numbers, parameters, _pi, + - * / ^, matching parentheses, sin, cos, tan, exp, log, ln, sqrt and abs"
# Maximum number of bisections per parameter; a divisor whose interval still contains zero then counts as zero
HALVINGS = 40


class Expression:
    """A parsed expression: its `text`, and the sorted `names` of the parameters that occur in it."""

    def __init__(self, text, names, where):
        """Raises Error if the text cannot be parsed or contains a parameter that is not in `names`."""
        self.text, self.where = text, where
        try:
            self._tree = ast.parse(python_text(text), mode="eval").body
            self.names = sorted(names_in(self._tree))
        except (SyntaxError, ValueError, RecursionError, MemoryError):
            raise Error(f"`{text}` is not an expression that can be parsed", where, CHANGE) from None
        if unknown := [name for name in self.names if name not in names]:
            raise Error(f"`{text}` contains `{unknown[0]}`, which is unknown", where,
                        f"use numbers, _pi and parameters; parameters allowed here: {', '.join(names) or '(none)'}")

    def __call__(self, values):
        """The value for a dictionary of parameter values. Raises Error unless it is a finite number."""
        try:
            result = evaluate(self._tree, values)
        except ZeroDivisionError:
            result = None
        except (ValueError, OverflowError):
            result = math.nan
        if isinstance(result, float) and math.isfinite(result):
            return result
        place = ", ".join(f"{name} = {values[name]:.17g}" for name in self.names)
        what = "divides by zero" if result is None else "is not a finite real number"
        raise Error(f"`{self.text}` {what}" + (f" at {place}" if place else ""), self.where, "change the expression or the values of its parameters")

    def check_range(self, ranges):
        """Raises Error if a divisor may vanish within the ranges of the parameters, name -> (lower, upper)."""
        for node in filter(is_division, ast.walk(self._tree)):
            # Treat the base of a power as a divisor if the exponent may be negative
            is_power = isinstance(node.op, ast.Pow)
            if is_power and not interval_of(node.right, ranges).a < 0:
                continue
            if (zero := find_zero(node.left if is_power else node.right, ranges)) is not None:
                place = ", ".join(f"{name} = {value:.6g}" for name, value in zero.items())
                raise Error(f"`{self.text}` divides by zero" + (f" near {place}, within the ranges of its parameters" if place else ""), self.where,
                            "change the expression, or the values or ranges of its parameters")


def python_text(text):
    """The expression in Python's syntax; a prefix distinguishes parameters from keywords."""
    words, at = [], 0
    while at < len(text.rstrip()):
        match = TOKEN.match(text, at)
        if not match:
            raise ValueError(text)
        at = match.end()
        word = match[match.lastgroup]
        words.append(repr(float(word)) if match.lastgroup == "number" else f"v_{word}" if match.lastgroup == "name" else word.replace("^", "**"))
    return " ".join(words)


def names_in(node):
    """Names of the parameters in a syntax tree. Raises ValueError for unsupported operations."""
    if isinstance(node, ast.Call) and isinstance(node.func, ast.Name) and node.func.id[2:] in FUNCTIONS and len(node.args) == 1:
        return names_in(node.args[0])
    if isinstance(node, ast.Name):
        return {node.id[2:]} - CONSTANTS.keys()
    if isinstance(node, ast.UnaryOp):
        return names_in(node.operand)
    if isinstance(node, ast.BinOp) and type(node.op) in OPERATORS:
        return names_in(node.left) | names_in(node.right)
    if isinstance(node, ast.Constant):
        return set()
    raise ValueError(node)


def evaluate(node, values, functions=FUNCTIONS, operators=OPERATORS, number=float):
    """The value of a syntax tree for floats or intervals; `number` converts the constants."""
    own = functools.partial(evaluate, values=values, functions=functions, operators=operators, number=number)
    if isinstance(node, ast.Constant):
        return number(node.value)
    if isinstance(node, ast.Name):
        name = node.id[2:]
        return number(CONSTANTS[name]) if name in CONSTANTS else values[name]
    if isinstance(node, ast.UnaryOp):
        return -own(node.operand) if isinstance(node.op, ast.USub) else own(node.operand)
    if isinstance(node, ast.Call):
        return functions[node.func.id[2:]](own(node.args[0]))
    return operators[type(node.op)](own(node.left), own(node.right))


def is_division(node):
    return isinstance(node, ast.BinOp) and isinstance(node.op, (ast.Div, ast.Pow))


EVERYTHING = iv.mpf([-math.inf, math.inf])


def guarded(operation):
    """An operation on intervals that returns EVERYTHING if it is undefined for some values of its operands."""
    def result(*operands):
        try:
            found = operation(*operands)
        except (mpmath.libmp.ComplexResult, NotImplementedError, OverflowError, ValueError, ZeroDivisionError):
            return EVERYTHING
        return found if isinstance(found, type(EVERYTHING)) else EVERYTHING  # a complex result counts as undefined

    return result


INTERVAL_FUNCTIONS = {name: abs if name == "abs" else guarded(getattr(iv, name)) for name in FUNCTIONS}
INTERVAL_OPERATORS = {kind: guarded(operation) for kind, operation in OPERATORS.items()}


def interval_of(node, ranges):
    """An interval that contains all values of a syntax tree for parameters within `ranges`, name -> (lower, upper)."""
    values = {name: iv.mpf(ranges[name]) for name in names_in(node)}
    return evaluate(node, values, INTERVAL_FUNCTIONS, INTERVAL_OPERATORS, iv.mpf)


def find_zero(node, ranges):
    """Parameter values near a possible zero of a syntax tree, or None. Bisects the ranges until no interval contains
    zero, or until the limit HALVINGS is reached."""
    boxes = [(0, {name: ranges[name] for name in names_in(node)})]
    while boxes:
        halvings, box = boxes.pop()
        if 0 not in interval_of(node, box):
            continue
        widths = {name: (upper - lower) / ((ranges[name][1] - ranges[name][0]) or 1.0) for name, (lower, upper) in box.items()}
        widest = max(widths, key=widths.get, default=None)
        if widest is None or widths[widest] == 0 or halvings == HALVINGS * len(box):
            return {name: min(ends, key=abs) for name, ends in box.items()}
        lower, upper = box[widest]
        middle = 0.5 * (lower + upper)
        boxes += [(halvings + 1, {**box, widest: half}) for half in ((middle, upper), (lower, middle))]
    return None
