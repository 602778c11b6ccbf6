"""An interpreter of the structured text that the export writes: a function block of IEC 61131-3, or of Siemens SCL.

Parsed by the rules of the standard for these constructs, types checked (no implicit conversions, names whatever their
case), then run as Python with reals of 32 bits (numpy) or 64. There is no MATIEC and no interpreter in the package
registries that this could lean on; the grammar is checked by an independent parser beside it.
"""

from __future__ import annotations

import math
import re
from collections.abc import Iterator, Mapping
from dataclasses import dataclass, field
from typing import Any

import numpy as np

_TOKEN = re.compile(
    r"(?P<comment>\(\*.*?\*\)|//[^\n]*|\{[^}]*\})|(?P<space>\s+)"
    r"|(?P<number>\d+\.\d+(?:[eE][+-]?\d+)?|\d+)(?![\w.]*\w*\.)|(?P<name>#?[A-Za-z]\w*|\"[^\"]+\")"
    r"|(?P<op>:=|<=|>=|<>|\*\*|\.\.|[-+*/()\[\]<>=;:,.])",
    re.S,
)
_REALS = ("REAL", "LREAL")
KEYWORDS = frozenset(
    [
        "IF",
        "THEN",
        "ELSE",
        "ELSIF",
        "END_IF",
        "FOR",
        "TO",
        "BY",
        "DO",
        "END_FOR",
        "FUNCTION_BLOCK",
        "END_FUNCTION_BLOCK",
        "VAR",
        "VAR_INPUT",
        "VAR_OUTPUT",
        "VAR_TEMP",
        "END_VAR",
        "RETAIN",
        "AND",
        "OR",
        "XOR",
        "NOT",
        "MOD",
        "TRUE",
        "FALSE",
        "BEGIN",
        "VERSION",
        "ARRAY",
        "OF",
    ]
)


class StError(Exception):
    """The text is not what the standard allows."""


@dataclass
class Var:
    kind: str
    section: str
    start: Any = None
    length: int = 0


@dataclass
class Block:
    """A parsed function block. code: a Python function of its variables."""

    name: str
    real: str
    variables: dict[str, Var] = field(default_factory=dict)
    run: Any = None

    def instance(self) -> dict[str, Any]:
        """Fresh variables, as after a cold start."""
        return {n: self.initial(v) for n, v in self.variables.items() if v.section != "VAR_TEMP"}

    def initial(self, v: Var) -> Any:
        zero = {"BOOL": False, "DINT": 0}.get(v.kind, self.number(0.0))
        return [zero] * v.length if v.length else (zero if v.start is None else v.start)

    def number(self, value: float) -> Any:
        return np.float32(value) if self.real == "REAL" else float(value)

    def call(self, held: dict[str, Any], **inputs: Any) -> dict[str, Any]:
        """One cycle; names in lower case."""
        for name, value in inputs.items():
            kind = self.variables[name.lower()].kind
            held[name.lower()] = bool(value) if kind == "BOOL" else self.number(value)
        self.run(held)
        return held


def parse(text: str) -> Block:
    """The function block in a text, standard or SCL."""
    return _Parser(text).block()


