"""`tests_from` of a draft: where the names of all tests follow one pattern, S8000_F12_3.csv, one entry says it all."""

from __future__ import annotations

import re
from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from pathlib import PurePosixPath

from thermodata.draft.campaign.parts import Draft, DraftTest
from thermodata.draft.words.said_by_names import speed_in

_LEAST = 3
_FIELDS: tuple[tuple[str, str, str], ...] = (  # name before the number, condition, its unit
    (r"f|vf|feed|vorschub|posuv", "feed", ""),
    (r"ap", "depth", "mm"),
    (r"ae", "width", "mm"),
)
_PIECE = re.compile(r"[_\-. ]")


@dataclass(frozen=True, slots=True)
class Pattern:
    """tests_from: files with {fields}; units of the fields; doubts: of the units."""

    source: str
    files: str
    units: Mapping[str, str]
    doubts: tuple[str, ...] = ()


def pattern_of(draft: Draft) -> Pattern | None:
    """The pattern of all tests' names with a condition in it; None where there is none, or where tests differ in more
    than their conditions."""
    tests = draft.tests
    if len(tests) < _LEAST or len({t.kind.kind for t in tests}) > 1 or draft.table:
        return None
    if any(t.files or t.kind.start or t.channels or t.measuring or t.window for t in tests):
        return None  # each has its own
    if any(set(t.doubts) - set(t.kind.doubts) for t in tests):
        return None  # what is asked of one has no line there
    source = next(
        (
            s
            for s in draft.sources
            if s.files
            and s.files.count("{test}") == 1
            and PurePosixPath(s.files).stem == "{test}"
            and "*" not in s.files
        ),
        None,
    )
    if source is None or source.files is None or any(s.files is None for s in draft.sources):
        return None
    found = _fields([t.id for t in tests])
    if found is None or not any(condition in ("speed", "feed", "depth", "width") for condition, _ in found[1]):
        return None
    text, fields = found
    units, doubts = {}, []
    for condition, values in fields:
        unit = "rpm" if condition == "speed" else next((u for _, name, u in _FIELDS if name == condition), "")
        if condition == "feed":
            unit = "mm/min" if min(values) >= 100 else "m/min"
            doubts.append(f"feed in {unit}?")
        if unit:
            units[condition] = unit
        if not _as_told(condition, values, unit, tests):
            return None
    return Pattern(source.name, source.files.replace("{test}", text), units, tuple(doubts))


def _as_told(condition: str, values: Sequence[float], unit: str, tests: Sequence[DraftTest]) -> bool:
    """Whether the numbers that the pattern would take are those that are told of the tests: a 'k' that it leaves
    out, or a number that the logged speed contradicts, makes them others."""
    told = [t.conditions.get(condition) for t in tests]
    if condition == "feed" and not any(told):
        return True
    return condition not in ("speed", "feed") or told == [f"{v:g} {unit}" for v in values]


def _known(piece: str) -> str | None:
    """The condition that a piece of a name states: 'S8000' a speed, 'F12' a feed."""
    match = re.fullmatch(r"([^\W\d_]*)\d+(?:\.\d+)?([^\W\d_]*)", piece)
    if match is None:
        return None
    if speed_in(piece):
        return "speed"
    return next((name for words, name, _ in _FIELDS if re.fullmatch(words, match[1].lower())), None)


def _fields(ids: Sequence[str]) -> tuple[str, list[tuple[str, list[float]]]] | None:
    """('S{speed}_F{feed}_{nr}', [(field, its numbers)]) where all ids have the same pieces; None where they do not."""
    split = [_PIECE.split(i) for i in ids]
    if len({tuple(_PIECE.findall(i)) for i in ids}) != 1:
        return None
    out, fields, used = [], [], set()
    for column in zip(*split, strict=True):
        if len(set(column)) == 1 and not _known(column[0]):
            out.append(column[0])
            continue
        parts = [re.fullmatch(r"([^\W\d_]*)(\d+(?:\.\d+)?)([^\W\d_]*)", c) for c in column]
        if any(p is None for p in parts):
            return None
        heads, tails = {p[1] for p in parts if p}, {p[3] for p in parts if p}
        if len(heads) != 1 or len(tails) != 1:
            return None
        head, tail = heads.pop(), tails.pop()
        every = {_known(c) for c in column}
        known = every.pop() if len(every) == 1 else None
        name = known or (head.lower() if re.fullmatch(r"[a-z]{2,}", head.lower()) else "nr")
        if name in used:
            return None
        used.add(name)
        out.append(f"{head}{{{name}}}{tail}")
        fields.append((name, [float(p[2]) for p in parts if p]))
    gaps = _PIECE.findall(ids[0])
    return "".join(a + b for a, b in zip(out, [*gaps, ""], strict=True)), fields
