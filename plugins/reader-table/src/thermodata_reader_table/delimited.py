"""Delimited text: CSV and its like, in two passes of bounded memory: the times of all rows, then their values."""

from __future__ import annotations

import warnings
from collections.abc import Iterator, Mapping
from dataclasses import dataclass
from pathlib import Path
from typing import Any

import numpy as np

from thermodata.errors import FormatError
from thermodata.plugin import Array, Block, Loss, Recording, Signal, Source
from thermodata.reader.text import clean, decimal_mark, decode_head, file_encoding, last_line_is_whole
from thermodata.reader.zone import NAT
from thermodata_reader_table import stamps
from thermodata_reader_table.layout import Layout, find, is_number

STREAM = "table"
DELIMITERS = (";", "\t", ",", "|")
_HEAD_BYTES = 256 * 1024
_BLOCK_VALUES = 1_000_000
_SPARE = 8                 # cells that a line may have too many before the file is refused
_EMPTY = {"", "nan", "null", "none", "n/a", "#n/a", "-", "--", "---", "?"}
_TEXT_NAME = ("comment", "note", "alarm", "message", "text", "label", "remark", "bemerk", "pozn", "hinweis")


@dataclass(frozen=True)
class Sheet:
    """What the head of the file tells. kinds: "float64" or "str" by column; lines: physical lines before the data."""

    encoding: str
    delimiter: str
    decimal: str
    layout: Layout
    kinds: tuple[str, ...]
    quoted: bool
    notes: tuple[str, ...]
    cut: str | None


def split(line: str, delimiter: str) -> list[str]:
    """Cells of a line, quotes honoured."""
    if '"' not in line:
        return [c.strip() for c in line.split(delimiter)]
    import csv

    return [c.strip() for c in next(csv.reader([line], delimiter=delimiter), [])]


