# SPDX-License-Identifier: GPL-3.0-or-later

"""Coefficients: muParser expressions in named parameters.

Operators are + - * / ^, functions sin, cos, tan, exp, log and ln (natural), sqrt and abs; _pi is pi.
"""

import ast
import math
import operator
import re

from squeal.errors import Error

FUNCTIONS = {"sin": math.sin, "cos": math.cos, "tan": math.tan, "exp": math.exp, "log": math.log, "ln": math.log, "sqrt": math.sqrt, "abs": abs}
OPERATORS = {ast.Add: operator.add, ast.Sub: operator.sub, ast.Mult: operator.mul, ast.Div: operator.truediv, ast.Pow: operator.pow}
CONSTANTS = {"_pi": math.pi}
TOKEN = re.compile(r"\s*(?:(?P<number>(?:\d+\.?\d*|\.\d+)(?:[eE][+-]?\d+)?)|(?P<name>[A-Za-z_]\w*)|(?P<operator>[-+*/^()]))", re.ASCII)
NAME = re.compile(r"[A-Za-z_]\w*", re.ASCII)
CHANGE = "write + - * / ^, sin, cos, tan, exp, log, sqrt, abs, _pi, numbers and names of parameters"
# Bisections per parameter after which a divisor that may vanish counts as zero
HALVINGS = 40


class Expression:
    """A parsed expression: its `text`, and the sorted `names` of its parameters."""

    def __init__(self, text, names, where):
        """Raises Error if the text cannot be parsed or contains a parameter that is not in `names`."""
        self.text, self.where = text, where
        try:
            self._tree = ast.parse(python_text(text), mode="eval").body
            self.names = sorted(names_in(self._tree))
        except (SyntaxError, ValueError, RecursionError, MemoryError):
            raise Error(f"`{text}` is not an expression", where, CHANGE) from None
        if unknown := [name for name in self.names if name not in names]:
            raise Error(f"`{text}` names the parameter `{unknown[0]}`, which is unknown", where,
                        f"declare it under `parameters`, or name one of: {', '.join(names) or '(none)'}")

    def __call__(self, values):
        """The value for a dictionary of parameter values. Raises Error if it is not a finite number."""
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
        """Raises Error if a divisor vanishes within the ranges of the parameters, name -> (lower, upper)."""
        for node in ast.walk(self._tree):
            if is_division(node) and (zero := find_zero(divisor(node), {name: ranges[name] for name in self.names})) is not None:
                place = ", ".join(f"{name} = {value:.6g}" for name, value in zero.items())
                raise Error(f"`{self.text}` divides by zero" + (f" at {place}, inside the range" if place else ""), self.where,
                            "change the ranges of the parameters or the expression")


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
    """Names of the parameters in a tree. Raises ValueError if it contains anything but the allowed operations."""
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


def evaluate(node, values, functions=FUNCTIONS, number=float):
    """The value of a tree for floats or intervals; `number` converts the constants."""
    if isinstance(node, ast.Constant):
        return number(node.value)
    if isinstance(node, ast.Name):
        name = node.id[2:]
        return number(CONSTANTS[name]) if name in CONSTANTS else values[name]
    if isinstance(node, ast.UnaryOp):
        value = evaluate(node.operand, values, functions, number)
        return -value if isinstance(node.op, ast.USub) else value
    if isinstance(node, ast.Call):
        return functions[node.func.id[2:]](evaluate(node.args[0], values, functions, number))
    return OPERATORS[type(node.op)](*(evaluate(side, values, functions, number) for side in (node.left, node.right)))


def is_division(node):
    return isinstance(node, ast.BinOp) and isinstance(node.op, (ast.Div, ast.Pow))


def divisor(node):
    """The divisor; that of a power is its base if the exponent is negative."""
    return node.right if isinstance(node.op, ast.Div) else ast.IfExp(test=node.right, body=node.left, orelse=ast.Constant(1.0))


class Interval:
    """The interval [lower, upper]; operations return intervals that contain all results for numbers in the operands."""

    def __init__(self, lower, upper=None):
        self.lower, self.upper = lower, lower if upper is None else upper

    @classmethod
    def around(cls, values):
        values = list(values)
        return EVERYTHING if any(math.isnan(value) for value in values) else cls(min(values), max(values))

    @property
    def ends(self):
        return self.lower, self.upper

    def __contains__(self, value):
        return self.lower <= value <= self.upper

    def __neg__(self):
        return Interval(-self.upper, -self.lower)

    def __add__(self, other):
        return Interval(self.lower + other.lower, self.upper + other.upper)

    def __sub__(self, other):
        return self + -other

    def __mul__(self, other):
        return Interval.around(a * b for a in self.ends for b in other.ends)

    def __truediv__(self, other):
        return EVERYTHING if 0 in other else Interval.around(a / b for a in self.ends for b in other.ends)

    def __pow__(self, exponent):
        if exponent.lower < 0:
            return EVERYTHING if 0 in self else Interval(1.0) / self**-exponent
        if exponent.lower == exponent.upper and exponent.lower.is_integer():
            ends = (bounded(pow, end, exponent.lower) for end in self.ends)
            return Interval.around([*ends, 0.0] if exponent.lower > 0 and 0 in self else ends)
        return EVERYTHING if self.lower < 0 else Interval.around(bounded(pow, a, b) for a in self.ends for b in exponent.ends)

    def __abs__(self):
        return Interval.around([*map(abs, self.ends), *([0.0] if 0 in self else [])])


EVERYTHING = Interval(-math.inf, math.inf)


def bounded(function, *values):
    """The value of a function, infinite on overflow."""
    try:
        return function(*values)
    except OverflowError:
        return math.inf


def monotonic(function, least):
    """An increasing function of intervals, undefined for numbers up to `least`."""
    return lambda x: EVERYTHING if x.lower <= least else Interval(*(bounded(function, end) for end in x.ends))


def wave(function, top):
    """Sine or cosine of intervals, with its maximum at `top`."""
    def of(x):
        if not x.upper - x.lower < 2 * math.pi:
            return Interval(-1.0, 1.0)
        extremes = [value for value, place in ((1.0, top), (-1.0, top + math.pi))
                    if place + 2 * math.pi * math.ceil((x.lower - place) / (2 * math.pi)) in x]
        return Interval.around([*map(function, x.ends), *extremes])

    return of


SIN, COS = wave(math.sin, math.pi / 2), wave(math.cos, 0.0)
OF_INTERVALS = {"sin": SIN, "cos": COS, "tan": lambda x: SIN(x) / COS(x), "exp": monotonic(math.exp, -math.inf), "log": monotonic(math.log, 0.0),
                "ln": monotonic(math.log, 0.0), "sqrt": monotonic(math.sqrt, -math.ulp(0.0)), "abs": abs}


def interval_of(node, ranges):
    """An interval that contains all values of a tree for parameters within ranges."""
    return evaluate(node, {name: Interval(*ends) for name, ends in ranges.items()}, OF_INTERVALS, Interval)


def find_zero(node, ranges):
    """Parameters near a zero of a tree, None if it has none; bisects the ranges until every interval excludes zero."""
    if isinstance(node, ast.IfExp):
        return find_zero(node.body, ranges) if interval_of(node.test, ranges).lower < 0 else None
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
