"""Rows of delimited text with every care: whatever cells hold, the good ones are kept and the others counted."""

from __future__ import annotations

import re
import warnings
from collections.abc import Iterable, Iterator, Sequence
from contextlib import suppress
from dataclasses import dataclass, field
from pathlib import Path
from typing import IO, Any

import numpy as np

from thermodata.errors import FormatError
from thermodata.plugin import Array, Block, Int1D, Loss, Source
from thermodata.reader.text import clean
from thermodata.reader.zone import NAT
from thermodata_reader_table import clocks, stamps
from thermodata_reader_table.layout import Group, Layout
from thermodata_reader_table.time_columns import MILLISECONDS

BLOCK_VALUES = 1_000_000
_SPARE = 8  # cells that a line may have too many before the file is refused
EMPTY = {"", "nan", "null", "none", "n/a", "#n/a", "na", "-", "--", "---", "?"}
_LINE = re.compile(r"line (\d+)")  # as pandas counts, from the first row of data
_GROUPED = {
    ",": re.compile(r"^[+-]?\d{1,3}(?:[. \u00a0\u202f'’]\d{3})+(?:,\d*)?$"),
    ".": re.compile(r"^[+-]?\d{1,3}(?:[, \u00a0\u202f'’]\d{3})+(?:\.\d*)?$"),
}


@dataclass(frozen=True)
class Sheet:
    """What the head of the file tells. kinds: "float64" or "str" by column; cells: of a usual line."""

    encoding: str
    delimiter: str
    decimal: str
    layout: Layout
    kinds: tuple[str, ...]
    quoted: bool
    notes: tuple[str, ...]
    cut: str | None
    cells: int
    head: tuple[tuple[str, ...], ...]  # its first rows of data, as wide as the header


@dataclass
class Tally:
    """What became of the rows: how many were read, which gave no time, which cells are no numbers."""

    at: int = 0
    bad_rows: int = 0
    short_rows: int = 0
    last_ns: int | None = None
    odd: dict[str, list[str]] = field(default_factory=dict)
    odd_count: dict[str, int] = field(default_factory=dict)

    def add_odd(self, name: str, cells: list[str]) -> None:
        if cells:
            self.odd_count[name] = self.odd_count.get(name, 0) + len(cells)
            self.odd.setdefault(name, cells[:3])

    def losses(self, path: Path, sheet: Sheet) -> Iterator[Loss]:
        """Losses of the whole file; FormatError where most rows hold no time."""
        at = max(self.at, 1)
        if self.at and self.bad_rows * 2 > self.at:
            raise FormatError(
                "most rows hold no time",
                where=path.name,
                got=f"{self.bad_rows} of {self.at}",
                hint="declare table: {time: {column: ..., format: ...}}",
            )
        for name, cells in self.odd.items():
            n = self.odd_count[name]
            yield Loss(
                f"{path.name} column '{name}'",
                None,
                None,
                min(1.0, n / at),
                f"{n} cells are no numbers, such as '{cells[0]}'",
            )
        if self.bad_rows:
            yield Loss(
                path.name,
                None,
                None,
                min(1.0, self.bad_rows / at),
                f"{self.bad_rows} rows without a time, or with too many cells",
            )
        if self.short_rows:
            yield Loss(
                path.name,
                None,
                None,
                min(1.0, self.short_rows / at),
                f"{self.short_rows} lines have fewer cells than the others: their last cell may be cut",
            )
        if sheet.cut:
            yield Loss(f"{path.name} row {sheet.layout.first + self.at}", self.last_ns, None, 1 / at, sheet.cut)


