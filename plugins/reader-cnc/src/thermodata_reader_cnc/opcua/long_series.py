"""Which columns of a long table tell its series apart, besides the one that is called a tag: two devices may have a
sensor of one name, and read as one they would be a saw of both."""

from __future__ import annotations

import re
from collections.abc import Mapping, Sequence
from dataclasses import dataclass

from thermodata.plugin import Int1D
from thermodata.reader.signals.header_words import LABEL_WORDS, NAME_WORDS
from thermodata.reader.text.cells.time_forms.time_pattern import is_date_text, is_time_of_day
from thermodata.reader.text.cells.values.number import is_empty, is_number
from thermodata.reader.text.cells.values.quotes import clean
from thermodata.reader.times.zone import NAT

_LIVELY = 0.25  # of the rows: a word that changes as often stands for one of several series, and is no state
_MEET = 0.05  # of the rows share their time with another word's
_FEWEST = 3  # changes of a word
_DECIMAL = re.compile(r"[+-]?\d*[.,]\d+(?:[eE][+-]?\d+)?")


@dataclass(frozen=True, slots=True)
class Series:
    """tags: columns that name a series, together; known: the name of each of those that were seen, by the cells of all
    tags; unread: columns of numbers that differ and belong to no series; measured: those of them with decimals; parted:
    whether rows are of several series, as their tags, their times or another column tell."""

    tags: tuple[int, ...]
    known: Mapping[tuple[str, ...], str]
    unread: tuple[int, ...] = ()
    measured: tuple[int, ...] = ()
    parted: bool = True


def series_of(names: Sequence[str], rows: Sequence[Sequence[str]], t_ns: Int1D, tag: int, used: set[int]) -> Series:
    """The series of a long table whose column `tag` is called so. names: bare, of all columns; rows: cells of sampled
    rows in the order of the file, and their times; used: columns that hold something else."""
    dated = [(r, t) for r, t in zip(rows, t_ns.tolist(), strict=True) if t != NAT]
    times = [t for _, t in dated]
    columns = {k: [clean(r[k]) for r, _ in dated] for k in range(len(names)) if k not in used}
    free = [k for k in columns if k != tag]
    labels = {k for k in free if names[k] in LABEL_WORDS or names[k] in NAME_WORDS}
    words = [k for k in free if k in labels or _is_words(names[k], columns[k])]
    chosen, left = [tag], sorted(words, key=lambda k: (k not in labels, k))
    while left:
        keys = list(zip(*(columns[k] for k in chosen), strict=True))
        more = next((k for k in left if _parts(keys, times, columns[k], surely=k in labels)), None)
        if more is None:
            break
        chosen.append(more)
        left.remove(more)
    # labels that part nothing of what was looked at are part of the key: where they do later, that is told
    tags = tuple(sorted({*chosen, *labels}))
    shown = [i for i, k in enumerate(tags) if k in chosen]
    found = dict.fromkeys(zip(*(columns[k] for k in tags), strict=True))
    called = tags.index(tag)
    known = {each: "/".join(filter(None, (each[i] for i in shown))) if each[called] else "" for each in found}
    unread = tuple(k for k in free if k not in tags and _is_measured(columns[k]))
    measured = tuple(k for k in unread if any(map(_DECIMAL.fullmatch, columns[k])))
    parted = len(chosen) > 1 or _parts([()] * len(times), times, columns[tag], surely=False)
    return Series(tags, known, unread, measured, parted)


def _is_words(name: str, cells: Sequence[str]) -> bool:
    """Whether a column may name something: by few words, none of them a number, a time or a value that is a text."""
    found = set(cells) - {""}
    if not found or "value" in name or "wert" in name:
        return False
    some = list(found)[:40]
    if any(is_number(c) or is_date_text(c) or is_time_of_day(c) for c in some):
        return False
    return len(found) <= max(2, len(cells) // 3)


def _is_measured(cells: Sequence[str]) -> bool:
    found = set(cells) - {""}
    return len(found) > 1 and all(is_number(c) or is_empty(c) for c in list(found)[:40])


def _parts(keys: Sequence[tuple[str, ...]], times: Sequence[int], words: Sequence[str], *, surely: bool) -> bool:
    """Whether a column parts rows of one name into series: rows of one time differ in it, it changes to and fro, or
    times begin anew where it changes. surely: by its own name, wherever it differs."""
    at_time: dict[tuple[tuple[str, ...], int], str] = {}
    last: dict[tuple[str, ...], tuple[int, str]] = {}
    meeting = changes = back = 0
    for key, t, word in zip(keys, times, words, strict=True):
        if not word:
            continue
        if at_time.setdefault((key, t), word) != word:
            meeting += 1
        before = last.get(key)
        if before is not None and before[1] != word:
            changes += 1
            back += t < before[0]
        last[key] = t, word
    if surely:
        return changes > 0
    lively = changes >= _FEWEST and changes > _LIVELY * len(keys)
    return meeting > _MEET * len(keys) or lively or (back > 0 and 2 * back >= changes)


def series_of_influx(names: Sequence[str], rows: Sequence[Sequence[str]]) -> Series:
    """The series of an export of InfluxDB, named by the fewest columns that tell them apart: its field, what it is
    tagged with, and its measurement."""
    keys = [k for word in ("_field", "", "_measurement") for k, n in enumerate(names) if _is_key(n, word)]
    body = [r for r in rows if len(r) == len(names) and not r[0].startswith("#")]
    found = dict.fromkeys(tuple(clean(r[k]) for k in keys) for r in body)
    found.pop(tuple(names[k] for k in keys), None)  # headers that are repeated
    telling: list[int] = []
    for i in range(len(keys)):
        if len({tuple(each[j] for j in (*telling, i)) for each in found}) > len(
            {tuple(each[j] for j in telling) for each in found}
        ):
            telling.append(i)
    return Series(tuple(keys), {each: "/".join(filter(None, (each[i] for i in telling or [0]))) for each in found})


def _is_key(name: str, word: str) -> bool:
    """Whether a column is the one of this word; for none, whether it holds a tag."""
    return name == word if word else bool(name) and name[0] != "_" and name not in ("result", "table")
