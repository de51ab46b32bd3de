"""OpenSCENARIO: parameters and the expressions that are made of them."""

from __future__ import annotations

import ast
import math
import operator
import re
from collections.abc import Callable, Mapping
from typing import Any

from ._refusals import number, refuse
from ._xml import Node

MAX_EXPRESSION = 500
MAX_PARAMETERS = 2_000
_NAME = re.compile(r"\$([A-Za-z_][A-Za-z0-9_]*)")
_PREFIX = "parameter_"

_BINARY: dict[type[ast.AST], Callable[[float, float], float]] = {
    ast.Add: operator.add,
    ast.Sub: operator.sub,
    ast.Mult: operator.mul,
    ast.Div: operator.truediv,
    ast.Mod: math.fmod,
    ast.Pow: math.pow,
}
_UNARY: dict[type[ast.AST], Callable[[float], float]] = {
    ast.UAdd: operator.pos,
    ast.USub: operator.neg,
}
_FUNCTIONS: dict[str, Callable[..., float]] = {
    "round": lambda value: float(round(value)),
    "floor": lambda value: float(math.floor(value)),
    "ceil": lambda value: float(math.ceil(value)),
    "sqrt": math.sqrt,
    "pow": math.pow,
    "abs": abs,
    "sign": lambda value: math.copysign(1.0, value) if value else 0.0,
    "max": max,
    "min": min,
    "sin": math.sin,
    "cos": math.cos,
    "tan": math.tan,
}


class Parameters:
    """Values of parameters by name; a scope inside another sees both.

    Parameters
    ----------
    values : mapping
        Values by name, as text.
    """

    def __init__(self, values: Mapping[str, str] | None = None) -> None:
        self._values = dict(values or {})

    def declared(self, node: Node | None, given: Mapping[str, str] | None = None) -> Parameters:
        """Return these and the parameters of a `ParameterDeclarations`.

        Parameters
        ----------
        given : mapping, optional
            Values in place of those that the declarations state.
        """
        inner = Parameters(self._values)
        declarations = node.children("ParameterDeclaration") if node is not None else []
        for each in declarations:
            if len(inner._values) >= MAX_PARAMETERS:
                refuse(each.file, each.place, "is one parameter too many", "declare fewer")
            name = each.attribute("name").removeprefix("$")
            if given is not None and name in given:
                inner._values[name] = given[name]
            else:
                inner._values[name] = inner.text(each, "value")
        return inner

    def text(self, node: Node, attribute: str, otherwise: str | None = None) -> str:
        """Return an attribute with parameters and expressions replaced by their values."""
        stated = node.get(attribute)
        if stated is None:
            if otherwise is not None:
                return otherwise
            stated = node.attribute(attribute)
        stated = stated.strip()
        if stated.startswith("${") and stated.endswith("}"):
            return self._evaluated(node, attribute, stated[2:-1])
        if stated.startswith("$"):
            name = stated[1:]
            if name not in self._values:
                refuse(node.file, node.place, f"uses the unknown parameter ${name}", "declare it")
            return self._values[name]
        return stated

    def number(
        self, node: Node, attribute: str, otherwise: float | None = None,
        low: float = -1e9, high: float = 1e9,
    ) -> float:  # fmt: skip
        """Return an attribute as a number within a range."""
        if node.get(attribute) is None and otherwise is not None:
            return otherwise
        text = self.text(node, attribute)
        return number(text, node.file, f"{node.place}, {attribute}", low, high)

    def _evaluated(self, node: Node, attribute: str, expression: str) -> str:
        place = f"{node.place}, {attribute}"
        if len(expression) > MAX_EXPRESSION:
            refuse(node.file, place, "is a long expression", f"at most {MAX_EXPRESSION} characters")
        names = set(_NAME.findall(expression))
        unknown = sorted(names - self._values.keys())
        if unknown:
            refuse(node.file, place, f"uses the unknown parameter ${unknown[0]}", "declare it")
        try:
            tree = ast.parse(_NAME.sub(rf"{_PREFIX}\1", expression).strip(), mode="eval")
            value = self._value(tree.body)
        except (SyntaxError, ValueError, TypeError, ArithmeticError, RecursionError, MemoryError):
            refuse(
                node.file, place, f"is an expression that has no number: {expression[:80]}",
                "write it with numbers, + - * / % and the functions of OpenSCENARIO",
            )  # fmt: skip
        return repr(value)

    def _value(self, tree: ast.AST) -> float:
        """Return the value of an expression; raises ValueError for anything else."""
        if isinstance(tree, ast.Constant) and isinstance(tree.value, (int, float)):
            return float(tree.value)
        if isinstance(tree, ast.Name) and tree.id.startswith(_PREFIX):
            return float(self._values[tree.id.removeprefix(_PREFIX)])
        if isinstance(tree, ast.BinOp) and type(tree.op) in _BINARY:
            return _BINARY[type(tree.op)](self._value(tree.left), self._value(tree.right))
        if isinstance(tree, ast.UnaryOp) and type(tree.op) in _UNARY:
            return _UNARY[type(tree.op)](self._value(tree.operand))
        if isinstance(tree, ast.Call) and isinstance(tree.func, ast.Name) and not tree.keywords:
            function: Any = _FUNCTIONS.get(tree.func.id)
            if function is not None:
                return float(function(*[self._value(each) for each in tree.args]))
        raise ValueError


def assignments(node: Node | None, parameters: Parameters) -> dict[str, str]:
    """Return the values of a `ParameterAssignments` by name."""
    found = node.children("ParameterAssignment") if node is not None else []
    return {
        each.attribute("parameterRef").removeprefix("$"): parameters.text(each, "value")
        for each in found
    }
