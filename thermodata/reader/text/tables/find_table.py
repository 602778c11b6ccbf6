"""The first look at a file of delimited text: its header, its columns and their kinds, its times."""

from __future__ import annotations

from collections.abc import Callable, Iterable, Iterator, Sequence
from dataclasses import dataclass, field, replace
from functools import lru_cache
from pathlib import Path
from typing import Any

from thermodata.errors import FormatError
from thermodata.plugin import Source
from thermodata.reader.open_questions import UNKNOWN, unanswered
from thermodata.reader.text.cells import delimiter as delimiters
from thermodata.reader.text.cells.quotes import clean
from thermodata.reader.text.cells.status import declared_zero
from thermodata.reader.text.cells.zone_words import stated_zone
from thermodata.reader.text.file.foreign_texts import refuse_foreign
from thermodata.reader.text.file.lines import WHOLE, Sample, sample
from thermodata.reader.text.names.unit_cells import refuse_units_in_cells, unit_note
from thermodata.reader.text.names.unit_column import unit_column, unit_column_note
from thermodata.reader.text.page.group import STREAM, Group
from thermodata.reader.text.page.layout import Layout, find
from thermodata.reader.text.page.second_header import second_header
from thermodata.reader.text.preamble.begin import (
    NOT_TAKEN,
    Begin,
    declared_start,
    find_begin,
    first_times,
    unused_start,
)
from thermodata.reader.text.rows.fixed_width import by_width, fixed_width
from thermodata.reader.text.rows.grid import TIME
from thermodata.reader.text.rows.quality_columns import qualities, said_of_codes, shared, worded
from thermodata.reader.text.tables.columns import ask_for_thousands, dtype_of_counts, find_decimal, kind_of
from thermodata.reader.text.tables.head_lines import records, top_of
from thermodata.reader.text.tables.long_rows import refuse_long
from thermodata.reader.text.tables.row_series import with_series
from thermodata.reader.text.tables.sampled_cells import sampled_cells, still_going
from thermodata.reader.text.tables.standing_columns import standing_columns
from thermodata.reader.text.tables.table import Table, TimedGroup, header_lines
from thermodata.reader.text.tables.told_thousands import told_thousands
from thermodata.reader.text.tables.zone_named import zones_said
from thermodata.reader.text.times.date_parts import PART
from thermodata.reader.text.times.days import NOTE, STANDS, have_days, is_once, stands
from thermodata.reader.text.times.time_formats import find_formats
from thermodata.reader.text.times.unpadded import unpadded_note

_TYPED_ROWS = 2000  # of the head, by which columns are typed


def open_table(path: Path, source: Source, stream: str = STREAM) -> Table:
    """The table of a file by its head and pieces of the rest. stream: what its one stream is called; the option `text`
    of the source names columns that are text whatever their cells. FormatError where there is none.

    Describing and reading follow each other, so the last ones are kept.
    """
    status = path.stat()
    key = (str(path.resolve()), status.st_mtime_ns, status.st_size, repr(source), stream)
    return _kept(_Asked(path, source, stream, key))


@dataclass(frozen=True)
class _Asked:
    path: Path = field(compare=False)
    source: Source = field(compare=False)
    stream: str = field(compare=False)
    key: tuple[Any, ...]


@lru_cache(maxsize=4)
def _kept(asked: _Asked) -> Table:
    path, source = asked.path, asked.source
    first = sample(path, source.encoding)
    # a last line without its end may be half a row: it decides nothing
    head = first.head[:-1] if first.whole and not first.ends_with_newline and len(first.head) > 2 else first.head
    if not first.head and not first.whole:
        raise FormatError(
            "its first line is too long to be looked at",
            where=path.name,
            expected=f"a header and rows within the first {WHOLE // 4096} KiB",
            got=f"no line end in them, in a file of {path.stat().st_size} bytes",
            hint="export fewer columns a file",
        )
    if not any(line.strip() for line in head):
        raise FormatError(
            "no whole line" if first.head else "an empty file",
            where=path.name,
            expected="a table",
            got=repr(first.head[0][:60]) if first.head else "nothing",
        )
    return with_series(find_table(head, first, source, path.name, asked.stream, strict=True), source)


