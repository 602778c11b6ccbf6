"""The first look at a file of delimited text: its header, its columns and their kinds, its times."""

from __future__ import annotations

from collections.abc import Iterator, Mapping, Sequence
from dataclasses import dataclass, field, replace
from functools import cache, lru_cache
from pathlib import Path
from typing import Any

from thermodata.errors import FormatError, QuestionError
from thermodata.plugin import Source
from thermodata.reader.text.cells.lines import delimiter as delimiters
from thermodata.reader.text.cells.lines.named_values import TIME as NAMED_TIME
from thermodata.reader.text.cells.lines.named_values import named_values
from thermodata.reader.text.cells.time_forms.zone_words import stated_zone
from thermodata.reader.text.cells.values.quotes import clean
from thermodata.reader.text.file.foreign_texts import refuse_foreign
from thermodata.reader.text.file.lines import WHOLE, Sample, sample
from thermodata.reader.text.page.header.header_again import repeats_of
from thermodata.reader.text.page.header.second_header import second_header
from thermodata.reader.text.page.layout import Layout, find_layout
from thermodata.reader.text.page.on_its_side import refuse_sideways
from thermodata.reader.text.page.timed.group import STREAM, Group
from thermodata.reader.text.preamble.begin import BY_HALF
from thermodata.reader.text.tables.head_lines import HeadLines, head_lines
from thermodata.reader.text.tables.long_rows import refuse_long
from thermodata.reader.text.tables.row_series import with_series
from thermodata.reader.text.tables.sample.begun import begin_above, begins_of_blocks, on_one_clock
from thermodata.reader.text.tables.sample.look_at_columns import look_at_columns
from thermodata.reader.text.tables.sample.sampled import Sampled, still_going
from thermodata.reader.text.tables.sample.zone_named import zones_said
from thermodata.reader.text.tables.table import Table, TimedGroup, header_lines
from thermodata.reader.text.times.one_cell.unpadded import unpadded_note
from thermodata.reader.text.times.several_cells.date_parts import PART
from thermodata.reader.text.times.several_cells.days import NOTE, STANDS, have_days, is_once, stands
from thermodata.reader.text.times.time_formats import find_formats

_TYPED_ROWS = 2000  # of the head, by which columns are typed


def open_table(path: Path, source: Source, stream: str = STREAM) -> Table:
    """The table of a file by its head and pieces of the rest. stream: what its one stream is called; the option `text`
    of the source names columns that are text whatever their cells. FormatError where there is none.

    Describing and reading follow each other, so the last ones are kept.
    """
    status = path.stat()
    key = (str(path.resolve()), status.st_mtime_ns, status.st_size, repr(source), stream)
    return _find_table_kept(_AskedTable(path, source, stream, key))


@dataclass(frozen=True)
class _AskedTable:
    path: Path = field(compare=False)
    source: Source = field(compare=False)
    stream: str = field(compare=False)
    key: tuple[Any, ...]


@lru_cache(maxsize=4)
def _find_table_kept(asked: _AskedTable) -> Table:
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
        got = repr(first.head[0][:60]) if first.head else "nothing"
        raise _no_table("no whole line" if first.head else "an empty file", path.name, got)
    return with_series(find_table(head, first, source, path.name, asked.stream, strict=True), source)


def _no_table(what: str, where: str, got: str) -> FormatError:
    return FormatError(what, where=where, expected="a table", got=got, hint="copy it anew from where it was recorded")


