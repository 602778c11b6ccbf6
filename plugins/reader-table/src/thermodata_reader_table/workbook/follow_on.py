"""Sheets of a log that goes on from one to the next, as a workbook of the hall has them with a sheet a week or a day:
they are one stream. Sheets that are called as tests are stay apart, however close they follow each other."""

from __future__ import annotations

import re
from collections.abc import Mapping, Sequence
from dataclasses import replace
from itertools import pairwise

import numpy as np

from thermodata.plugin import Array
from thermodata.reader.text.cells.time_forms.calendar_words import MONTH, WEEKDAYS, folded
from thermodata.reader.text.page.timed.group import STREAM
from thermodata.reader.text.times.in_memory import Stamps
from thermodata.reader.times.zone import NAT
from thermodata_reader_table.workbook.sheet import Stream

_PERIODS = (
    "week weeks wk w kw woche wochen semaine sem settimana sett semana týden tyden tydzień tydzien vecka uge "
    "day days d tag jour giorno dia día den dzień dzien month monat mois mese mes měsíc mesic miesiąc miesiac "
    "sheet tabelle blatt feuil feuille foglio hoja planilha list arkusz blad ark part teil partie parte část cast "
    "月 週 日 周 年 シート"
)
_WORDS = frozenset(map(folded, (*MONTH, *WEEKDAYS.split(), *_PERIODS.split())))
_STEPS = 2.5  # of a log, within which the next sheet goes on
_UNLIKE = 1.2  # as much may the steps of two sheets differ


def joined(found: Mapping[str, Sequence[Stream]]) -> Stream | None:
    """The one stream that all sheets are, in the order of their times, its signals called without the sheets; None
    where they are not alike, are called as tests, or do not go on where another ends. found: sheet -> its streams."""
    parts = [streams[0] for streams in found.values() if len(streams) == 1]
    if len(parts) < 2 or len(parts) < len(found) or not all(map(_names_a_period, found)):
        return None
    if not all(s.times.absolute and s.times.t_ns.size > 1 and (s.times.t_ns != NAT).all() for s in parts):
        return None
    bare = [_bare(s) for s in sorted(parts, key=lambda s: int(s.times.t_ns[0]))]
    if any(_shape(s) != _shape(bare[0]) for s in bare) or not all(_goes_on(a, b) for a, b in pairwise(bare)):
        return None
    return _as_one(bare)


def _names_a_period(sheet: str) -> bool:
    """Whether a sheet is called as a week, a day or a date is, or as a spreadsheet calls it by itself."""
    words = [folded(w) for w in re.findall(r"[^\W\d_]+", sheet)]
    return all(w in _WORDS for w in words) and (bool(words) or re.search(r"\d\D+\d", sheet) is not None)


def _bare(stream: Stream) -> Stream:
    """A stream whose signals are called without its sheet."""

    def of(name: str) -> str:
        return name.removeprefix(f"{stream.sheet}/")

    return replace(
        stream,
        values={of(k): v for k, v in stream.values.items()},
        units={of(k): v for k, v in stream.units.items()},
        flags={of(k): v for k, v in stream.flags.items()},
        empty={of(k): v for k, v in stream.empty.items()},
        percent=frozenset(map(of, stream.percent)),
        said={of(k): v for k, v in stream.said.items()},
        held=frozenset(map(of, stream.held)),
    )


def _shape(stream: Stream) -> tuple[object, ...]:
    """What streams of one log have in common: a column may be empty in some weeks, and then has no kind."""
    return list(stream.values), stream.units, stream.percent, stream.said, stream.held


def _goes_on(one: Stream, then: Stream) -> bool:
    """Whether a stream begins where another ends, at the same steps."""
    a, b = _step(one), _step(then)
    pause = int(then.times.t_ns[0]) - int(one.times.t_ns.max())
    return 0 < pause <= _STEPS * max(a, b) and max(a, b) <= _UNLIKE * min(a, b)


def _step(stream: Stream) -> float:
    return max(float(np.median(np.diff(stream.times.t_ns))), 1.0)


def _as_one(parts: Sequence[Stream]) -> Stream:
    first = parts[0]

    def whole(of: str, fill: object, dtype: object) -> dict[str, Array]:
        """A mapping of columns that only some parts may have."""
        names = dict.fromkeys(name for s in parts for name in getattr(s, of))
        rows = [(getattr(s, of), s.at.size) for s in parts]
        return {n: np.concatenate([k[n] if n in k else np.full(size, fill, dtype) for k, size in rows]) for n in names}

    times = np.concatenate([s.times.t_ns for s in parts])
    notes = tuple(dict.fromkeys(note for s in parts for note in s.times.notes))
    return replace(
        first,
        name=STREAM,
        times=Stamps(times, True, notes),
        values={name: np.concatenate([_kind(s, name, parts) for s in parts]) for name in first.values},
        at=np.concatenate([s.at for s in parts]),
        flags=whole("flags", 0, np.uint16),
        empty=whole("empty", False, bool),
        sheets=tuple((s.sheet, s.at.size) for s in parts),
    )


def _kind(stream: Stream, name: str, parts: Sequence[Stream]) -> Array:
    """A column as texts, where any part has it so."""
    values = stream.values[name]
    return values.astype(object) if any(s.values[name].dtype == object for s in parts) else values
