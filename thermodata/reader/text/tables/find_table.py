"""The first look at a file of delimited text: its header, its columns and their kinds, its times."""

from __future__ import annotations

from collections.abc import Collection, Iterable, Iterator, Mapping, Sequence
from dataclasses import dataclass, field
from functools import lru_cache
from pathlib import Path
from typing import Any

from thermodata.errors import FormatError
from thermodata.plugin import Source
from thermodata.reader.text.cells import delimiter as delimiters
from thermodata.reader.text.cells.named_values import TIME as NAMED_TIME
from thermodata.reader.text.cells.named_values import named_values
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
from thermodata.reader.text.rows.grid import TIME
from thermodata.reader.text.rows.quality_columns import qualities, said_of_codes, shared, worded
from thermodata.reader.text.tables.columns import ask_for_thousands, dtype_of_counts, find_decimal, kind_of
from thermodata.reader.text.tables.head_lines import HeadLines, part
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
from thermodata.reader.times.open_questions import UNKNOWN, unanswered

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
    if not named_values(head):
        refuse_foreign(head, where)
    said = source.table or {}
    whole = part(head, first, said, where)
    if whole.named:
        said = {"names": [NAMED_TIME, *whole.named], **said}
    lines, rows = whole, whole.rows()
    if (end := second_header(rows)) is not None:  # what stands behind it is not read: it tells nothing of the columns
        lines, rows = whole.up_to(end), rows[:end]
    layout = find(rows, said, where, delimiters.shown(whole.delimiter, whole.blanks) if strict else None)
    body = _body(lines, rows, layout)
    if said.get("series") is None:  # else it is declared how its rows lie
        refuse_long(layout.names, body, where)
    groups = tuple(_timed(g, layout, body, lines, stream, where) for g in layout.groups)
    preamble = lines.head[: layout.first]
    groups, zone, open_zone = zones_said(groups, layout.names, map(lines.cells, preamble), source.timezone)
    cells_of = sampled_cells(layout, groups, body)
    own_cells = {layout.names[i]: cells_of[layout.names[i]] for g in groups for i in g.group.columns}
    units = dict(zip(layout.names, layout.units, strict=True))
    measured = {name for name, unit in units.items() if unit}
    quality, of_rows, codes = qualities(own_cells, lambda zero, name: declared_zero(said, zero, name, where), measured)
    forced = {*(source.options.get("text") or ()), *worded(cells_of, quality), *worded(cells_of, of_rows)}
    kinds = _kinds(layout, groups, cells_of, forced)
    times = {layout.names[i] for i in layout.time}
    values = {n: kind for n, kind in zip(layout.names, kinds, strict=True) if n not in times}
    words = [n for n, kind in values.items() if kind == "str" and n not in forced]
    _refuse_without_values(values, layout, words, cells_of, where)
    numbers = {n: cells_of[n] for n, kind in zip(layout.names, kinds, strict=True) if kind == "float64"}
    decimal = _decimal(said.get("decimal"), numbers, whole.delimiter, where)
    bare = {n: kind for n, kind in values.items() if units[n] is None}
    told_unit = unit_column(bare, cells_of) if len(groups) == 1 else None
    if told_unit and told_unit.others:  # what is converted is whole no more
        kinds[layout.names.index(told_unit.of)] = "float64"
    standing, standing_note = standing_columns(said, layout, groups, kinds, cells_of, quality, where)
    above = [[line.replace("\t", " ")] if whole.blanks else whole.cells(line) for line in preamble]
    units_told = told_unit.note() if told_unit else unit_column_note(bare, cells_of)
    begin, doubt = _begin(groups, above, body, declared_start(said), where)
    notes = [
        whole.sample.note,
        *layout.notes,
        *_notes(layout, kinds, groups),
        *(STANDS for g in groups if stands(body, g.group.time, g.formats)),
        *(unpadded_note(r[i] for r in body) for g in groups if g.formats for i in g.group.time),
        decimal.note,
        *(unit_note(cells_of[name], name) for name in words),
        *shared({**quality, **of_rows}),
        *said_of_codes(own_cells, codes, quality, of_rows),
        standing_note,
        units_told,
        doubt,
        open_zone,
    ]
    return Table(
        name=where,
        sample=whole.sample,
        delimiter=whole.delimiter,
        quoted=whole.quoted,
        layout=layout,
        groups=groups,
        kinds=tuple(kinds),
        decimal=decimal.mark,
        decimal_declared=decimal.is_told,
        header=header_lines(lines.head, layout.first, lines.cells),
        quality=quality,
        notes=tuple(dict.fromkeys(note for note in notes if note)),
        blanks=whole.blanks,
        named=whole.named,
        begin=begin,
        zone=zone,
        unit=told_unit,
        units_told=units_told,
        stands=standing,
        row_quality=of_rows,
        states=codes,
    )