def find_table(
    head: Sequence[str], first: Sample, source: Source, where: str, stream: str, strict: bool = False
) -> Table:
    """The table in a file's first lines. first: all that was sampled of the file; stream: what its one stream is
    called; strict: not where its header has another number of cells than its rows, and nothing tells which names which
    (whose file it is does not hang on that).

    FormatError where there is none, or it can't be read; QuestionError where it leaves open how."""
    if not any(line.strip() for line in head):
        raise _no_table("no whole line", where, "nothing")
    if not named_values(head):
        refuse_foreign(head, where)
    said = source.table or {}
    whole = head_lines(head, first, said, where)
    if whole.named:
        said = {"names": [NAMED_TIME, *whole.named], **said}
    if whole.schedules is not None and len(whole.schedules.times) > 1:
        said = {"time": [{"column": column} for column in whole.schedules.times], **said}
    try:
        lines, table = _sample_table(whole, said, where, stream, strict)
    except FormatError as error:
        if whole.columns is None or isinstance(error, QuestionError):
            raise
        whole = head_lines(head, first, said, where, cut_names=True)
        lines, table = _cut_by_columns(whole, said, where, stream, error)
    layout, preamble = table.layout, lines.head[: table.layout.first]
    groups, zone, open_zone = zones_said(table.groups, layout.names, map(lines.cells, preamble), source.timezone)
    table = replace(table, groups=groups)
    columns = look_at_columns(table, source.options.get("text") or (), whole.delimiter)
    # what blanks part in a title are its parts
    above = [[line] for line in head[: table.layout.first]] if whole.blanks else [*map(whole.cells, preamble)]
    own, asked = begins_of_blocks(table, above)
    begin, doubt = (own[0] if own else None, asked) if own or asked else begin_above(table, above)
    groups = tuple(replace(g, begin=b) for g, b in zip(groups, own, strict=True)) if own else groups
    notes = [
        whole.sample.note,
        *layout.notes,
        *_of_names(layout, columns.kinds),
        *_of_times(table),
        *columns.notes,
        doubt,
        open_zone,
    ]
    return Table(
        name=where,
        sample=whole.sample,
        delimiter=whole.delimiter,
        quoted=whole.quoted,
        layout=layout,
        groups=groups if begin is not None else on_one_clock(table),
        kinds=columns.kinds,
        decimal=columns.decimal,
        decimal_declared=columns.decimal_is_told,
        header=header_lines(lines.head, layout.first, lines.cells),
        qualities=columns.qualities,
        notes=tuple(dict.fromkeys(note for note in notes if note)),
        blanks=whole.blanks,
        columns=whole.columns,
        schedules=whole.schedules,
        named=whole.named,
        stamped=whole.stamped,
        begin=begin,
        zone=zone,
        unit=columns.unit,
        paired=columns.paired,
        units_told=columns.units_told,
        stands=columns.stands,
    )


def _cut_by_columns(
    whole: HeadLines, said: Mapping[str, Any], where: str, stream: str, error: FormatError
) -> tuple[HeadLines, Sampled]:
    """The same where names hold blanks, and stand over columns at fixed places. error: of names that blanks part."""
    try:
        return _sample_table(whole, said, where, stream, strict=True)
    except QuestionError:
        raise
    except FormatError:
        raise error from None


def _sample_table(
    whole: HeadLines, said: Mapping[str, Any], where: str, stream: str, strict: bool
) -> tuple[HeadLines, Sampled]:
    """(the lines of the table, without another below it; what was sampled of it). said: what is declared of it."""
    lines, rows = whole, whole.rows()
    if (end := second_header(rows)) is not None:  # what stands behind it is not read: it tells nothing of the columns
        lines, rows = whole.up_to(end), rows[:end]
    try:
        layout = find_layout(rows, said, where, delimiters.shown(whole.delimiter, whole.blanks) if strict else None)
    except FormatError:
        refuse_sideways(rows, where, _how_to_turn(where))
        raise
    if (end := _moved_header(lines, layout)) is not None:
        lines = lines.up_to(end)
    body = _body(lines, rows, layout)
    if said.get("series") is None:  # else it is declared how its rows lie
        refuse_long(layout.names, body, where)
    groups = tuple(_with_time_formats(g, layout, body, lines, stream, where) for g in layout.groups)
    return lines, Sampled(said, layout, groups, body, where)


