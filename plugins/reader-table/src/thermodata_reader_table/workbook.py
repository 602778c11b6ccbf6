"""Workbooks (XLSX): refused where they would unpack to something absurd, then read by calamine."""

from __future__ import annotations

import datetime as dt
import re
import struct
import zipfile
import zlib
from collections.abc import Iterator
from functools import lru_cache
from pathlib import Path
from typing import Any

import numpy as np

from thermodata.errors import FormatError, UsageError
from thermodata.plugin import Array, Block, Loss, Recording, Signal, Source
from thermodata.reader.text import decimal_mark
from thermodata.reader.zone import NAT
from thermodata_reader_table import stamps
from thermodata_reader_table.layout import Layout, find

STREAM = "table"
MAX_UNPACKED = 1 << 30
MAX_CELLS = 60_000_000
_SPARSE = 3_000_000                          # cells of a sheet that may be almost empty
_BLOCK_VALUES = 1_000_000
_SMALL = 8_000_000
_CELL = re.compile(rb'<(?:\w+:)?c [^>]*?r="([A-Z]{1,3})(\d{1,7})"')


# what calamine gives as an empty cell, or does not tell
_ODD = {
    "hold an error such as #N/A": re.compile(rb'<(?:\w+:)?c [^>]*?t="e"'),
    "hold a formula without its value (open the workbook once in a spreadsheet and save it)":
        re.compile(rb"(?:</(?:\w+:)?f>|<(?:\w+:)?f [^>]*/>)</(?:\w+:)?c>"),
    "hidden": re.compile(rb'<(?:\w+:)?row [^>]*?hidden="(?:1|true)"'),
}


def check_size(path: Path) -> dict[str, int]:
    """How many cells and rows of all sheets are of each kind of _ODD.

    FormatError for a workbook that is no ZIP, or whose parts unpack to more than 1 GiB (whatever their headers
    say), or whose cells span an absurd area: a reader of it would take all memory."""
    try:
        with zipfile.ZipFile(path) as archive:
            members = archive.infolist()
    except (zipfile.BadZipFile, OSError, ValueError, NotImplementedError) as error:
        raise FormatError("not a readable workbook", where=path.name, expected="an XLSX (ZIP) file",
                          got=str(error)) from None
    unpacked, odd = 0, dict.fromkeys(_ODD, 0)
    with path.open("rb") as file:
        for member in members:
            sheet = member.filename.startswith("xl/worksheets/")
            right, bottom, rest, count = 0, 0, b"", 0
            for part in _inflate(file, member, path):
                unpacked += len(part)
                if unpacked > MAX_UNPACKED:
                    raise FormatError("workbook unpacks to more than 1 GiB", where=f"{path.name} {member.filename}",
                                      expected="a log of reasonable size", got=f"{path.stat().st_size} bytes packed",
                                      hint="export it as CSV or Parquet")
                if sheet:
                    for kind, pattern in _ODD.items():
                        odd[kind] += len(pattern.findall(rest + part)) - len(pattern.findall(rest))
                    cells = _CELL.findall(rest + part)
                    count += len(cells)
                    found = set(cells)
                    rest = part[-200:]
                    if found:
                        right = max(right, max(_column(c) for c in {c for c, _ in found}))
                        bottom = max(bottom, max(int(r) for _, r in found))
            if right * bottom > MAX_CELLS or right * bottom > max(_SPARSE, 20 * count):
                raise FormatError("sheet spans an absurd area", where=f"{path.name} {member.filename}",
                                  expected=f"at most {MAX_CELLS} cells, most of them filled",
                                  got=f"{bottom} rows x {right} columns with {count} cells",
                                  hint="delete the stray cells far off, or export it as CSV or Parquet")
    return odd


def _inflate(file: Any, member: zipfile.ZipInfo, path: Path) -> Iterator[bytes]:
    file.seek(member.header_offset)
    header = file.read(30)
    if len(header) < 30 or header[:4] != b"PK\x03\x04":
        raise FormatError("damaged workbook", where=f"{path.name} byte {member.header_offset}",
                          expected="a ZIP entry", got=header[:4].hex(" "))
    name, extra = struct.unpack("<HH", header[26:30])
    file.seek(name + extra, 1)
    left = member.compress_size
    if member.compress_type == zipfile.ZIP_STORED:
        while left > 0 and (raw := file.read(min(left, 65536))):
            left -= len(raw)
            yield raw
        return
    if member.compress_type != zipfile.ZIP_DEFLATED:
        raise FormatError("workbook packed in an unusual way", where=f"{path.name} {member.filename}")
    unpack = zlib.decompressobj(-15)
    try:
        while left > 0 and (raw := file.read(min(left, 65536))):
            left -= len(raw)
            while raw:
                yield unpack.decompress(raw, 1 << 20)
                raw = unpack.unconsumed_tail
    except zlib.error as error:
        raise FormatError("damaged workbook", where=f"{path.name} {member.filename}", got=str(error)) from None