def _body(lines: HeadLines, rows: Sequence[list[str]], layout: Layout) -> list[list[str]]:
    """The sampled rows of the table, those with a cell for each column. rows: of the top."""
    first, top = layout.first, len(lines.top)
    # lines of a header were joined, rows are not
    top_rows = map(lines.cells, lines.top[first:]) if lines.quoted else rows[first:]
    later = map(lines.cells, (*lines.head[max(top, first) : first + _TYPED_ROWS], *lines.sample.rest))
    return [r for r in (*top_rows, *later) if len(r) == len(layout.names)]


def _kinds(
    layout: Layout, groups: Sequence[TimedGroup], cells_of: Mapping[str, list[str]], texts: Collection[str]
) -> list[str | None]:
    """The dtype of each column, None for one without values. texts: columns that are text whatever their cells."""
    times = {
        i: TIME if g.formats else "float64" if g.group.epoch is None else dtype_of_counts(cells_of[layout.names[i]])
        for g in groups
        for i in g.group.time
    }
    return [
        times[i] if i in times else "str" if name in texts else kind_of(cells_of[name], name, layout.units[i])
        for i, name in enumerate(layout.names)
    ]


def _refuse_without_values(
    kinds: Mapping[str, str | None],
    layout: Layout,
    words: Sequence[str],
    cells_of: Mapping[str, list[str]],
    where: str,
) -> None:
    """kinds: of the columns beside the time; words: those of them that are text by their cells alone."""
    if not any(kind is not None for kind in kinds.values()):
        raise FormatError("no column beside the time", where=where, expected="values", got=", ".join(layout.names))
    if all(kind in (None, "str") for kind in kinds.values()):
        refuse_units_in_cells([c for name in words for c in cells_of[name]], where)


@dataclass(frozen=True, slots=True)
class _Decimal:
    """is_told: declared, or told by thousands, as the note says."""

    mark: str | None
    is_told: bool
    note: str | None = None


def _decimal(declared: str | None, numbers: Mapping[str, list[str]], delimiter: str, where: str) -> _Decimal:
    """numbers: the cells of the columns of numbers."""
    if declared == UNKNOWN:
        raise unanswered("decimal", "'.' or ','", where)
    if declared is not None:
        return _Decimal(declared, is_told=True)
    columns = list(numbers.values())
    if (told := told_thousands(columns)) is not None:
        return _Decimal(told.decimal, is_told=True, note=told.note)
    mark = find_decimal(columns, delimiter, where)
    ask_for_thousands(numbers, mark, where)
    return _Decimal(mark, is_told=False)


def _timed(
    group: Group, layout: Layout, body: Sequence[list[str]], lines: HeadLines, stream: str, where: str
) -> TimedGroup:
    name = stream if group.stream == STREAM else group.stream
    if not group.dated:
        return TimedGroup(name, group, (), stated_zone(layout.names[i] for i in group.time))

    def more(k: int) -> list[str]:
        rows = still_going(lines.below(layout.first), group, layout)
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