def block_rows(sheet: Sheet, source: Source) -> int:
    return max(1, int(source.options.get("block_rows", BLOCK_VALUES // (len(sheet.layout.names) + _SPARE))))


def chunks(path: Path, sheet: Sheet, rows: int, only: tuple[int, ...] | None = None) -> Iterator[Any]:
    """DataFrames, one column a position: numbers where pandas reads all of a part's cells as such, else text;
    an empty cell is NaN. Column `width + i` holds cells that a line has too many. only: these columns."""
    import pandas as pd

    width = len(sheet.layout.names)
    # columns of numbers and words are told as a Loss; pandas' own warning about them would come besides
    warnings.filterwarnings("ignore", category=pd.errors.DtypeWarning)
    # pandas before 3 rounds the last digit unless told not to
    exact: dict[str, Any] = {} if int(pd.__version__.split(".")[0]) >= 3 else {"float_precision": "round_trip"}
    text = {i: str for i, kind in enumerate(sheet.kinds) if kind == "str"}
    text |= dict.fromkeys(sheet.layout.dated, str)
    try:
        with (
            _behind_head(path, sheet) as file,
            pd.read_csv(
                file,
                sep=sheet.delimiter,
                header=None,
                names=list(range(width + _SPARE)),
                index_col=False,
                dtype=text,
                keep_default_na=False,
                na_values=[""],
                decimal=sheet.decimal,
                quoting=0 if sheet.quoted else 3,
                skip_blank_lines=True,
                chunksize=rows,
                engine="c",
                low_memory=True,
                on_bad_lines="error",
                **exact,
            ) as reader,
        ):
            for chunk in reader:
                yield chunk if only is None else chunk[list(only)]
    except pd.errors.EmptyDataError:
        return
    except (pd.errors.ParserError, UnicodeError) as error:
        raise FormatError(
            "a line that does not fit the table",
            where=path.name,
            expected=f"{width} cells",
            got=_LINE.sub(
                lambda m: f"line {int(m[1]) + sheet.layout.first}", (str(error).strip().splitlines() or ["?"])[-1]
            ),
        ) from None


def _behind_head(path: Path, sheet: Sheet, encoding: str | None = None) -> IO[str]:
    """The file at its first row of data. pandas would count other lines: a quote that is left open, or a carriage
    return behind the line feed, is not an end to all."""
    file = path.open(encoding=encoding or sheet.encoding, newline="")
    for _ in range(sheet.layout.first):
        file.readline()
    return file


class Clock:
    """The times of the rows of a group; dates are resolved over all of them."""

    def __init__(self, path: Path, sheet: Sheet, source: Source, group: Group) -> None:
        self.path, self.sheet, self.source, self.group = path, sheet, source, group
        self._writing: stamps.Writing | None = None
        self._numbers: list[Int1D] = []
        self._locals: list[stamps.Local] = []

    def texts(self, chunk: Any) -> list[str]:
        """The cells of the time columns of a chunk, joined."""
        time = self.group.time
        cells = chunk[time[0]].fillna("")
        for column in time[1:]:
            more = chunk[column].fillna("").str.strip()
            milli = MILLISECONDS.match(self.sheet.layout.names[column])
            cells = cells.str.strip() + ("." + more.str.zfill(3) if milli else " " + more)
        found: list[str] = cells.tolist()
        return found

    def writing(self, first: list[str]) -> stamps.Writing:
        """How the dates are written, by the first rows, or by as many as it takes."""
        if self._writing is None:
            try:
                self._writing = stamps.find_writing([_filled(first)], self.group.form, self.path.name)
            except FormatError:
                # which number is the day may show further down only
                parts = (_filled(self.texts(c)) for c in chunks(self.path, self.sheet, 50_000, self.group.time))
                self._writing = stamps.find_writing(filter(None, parts), self.group.form, self.path.name)
        return self._writing

    def numbers(self, cells: Array) -> Int1D:
        values = floats(cells, self.sheet.decimal)[0]
        if self.group.epoch is not None:
            epoch = clocks.EPOCHS[self.group.epoch]
            return clocks.to_ns(values, epoch.seconds, epoch.zero_s)
        assert self.group.seconds is not None
        return clocks.to_ns(values, self.group.seconds)

    def add(self, chunk: Any) -> None:
        """Takes the times of the next rows."""
        if not self.group.dated:
            self._numbers.append(self.numbers(chunk[self.group.time[0]].to_numpy()))
        else:
            self.add_texts(self.texts(chunk))

    def add_texts(self, texts: list[str]) -> None:
        if not self.group.dated:
            self._numbers.append(self.numbers(np.array(texts, object)))
        else:
            self._locals.append(stamps.local(texts, self.writing(texts)))

    def all(self) -> stamps.Stamps:
        """The times of all rows that were added."""
        group = self.group
        if not group.dated:
            t_ns = np.concatenate(self._numbers) if self._numbers else np.zeros(0, np.int64)
            if group.epoch is None:
                return stamps.Stamps(t_ns, False, ())
            if not clocks.EPOCHS[group.epoch].local:
                return stamps.Stamps(t_ns, True, ())
            return stamps.local_stamps(t_ns.view("datetime64[ns]"), self.source.timezone)
        if self._writing is None:
            return stamps.Stamps(np.zeros(0, np.int64), True, ())
        return stamps.resolved(self._locals, self._writing, self.source.timezone)


def joined(names: Sequence[str], group: Group, row: Sequence[str]) -> str:
    """The cells of a group's time in a row of text; milliseconds behind a point."""
    parts = [
        "." + row[i].strip().zfill(3) if MILLISECONDS.match(names[i]) else " " + row[i].strip() for i in group.time[1:]
    ]
    return row[group.time[0]].strip() + "".join(parts)


def first_times(path: Path, sheet: Sheet, source: Source) -> list[stamps.Stamps]:
    """The times of each group over the head's rows."""
    found = []
    for group in sheet.layout.groups:
        clock = Clock(path, sheet, source, group)
        texts = [joined(sheet.layout.names, group, row) for row in sheet.head]
        if texts:
            clock.add_texts(texts)
        found.append(clock.all())
    return found


def _filled(cells: list[str]) -> list[str]:
    return [c for c in cells if c and not c.isspace()]


def times(path: Path, sheet: Sheet, source: Source, parts: Iterable[Any]) -> list[stamps.Stamps]:
    """The times of each group over some chunks."""
    found = [Clock(path, sheet, source, g) for g in sheet.layout.groups]
    for chunk in parts:
        for clock in found:
            clock.add(chunk)
    return [clock.all() for clock in found]


def blocks(path: Path, sheet: Sheet, source: Source, tally: Tally) -> Iterator[Block | Loss]:
    """Blocks of the rows behind those that `tally` has already, in two passes: the times of all, then the values."""
    layout, width = sheet.layout, len(sheet.layout.names)
    rows, done = block_rows(sheet, source), tally.at
    t_of = [s.t_ns for s in times(path, sheet, source, chunks(path, sheet, rows, layout.time))]
    total = t_of[0].size - (1 if sheet.cut else 0)
    tally.short_rows = _short(path, sheet)
    at = 0
    for chunk in chunks(path, sheet, rows):
        n = len(chunk)
        if at + n <= done:
            at += n
            continue
        new = (np.arange(at, at + n) >= done) & (np.arange(at, at + n) < total)
        whole = ~chunk.iloc[:, width:].notna().any(axis=1).to_numpy()
        made = []
        for group, t_ns in zip(layout.groups, t_of, strict=True):
            t = t_ns[at : at + n]
            good = new & (t != NAT) & whole
            bad = new & ~good
            if len(layout.groups) > 1:  # a group that has ended is empty beside longer ones
                bad &= chunk[[*group.time, *group.columns]].notna().any(axis=1).to_numpy() | ~whole
            tally.bad_rows += int(bad.sum())
            if good.any():
                tally.last_ns = int(t[good][-1])
                made.append(Block(group.stream, t[good], _taken(chunk, good, group, sheet, tally)))
        at += n
        tally.at = at
        yield from made


def _taken(chunk: Any, good: Array, group: Group, sheet: Sheet, tally: Tally) -> dict[str, Array]:
    values: dict[str, Array] = {}
    for i in group.columns:
        name, cells = sheet.layout.names[i], chunk[i].to_numpy()[good]
        if sheet.kinds[i] == "str":
            values[name] = np.array([clean(c) if isinstance(c, str) else "" for c in cells], object)
        else:
            values[name], odd = floats(cells, sheet.decimal)
            tally.add_odd(name, odd)
    return values


class _Ends:
    """Counts lines that have fewer cells than is usual, so that one may be cut. Where columns have times of their
    own, lines become shorter for good where a group has ended, and are whole."""

    def __init__(self, sheet: Sheet) -> None:
        self.usual, self.short, self._ended = sheet.cells, 0, 0
        self._edges = {min(g.time) for g in sheet.layout.groups[1:]}
        self._least = self.usual

    def add(self, cells: int) -> None:
        if cells > self._least:
            self.short, self._ended, self._least = self.short + self._ended, 0, self.usual
        if cells >= self.usual:
            return
        if cells in self._edges:
            self._ended, self._least = self._ended + 1, cells
        else:
            self.short += 1


def _short(path: Path, sheet: Sheet) -> int:
    ends = _Ends(sheet)
    if sheet.quoted or sheet.encoding.startswith("utf-16"):
        return _short_records(path, sheet, ends)
    with _behind_head(path, sheet, "latin-1") as file:  # the same lines and delimiters, faster
        last = ""
        for line in file:
            cells = line.count(sheet.delimiter) + 1
            if cells < ends.usual and line.isspace():
                continue
            before = ends.short
            ends.add(cells)
            last = line if ends.short > before else last
    return ends.short - (1 if sheet.cut and last and not last.endswith(("\n", "\r")) and ends.short else 0)


def _short_records(path: Path, sheet: Sheet, ends: _Ends) -> int:
    import csv

    with _behind_head(path, sheet) as file:
        try:
            for row in csv.reader(file, delimiter=sheet.delimiter, quoting=0 if sheet.quoted else 3):
                if row:
                    ends.add(len(row))
        except csv.Error:
            return ends.short
    return ends.short - (1 if sheet.cut and ends.short else 0)


def floats(cells: Array, decimal: str) -> tuple[Array, list[str]]:
    """Numbers of a column; empty cells are NaN, and so are cells that are no numbers, which are named."""
    if cells.dtype.kind in "biuf":
        return cells.astype(np.float64), []
    # pandas reads a part of such a column as numbers where that part holds no word; NaN is an empty cell
    texts = [c.strip() if isinstance(c, str) else "" if c != c else repr(float(c)) for c in cells.tolist()]
    plain = [c.replace(",", ".") for c in texts] if decimal == "," and not any("." in c for c in texts) else texts
    with suppress(ValueError):  # then cell by cell
        if not any("_" in c for c in texts):  # numpy takes 1_000 for a number
            return np.array([c or "nan" for c in plain]).astype(np.float64), []
    out, odd = np.full(len(texts), np.nan), []
    for i, text in enumerate(texts):
        if text.lower() in EMPTY:
            continue
        number = to_number(text, decimal)
        if number is None:
            odd.append(text)
        else:
            out[i] = number
    return out, odd


def to_number(text: str, decimal: str) -> float | None:
    """A number, with marks between thousands or a per cent sign behind it, or true and false; None for any other
    word. `1_000` is none, though Python reads it."""
    low = text.lower()
    if text[:1] in "+-" and text[1:2] == " ":
        text = text[0] + text[1:].lstrip(" ")  # "+   23.5"
    if low in ("true", "false"):
        return float(low == "true")
    if "_" in text:
        return None
    if _GROUPED[decimal].match(text):
        text = re.sub(r"[. \u00a0\u202f'’]" if decimal == "," else r"[, \u00a0\u202f'’]", "", text)
    elif decimal == "," and "." in text and "," in text:
        return None
    try:
        return float(text.replace(",", ".") if decimal == "," else text)
    except ValueError:
        return None
