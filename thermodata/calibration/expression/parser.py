"""Expressions over channels, as `derive`, `measuring` and model drivers use them; parsed here, never eval().

    either     := both ("or" both)*
    both       := negation ("and" negation)*
    negation   := "not" negation | comparison
    comparison := sum (("<" | "<=" | ">" | ">=" | "==" | "!=") sum)*
    sum        := product (("+" | "-") product)*
    product    := factor (("*" | "/") factor)*
    factor     := ("-" | "+") factor | number [unit] | name | call | "(" either ")"
    call       := "abs" "(" either ")" | "rate" "(" name ")"

A unit stands right after its number and has no blank inside ("100 mm", "10 m/min", "6000 1/min"; "N m" is the
one exception). What could be a unit is one: write "100 / mm_count", or "2 * s", where a channel is meant. A rate is of
one channel and its own samples, and so in `derive` only: whoever else reads an expression has them on a grid.
"""

from __future__ import annotations

import re
from collections.abc import Callable
from functools import lru_cache
from typing import Any, cast

from thermodata.calibration.expression import nodes
from thermodata.calibration.expression.expression import Expression
from thermodata.calibration.expression.nodes import Node
from thermodata.errors import UsageError
from thermodata.schema.agreed.comparators import COMPARE, Comparator
from thermodata.schema.units.unit import is_unit

_TOKEN = re.compile(
    r"\s*(?:(?P<number>(?:\d+\.?\d*|\.\d+)(?:[eE][+-]?\d+)?)"
    r"|(?P<name>[^\W\d]\w*(?:\.[^\W\d]\w*)*)|(?P<op><=|>=|==|!=|[<>=+\-*/()]))"
)
_UNIT = re.compile(r"[ \t]*(?P<unit>N[ ]m\b|1/[^\W\d]\w*|[°%]?(?:[^\W\d][\w°²³⁻¹^·]*(?:-\d)?)?(?:/[^\W\d][\w²³^]*)*)")
_WORDS = frozenset({"and", "or", "not", "abs"})
_LONGEST, _DEEPEST = 2000, 60


@lru_cache(maxsize=1024)
def parse(text: str, *, rates: bool = False) -> Expression:
    """Parses `text`; UsageError with the place of what is wrong. rates: whether it may take the rate of a channel."""
    if not isinstance(text, str) or not text.strip():
        raise UsageError("an empty expression", expected="for example 'T_nut_Z - T_amb'", got=repr(text))
    if len(text) > _LONGEST:
        raise UsageError(
            "an expression too long",
            expected=f"at most {_LONGEST} characters",
            got=str(len(text)),
            hint="take it apart: a 'derive' may read other derived channels",
        )
    parser = _Parser(text, rates)
    tree = parser.either()
    parser.end()
    return Expression(text, tree, frozenset(parser.names), frozenset(parser.rated))