def find_table(
    head: Sequence[str], first: Sample, source: Source, where: str, stream: str, strict: bool = False
) -> Table:
    """The table in a file's first lines. first: all that was sampled of the file; strict: not where its header has
    another number of cells than its rows, and nothing tells which names which (whose file it is does not hang on
    that)."""
    if not any(line.strip() for line in head):
        raise FormatError("no whole line", where=where, expected="a table", got="nothing")
    refuse_foreign(head, where)
    said = source.table or {}
    delimiter = delimiters.declared(said["delimiter"]) if said.get("delimiter") else None
    top = top_of(head)
    delimiter = delimiter or delimiters.find_delimiter(top)
    if delimiter is None:
        raise FormatError(
            "no columns found",
            where=where,
            expected="lines with as many cells between ';', tabs, commas, '|' or blanks",
            got=repr(head[0][:60]),
            hint=by_width(where) if fixed_width(head) else "declare table: {delimiter: ...}",
        )
    blanks = delimiter == delimiters.BLANKS
    if blanks:
        delimiter, head = "\t", [delimiters.parted(line) for line in head]
        first = replace(
            first,
            head=tuple(map(delimiters.parted, first.head)),
            rest=tuple(map(delimiters.parted, first.rest)),
        )
        top = top_of(head)
    quoted = any('"' in line for line in (*head, *first.rest))

    def cells(line: str) -> list[str]:
        found = delimiters.fields(line, delimiter, quoted)
        if line.isascii():  # as `clean` begins, which nearly all cells are left alone by
            return [c if c and c[0] > '"' < c[-1] else clean(c) for c in found]
        return [clean(c) for c in found]

    rows = [cells(line) for line in (records(top) if quoted else top)]
    if head[0].lower().startswith("sep=") and len(rows[0]) <= 2:
        rows[0] = [""]
    looked = first
    if (end := second_header(rows)) is not None:  # what stands behind it is not read: it tells nothing of the columns
        head, top, rows, looked = head[:end], top[:end], rows[:end], replace(first, rest=())
    layout = find(rows, said, where, delimiters.shown(delimiter, blanks) if strict else None)
    width = len(layout.names)
    # lines of a header were joined, rows are not
    top_rows = map(cells, top[layout.first :]) if quoted else rows[layout.first :]
    later = map(cells, (*head[max(len(top), layout.first) : layout.first + _TYPED_ROWS], *looked.rest))
    body = [r for r in (*top_rows, *later) if len(r) == width]
    if said.get("series") is None:  # else it is declared how its rows lie
        refuse_long(layout.names, body, where)
    groups = tuple(_timed(g, layout, body, head, cells, looked, stream, where) for g in layout.groups)
    groups, zone, open_zone = zones_said(groups, layout.names, map(cells, head[: layout.first]), source.timezone)
    cells_of = sampled_cells(layout, groups, body)
    own_cells = {layout.names[i]: cells_of[layout.names[i]] for g in groups for i in g.group.columns}
    measured = {name for name, unit in zip(layout.names, layout.units, strict=True) if unit}
    quality, of_rows, codes = qualities(own_cells, lambda zero, name: declared_zero(said, zero, name, where), measured)
    forced = {*(source.options.get("text") or ()), *worded(cells_of, quality), *worded(cells_of, of_rows)}
    times = {
        i: TIME if g.formats else "float64" if g.group.epoch is None else dtype_of_counts(cells_of[layout.names[i]])
        for g in groups
        for i in g.group.time
    }
    kinds = [
        times[i] if i in times else "str" if name in forced else kind_of(cells_of[name], name, layout.units[i])
        for i, name in enumerate(layout.names)
    ]
    if not any(kind is not None for i, kind in enumerate(kinds) if i not in times):
        raise FormatError("no column beside the time", where=where, expected="values", got=", ".join(layout.names))
    words = [n for i, n in enumerate(layout.names) if kinds[i] == "str" and i not in times and n not in forced]
    if all(kind in (None, "str") for i, kind in enumerate(kinds) if i not in times):
        refuse_units_in_cells([c for name in words for c in cells_of[name]], where)
    units_noted = [unit_note(cells_of[name], name) for name in words]
    named = {n: cells_of[n] for n, kind in zip(layout.names, kinds, strict=True) if kind == "float64"}
    if (declared := said.get("decimal")) == UNKNOWN:
        raise unanswered("decimal", "'.' or ','", where)
    told = told_thousands(list(named.values())) if declared is None else None
    decimal = declared or (told.decimal if told else find_decimal(list(named.values()), delimiter, where))
    if declared is None and told is None:
        ask_for_thousands(named, decimal, where)
    bare = {n: kinds[i] for i, n in enumerate(layout.names) if i not in times and layout.units[i] is None}
    told_unit = unit_column(bare, cells_of) if len(groups) == 1 else None
    if told_unit and told_unit.others:  # what is converted is whole no more
        kinds[layout.names.index(told_unit.of)] = "float64"
    standing, standing_note = standing_columns(said, layout, groups, kinds, cells_of, quality, where)
    header = header_lines(head, layout.first, cells)
    above = ([line.replace("\t", " ")] if blanks else cells(line) for line in head[: layout.first])
    begin, doubt = _begin(groups, above, body, declared_start(said), where)
    midnights = [STANDS for g in groups if stands(body, g.group.time, g.formats)]
    found = [
        first.note,
        *layout.notes,
        *_notes(layout, kinds, groups),
        *midnights,
        *(unpadded_note(r[i] for r in body) for g in groups if g.formats for i in g.group.time),
        told.note if told else None,
        *units_noted,
        *shared({**quality, **of_rows}),
        *said_of_codes(own_cells, codes, quality, of_rows),
        standing_note,
        told_unit.note() if told_unit else unit_column_note(bare, cells_of),
        doubt,
        open_zone,
    ]
    return Table(
        name=where,
        sample=first,
        delimiter=delimiter,
        quoted=quoted,
        layout=layout,
        groups=groups,
        kinds=tuple(kinds),
        decimal=decimal,
        decimal_declared=declared is not None or told is not None,
        header=header,
        quality=quality,
        notes=tuple(dict.fromkeys(note for note in found if note)),
        blanks=blanks,
        begin=begin,
        zone=zone,
        unit=told_unit,
        stands=standing,
        row_quality=of_rows,
        states=codes,
    )


