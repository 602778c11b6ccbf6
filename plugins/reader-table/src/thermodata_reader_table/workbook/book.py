"""A workbook as the cells of its sheets, read by calamine."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from functools import lru_cache
from pathlib import Path
from typing import Any

from thermodata.archive.workbook import odd_cells
from thermodata.errors import FormatError, UsageError
from thermodata.plugin import Source
from thermodata_reader_table.workbook.percent import counts_from_1904, percent_columns

_SMALL = 8_000_000


@dataclass(frozen=True)
class Sheet:
    """Cells of a sheet. rows: down to the last that holds something; percent: column -> numbers that are shown in per
    cent; from_1904: whether days count from there, not from 1900."""

    name: str
    rows: list[list[Any]]
    percent: Mapping[int, int]
    from_1904: bool


@dataclass(frozen=True)
class Book:
    """sheets: by their names, those that are wanted and hold some rows. odd: what odd_cells() counted."""

    sheets: dict[str, Sheet]
    odd: dict[str, int]


def book_of(path: Path, source: Source) -> Book:
    """The sheets of a workbook that are wanted. Small ones are kept: describing and reading follow each other.
    FormatError where it can't be read or holds nothing, UsageError where a sheet is wanted that it has not."""
    status = path.stat()
    key = (str(path.resolve()), status.st_mtime_ns, status.st_size, (source.table or {}).get("sheet"))
    return (_kept if status.st_size < _SMALL else _load)(*key)


def _load(name: str, mtime_ns: int, size: int, wanted: int | str | None) -> Book:
    import python_calamine

    path = Path(name)
    odd = odd_cells(path)
    try:
        book = python_calamine.CalamineWorkbook.from_path(str(path))
    except Exception as error:  # calamine has many error classes, all of which mean: not this file
        raise FormatError(
            "not a readable workbook",
            where=path.name,
            got=str(error),
            hint="open and save it in Excel or LibreOffice, or export the sheet as CSV",
        ) from None
    names = _sheets_asked(book.sheet_names, wanted, path.name)
    rows = {sheet: found for sheet in names if (found := _rows(book, sheet, path.name))}
    if not rows:
        raise FormatError(
            f"sheet '{names[0]}' is empty" if names else "a workbook without sheets",
            where=path.name,
            expected="a table",
            hint="name another sheet: table: {sheet: NAME}",
        )
    percent, from_1904 = percent_columns(path), counts_from_1904(path)
    return Book({name: Sheet(name, cells, percent.get(name, {}), from_1904) for name, cells in rows.items()}, odd)


def _sheets_asked(names: Sequence[str], wanted: int | str | None, where: str) -> Sequence[str]:
    """The sheets that a source is read from: the one that it declares, by its name or its number from 1, or all.
    UsageError where there is none such."""
    if wanted is None:
        return names
    if isinstance(wanted, str):
        if wanted not in names:
            raise UsageError(
                f"no sheet '{wanted}'",
                where=where,
                expected=", ".join(names),
                got=wanted,
                hint="correct table: {sheet: ...}, or leave it out: every sheet with a table is read",
            )
        return [wanted]
    number = int(wanted)
    if not 1 <= number <= len(names):
        raise UsageError(
            f"no sheet {number}",
            where=where,
            expected=f"1 to {len(names)}",
            got=str(number),
            hint="sheets count from 1; or give the name",
        )
    return [names[number - 1]]


def _rows(book: Any, sheet: str, where: str) -> list[list[Any]]:
    """The rows of a sheet, down to the last that holds something. book: calamine's."""
    try:
        rows: list[list[Any]] = book.get_sheet_by_name(sheet).to_python(skip_empty_area=False)
    except Exception as error:
        raise FormatError(
            f"sheet '{sheet}' cannot be read",
            where=where,
            got=str(error),
            hint="declare table: {sheet: ...} to read another one alone",
        ) from None
    while rows and not any(c not in ("", None) for c in rows[-1]):
        rows.pop()
    return rows


_kept = lru_cache(maxsize=1)(_load)
