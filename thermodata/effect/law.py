"""An effect's law: what it computes from one sample to the next, in a form that another program can run.

An effect may have a method more than the contract asks for, `law(roles, p, step_s)`: one formula a gain, as text or as
a tree of this module. With it the effect can be shown as a linear system and exported into a control; `basis` stays
what is fitted, and the kit holds the two equal.

    lag(temperature, tau)                          F_tau{dT}
    lag(abs(speed / 10000) ** exponent, tau)       friction heat
    lag(temperature, where(abs(speed) > 1, tau_on, tau_off))
    delay(u, dead)                                 u(t - dead)

Names are drivers and parameters; a parameter in min or h that stands as a time counts in seconds.
"""

from __future__ import annotations

import ast
import operator as op
from collections.abc import Callable, Iterator, Mapping
from dataclasses import dataclass, fields, replace
from functools import lru_cache
from typing import Any, Literal, TypeAlias, cast, get_args

from thermodata.effect.linear import Filter
from thermodata.errors import PluginError
from thermodata.schema.agreed.comparators import Comparator
from thermodata.schema.units.quantity import SECONDS_PER_UNIT

Operator = Literal["+", "-", "*", "/", "**"]


@dataclass(frozen=True, slots=True)
class Number:
    """A constant."""

    value: float


@dataclass(frozen=True, slots=True)
class Symbol:
    """A driver's role; or a parameter, until its value is put in."""

    name: str


@dataclass(frozen=True, slots=True)
class Binary:
    """left operator right."""

    operator: Operator
    left: Node
    right: Node


@dataclass(frozen=True, slots=True)
class Absolute:
    """|of|."""

    of: Node


@dataclass(frozen=True, slots=True)
class Compare:
    """A condition: as a number 1 where it holds, else 0."""

    operator: Comparator
    left: Node
    right: Node


@dataclass(frozen=True, slots=True)
class Logic:
    """`and` or `or` of conditions, or `not` of one."""

    operator: Literal["and", "or", "not"]
    of: tuple[Node, ...]


@dataclass(frozen=True, slots=True)
class Where:
    """then where the condition holds, else other."""

    condition: Node
    then: Node
    other: Node


@dataclass(frozen=True, slots=True)
class Lag:
    """F_tau{of}; tau [s] a number, or a choice between numbers."""

    of: Node
    tau: Node


@dataclass(frozen=True, slots=True)
class Delay:
    """of(t - dead); dead [s] a number. Before the start `of` stood where it started."""

    of: Node
    dead: Node


@dataclass(frozen=True, slots=True)
class Filtered:
    """A linear filter of `of`."""

    of: Node
    by: Filter


Node: TypeAlias = Number | Symbol | Binary | Absolute | Compare | Logic | Where | Lag | Delay | Filtered
Law: TypeAlias = str | Node
NODES = get_args(Node)
ZERO, ONE = Number(0.0), Number(1.0)

_BINARY: dict[type[ast.operator], Operator] = {
    ast.Add: "+",
    ast.Sub: "-",
    ast.Mult: "*",
    ast.Div: "/",
    ast.Pow: "**",
}
_COMPARE: dict[type[ast.cmpop], Comparator] = {
    ast.Lt: "<",
    ast.LtE: "<=",
    ast.Gt: ">",
    ast.GtE: ">=",
    ast.Eq: "==",
    ast.NotEq: "!=",
}
_COMPUTED = {"+": op.add, "-": op.sub, "*": op.mul, "/": op.truediv, "**": op.pow}
_FUNCTIONS = {"abs": 1, "lag": 2, "delay": 2, "where": 3}


@lru_cache(maxsize=512)
def parse(text: str) -> Node:
    """The tree of a formula. PluginError names what it can't hold."""
    try:
        return _tree(ast.parse(text.strip(), mode="eval").body)
    except SyntaxError as error:
        raise PluginError("a law is no formula", where=text, got=str(error)) from None
    except _ForeignError as error:
        raise PluginError(
            "a law holds what no control computes",
            where=text,
            expected="numbers, names, + - * / **, comparisons, " + ", ".join(_FUNCTIONS),
            got=str(error),
        ) from None


class _ForeignError(Exception):
    """A part of a formula that no control computes, as it is written."""