def _moved_header(lines: HeadLines, layout: Layout) -> int | None:
    """The first line below the top that has all names of the columns, and not in their order; None where none has."""
    names, time = list(layout.names), layout.names[layout.time[0]] if layout.time else ""
    top = len(lines.top)
    for number, line in enumerate(lines.head[top:], top) if time else ():
        if time in line and (cells := lines.cells(line)) != names and set(names) <= set(cells):
            return number
    return None


def _how_to_turn(where: str) -> str:
    """How a text that stands on its side is turned round, in a spreadsheet or, of one that is too wide for it, by a
    command."""
    return (
        "in a spreadsheet copy all, and paste it with 'transpose' into a new sheet; or "
        f"python -c \"import pandas; pandas.read_csv('{where}', header=None).T.to_csv('{Path(where).stem}_turned.csv', "
        "header=False, index=False)\", with sep=';' where cells stand between these"
    )


def _body(lines: HeadLines, rows: Sequence[list[str]], layout: Layout) -> list[list[str]]:
    """The sampled rows of the table, those with a cell for each column, but for headers that stand again. rows: of the
    top."""
    first, top = layout.first, len(lines.top)
    # lines of a header were joined, rows are not
    top_rows = map(lines.cells, lines.top[first:]) if lines.quoted else rows[first:]
    later = map(lines.cells, (*lines.head[max(top, first) : first + _TYPED_ROWS], *lines.sample.rest))
    repeats = repeats_of(rows[:first])
    return [r for r in (*top_rows, *later) if len(r) == len(layout.names) and not repeats(r)]


def _with_time_formats(
    group: Group, layout: Layout, body: Sequence[list[str]], lines: HeadLines, stream: str, where: str
) -> TimedGroup:
    name = stream if group.stream == STREAM else group.stream
    if not group.dated:
        return TimedGroup(name, group, (), stated_zone(layout.names[i] for i in group.time))

    @cache
    def below() -> list[list[str]]:
        repeats = repeats_of(map(lines.cells, lines.head[: layout.first]))
        return [r for r in still_going(lines.below(layout.first), group, layout) if not repeats(r)]

    def more(k: int) -> list[str]:
        return [r[group.time[k]] for r in below() if len(r) > group.time[k]]

    columns = [[r[i] for r in still_going(body[:_TYPED_ROWS], group, layout)] for i in group.time]
    names = [layout.names[i] for i in group.time]
    once = len(columns) > 1 and is_once(columns[0])
    if once:
        columns[0] = [c for c in columns[0] if clean(c)]
    forms = find_formats(names, columns, group.form, where, more)
    return TimedGroup(name, group, forms, stated_zone(names), once and have_days(forms))


def _of_names(layout: Layout, kinds: Sequence[str | None]) -> Iterator[str]:
    """Notes on columns without a name, or with the same."""
    times = set(layout.time)
    names = [n for i, (n, kind) in enumerate(zip(layout.names, kinds, strict=True)) if kind and i not in times]
    # a name of the file may begin with that word
    places = {f"column {i + 1}" for i in range(len(layout.names))}
    if not places.isdisjoint(names):
        yield "columns without a name are called by their place"
    if any("#" in n and n.rsplit("#", 1)[-1].isdigit() for n in names):
        yield "names that repeat are numbered: #2, #3, ..."


def _of_times(table: Sampled) -> Iterator[str | None]:
    """Notes on how times are written."""
    groups, body = table.groups, table.body
    if any(g.once for g in groups):
        yield NOTE
    forms = [form for g in groups for form in g.formats if form.role != PART.role]
    for text in dict.fromkeys(form.text for form in forms):
        if "DD/MM" in text or "MM/DD" in text:
            supposed = any(form.supposed for form in forms if form.text == text)
            yield f"dates read as {text}{f', {BY_HALF}' if supposed else ''}"
    yield from (STANDS for g in groups if stands(body, g.group.time, g.formats))
    yield from (unpadded_note(r[i] for r in body) for g in groups if g.formats for i in g.group.time)
