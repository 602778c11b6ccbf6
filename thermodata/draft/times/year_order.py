"""At which end the year of two digits stands, where the other logs of a folder settle it: 26-07-06 is of 2026 beside
logs of that day, and of 2006 beside none."""

from __future__ import annotations

import re
from collections.abc import Sequence
from pathlib import Path

from thermodata.draft.files.day_in_name import day_of_name
from thermodata.draft.files.raw_file import RawFile
from thermodata.draft.times.date_order import declared, told_by
from thermodata.errors import ThermodataError
from thermodata.reader.contract.guard import described
from thermodata.reader.finding.registry import reader

_BEGINS = "format of the dates: '"
_YEAR = re.compile(rf"{_BEGINS}(?P<form>[^']+)' or dmy\?")
_AT_THE_END = "dmy"
_DAY_NS = 86_400_000_000_000
_LOOKED_AT = 40  # files of a form, each once for either end


def with_years_told(folder: Path, logs: Sequence[RawFile]) -> tuple[RawFile, ...]:
    """The logs, those that leave it open with the form that puts one of them within a day of another log, or of the day
    in its own name, where the other form puts none there."""
    open_ones = {id(f): form for f in logs if (form := _form_of(f)) is not None}
    dated = [(f.start_ns, f.path.name) for f in logs if not f.asked and f.start_ns is not None]
    made: dict[int, RawFile] = {}
    for form in sorted(set(open_ones.values())):
        files = [f for f in logs if open_ones.get(id(f)) == form]
        beside = {order: _beside(folder, files[:_LOOKED_AT], order, dated) for order in (form, _AT_THE_END)}
        fits = [order for order, name in beside.items() if name is not None]
        if len(fits) == 1:
            why = f"dates {fits[0]}: so they are of the days of {beside[fits[0]]}"
            made |= {id(f): told_by(folder, f, fits[0], why, _BEGINS) for f in files}
    return tuple(made.get(id(f), f) for f in logs)


def _form_of(file: RawFile) -> str | None:
    """The form with the year first that its question offers; None of a file without that question."""
    found = (_YEAR.match(a.ask) for a in file.asked if not a.told)
    return next((m["form"] for m in found if m is not None), None)


def _beside(folder: Path, files: Sequence[RawFile], order: str, dated: Sequence[tuple[int, str]]) -> str | None:
    """The name of the first log, or of a file itself, that one of the files is of the day of when it is read so."""
    for file in files:
        begin = _start_of(folder, file, order)
        day = day_of_name(file)
        others = dated if day is None else [*dated, (day, file.path.name)]
        near = (name for at, name in others if begin is not None and abs(begin - at) < _DAY_NS)
        if (name := next(near, None)) is not None:
            return name
    return None


def _start_of(folder: Path, file: RawFile, order: str) -> int | None:
    try:
        return described(reader(file.reader), folder / file.path, declared(file, order).source).start_ns
    except ThermodataError:
        return None