class _Parser:
    def __init__(self, text: str) -> None:
        self.tokens = list(self._tokens(text))
        self.at = 0
        self.scl = any(t.startswith("#") for _, t in self.tokens)
        self.block_: Block | None = None

    @staticmethod
    def _tokens(text: str) -> Iterator[tuple[str, str]]:
        at = 0
        while at < len(text):
            match = _TOKEN.match(text, at)
            if match is None:
                raise StError(f"line {text[:at].count(chr(10)) + 1}: unexpected {text[at : at + 20]!r}")
            at = match.end()
            if match.lastgroup not in ("comment", "space"):
                yield str(match.lastgroup), match[0]
        yield "end", ""

    def peek(self) -> str:
        return self.tokens[self.at][1]

    def next(self) -> str:
        self.at += 1
        return self.tokens[self.at - 1][1]

    def expect(self, *wanted: str) -> str:
        got = self.next()
        if got.upper() not in wanted:
            raise StError(f"token {self.at}: expected {' or '.join(wanted)}, got {got!r}")
        return got.upper()

    def take(self, *wanted: str) -> str | None:
        return self.next().upper() if self.peek().upper() in wanted else None

    # ---- declarations

    def block(self) -> Block:
        self.expect("FUNCTION_BLOCK")
        block = self.block_ = Block(self.next().strip('"'), "")
        if self.take("VERSION"):
            self.expect(":")
            self.next()
        while section := self.take("VAR", "VAR_INPUT", "VAR_OUTPUT", "VAR_TEMP"):
            section = "RETAIN" if self.take("RETAIN") else section
            while not self.take("END_VAR"):
                self.declaration(section)
        if self.scl:
            self.expect("BEGIN")
        lines = self.statements(1, "END_FUNCTION_BLOCK")
        self.expect("END_FUNCTION_BLOCK")
        if self.tokens[self.at][0] != "end":
            raise StError("text behind the function block")
        temps = [f"    v_{n} = {block.initial(v)!r}" for n, v in block.variables.items() if v.section == "VAR_TEMP"]
        kept = [n for n, v in block.variables.items() if v.section != "VAR_TEMP"]
        source = [
            "def run(held):",
            *(f"    v_{n} = held['{n}']" for n in kept),
            *(t.replace("np.float32", "f32") for t in temps),
            *lines,
            *(f"    held['{n}'] = v_{n}" for n in kept),
        ]
        scope = {"f32": np.float32, "power": _power, "math": math}
        exec("\n".join(source), scope)
        block.run = scope["run"]
        return block

    def declaration(self, section: str) -> None:
        assert self.block_ is not None
        name = self.next()
        if name.upper() in KEYWORDS or not re.fullmatch(r"[A-Za-z](?:_?[A-Za-z0-9])*", name):
            raise StError(f"'{name}' is no name")
        if name.lower() in self.block_.variables:
            raise StError(f"'{name}' is declared twice")
        self.expect(":")
        length = 0
        if self.take("ARRAY"):
            self.expect("[")
            low = int(self.next())
            self.expect("..")
            length = int(self.next()) - low + 1
            self.expect("]")
            self.expect("OF")
        kind = self.expect("REAL", "LREAL", "DINT", "BOOL")
        start = None
        if self.take(":="):
            start = self.expect("TRUE", "FALSE") == "TRUE"
        self.expect(";")
        if kind in _REALS:
            if self.block_.real not in ("", kind):
                raise StError(f"{name}: {kind} beside {self.block_.real}")
            self.block_.real = kind
        self.block_.variables[name.lower()] = Var("REAL" if kind in _REALS else kind, section, start, length)

    def variable(self) -> tuple[str, str]:
        """(Python, type) of a variable or an element of an array."""
        assert self.block_ is not None
        token = self.next()
        if self.scl != token.startswith("#"):
            raise StError(f"'{token}': locals are written with # in SCL, and without elsewhere")
        name = token.lstrip("#").lower()
        found = self.block_.variables.get(name)
        if found is None:
            raise StError(f"'{token}' is not declared")
        if found.length:
            self.expect("[")
            index, kind = self.expression()
            self.expect("]")
            if kind != "DINT":
                raise StError(f"'{token}': an index is no {kind}")
            return f"v_{name}[{index}]", found.kind
        return f"v_{name}", found.kind

    # ---- statements

    def statements(self, depth: int, *ends: str) -> list[str]:
        pad, lines = "    " * depth, list[str]()
        while self.peek().upper() not in ends:
            if self.take("IF"):
                word = "if"
                while True:
                    condition, kind = self.expression()
                    self.need(kind, "BOOL")
                    self.expect("THEN")
                    lines += [f"{pad}{word} {condition}:", f"{pad}    pass"]
                    lines += self.statements(depth + 1, "ELSIF", "ELSE", "END_IF")
                    if not self.take("ELSIF"):
                        break
                    word = "elif"
                if self.take("ELSE"):
                    lines += [f"{pad}else:", f"{pad}    pass", *self.statements(depth + 1, "END_IF")]
                self.expect("END_IF")
            elif self.take("FOR"):
                counter, kind = self.variable()
                self.need(kind, "DINT")
                self.expect(":=")
                first, _ = self.expression()
                self.expect("TO")
                last, _ = self.expression()
                self.expect("DO")
                lines.append(f"{pad}for {counter} in range({first}, {last} + 1):")
                lines += self.statements(depth + 1, "END_FOR")
                self.expect("END_FOR")
            else:
                target, kind = self.variable()
                self.expect(":=")
                value, got = self.expression()
                self.need(got, kind)
                lines.append(f"{pad}{target} = {value}")
            self.expect(";")
        return lines

    @staticmethod
    def need(got: str, wanted: str) -> None:
        if got != wanted:
            raise StError(f"a {wanted} is needed, not a {got}: there is no implicit conversion")

    # ---- expressions, by the standard's precedence: NOT and minus, **, * /, + -, comparisons, AND, OR

    def expression(self) -> tuple[str, str]:
        return self.chain(self.conjunction, {"OR": "or"}, "BOOL")

    def conjunction(self) -> tuple[str, str]:
        return self.chain(self.comparison, {"AND": "and"}, "BOOL")

    def chain(self, part: Any, words: Mapping[str, str], kind: str) -> tuple[str, str]:
        left, got = part()
        while word := self.take(*words):
            right, other = part()
            self.need(got, kind)
            self.need(other, kind)
            left = f"({left} {words[word]} {right})"
        return left, got

    def comparison(self) -> tuple[str, str]:
        left, kind = self.sum()
        words = {"<": "<", ">": ">", "<=": "<=", ">=": ">=", "=": "==", "<>": "!="}
        if word := self.take(*words):
            right, other = self.sum()
            self.need(other, kind)
            return f"bool({left} {words[word]} {right})", "BOOL"
        return left, kind

    def sum(self) -> tuple[str, str]:
        return self.arithmetic(self.product, "+", "-")

    def product(self) -> tuple[str, str]:
        return self.arithmetic(self.power, "*", "/")

    def arithmetic(self, part: Any, *words: str) -> tuple[str, str]:
        left, kind = part()
        while word := self.take(*words):
            right, other = part()
            self.need(other, kind)
            if kind == "BOOL":
                raise StError("arithmetic with a BOOL")
            left = f"({left} {word} {right})"
        return left, kind

    def power(self) -> tuple[str, str]:
        left, kind = self.unary()
        if self.take("**"):
            right, other = self.unary()
            self.need(kind, "REAL")
            self.need(other, "REAL")
            return self.rounded(f"power({left}, {right})"), "REAL"
        return left, kind

    def unary(self) -> tuple[str, str]:
        if self.take("NOT"):
            inner, kind = self.unary()
            self.need(kind, "BOOL")
            return f"(not {inner})", "BOOL"
        if self.take("-"):
            inner, kind = self.unary()
            return f"(-{inner})", kind
        return self.primary()

    def primary(self) -> tuple[str, str]:
        kind, token = self.tokens[self.at]
        if self.take("("):
            inner = self.expression()
            self.expect(")")
            return inner
        if kind == "number":
            self.next()
            return (self.rounded(token), "REAL") if "." in token else (token, "DINT")
        if word := self.take("TRUE", "FALSE"):
            return ("True" if word == "TRUE" else "False"), "BOOL"
        if word := self.take("ABS", "EXPT"):
            self.expect("(")
            parts = [self.expression()]
            while self.take(","):
                parts.append(self.expression())
            self.expect(")")
            for _, one in parts:
                self.need(one, "REAL")
            if len(parts) != {"ABS": 1, "EXPT": 2}[word]:
                raise StError(f"{word} of {len(parts)} arguments")
            text = ", ".join(p for p, _ in parts)
            return (f"abs({text})" if word == "ABS" else self.rounded(f"power({text})")), "REAL"
        return self.variable()

    def rounded(self, text: str) -> str:
        assert self.block_ is not None
        return f"f32({text})" if self.block_.real == "REAL" else text


def _power(base: Any, exponent: Any) -> float:
    return float(base) ** float(exponent)
