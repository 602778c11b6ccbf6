"""Statements written in a language: what differs from one to the next is a few words."""

from __future__ import annotations

import re
from collections.abc import Callable, Iterable
from dataclasses import dataclass

import numpy as np

from thermodata.effect import law
from thermodata.export.control.program import Program
from thermodata.export.control.statements import Assign, Body, Fill, If, Say, Statement, WholeNumber

_RANK = {"+": 4, "-": 4, "*": 5, "/": 5, "**": 6}
_NAME = re.compile(r"[A-Za-z_]\w*")


@dataclass(frozen=True)
class Words:
    """A language. assign, if_, else_, end_if, loop: formats; real: how a real number is written."""

    equal: str
    unequal: str
    both: str
    either: str
    no: str
    true: str
    false: str
    absolute: str
    power: str
    assign: str
    if_: str
    else_: str
    end_if: str | None
    fill: tuple[str, ...]
    comment: str
    real: Callable[[float], str]
    choose: str | None = None  # then, condition, other: where a language has it within a formula


def digits(value: float, single: bool) -> str:
    """The shortest number that reads back as the same, with a point in it."""
    text = str(np.float32(value)) if single else repr(float(value))
    mantissa, _, exponent = text.lower().partition("e")
    mantissa = mantissa if "." in mantissa else f"{mantissa}.0"
    return f"{mantissa}e{int(exponent)}" if exponent else mantissa


@dataclass(frozen=True)
class Printer:
    """where: variable -> how it is reached (self.x, m->x, #x)."""

    words: Words
    where: Callable[[str], str]

    def block(self, statements: Iterable[Statement], depth: int = 0) -> list[str]:
        """Lines of code, four blanks a level."""
        pad, w, lines = "    " * depth, self.words, list[str]()
        for one in statements:
            match one:
                case Say(text):
                    lines += ["", pad + w.comment.format(text)] if depth < 2 else [pad + w.comment.format(text)]
                case Assign(target, value):
                    lines.append(pad + w.assign.format(self.name(target), self.text(value)))
                case Fill(ring, length, value):
                    parts = {"ring": self.name(ring), "last": length - 1, "length": length, "value": self.text(value)}
                    lines += [pad + line.format(**parts) for line in w.fill]
                case If(condition, then, other):
                    lines.append(pad + w.if_.format(self.text(condition)))
                    lines += self.block(then, depth + 1)
                    if other:
                        lines += [pad + w.else_, *self.block(other, depth + 1)]
                    if w.end_if is not None:
                        lines.append(pad + w.end_if)
        return lines

    def name(self, text: str) -> str:
        """A variable, or an element of a ring, as it is reached."""
        return _NAME.sub(lambda m: self.where(m[0]), text)

    def text(self, node: law.Node | WholeNumber, outer: int = -1) -> str:
        """An expression, with the parentheses that it needs and those that help."""
        w = self.words
        match node:
            case WholeNumber(value, truth):
                return (w.true if value else w.false) if truth else str(value)
            case law.Number(value):
                text = w.real(value)
                return f"({text})" if value < 0 and outer > 3 else text
            case law.Symbol(name):
                return self.name(name)
            case law.Absolute(of):
                return w.absolute.format(self.text(of))
            case law.Binary("*", law.Number(-1.0), right):
                return f"(-{self.text(right, 6)})" if outer >= 0 else f"-{self.text(right, 6)}"
            case law.Binary("**", left, right):
                return w.power.format(self.text(left, 6), self.text(right, 6))
            case law.Binary(operator, left, right):
                rank = _RANK[operator]
                return _in_parentheses(f"{self.text(left, rank)} {operator} {self.text(right, rank + 1)}", rank < outer)
            case law.Where(condition, then, other) if w.choose is not None:
                return w.choose.format(self.text(then, 0), self.text(condition), self.text(other, 0))
            case law.Compare(operator, left, right):
                sign = {"==": w.equal, "!=": w.unequal}.get(operator, operator)
                return _in_parentheses(f"{self.text(left, 4)} {sign} {self.text(right, 4)}", outer >= 0)
            case law.Logic("not", of):
                return _in_parentheses(f"{w.no}{self.text(of[0], 2)}", outer > 1)
            case law.Logic(operator, of):
                word = w.both if operator == "and" else w.either
                return _in_parentheses(word.join(self.text(one, 2) for one in of), outer >= 0)
        raise TypeError(f"{type(node).__name__} is no arithmetic")


def _in_parentheses(text: str, parentheses: bool) -> str:
    return f"({text})" if parentheses else text


def _counts_from(program: Program) -> str:
    if program.start is None:
        return "what they are"
    minutes = program.start.bins * program.start.cycles * program.cycle_s / 60.0
    return f"their mean of the next {minutes:.3g} min, for as long as they stand still"


def heading(body: Body) -> list[str]:
    """What the program is, for the comment at its head."""
    p = body.program
    width = max((len(k) for k, _ in p.about), default=0)
    lines = [f"{k.ljust(width)}  {v}" for k, v in p.about]
    lines += ["", f"Displacement of {p.response} [{p.unit}], the sum of:"]
    for t in p.terms:
        lines.append(f"  {t.name[2:]}: {t.equation}")
        lines += [f"    {text}" for text in t.about]
    lines += [
        "",
        f"Call it every {p.cycle_s:g} s, no matter whether the correction is applied: the states go on.",
        "It starts when all readings are good for the first time, and again at `restart`: temperatures then count",
        f"from {_counts_from(p)}, and what is zero at rest (speeds, powers, switches) counts",
        "as at rest before.",
        "What is kept holds the last state over a power cut.",
        f"A bad reading is held for {p.limits.hold_s:g} s at most; then `fault`, and the correction stands still.",
    ]
    return lines