def _column(letters: bytes) -> int:
    n = 0
    for letter in letters:
        n = n * 26 + letter - 64
    return n


def _rows(path: Path, source: Source) -> tuple[list[list[Any]], str, dict[str, int], list[str]]:
    """Rows of the wanted sheet, its name, what check_size() counted, and the names of the other sheets.
    Small workbooks are kept: describing and reading follow each other."""
    status = path.stat()
    key = (str(path.resolve()), status.st_mtime_ns, status.st_size, (source.table or {}).get("sheet"))
    return (_kept if status.st_size < _SMALL else _load)(*key)


def _load(name: str, mtime_ns: int, size: int, wanted: int | str | None) -> tuple[
        list[list[Any]], str, dict[str, int], list[str]]:
    import python_calamine

    path = Path(name)
    odd = check_size(path)
    try:
        book = python_calamine.CalamineWorkbook.from_path(str(path))
    except Exception as error:  # calamine has many error classes, all of which mean: not this file
        raise FormatError("not a readable workbook", where=path.name, got=str(error)) from None
    names = book.sheet_names
    if isinstance(wanted, str):
        if wanted not in names:
            raise UsageError(f"no sheet '{wanted}'", where=path.name, expected=", ".join(names), got=wanted)
        sheet = wanted
    else:
        number = 1 if wanted is None else int(wanted)
        if not 1 <= number <= len(names):
            raise UsageError(f"no sheet {number}", where=path.name, expected=f"1 to {len(names)}", got=str(number))
        sheet = names[number - 1]
    try:
        rows = book.get_sheet_by_name(sheet).to_python(skip_empty_area=False)
    except Exception as error:
        raise FormatError(f"sheet '{sheet}' cannot be read", where=path.name, got=str(error)) from None
    if not rows:
        raise FormatError(f"sheet '{sheet}' is empty", where=path.name, expected="a table")
    while rows and not any(c not in ("", None) for c in rows[-1]):
        rows.pop()
    others = [n for n in names if wanted is None and n != sheet and _has_rows(book, n)]
    return rows, sheet, odd, others


def _has_rows(book: Any, name: str) -> bool:
    try:
        return int(book.get_sheet_by_name(name).height) > 1
    except Exception:  # a chart, or a damaged sheet that nobody asked for
        return False


_kept = lru_cache(maxsize=1)(_load)


