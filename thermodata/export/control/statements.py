"""Declarations and statements of a control program: few enough that every language has them."""

from __future__ import annotations

from dataclasses import dataclass, field
from typing import Literal, TypeAlias

from thermodata.effect import law
from thermodata.export.control.program import Program

Kind = Literal["real", "int", "bool", "ring"]
Held = Literal["in", "out", "kept", "temp"]


@dataclass(frozen=True)
class Variable:
    """held: an input, an output, kept from cycle to cycle (and over power off), or of one cycle. length: of a ring."""

    name: str
    kind: Kind
    held: Held
    about: str = ""
    start: float = 0.0
    length: int = 0


@dataclass(frozen=True)
class Assign:
    """target := value. kind: of the value."""

    target: str
    value: law.Node
    kind: Kind = "real"


@dataclass(frozen=True)
class If:
    """Statements where a condition holds, and others where it does not."""

    condition: law.Node
    then: tuple[Statement, ...]
    other: tuple[Statement, ...] = ()


@dataclass(frozen=True)
class Fill:
    """All places of a ring := value."""

    ring: str
    length: int
    value: law.Node


@dataclass(frozen=True)
class Say:
    """A comment."""

    text: str


Statement: TypeAlias = Assign | If | Fill | Say


@dataclass
class Body:
    """compensated: states are kept in two words, for reals of 32 bits."""

    program: Program
    compensated: bool
    variables: list[Variable] = field(default_factory=list)
    statements: list[Statement] = field(default_factory=list)
    _temps: int = 0


def number(body: Body, node: law.Node) -> law.Node:
    """The node as arithmetic alone: conditions and choices become statements before it, a square a product."""
    match node:
        case law.Binary("**", left, law.Number(2.0)):
            base = number(body, left)
            base = base if isinstance(base, law.Symbol) else _hoist(body, base)
            return law.Binary("*", base, base)
        case law.Binary(operator, left, right):
            return law.Binary(operator, number(body, left), number(body, right))
        case law.Absolute(of):
            return law.Absolute(number(body, of))
        case law.Compare() | law.Logic():
            return number(body, law.Where(node, law.ONE, law.ZERO))
        case law.Where(holds, then, other):
            name = _temp(body)
            held = condition(body, holds)
            a, b = number(body, then), number(body, other)
            body.statements.append(If(held, (Assign(name, a),), (Assign(name, b),)))
            return var(name)
    return node


def condition(body: Body, node: law.Node) -> law.Node:
    """The node as a truth value: a number is true where it is not 0."""
    match node:
        case law.Compare(operator, left, right):
            return law.Compare(operator, number(body, left), number(body, right))
        case law.Logic(operator, parts):
            return law.Logic(operator, tuple(condition(body, p) for p in parts))
    return law.Compare("!=", number(body, node), law.ZERO)


def _hoist(body: Body, value: law.Node) -> law.Node:
    name = _temp(body)
    body.statements.append(Assign(name, value))
    return var(name)


def _temp(body: Body) -> str:
    body._temps += 1
    name = f"tmp_{body._temps}"
    body.variables.append(Variable(name, "real", "temp"))
    return name


@dataclass(frozen=True, slots=True)
class WholeNumber:
    """A whole number or, as `truth`, a truth value: languages write them otherwise than reals."""

    value: int
    truth: bool = False


def var(name: str) -> law.Symbol:
    """A variable of the program."""
    return law.Symbol(name)


def whole(value: int) -> law.Node:
    """A whole number."""
    return WholeNumber(value)  # type: ignore[return-value]


def truth(value: bool) -> law.Node:
    """TRUE or FALSE."""
    return WholeNumber(int(value), truth=True)  # type: ignore[return-value]


def any_of(parts: tuple[law.Node, ...]) -> law.Node:
    """Whether one of some conditions holds."""
    if not parts:
        return truth(False)
    return parts[0] if len(parts) == 1 else law.Logic("or", parts)