class _Parser:
    def __init__(self, text: str, rates: bool) -> None:
        self.text, self.rates, self.at, self.depth, self.size = text, rates, 0, 0, 0
        self.names, self.rated = set[str](), set[str]()
        self.kind, self.token = "", ""
        self._next_token()

    def _fail(self, what: str, expected: str, at: int | None = None, hint: str | None = None) -> UsageError:
        place = self.at - len(self.token) if at is None else at
        return UsageError(
            what,
            where=f"expression '{self.text}', column {place + 1}",
            expected=expected,
            got=repr(self.token) if self.token else "the end",
            hint=hint,
        )

    def _next_token(self) -> None:
        match = _TOKEN.match(self.text, self.at)
        if match is None:
            rest = self.text[self.at :].strip()
            self.kind, self.token, at = "end", rest[:1], self.at
            self.at = len(self.text)
            if rest:
                hint = {"&": "write 'and'", "|": "write 'or'", "!": "write 'not'"}.get(rest[0])
                raise self._fail(f"unexpected character '{rest[0]}'", "a channel, a number or an operator", at, hint)
            return
        self.at = match.end()
        self.kind, self.token = str(match.lastgroup), str(match[str(match.lastgroup)])

    def _take_token(self, *tokens: str) -> str | None:
        if self.kind in ("op", "name") and self.token in tokens:
            token = self.token
            self._next_token()
            return token
        return None

    def end(self) -> None:
        if self.kind != "end":
            hint = "write '==' to compare" if self.token == "=" else None
            raise self._fail(f"unexpected '{self.token}'", "an operator or the end", hint=hint)

    def either(self) -> Node:
        parts = [self._conjunction()]
        while self._take_token("or"):
            parts.append(self._conjunction())
        return parts[0] if len(parts) == 1 else nodes.AnyOf(tuple(parts))

    def _conjunction(self) -> Node:
        parts = [self._negation()]
        while self._take_token("and"):
            parts.append(self._negation())
        return parts[0] if len(parts) == 1 else nodes.Every(tuple(parts))

    def _negation(self) -> Node:
        if self._take_token("not"):
            return nodes.Not(self._nested(self._negation))
        return self._comparison()

    def _comparison(self) -> Node:
        operands, operators = [self._sum()], []
        while operator := self._take_token(*COMPARE):
            operators.append(cast(Comparator, operator))
            operands.append(self._sum())
        return nodes.Comparison(tuple(operands), tuple(operators)) if operators else operands[0]

    def _sum(self) -> Node:
        return self._chain(self._product, "+", "-")

    def _product(self) -> Node:
        return self._chain(self._factor, "*", "/")

    def _chain(self, part: Callable[[], Node], *operators: str) -> Node:
        left = part()
        while operator := self._take_token(*operators):
            self.size += 1
            if self.size > 5 * _DEEPEST:  # a left-leaning chain is as deep as it is long
                raise self._fail("an expression with too many operations", f"at most {5 * _DEEPEST}")
            left = nodes.Arithmetic(cast(nodes.Operator, operator), left, part())
        return left

    def _nested(self, part: Callable[[], Node]) -> Node:
        self.depth += 1
        if self.depth > _DEEPEST:
            raise self._fail("an expression nested too deep", f"at most {_DEEPEST} levels")
        node = part()
        self.depth -= 1
        return node

    def _factor(self) -> Node:
        if sign := self._take_token("-", "+"):
            node = self._nested(self._factor)
            return nodes.Negative(node) if sign == "-" else node
        if self.kind == "number":
            return self._number()
        if self._take_token("("):
            return self._closed(self._nested(self.either))
        if self.kind == "name" and self.token not in _WORDS - {"abs"}:
            return self._name()
        raise self._fail(
            f"unexpected '{self.token}'" if self.token else "the expression ends too early",
            "a channel, a number or '('",
        )

    def _closed(self, node: Node) -> Node:
        if not self._take_token(")"):
            raise self._fail("a parenthesis is not closed", "')'")
        return node

    def _name(self) -> Node:
        name, at = self.token, self.at - len(self.token)
        self._next_token()
        if self._take_token("("):
            if name == "rate":
                return self._rate(at)
            if name != "abs":
                self.token = name
                raise self._fail(f"no function '{name}'", "abs, rate", at)
            return nodes.Absolute(self._closed(self._nested(self.either)))
        if name == "abs":
            raise self._fail("'abs' without its argument", "abs(...)", at)
        self.names.add(name)
        return nodes.Name(name)

    def _rate(self, at: int) -> Node:
        """Behind 'rate('."""
        if not self.rates:
            self.token = "rate"
            raise self._fail(
                "a rate is of a channel's own samples, which only 'derive' has",
                "a channel",
                at,
                "derive a channel, v: {derive: rate(x_pos), quantity: feed}, and write v here",
            )
        name = self.token
        one = self.kind == "name" and name not in _WORDS
        if one:
            self._next_token()
        if not one or not self._take_token(")"):
            raise self._fail(
                "a rate is of one channel, as it was logged",
                "rate(x_pos)",
                hint="derive the rate of each channel as a channel of its own, and compute with these",
            )
        self.names.add(name)
        self.rated.add(name)
        return nodes.Rate(name)

    def _number(self) -> Node:
        value = float(self.token)
        match: Any = _UNIT.match(self.text, self.at)
        words = match["unit"]
        while words and not is_unit(words):  # "100 mm/x": mm is the unit, x a channel
            words = words.rpartition("/")[0] if "/" in words else (words[:-2] if words[-2:-1] == "-" else "")
        if words and words.split("/")[0] not in _WORDS:
            self.at = match.start("unit") + len(words)
            self._next_token()
            return nodes.Constant(value, words)
        self._next_token()
        if self.kind == "name" and self.token not in _WORDS:
            raise self._fail(
                f"'{self.token}' after a number is not a unit",
                "an operator or a unit",
                hint=f"write '{value:g} * {self.token}'",
            )
        return nodes.Constant(value, "")