class Table:
    """A sheet in memory, column by column. decimal: of numbers that stand as text."""

    def __init__(self, path: Path, source: Source) -> None:
        rows, self.sheet, odd, others = _rows(path, source)
        self.layout: Layout = find(rows[:500], source.table, f"{path.name} sheet '{self.sheet}'")
        self.columns = list(zip(*rows[self.layout.first:], strict=False))
        self.notes = list(self.layout.notes)
        self.losses: list[Loss] = []
        if others:
            self.notes.append(f"only sheet '{self.sheet}' is read, not {', '.join(others)}: a source for each, with "
                              "table: {sheet: ...}")
        for kind, count in odd.items():
            if count and kind == "hidden":
                self.notes.append(f"{count} hidden rows: they are read like the others")
            elif count:
                self.losses.append(Loss(f"{path.name}", None, None, None, f"{count} cells of the workbook {kind}: "
                                        "they are empty"))
        said = (source.table or {}).get("decimal")
        columns = [c for i, c in enumerate(self.columns) if i not in self.layout.time]
        self.decimal = said or decimal_mark(c for col in columns for c in col[:200] if isinstance(c, str)) or "."
        self.times = self._times(source, path)
        self.values: dict[str, Array] = {}
        for i, name in enumerate(self.layout.names):
            if i not in self.layout.time:
                self.values[name] = self._values(name, self.columns[i], path)

    def _times(self, source: Source, path: Path) -> stamps.Stamps:
        layout = self.layout
        columns = [self.columns[i] for i in layout.time]
        if layout.seconds is not None:
            seconds = self._numbers(columns[0])[0] * layout.seconds
            good = np.isfinite(seconds) & (np.abs(seconds) < 9e9)
            t_ns = np.full(seconds.size, NAT, np.int64)
            t_ns[good] = np.rint(seconds[good] * 1e9).astype(np.int64)
            return stamps.Stamps(t_ns, False, ())
        joined = [_joined(cells) for cells in zip(*columns, strict=True)]
        if any(isinstance(j, str) and j for j in joined):
            texts = [j if isinstance(j, str) else str(j).replace(" 00:00:00", " 0:00:00") for j in joined]
            return stamps.parse(texts, source.timezone, layout.form, path.name)
        if any(isinstance(j, dt.timedelta) for j in joined):
            micro = dt.timedelta(microseconds=1)
            t = np.array([(j // micro) * 1000 if isinstance(j, dt.timedelta) else NAT for j in joined], np.int64)
            return stamps.Stamps(t, False, ("times of day without a date: counted from midnight",))
        naive = np.array([j.isoformat() if isinstance(j, dt.datetime) else "NaT" for j in joined], "datetime64[ns]")
        return stamps.local_stamps(naive, source.timezone)

    def _numbers(self, cells: tuple[Any, ...]) -> tuple[Array, list[str]]:
        out, odd = np.full(len(cells), np.nan), []
        for i, cell in enumerate(cells):
            if isinstance(cell, int | float):
                out[i] = cell
            elif isinstance(cell, str) and cell.strip():
                try:
                    out[i] = float(cell.strip().replace(",", ".") if self.decimal == "," else cell)
                except ValueError:
                    odd.append(cell)
            elif cell not in ("", None):
                odd.append(str(cell))
        return out, odd

    def _values(self, name: str, cells: tuple[Any, ...], path: Path) -> Array:
        numbers, odd = self._numbers(cells)
        if odd and len(odd) * 2 > sum(c not in ("", None) for c in cells):
            return np.array(["" if c is None else str(c) for c in cells], object)
        if odd:
            self.losses.append(Loss(f"{path.name} column '{name}'", None, None, len(odd) / len(cells),
                                    f"{len(odd)} cells are no numbers, such as '{odd[0]}'"))
        return numbers


def _joined(cells: tuple[Any, ...]) -> Any:
    """One date and time of a row's time cells."""
    if len(cells) == 1:
        cell = cells[0]
        if isinstance(cell, dt.time):
            return dt.datetime.combine(dt.date.min, cell) - dt.datetime.min
        if isinstance(cell, dt.date) and not isinstance(cell, dt.datetime):
            return dt.datetime.combine(cell, dt.time())
        return cell
    day, clock = cells[0], cells[1]
    if isinstance(day, dt.date) and isinstance(clock, dt.time | dt.timedelta | dt.datetime):
        midnight = dt.datetime(day.year, day.month, day.day)
        if isinstance(clock, dt.timedelta):
            return midnight + clock
        return dt.datetime.combine(midnight.date(), clock.time() if isinstance(clock, dt.datetime) else clock)
    return " ".join(str(c).strip() for c in cells)


def describe(path: Path, source: Source) -> Recording:
    table = Table(path, source)
    layout = table.layout
    signals = tuple(
        Signal(name, STREAM, layout.units[i], "str" if table.values[name].dtype == object else "float64")
        for i, name in enumerate(layout.names) if i not in layout.time
    )
    good = table.times.t_ns[table.times.t_ns != NAT]
    absolute = table.times.absolute
    return Recording(signals, "absolute" if absolute else "relative",
                     (int(good[0]) if good.size else 0) if absolute else None, None,
                     (*table.notes, *table.times.notes))


def blocks(path: Path, source: Source) -> Iterator[Block | Loss]:
    table = Table(path, source)
    t_ns = table.times.t_ns
    good = t_ns != NAT
    if not good.any():
        raise FormatError("no row holds a time", where=path.name,
                          hint="declare table: {time: {column: ..., unit: ...}}")
    size = max(1, int(source.options.get("block_rows", _BLOCK_VALUES // max(1, len(table.values)))))
    for first in range(0, t_ns.size, size):
        part = good[first:first + size]
        yield Block(STREAM, t_ns[first:first + size][part],
                    {name: v[first:first + size][part] for name, v in table.values.items()})
    yield from table.losses
    if not good.all():
        bad = int((~good).sum())
        yield Loss(path.name, None, None, bad / t_ns.size, f"{bad} rows without a time")
