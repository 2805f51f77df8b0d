# SPDX-FileCopyrightText: The uel-harness authors
# SPDX-License-Identifier: BSD-3-Clause
"""*PARAMETER: statements `name = expression` in Python syntax, evaluated by a small interpreter."""

from __future__ import annotations

import ast
import math
import operator
from collections.abc import Callable, Mapping

Value = float | int | str

_BINARY: dict[type[ast.operator], Callable[[float, float], float]] = {
    ast.Add: operator.add,
    ast.Sub: operator.sub,
    ast.Mult: operator.mul,
    ast.FloorDiv: operator.floordiv,
    ast.Mod: operator.mod,
}
_FUNCTIONS: dict[str, Callable[..., float]] = {
    **{name: getattr(math, name) for name in ("sin", "cos", "tan", "asin", "acos", "atan", "atan2", "sinh", "cosh")},
    **{name: getattr(math, name) for name in ("tanh", "sqrt", "exp", "log", "log10", "floor", "ceil", "radians")},
    **{"degrees": math.degrees, "abs": abs, "int": int, "float": float, "min": min, "max": max, "pow": math.pow},
}
_CONSTANTS: dict[str, Value] = {"pi": math.pi}
_LONGEST = 2000
_LARGEST_INTEGER = 2**63


def assign(statement: str, parameters: Mapping[str, Value]) -> tuple[str, Value]:
    """Return name and value of `name = expression`. Raises ValueError."""
    if len(statement) > _LONGEST:
        raise ValueError("the expression is too long")
    source = statement.strip()
    malformed = ValueError(f"'{source}' is not of the form name = expression")
    try:
        tree = ast.parse(source)
    except (SyntaxError, ValueError, RecursionError, MemoryError):
        raise malformed from None
    match tree.body:
        case [ast.Assign(targets=[ast.Name(id=name)], value=value)]:
            pass
        case _:
            raise malformed
    try:
        return name, _evaluate(value, parameters, source)
    except OverflowError:
        raise ValueError(f"'{source}' cannot be evaluated: a number is too large") from None
    except (ArithmeticError, TypeError, RecursionError) as error:
        raise ValueError(f"'{source}' cannot be evaluated: {error}") from None


def find(name: str, parameters: Mapping[str, Value]) -> Value | None:
    """Return the value of a parameter, else of the only one that differs in case, else None."""
    if name in parameters:
        return parameters[name]
    alike = [value for key, value in parameters.items() if key.lower() == name.lower()]
    return alike[0] if len(alike) == 1 else None


def _evaluate(node: ast.expr, parameters: Mapping[str, Value], source: str) -> Value:
    """Evaluate a part of the statement whose text is `source`. Raises ValueError."""
    match node:
        case ast.Constant(value=str() | float() | int() as value):
            return value
        case ast.Name(id=name):
            parameter = find(name, {**_CONSTANTS, **parameters})
            if parameter is None:
                raise ValueError(f"parameter '{name}' is not defined")
            return parameter
        case ast.UnaryOp(op=ast.USub(), operand=operand):
            return -_number(operand, parameters, source)
        case ast.UnaryOp(op=ast.UAdd(), operand=operand):
            return _number(operand, parameters, source)
        case ast.BinOp(left=left, op=op, right=right):
            text = ast.get_source_segment(source, node)
            value = _binary(op, _number(left, parameters, source), _number(right, parameters, source), f"'{text}'")
            # integers without bound would double their digits with every x = x*x
            value = float(value) if abs(value) > _LARGEST_INTEGER else value
            if math.isinf(value):
                raise ValueError(f"'{text}' is too large for a number")
            return value
        case ast.Call(func=ast.Name(id=name), args=arguments, keywords=[]) if name in _FUNCTIONS:
            return _FUNCTIONS[name](*(_number(argument, parameters, source) for argument in arguments))
    text = ast.get_source_segment(source, node)
    raise ValueError(f"'{text}' is not an expression that *PARAMETER can evaluate here")


def _number(node: ast.expr, parameters: Mapping[str, Value], source: str) -> float | int:
    value = _evaluate(node, parameters, source)
    if isinstance(value, str):
        raise ValueError(f"'{value}' is text, expected a number")
    return value


def _binary(op: ast.operator, left: float, right: float, text: str) -> float:
    """Evaluate a binary operation; text: its spelling in the deck, in quotes. Raises ValueError."""
    if isinstance(op, ast.Div):
        if isinstance(left, int) and isinstance(right, int) and right and left % right:
            # releases of Abaqus differ: Python 2 truncates, Python 3 does not
            message = f"{text} divides the integers {left} and {right}, which depends on the release of Abaqus"
            raise ValueError(f"{message}; give one of them a point, as in {left}.")
        return left // right if isinstance(left, int) and isinstance(right, int) else left / right
    if isinstance(op, ast.Pow):
        return _power(left, right, text)
    if type(op) not in _BINARY:
        raise ValueError("expected one of the operators + - * / // % **")
    return _BINARY[type(op)](left, right)


def _power(left: float, right: float, text: str) -> float:
    exact = isinstance(left, int) and isinstance(right, int) and abs(left) < 10**9 and 0 <= right <= 64
    value: float | complex = left**right if exact else float(left) ** float(right)
    if isinstance(value, complex):
        raise ValueError(f"{text} is not real")
    return value
