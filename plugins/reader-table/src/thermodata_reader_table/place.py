"""Where a row stands in its file: the line of a text, the row of a sheet, of a row group, of an array, of a group.

Lines and sheets are counted, and held against the row's own values: where these do not stand there, the row is told
by its number only.
"""

from __future__ import annotations

import re
from collections.abc import Callable, Iterable, Iterator, Sequence
from pathlib import Path
from types import ModuleType
from typing import Any

import numpy as np

from thermodata.plugin import Block, Loss, Source
from thermodata.reader.text import clean

_CLEAN = re.compile(r"[ \u00a0\u202f'’%]")
_Record = tuple[int, Sequence[Any]]  # number of the line or row from 1, its cells
_Found = tuple[list[Any], int]  # a row's values, the rows of its stream


def place(module: ModuleType, path: Path, source: Source, stream: str, row: int) -> str | None:
    """Where a row (counted from 0) of a stream stands; None where that can't be told."""
    form = module.__name__.rsplit(".", 1)[-1]
    return (_in_workbook if form == "workbook" else _in_text)(module, path, source, stream, row)


def _in_text(module: ModuleType, path: Path, source: Source, stream: str, row: int) -> str | None:
    from thermodata_reader_table.delimited import open_sheet, split

    sheet = open_sheet(path, source)

    def records() -> Iterator[tuple[int, str]]:
        for number, text in _lines(path, sheet.encoding, sheet.quoted):
            if number > sheet.layout.first:
                yield number, text

    made = _numbered(
        module.blocks, path, source, stream, row, records, lambda text: split(text, sheet.delimiter), sheet.decimal
    )
    return None if made is None else f"line {made}"


def _lines(path: Path, encoding: str, quoted: bool) -> Iterator[tuple[int, str]]:
    """(number of its first line, text) of each record that is not empty; one in quotes may have several lines."""
    waiting, begin = "", 0
    with path.open(encoding=encoding, errors="replace") as file:
        for number, text in enumerate(file, 1):
            if waiting or (quoted and text.count('"') % 2):
                begin = begin if waiting else number
                waiting += text
                if waiting.count('"') % 2:
                    continue
                yield begin, waiting
                waiting = ""
            elif not text.isspace():
                yield number, text


def _in_workbook(module: ModuleType, path: Path, source: Source, stream: str, row: int) -> str | None:
    found = _values(module.blocks, path, source, stream, row)  # what is no safe workbook is refused here
    if found is None:
        return None
    import python_calamine

    book = python_calamine.CalamineWorkbook.from_path(str(path))
    wanted = (source.table or {}).get("sheet")
    if isinstance(wanted, str):
        names = [wanted]
    elif wanted is not None:
        names = [book.sheet_names[int(wanted) - 1]]
    else:
        names = [n for n in book.sheet_names if stream == n or stream.startswith(f"{n}/")] or list(book.sheet_names)
    for name in names:
        cells = book.get_sheet_by_name(name).to_python(skip_empty_area=False)
        rows = [(n, r) for n, r in enumerate(cells, 1) if any(c not in ("", None) for c in r)]

        def records(rows: list[_Record] = rows) -> Iterable[_Record]:
            return rows

        made = _numbered(module.blocks, path, source, stream, row, records, list, ".")
        if made is not None:
            return f"sheet '{name}', row {made}"
    return None


def _values(
    blocks: Callable[[Path, Source], Iterator[Block | Loss]], path: Path, source: Source, stream: str, row: int
) -> _Found | None:
    """(values of a row, rows of its stream); None where there is no such row."""
    done, values = 0, None
    for item in blocks(path, source):
        if isinstance(item, Block) and item.stream == stream:
            if values is None and row < done + item.t_ns.size:
                values = [v[row - done] for v in item.values.values()]
            done += item.t_ns.size
    return None if values is None else (values, done)


def _numbered(
    blocks: Callable[[Path, Source], Iterator[Block | Loss]],
    path: Path,
    source: Source,
    stream: str,
    row: int,
    records: Callable[[], Iterable[tuple[int, Any]]],
    split: Callable[[Any], Sequence[Any]],
    decimal: str,
) -> int | None:
    """The number of the record that is a row: the last ones, one a row, where each is one; else record by record."""
    found = _values(blocks, path, source, stream, row)
    if found is None:
        return None
    many = sum(1 for _ in records())
    if many == found[1]:
        number, text = next(r for k, r in enumerate(records()) if k == row)
        return number if _holds(split(text), found[0], decimal) else None
    left = iter(records())
    done = 0
    for item in blocks(path, source):
        if not isinstance(item, Block) or item.stream != stream:
            continue
        for values in zip(*item.values.values(), strict=True):
            at = next((n for n, text in left if _holds(split(text), values, decimal)), None)
            if at is None or done == row:
                return at
            done += 1
    return None


def _holds(cells: Sequence[Any], values: Sequence[Any], decimal: str) -> bool:
    """Whether a record's cells hold all values of a row that are there."""
    numbers: set[float] = set()
    words: set[str] = set()
    for cell in cells:
        words.add(clean(str(cell)))
        number = _number(cell, decimal)
        if number is not None:
            numbers.add(number)
    for value in values:
        if isinstance(value, str):
            if value and value not in words:
                return False
        elif value is not None and np.isfinite(value) and float(value) not in numbers:
            return False
    return True


def _number(cell: Any, decimal: str) -> float | None:
    if isinstance(cell, bool | int | float):
        return float(cell)
    text = str(cell).strip()
    if text.lower() in ("true", "false"):
        return float(text.lower() == "true")
    for plain in (text, _CLEAN.sub("", text).replace("." if decimal == "," else ",", "")):
        try:
            return float(plain.replace(",", ".") if decimal == "," else plain)
        except ValueError:
            continue
    return None