def find_delimiter(lines: list[str]) -> str | None:
    """The delimiter by which most lines have the same number of cells, two or more; ';' and tab before ',',
    which may be a decimal mark."""
    if lines and lines[0].lower().startswith("sep=") and len(lines[0].strip()) == 5:
        return lines[0].strip()[-1]
    body = [line for line in lines if line.strip()]
    body = body[len(body) // 3:][-100:]                  # preamble has other lengths
    best: tuple[float, str] | None = None
    for delimiter in DELIMITERS:
        counts = [len(split(line, delimiter)) for line in body]
        common = max(set(counts), key=counts.count) if counts else 0
        share = counts.count(common) / len(counts) if counts else 0.0
        if common >= 2 and share > 0.6 and (best is None or share > best[0] + 0.2):
            best = (share, delimiter)
    return best[1] if best else None


def head_rows(text: str, declared: str | None) -> tuple[str, list[list[str]]] | None:
    """(delimiter, rows) of a file's first text; a last line without an end, which may be cut, is left out."""
    lines = text.splitlines()
    if len(lines) > 2 and not text.endswith(("\n", "\r")):
        lines.pop()
    lines = lines[:2000]
    delimiter = declared or find_delimiter(lines)
    if delimiter is None:
        return None
    return delimiter, [split(line, delimiter) for line in lines]


def open_sheet(path: Path, source: Source) -> Sheet:
    """The layout of a file from its first 256 KiB; the encoding from all of it."""
    said: Mapping[str, Any] = source.table or {}
    encoding, note = file_encoding(path, source.encoding)
    with path.open("rb") as file:
        data = file.read(_HEAD_BYTES)
    if not data:
        raise FormatError("an empty file", where=path.name, expected="a table")
    text = data.decode(encoding, "replace") if source.encoding or encoding.startswith("utf-16") else \
        (decode_head(data) if encoding.startswith("utf-8") else data.decode(encoding))
    text = (text or "").lstrip("\ufeff")
    found = head_rows(text, said.get("delimiter"))
    if found is None:
        raise FormatError("no delimiter gives lines of equal length", where=path.name,
                          expected="; tab , or |", hint="declare table: {delimiter: ...}")
    delimiter, rows = found
    if rows and len(rows[0]) <= 2 and text[:4].lower() == "sep=":
        rows[0] = [""]
    cut = _cut(path, encoding, delimiter)
    layout = find(rows, said, path.name)
    width = len(layout.names)
    body = [r + [""] * (width - len(r)) for r in rows[layout.first:]]
    numbers = [c for r in body for i, c in enumerate(r[:width]) if layout.seconds is not None or i not in layout.time]
    decimal = said.get("decimal") or (decimal_mark(numbers) if delimiter != "," else ".") or "."
    kinds = tuple(_kind(layout, i, [r[i] for r in body]) for i in range(width))
    notes = [*([note] if note else []), *layout.notes]
    return Sheet(encoding, delimiter, decimal, layout, kinds, '"' in text, tuple(notes), cut)


def _kind(layout: Layout, column: int, cells: list[str]) -> str:
    filled = [c for c in cells if c.strip().lower() not in _EMPTY]
    if not filled:
        named = layout.names[column].lower()
        return "str" if layout.units[column] is None and any(w in named for w in _TEXT_NAME) else "float64"
    good = sum(is_number(c) or c.strip().lower() in ("true", "false", "inf", "-inf") for c in filled)
    return "float64" if good * 2 > len(filled) else "str"


def _cut(path: Path, encoding: str, delimiter: str) -> str | None:
    """Why the last line may not be whole, or None."""
    with path.open("rb") as file:
        file.seek(max(0, path.stat().st_size - 65536))
        tail = file.read()
    if encoding.startswith("utf-16"):
        return "the file ends inside a character" if len(tail) % 2 else None
    if tail.endswith((b"\n", b"\r")) or b"\n" not in tail:
        return None
    lines = tail.decode("utf-8" if encoding.startswith("utf-8") else encoding, "replace").splitlines()
    if len(lines) < 2 or last_line_is_whole(lines[-1], lines[-2], delimiter):
        return None
    return "the last line has no end and is shorter than the one before: it is cut"


def describe(path: Path, source: Source) -> Recording:
    sheet = open_sheet(path, source)
    layout = sheet.layout
    signals = tuple(
        Signal(name, STREAM, layout.units[i], sheet.kinds[i])
        for i, name in enumerate(layout.names) if i not in layout.time
    )
    notes = list(sheet.notes)
    first = _first_stamps(path, sheet, source)
    notes += first.notes
    if sheet.cut:
        notes.append(sheet.cut)
    absolute = layout.seconds is None and first.absolute
    start = first.t_ns[first.t_ns != NAT]
    return Recording(signals, "absolute" if absolute else "relative", int(start[0]) if absolute and start.size else
                     (0 if absolute else None), False if sheet.cut else None, tuple(notes))


def _first_stamps(path: Path, sheet: Sheet, source: Source) -> stamps.Stamps:
    chunk = next(_chunks(path, sheet, 2000), None)
    if chunk is None:
        return stamps.Stamps(np.zeros(0, np.int64), sheet.layout.seconds is None, ())
    try:
        return _stamps(sheet, chunk, source, path.name)
    except FormatError:
        # which number is the day may show further down only
        return _all_stamps(path, sheet, source, 2000)


def _chunks(path: Path, sheet: Sheet, rows: int) -> Iterator[Any]:
    """DataFrames, one column a position: numbers where pandas reads all of a part's cells as such, else text;
    an empty cell is NaN. Column `width + i` holds cells that a line has too many."""
    import pandas as pd

    width = len(sheet.layout.names)
    # columns of numbers and words are told as a Loss; pandas' own warning about them would come besides
    warnings.filterwarnings("ignore", category=pd.errors.DtypeWarning)
    # pandas before 3 rounds the last digit unless told not to
    exact: dict[str, Any] = {} if int(pd.__version__.split(".")[0]) >= 3 else {"float_precision": "round_trip"}
    text = {i: str for i, kind in enumerate(sheet.kinds) if kind == "str"}
    if sheet.layout.seconds is None:
        text |= dict.fromkeys(sheet.layout.time, str)
    try:
        with pd.read_csv(
            path, sep=sheet.delimiter, header=None, names=list(range(width + _SPARE)), index_col=False, dtype=text,
            skiprows=sheet.layout.first, encoding=sheet.encoding, keep_default_na=False, na_values=[""],
            decimal=sheet.decimal,
            quoting=0 if sheet.quoted else 3, skip_blank_lines=True, chunksize=rows, encoding_errors="strict",
            engine="c", low_memory=True, on_bad_lines="error", **exact,
        ) as reader:
            yield from reader
    except pd.errors.EmptyDataError:
        return
    except (pd.errors.ParserError, UnicodeDecodeError) as error:
        raise FormatError("a line that does not fit the table", where=path.name, expected=f"{width} cells",
                          got=str(error).strip().splitlines()[-1]) from None


def _stamps(sheet: Sheet, chunk: Any, source: Source, where: str) -> stamps.Stamps:
    layout = sheet.layout
    if layout.seconds is not None:
        seconds, _ = _floats(chunk[layout.time[0]].to_numpy(), sheet.decimal)
        good = np.isfinite(seconds) & (np.abs(seconds * layout.seconds) < 9e9)
        t_ns = np.full(seconds.size, NAT, np.int64)
        t_ns[good] = np.rint(seconds[good] * (layout.seconds * 1e9)).astype(np.int64)
        return stamps.Stamps(t_ns, False, ())
    cells = chunk[layout.time[0]].fillna("")
    for column in layout.time[1:]:
        cells = cells.str.strip() + " " + chunk[column].fillna("").str.strip()
    return stamps.parse(cells.tolist(), source.timezone, layout.form, where)


def _all_stamps(path: Path, sheet: Sheet, source: Source, rows: int) -> stamps.Stamps:
    """Times of all rows: dates need the whole column (which hour repeats, which number is the day)."""
    if sheet.layout.seconds is not None:
        parts = [_stamps(sheet, c, source, path.name).t_ns for c in _chunks(path, sheet, rows)]
        return stamps.Stamps(np.concatenate(parts) if parts else np.zeros(0, np.int64), False, ())
    import pandas as pd

    kept = [c[list(sheet.layout.time)] for c in _chunks(path, sheet, rows)]
    if not kept:
        return stamps.Stamps(np.zeros(0, np.int64), True, ())
    return _stamps(sheet, pd.concat(kept), source, path.name)


def blocks(path: Path, source: Source) -> Iterator[Block | Loss]:
    sheet = open_sheet(path, source)
    layout, width = sheet.layout, len(sheet.layout.names)
    rows = max(1, int(source.options.get("block_rows", _BLOCK_VALUES // (width + _SPARE))))
    t_ns = _all_stamps(path, sheet, source, rows).t_ns
    total = t_ns.size - (1 if sheet.cut else 0)
    at, bad_times, bad_cells = 0, 0, dict[str, list[str]]()
    last_ns: int | None = None
    for chunk in _chunks(path, sheet, rows):
        t = t_ns[at:at + len(chunk)]
        good = (t != NAT) & (np.arange(at, at + len(chunk)) < total)
        spare = chunk.iloc[:, width:]
        good &= ~spare.notna().any(axis=1).to_numpy()
        bad_times += int((~good).sum()) - (1 if at + len(chunk) > total else 0)
        values: dict[str, Array] = {}
        for i, name in enumerate(layout.names):
            if i in layout.time:
                continue
            cells = chunk[i].to_numpy()
            if sheet.kinds[i] == "str":
                values[name] = np.array([clean(c) if isinstance(c, str) else "" for c in cells], object)[good]
                continue
            numbers, odd = _floats(cells, sheet.decimal)
            values[name] = numbers[good]
            if odd:
                bad_cells.setdefault(name, []).extend(odd)
        at += len(chunk)
        block = Block(STREAM, t[good], values)
        if block.t_ns.size:
            last_ns = int(block.t_ns[-1])
            yield block
    if at and bad_times * 2 > at:
        raise FormatError("most rows hold no time", where=path.name, got=f"{bad_times} of {at}",
                          hint="declare table: {time: {column: ..., format: ...}}")
    for name, odd in bad_cells.items():
        yield Loss(f"{path.name} column '{name}'", None, None, min(1.0, len(odd) / max(at, 1)),
                   f"{len(odd)} cells are no numbers, such as '{odd[0]}'")
    if bad_times:
        yield Loss(path.name, None, None, bad_times / at, f"{bad_times} rows without a time, or with too many cells")
    if sheet.cut:
        yield Loss(f"{path.name} row {layout.first + at}", last_ns, None, 1 / max(at, 1), sheet.cut)


def _floats(cells: Array, decimal: str) -> tuple[Array, list[str]]:
    """Numbers of a column; empty cells are NaN, and so are cells that are no numbers, which are named."""
    if cells.dtype.kind in "biuf":
        return cells.astype(np.float64), []
    # pandas reads a part of such a column as numbers where that part holds no word; NaN is an empty cell
    texts = [c.strip() if isinstance(c, str) else "" if c != c else repr(float(c)) for c in cells.tolist()]
    if decimal == ",":
        texts = [c.replace(",", ".") for c in texts]
    try:
        return np.array([c or "nan" for c in texts]).astype(np.float64), []
    except ValueError:
        pass
    out, odd = np.full(len(texts), np.nan), []
    for i, text in enumerate(texts):
        low = text.lower()
        if low in _EMPTY:
            continue
        try:
            out[i] = {"true": 1.0, "false": 0.0}[low] if low in ("true", "false") else float(text)
        except ValueError:
            odd.append(text)
    return out, odd
