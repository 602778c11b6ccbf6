"""Lines of a time and of names with their values, `2026-03-02 08:00:00 T1=23.4 T2=24.1 n=3000`, as lines of a table:
each value in the column of its name, wherever in its line it stands; nothing where the line lacks it."""

from __future__ import annotations

import re
from collections.abc import Iterable, Sequence

from thermodata.reader.text.cells.time_forms.clock_pattern import BLANK

TIME = "time"  # what the first column is called
_FEWEST, _NEARLY_ALL, _MOST = 10, 0.95, 1000  # lines, share of them, names
_DATE = r"\d{4}[-/.]\d{1,2}[-/.]\d{1,2}|\d{1,2}[-/.]\d{1,2}[-/.]\d{4}"
_STAMP = rf"(?:(?:{_DATE})(?:[T _]|,? ))?\d{{1,2}}:\d\d(?::\d\d(?:[.,]\d{{1,9}})?)?(?: ?Z| ?[+-]\d\d:?\d\d| UTC)?"
_NUMBER = r"[-+]?(?:\d+(?:[.,]\d+)?|\.\d+)(?:[eE][-+]?\d{1,3})?|[-+]?(?:[nN]a[nN]|[iI]nf)"
_NAME = r"[^\W\d][\w./°-]*(?:[\[(][^\])=\s]{1,12}[\])])?"
_PAIR = re.compile(rf"(?P<name>{_NAME}) ?[=:] ?(?P<value>{_NUMBER})?(?![^\s,;|])")
_BETWEEN = re.compile(rf"{BLANK}*[,;|]?{BLANK}*")
_BEGIN = re.compile(rf"\s*(?:(?i:ts|time|timestamp|zeit|t) ?[=:] ?)?[\[\"']?(?P<stamp>{_STAMP})[\]\"']?:?(?=[\s,;|])")


def named_values(lines: Sequence[str]) -> tuple[str, ...]:
    """The names of such lines, in the order in which they came; () where nearly all of them are none."""
    full = [line for line in lines if line.strip()]
    found = [pairs for line in full if (pairs := _pairs(line)) is not None]
    names = tuple(dict.fromkeys(name for _, pairs in found for name in pairs))
    enough = len(found) >= max(_FEWEST, _NEARLY_ALL * len(full))
    return names if enough and 1 < len(names) <= _MOST and len({n.casefold() for n in names}) == len(names) else ()


def in_columns(line: str, names: Sequence[str]) -> str:
    """Such a line as cells with tabs between them, the time before those of the names; others as they stand."""
    found = _pairs(line)
    if found is None or not found[1].keys() <= set(names):
        return line
    return "\t".join((found[0], *(found[1].get(name, "") for name in names)))


def all_in_columns(data: bytes, names: Sequence[str]) -> bytes:
    """The same of whole lines in UTF-8, which keep their number."""
    lines = data.decode("utf-8", "surrogateescape").split("\n")
    return "\n".join(_lines_in_columns(lines, names)).encode("utf-8", "surrogateescape")


def _lines_in_columns(lines: Iterable[str], names: Sequence[str]) -> Iterable[str]:
    return (in_columns(line, names) if line else line for line in lines)


def _pairs(line: str) -> tuple[str, dict[str, str]] | None:
    """(the stamp of a line, its values by name); None where anything else stands in it, or a name twice."""
    begin = _BEGIN.match(line)
    if begin is None:
        return None
    values: dict[str, str] = {}
    at, end = begin.end(), len(line.rstrip())
    while at < end:
        between = _BETWEEN.match(line, at)
        pair = _PAIR.match(line, between.end() if between is not None else at)
        if pair is None or pair["name"] in values:
            return None
        values[pair["name"]] = pair["value"] or ""
        at = pair.end()
    return (begin["stamp"], values) if values else None