def _tree(node: ast.expr) -> Node:
    if isinstance(node, ast.Constant) and isinstance(node.value, int | float) and not isinstance(node.value, bool):
        return Number(float(node.value))
    if isinstance(node, ast.Name):
        return Symbol(node.id)
    if isinstance(node, ast.UnaryOp) and isinstance(node.op, ast.USub):
        inner = _tree(node.operand)
        return Number(-inner.value) if isinstance(inner, Number) else Binary("*", Number(-1.0), inner)
    if isinstance(node, ast.BinOp) and type(node.op) in _BINARY:
        return Binary(_BINARY[type(node.op)], _tree(node.left), _tree(node.right))
    if isinstance(node, ast.Compare) and len(node.ops) == 1 and type(node.ops[0]) in _COMPARE:
        return Compare(_COMPARE[type(node.ops[0])], _tree(node.left), _tree(node.comparators[0]))
    if isinstance(node, ast.BoolOp):
        return Logic("and" if isinstance(node.op, ast.And) else "or", tuple(map(_tree, node.values)))
    if isinstance(node, ast.Call) and isinstance(node.func, ast.Name) and not node.keywords:
        name, inner_nodes = node.func.id, [_tree(a) for a in node.args]
        if _FUNCTIONS.get(name) == len(inner_nodes):
            made: dict[str, type[Any]] = {"abs": Absolute, "lag": Lag, "delay": Delay, "where": Where}
            return cast(Node, made[name](*inner_nodes))
    raise _ForeignError(ast.unparse(node))


def tree(law: Law) -> Node:
    """The law as a tree, however it was given."""
    return parse(law) if isinstance(law, str) else law


def children(node: Node) -> Iterator[Node]:
    """The nodes right below one."""
    for field in fields(node):
        value = getattr(node, field.name)
        yield from (one for one in (value if isinstance(value, tuple) else (value,)) if isinstance(one, NODES))


def walk(node: Node) -> Iterator[Node]:
    """The node and all below it."""
    yield node
    for child in children(node):
        yield from walk(child)


def mapped(node: Node, change: Callable[[Node], Node]) -> Node:
    """The node with each of its children changed."""
    changed: dict[str, Any] = {}
    for field in fields(node):
        value = getattr(node, field.name)
        if isinstance(value, tuple):
            changed[field.name] = tuple(change(one) for one in value)
        elif isinstance(value, NODES):
            changed[field.name] = change(value)
    return cast(Node, replace(cast(Any, node), **changed)) if changed else node


def put(node: Node, values: Mapping[str, Node]) -> Node:
    """The tree with symbols replaced by other trees."""
    if isinstance(node, Symbol):
        return values.get(node.name, node)
    return mapped(node, lambda one: put(one, values))


def with_parameters(law: Law, p: Mapping[str, float], units: Mapping[str, str]) -> Node:
    """The tree with the parameters' values; times in s where they are times (in `lag` and `delay`)."""
    plain: dict[str, Node] = {name: Number(float(value)) for name, value in p.items()}
    times: dict[str, Node] = {
        name: Number(float(value) * SECONDS_PER_UNIT.get(units.get(name, "s"), 1.0)) for name, value in p.items()
    }

    def time(one: Node) -> Node:
        # a choice between times: its condition is in the parameters' own units
        if isinstance(one, Where):
            return Where(put(one.condition, plain), time(one.then), time(one.other))
        return put(one, times)

    def inside(one: Node) -> Node:
        if isinstance(one, Lag):
            return Lag(inside(one.of), fold(time(one.tau)))
        if isinstance(one, Delay):
            return Delay(inside(one.of), fold(time(one.dead)))
        return plain.get(one.name, one) if isinstance(one, Symbol) else mapped(one, inside)

    return fold(inside(tree(law)))


def fold(node: Node) -> Node:
    """Constants computed, and what multiplies by 1 or adds 0 left out."""
    node = mapped(node, fold)
    if isinstance(node, Absolute) and isinstance(node.of, Number):
        return Number(abs(node.of.value))
    if not isinstance(node, Binary):
        return node
    left, right = node.left, node.right
    if isinstance(left, Number) and isinstance(right, Number) and not (node.operator == "/" and right == ZERO):
        return Number(float(_COMPUTED[node.operator](left.value, right.value)))
    if node.operator == "*" and ONE in (left, right):
        return right if left == ONE else left
    if node.operator in ("/", "**") and right == ONE:
        return left
    if node.operator in ("+", "-") and right == ZERO:
        return left
    if node.operator == "+" and left == ZERO:
        return right
    return node


def symbols(node: Node) -> set[str]:
    """The names that a tree reads."""
    return {n.name for n in walk(node) if isinstance(n, Symbol)}


def is_static(node: Node) -> bool:
    """Whether it remembers nothing: no lag, no delay, no filter below it."""
    return not any(isinstance(n, Lag | Delay | Filtered) for n in walk(node))
