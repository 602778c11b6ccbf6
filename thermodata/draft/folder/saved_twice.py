"""A table that was saved in two formats: 'V1.csv' beside 'V1.xlsx' with the same signals, rows and values."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import replace

from thermodata.draft.files.raw_file import RawFile
from thermodata.draft.folder.beside.table import SUFFIXES, WORKBOOKS
from thermodata.draft.folder.scan import Scan
from thermodata.draft.signals.values import Values
from thermodata.draft.words.naming import parts_of
from thermodata.reader.text import split_unit
from thermodata.schema.words.sentences import counted

_ROUNDED = 0.01  # of a signal's range: what is left where a program rounded what it saved

_QUARTER_S, _ZONES_S, _CLOCK_S = 900.0, 50_400.0, 1.0  # zones are quarters of an hour apart, up to 14 hours


def saved_once(found: Scan) -> Scan:
    """What was found, of each table that stands in two formats one: what has more of it or a date; not a workbook,
    where another is there."""
    alike: dict[str, list[RawFile]] = {}
    for f in found.logs:
        if f.part is None and f.sample.whole:
            alike.setdefault(f.path.stem.casefold(), []).append(f)
    twice: dict[str, tuple[RawFile, RawFile]] = {}
    for together in alike.values():
        together.sort(key=_rank)
        for k, file in enumerate(together):
            of = next((o for o in together[:k] if str(o.path) not in twice and _is_same(file, o)), None)
            if of is not None:
                twice[str(file.path)] = (file, of)
    told = tuple((path, _why(file, of)) for path, (file, of) in twice.items())
    kept = tuple(f for f in found.logs if str(f.path) not in twice)
    return replace(found, logs=kept, ignored=(*found.ignored, *told))


def _why(file: RawFile, of: RawFile) -> str:
    return (
        f"the same table as {of.path}, which is taken: {counted(len(file.signals), 'signal')} and "
        f"{counted(file.sample.rows, 'row')} of the same values; to have this one, move the other out of the folder"
    )


def _rank(file: RawFile) -> tuple[int, bool, bool, bool]:
    suffix = file.path.suffix.lower()
    return -len(file.signals), file.start_ns is None, suffix in WORKBOOKS, suffix in SUFFIXES


def _is_same(one: RawFile, other: RawFile) -> bool:
    """Whether all signals of one are in the other, with as many rows and the same values."""
    suffixes = {one.path.suffix.lower(), other.path.suffix.lower()}
    formats = len(suffixes) == 2 and not any(s[1:].isdigit() for s in suffixes)  # 'log.1' is a piece
    if not formats or one.sample.rows != other.sample.rows or not _at_once(one, other):
        return False
    here, there = _values(one), _values(other)
    return bool(here) and all(_are_same(v, there.get(name)) for name, v in here.items()) and _goes(here)


def _at_once(one: RawFile, other: RawFile) -> bool:
    """Whether two began at the same time, in whatever zone; one without dates may have."""
    if one.start_ns is None or other.start_ns is None:
        return True
    apart_s = abs(one.start_ns - other.start_ns) / 1e9
    return apart_s <= _ZONES_S and min(apart_s % _QUARTER_S, -apart_s % _QUARTER_S) <= _CLOCK_S


def _values(file: RawFile) -> dict[str, Values]:
    """The values of a file's signals of numbers by their names without groups and units."""
    named = {(s.stream, s.name): parts_of(split_unit(s.name)[0])[-1].casefold() for s in file.signals}
    return {named[key]: v for key, v in file.sample.values.items() if key in named and v.n and not v.text}


def _are_same(one: Values, other: Values | None) -> bool:
    if other is None or one.n != other.n:
        return False
    least = _ROUNDED * max(one.high - one.low, other.high - other.low, 1e-9 * abs(one.high))
    return all(abs(a - b) <= least for a, b in zip(_points(one), _points(other), strict=True))


def _points(values: Values) -> tuple[float, float, float]:
    return values.low, values.median, values.high


def _goes(values: Mapping[str, Values]) -> bool:
    """Whether something changes: constants prove nothing."""
    return any(not v.constant for v in values.values())