def _timed(
    group: Group,
    layout: Layout,
    body: Sequence[list[str]],
    head: Sequence[str],
    cells: Callable[[str], list[str]],
    first: Sample,
    stream: str,
    where: str,
) -> TimedGroup:
    name = stream if group.stream == STREAM else group.stream
    if not group.dated:
        return TimedGroup(name, group, (), stated_zone(layout.names[i] for i in group.time))

    def more(k: int) -> list[str]:
        rows = still_going(map(cells, (*head[layout.first :], *first.rest)), group, layout)
        return [r[group.time[k]] for r in rows if len(r) > group.time[k]]

    columns = [[r[i] for r in still_going(body[:_TYPED_ROWS], group, layout)] for i in group.time]
    names = [layout.names[i] for i in group.time]
    once = len(columns) > 1 and is_once(columns[0])
    if once:
        columns[0] = [c for c in columns[0] if clean(c)]
    forms = find_formats(names, columns, group.form, where, more)
    return TimedGroup(name, group, forms, stated_zone(names), once and have_days(forms))


def _begin(
    groups: Sequence[TimedGroup], above: Iterable[list[str]], body: Sequence[list[str]], said: str | None, where: str
) -> tuple[Begin | None, str | None]:
    """(when the rows began, as a line above them says; a note where one is not taken). said: what is declared of it."""
    if any(g.absolute for g in groups):
        return None, unused_start(said)
    timed = groups[0]
    first_rows = first_times(timed.group.time, timed.group.seconds, timed.formats, body)
    begin, doubt = find_begin(list(above), first_rows, said, where)
    if begin is None or len({g.of_day for g in groups}) == 1:
        return begin, doubt
    stands = f"'{begin.text[:60]}' stands above the rows, {NOT_TAKEN}"
    return None, f"{stands}: some columns count from a start, others tell times of day"


def _notes(layout: Layout, kinds: Sequence[str | None], groups: Sequence[TimedGroup]) -> Iterator[str]:
    times = set(layout.time)
    names = [n for i, (n, kind) in enumerate(zip(layout.names, kinds, strict=True)) if kind and i not in times]
    # a name of the file may begin with that word
    places = {f"column {i + 1}" for i in range(len(layout.names))}
    if not places.isdisjoint(names):
        yield "columns without a name are called by their place"
    if any("#" in n and n.rsplit("#", 1)[-1].isdigit() for n in names):
        yield "names that repeat are numbered: #2, #3, ..."
    if any(g.once for g in groups):
        yield NOTE
    for text in dict.fromkeys(form.text for g in groups for form in g.formats if form.role != PART.role):
        if "DD/MM" in text or "MM/DD" in text:
            yield f"dates read as {text}"
