"""The tree of an expression: what the parser builds and the evaluation walks."""

from __future__ import annotations

from dataclasses import dataclass
from typing import Literal

from thermodata.schema.agreed.comparators import Comparator

Operator = Literal["+", "-", "*", "/"]


@dataclass(frozen=True, slots=True)
class Constant:
    """A number; unit "" where it has none: it then takes the unit of what it meets."""

    value: float
    unit: str


@dataclass(frozen=True, slots=True)
class Name:
    name: str


@dataclass(frozen=True, slots=True)
class Negative:
    of: Node


@dataclass(frozen=True, slots=True)
class Absolute:
    of: Node


@dataclass(frozen=True, slots=True)
class Rate:
    """The rate of change of a channel between its own samples, by the second."""

    name: str


@dataclass(frozen=True, slots=True)
class Arithmetic:
    operator: Operator
    left: Node
    right: Node


@dataclass(frozen=True, slots=True)
class Comparison:
    """a < b <= c is Comparison((a, b, c), ("<", "<="))."""

    operands: tuple[Node, ...]
    operators: tuple[Comparator, ...]


@dataclass(frozen=True, slots=True)
class Every:
    of: tuple[Node, ...]


@dataclass(frozen=True, slots=True)
class AnyOf:
    of: tuple[Node, ...]


@dataclass(frozen=True, slots=True)
class Not:
    of: Node


Node = Constant | Name | Negative | Absolute | Rate | Arithmetic | Comparison | Every | AnyOf | Not
