"""Which way round day and month of dates are, where some files of a source leave it open and others settle it: files of
the same source whose days leave no choice, or a source with other dates that runs beside it."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import replace
from itertools import pairwise
from pathlib import Path
from typing import Any

from thermodata.archive.members import standing
from thermodata.draft.files.day_in_name import day_of_name
from thermodata.draft.files.described_file import merged, sample_of_file
from thermodata.draft.files.file_question import FileQuestion
from thermodata.draft.files.raw_file import RawFile
from thermodata.draft.folder.into_sources.sources import Group, sources_of
from thermodata.draft.folder.into_tests.group import tests_of
from thermodata.draft.times.hints import fitting_others, swapped
from thermodata.errors import ThermodataError
from thermodata.reader.contract.guard import described
from thermodata.reader.finding.registry import reader
from thermodata.schema.words.sentences import with_count

_ORDERS = ("dmy", "mdy")
_EITHER = "format of the dates: dmy or mdy?"
_DAY_NS = 86_400_000_000_000
_LEAST_IN_ROW = 3  # files by whose names one more stands out of place
_SHOWN = 3
_LOOKED_AT = 40  # files of a source, each once for either order


def with_orders_told(folder: Path, logs: Sequence[RawFile]) -> tuple[RawFile, ...]:
    """The logs, those that leave the order open with the one that is settled: declared, and told instead of asked."""
    if not any(_is_open(f) for f in logs):
        return tuple(logs)
    groups = tests_of(sources_of(logs, []), ())
    made: dict[int, RawFile] = {}
    for group in groups:
        files = [f for f in (*group.files, *group.calibrations) if _is_open(f)]
        only = _only(folder, group) if files else {}
        if len(only) > 1:
            made |= {id(f): _doubted(f, _of_two(only)) for f in files}
            continue
        told = _settled(only, group, groups) if files else None
        if told is not None and _out_of_place(group, told[0]):
            told = None
        against = None if told is None else next((w for f in files if (w := _contradicts(folder, f, told[0]))), None)
        if told is not None and against is None:
            made |= {id(f): told_by(folder, f, told[0], f"{told[1]}{_either_way(files)}") for f in files}
        elif against is not None:
            made |= {id(f): _doubted(f, against) for f in files}
    return tuple(made.get(id(f), f) for f in logs)


def _is_open(file: RawFile) -> bool:
    return any(a.ask.startswith(_EITHER) for a in file.asked)


def _only(folder: Path, group: Group) -> dict[str, RawFile]:
    """Order -> a file of a source that can only be so."""
    closed = [f for f in (*group.files, *group.calibrations) if not f.asked and not f.like][:_LOOKED_AT]
    only: dict[str, RawFile] = {}
    for file in closed:
        if (order := _order_of(folder, file)) is not None:
            only.setdefault(order, file)
    return only


def _of_two(only: Mapping[str, RawFile]) -> str:
    """What the question says of a source whose files come from computers with either order."""
    said = ", ".join(f"{only[order].path} only {order}" for order in _ORDERS)
    return f"{said}: its files are of two sources, each with its format"


def _settled(only: Mapping[str, RawFile], group: Group, groups: Sequence[Group]) -> tuple[str, str] | None:
    """(order, why); None where nothing tells it, or not all that tell it agree. only: as of `_only`."""
    near = fitting_others(group, groups, [f for f in group.files if _is_open(f)])
    if len({*only, *near}) != 1:
        return None
    order = next(iter(only or near))
    why = f"{only[order].path.name} can only be" if only else f"it fits the dates of '{near[order]}'"
    return order, f"dates {order}: {why}"


def _out_of_place(group: Group, order: str) -> bool:
    """Whether a file that leaves the order open is of another computer: it ran while another did, as no others, or
    stands out of the row of files that ascend else, and does not with day and month the other way round. Asked, for
    one order is declared for all."""
    files = [f for f in group.files if f.start_ns is not None]
    spans = [_span(f, order) for f in files]
    other = [_span(f, next(o for o in _ORDERS if o != order)) for f in files]

    def other_way(n: int) -> list[tuple[int, int]]:
        return [*spans[:n], other[n], *spans[n + 1 :]]

    by_time = sorted(range(len(files)), key=spans.__getitem__)
    at_once = [(a, b) for a, b in pairwise(by_time) if spans[b][0] < spans[a][1]]
    if len(at_once) == 1 and any(_is_open(files[n]) and not _overlap(other_way(n)) for n in at_once[0]):
        return True
    back = _back(spans)
    return (
        len(files) > _LEAST_IN_ROW
        and len(back) in (1, 2)
        and any(
            _is_open(files[n]) and not _back([*spans[:n], *spans[n + 1 :]]) and not _back(other_way(n))
            for n in {n + beside for n in back for beside in (0, 1)}
        )
    )


def _either_way(files: Sequence[RawFile]) -> str:
    """Which files alone leave the order open."""
    return f"; {with_count([f.path.name for f in files], _SHOWN)} alone may be either"


def _contradicts(folder: Path, file: RawFile, order: str) -> str | None:
    """What of a file's own speaks for the other order: the day in its name, or when it was last written: right after
    its last row by that one, or before its rows by this one. None where nothing does."""
    other = next(o for o in _ORDERS if o != order)
    (begin, end), (other_begin, other_end) = _span(file, order), _span(file, other)
    day = day_of_name(file)
    if day is not None and abs(other_begin - day) <= _DAY_NS < abs(begin - day):
        return f"the day in the name of {file.path.name} fits {other}"
    written = standing(folder / file.path).stat().st_mtime_ns
    right_after = abs(written - other_end) <= _DAY_NS < abs(written - end)
    if right_after or other_end <= written + _DAY_NS < end:
        return f"{file.path.name} was last written when {other} says"
    return None


def _doubted(file: RawFile, against: str) -> RawFile:
    """The file with what speaks against the order of the others in its question."""
    asked = tuple(replace(a, ask=f"{a.ask}; {against}") if a.ask.startswith(_EITHER) else a for a in file.asked)
    return replace(file, asked=asked)


def _span(file: RawFile, order: str) -> tuple[int, int]:
    """(first, last time) of a file [ns]; of one that leaves the order open, which is read as dmy meanwhile, by it."""
    start = file.start_ns or 0
    begin = swapped(start) if _is_open(file) and order == "mdy" else start
    return begin, begin + max((file.sample.last_ns or 0) - (file.sample.first_ns or 0), 0)


def _overlap(spans: Sequence[tuple[int, int]]) -> bool:
    return any(b[0] < a[1] for a, b in pairwise(sorted(spans)))


def _back(spans: Sequence[tuple[int, int]]) -> list[int]:
    """The places after which one begins days before that."""
    return [n for n, (a, b) in enumerate(pairwise(spans)) if b[0] < a[0] - _DAY_NS]


def _order_of(folder: Path, file: RawFile) -> str | None:
    """The one order with which a file begins when it does without a declared one; None where both do, as with a month
    in letters."""
    fits = []
    for order in _ORDERS:
        try:
            again = described(reader(file.reader), folder / file.path, declared(file, order).source)
        except ThermodataError:
            continue
        if again.start_ns is not None and again.start_ns == file.recording.start_ns:
            fits.append(order)
    return fits[0] if len(fits) == 1 else None


def _format(order: str) -> dict[str, Any]:
    return {"time": {"format": order}}


def declared(file: RawFile, order: str) -> RawFile:
    return replace(file, table=merged(file.table or {}, _format(order)))


def told_by(folder: Path, file: RawFile, order: str, why: str, question: str = _EITHER) -> RawFile:
    """The file as it is with this order, told instead of asked. It was looked at as the first of them. question: how
    that begins."""
    asked = tuple(
        FileQuestion(why, _format(order), a.times, told=True) if a.ask.startswith(question) else a for a in file.asked
    )
    file = replace(declared(file, order), asked=asked)
    if order == _ORDERS[0] or file.like:
        return file
    again = described(reader(file.reader), folder / file.path, file.source)
    file = replace(file, recording=replace(file.recording, start_ns=again.start_ns, notes=again.notes))
    return replace(file, sample=sample_of_file(folder / file.path, file))
