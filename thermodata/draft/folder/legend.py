"""A table beside the logs, or a sheet among them, that says what their signals are: T01 is a bearing."""

from __future__ import annotations

import re
from collections.abc import Mapping, Sequence, Set
from dataclasses import dataclass, replace
from pathlib import Path

from thermodata.draft.files.raw_file import RawFile
from thermodata.draft.folder.scan import Scan
from thermodata.draft.folder.table import LARGEST, SUFFIXES, WORKBOOKS, grids_of
from thermodata.draft.words.filenames import normal
from thermodata.plugin import Signal
from thermodata.reader.text import split_unit
from thermodata.schema.quantity import is_unit

IN_LEGEND = "described_in"  # the property of a signal that says where its description stands
_MOST_ROWS, _FEWEST, _SHORTEST = 400, 3, 3
_SHOWN = 4


@dataclass(frozen=True, slots=True)
class Legend:
    """file: its path; says: the last word of a signal's name, in lower case -> (as it stands there, what it says)."""

    file: str
    says: Mapping[str, tuple[str, str]]

    def note(self) -> str:
        shown = ", ".join(f"{name} is '{text}'" for name, text in list(self.says.values())[:_SHOWN])
        more = f" and {len(self.says) - _SHOWN} more" if len(self.says) > _SHOWN else ""
        return f"{self.file} says what signals are: {shown}{more}"


def with_legends(folder: Path, found: Scan) -> tuple[Scan, list[str]]:
    """The logs, their signals described by the first table that names them; and a note on it. A description that stands
    in a log itself counts more."""
    names = {_word(s.name) for f in found.logs for s in f.signals}
    logs_of_many = [f for f in found.logs if len(f.signals) > 1]  # a file of one may be called as its signal is
    tests = {normal(t) for f in logs_of_many for t in (f.path.stem, *f.path.parts[:-1], f.sheet or "")}
    books = [str(f.path) for f in found.logs if f.path.suffix.lower() in WORKBOOKS]
    for file in dict.fromkeys((*found.others, *books)):
        path = folder / file
        if path.suffix.lower() not in SUFFIXES or path.stat().st_size > LARGEST:
            continue
        for rows in grids_of(path, _MOST_ROWS):
            if (legend := _legend(file, rows, names, tests)) is not None:
                logs = tuple(_described(f, legend) for f in found.logs)
                left = tuple(x for x in found.ignored if x[0] != file)
                return replace(found, logs=logs, ignored=left), [legend.note()]
    return found, []


def _word(name: str) -> str:
    """'t01' of 'Temp/T01 [°C]', and of 'ns=3;s="DB_Thermo"."T01"'."""
    found: list[str] = re.findall(r"\w+", split_unit(name)[0].casefold())
    return found[-1] if found else ""


def _legend(file: str, rows: Sequence[Sequence[str]], names: set[str], tests: Set[str]) -> Legend | None:
    """One row a signal: its name in one column, words in another. Where these are the names of the tests too, it says
    what those are."""
    full = [r for r in rows if sum(map(bool, r)) >= 2]
    for key in range(max(map(len, full), default=0)):
        named = [r for r in full if key < len(r) and r[key].casefold() in names]
        if len({r[key].casefold() for r in named}) < len(named) or len(named) < max(_FEWEST, (len(full) - 1) / 2):
            continue
        if all(normal(r[key]) in tests for r in named):
            continue
        for column in range(max(map(len, named))):
            said = {r[key].casefold(): (r[key], r[column]) for r in named if column < len(r) and _is_words(r[column])}
            if column != key and len(said) >= _FEWEST and len({text for _, text in said.values()}) * 2 > len(said):
                return Legend(file, said)
    return None


def _is_words(cell: str) -> bool:
    return sum(map(str.isalpha, cell)) >= _SHORTEST and not is_unit(cell)


def _described(file: RawFile, legend: Legend) -> RawFile:
    def told(signal: Signal) -> Signal:
        said = legend.says.get(_word(signal.name))
        if said is None or signal.properties.get("description"):
            return signal
        return replace(signal, properties={**signal.properties, "description": said[1], IN_LEGEND: legend.file})

    return replace(file, recording=replace(file.recording, signals=tuple(map(told, file.signals))))
