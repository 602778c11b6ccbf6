"""Columns that share a name with their time: `T_air_VALUE,T_air_TIMESTAMP,T_air_QUALITY`, whichever stands first.

What exports of OPC servers write: a value, its time and its quality a tag. Where each time shares its name with other
columns, that name tells which columns it is of, and not what stands beside it.
"""

from __future__ import annotations

import re
from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from itertools import pairwise

from thermodata.reader.text.cells.cell import TIME_WORD, Cell, is_empty, number_of
from thermodata.reader.text.cells.first_rows import FirstRows
from thermodata.reader.text.names.header import split_unit

_PARTS = re.compile(r"[\s_.:/\\()\[\]-]+")
_OF_ROWS = re.compile(r"(?i)(numeric ?id|id|index|idx|row|nr|no|#)\.?$")
Words = tuple[str, ...]


@dataclass(frozen=True)
class Tagged:
    """times: columns of a tag's time; columns: all of the tag, in order, its times among them."""

    times: tuple[int, ...]
    columns: tuple[int, ...]


def tagged(seen: FirstRows, times: Sequence[int]) -> tuple[list[Tagged], list[int]]:
    """(each time with the columns that share its name, the columns that share none); nothing where not every time
    shares its name with a column, or where names say only what the order of the columns says.

    times: columns that are called a time, and go like one. Columns that only number rows or tags go with the first.
    """
    of_time: dict[Words, list[int]] = {}
    for i in times:
        words = _without_time(_words(seen.names[i]))
        if not words:
            return [], []
        of_time.setdefault(words, []).append(i)
    if len(of_time) < 2:
        return [], []
    found: dict[Words, list[int]] = {tag: list(own) for tag, own in of_time.items()}
    left = []
    for i, name in enumerate(seen.names):
        if i in times:
            continue
        tag = _tag_of(_words(name), of_time)
        if tag is None:
            left.append(i)
        else:
            found[tag].append(i)
    if any(len(found[tag]) == len(of_time[tag]) for tag in found) or _in_order(found, of_time):
        return [], []
    groups = [Tagged(tuple(of_time[tag]), tuple(sorted(columns))) for tag, columns in found.items()]
    numbers = [i for i in left if _only_numbers(seen.names[i], seen.column(i))]
    if numbers:
        groups[0] = Tagged(groups[0].times, tuple(sorted((*groups[0].columns, *numbers))))
    return groups, [i for i in left if i not in numbers]


def _words(name: str) -> Words:
    bare = split_unit(re.sub(r"#\d+$", "", name))[0]
    return tuple(part for part in _PARTS.split(bare) if part)


def _without_time(words: Words) -> Words | None:
    """The words of a tag's time without those for time, at their end or their beginning."""
    for many in (2, 1):
        for time, rest in ((words[-many:], words[:-many]), (words[:many], words[many:])):
            if rest and len("".join(time)) > 1 and TIME_WORD.match("_".join(time)):
                return _folded(rest)
    return None


def _tag_of(words: Words, tags: Mapping[Words, Sequence[int]]) -> Words | None:
    """The longest tag that a name begins or ends with."""
    own = _folded(words)
    fitting = [tag for tag in tags if own[: len(tag)] == tag or own[-len(tag) :] == tag]
    return max(fitting, key=len, default=None)


def _folded(words: Words) -> Words:
    return tuple(word.casefold() for word in words)


def _in_order(found: Mapping[Words, Sequence[int]], times: Mapping[Words, Sequence[int]]) -> bool:
    """Whether each tag's columns stand behind its time and before the next: the order tells the same."""
    starts = sorted(min(own) for own in times.values())
    edges = dict(zip(starts, [*starts[1:], None], strict=True))
    for tag, columns in found.items():
        start = min(times[tag])
        end = edges[start]
        if min(columns) < start or (end is not None and max(columns) > end):
            return False
    return True


def _only_numbers(name: str, cells: Sequence[Cell]) -> bool:
    """Whether a column is called a number of rows or tags, and holds whole numbers that stay or rise by one."""
    words = _words(name)
    values = [number_of(c) for c in cells if not is_empty(c)]
    whole = [int(v) for v in values if v is not None and v.is_integer()]
    if not words or not _OF_ROWS.match(words[-1]) or len(whole) < len(values):
        return False
    return {b - a for a, b in pairwise(whole)} <= {0, 1}
