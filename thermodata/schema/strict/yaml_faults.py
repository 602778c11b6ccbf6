"""What to do where a text is no YAML, in words of its lines: a parser says which token it missed."""

from __future__ import annotations

import re
from typing import Any

from yaml.reader import ReaderError

# quotes and signs that YAML keeps for itself: "found character '@' that cannot start any token"
_NO_TOKEN = re.compile(r"found character '(.+)' that cannot start any token")


def line_of(error: Any, text: str) -> int | None:
    """The line, from 0, that an error of the parser is about."""
    if isinstance(error, ReaderError):
        return text.count("\n", 0, error.position)
    mark = getattr(error, "problem_mark", None)
    return None if mark is None else int(mark.line)


def place_of(error: Any, text: str) -> str:
    """':3, column 7' of an error of the parser; '' where it knows none."""
    mark = getattr(error, "problem_mark", None)
    if mark is not None:
        return f":{mark.line + 1}, column {mark.column + 1}"
    at = line_of(error, text)
    return "" if at is None else f":{at + 1}, column {error.position - text.rfind(chr(10), 0, error.position)}"


def problem_of(error: Any) -> str:
    """What the parser met."""
    if isinstance(error, ReaderError):
        return f"the character {_code(error)}, which no YAML holds"
    return str(getattr(error, "problem", None) or type(error).__name__)


def _code(error: ReaderError) -> str:
    number = error.character if isinstance(error.character, int) else ord(error.character)
    return f"U+{number:04X}"


def advice(error: Any, text: str) -> str:
    """What to change, and in which line. error: of the parser; text: what it read."""
    problem, at = str(getattr(error, "problem", None) or ""), line_of(error, text)
    if isinstance(error, ReaderError):
        number = 1 if at is None else at + 1
        return f"delete the character {_code(error)} in line {number}: an editor may show it as a sign, or not at all"
    lines = text.splitlines()
    if at is None or at >= max(1, len(lines)):
        at = len(lines) - 1
    own = lines[at] if lines else ""
    sign = _NO_TOKEN.search(problem)
    if sign and sign[1] in ("\t", "\\t"):
        return f"line {at + 1} has a tab where YAML wants spaces: indent it by spaces, as the lines beside it"
    if sign:
        return f'put what begins with {sign[1]} in quotes, as "{sign[1]}"'
    begun = getattr(getattr(error, "context_mark", None), "line", None)
    context = str(getattr(error, "context", None) or "")
    if "flow" in context and begun is not None:
        closed = "" if begun == at else f" before line {at + 1}"
        return (
            f"the bracket that opens in line {begun + 1} is not closed{closed}, or a ',' is missing, or text with "
            "{ } or [ ] in it has no quotes"
        )
    if "scalar" in context and begun is not None:
        return f"the quote that opens in line {begun + 1} is not closed"
    beside = _nearly_as_far_in(lines, at)
    if beside is not None:
        return (
            f"line {at + 1} is set in by {_indent(own)}, line {beside + 1} above it by {_indent(lines[beside])}: "
            "entries of one level stand equally far in, what belongs to an entry two spaces further"
        )
    if "mapping values" in problem:
        return f"line {at + 1} has a ':' within a value: put the value in quotes, or set it in as its neighbours are"
    return "check indentation, quotes and brackets near that line"


def _indent(line: str) -> int:
    return len(line) - len(line.lstrip(" "))


def _nearly_as_far_in(lines: list[str], at: int) -> int | None:
    """The line above that another one stands nearly as far in as, by a space or three; None where it stands right."""
    for k in range(at - 1, -1, -1):
        if lines[k].strip() and not lines[k].lstrip().startswith("#"):
            off = abs(_indent(lines[at]) - _indent(lines[k]))
            return k if off in (1, 3) or (off and ":" in lines[k] and not lines[k].rstrip().endswith(":")) else None
    return None
