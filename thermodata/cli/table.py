"""Neat text tables: one line a row, numbers to the right, units in the heading."""

from __future__ import annotations

from collections.abc import Iterable, Mapping, Sequence
from typing import Any

from thermodata.report.words import number

Column = tuple[str, str]  # (key of the row, heading)


def cell(value: Any) -> str:
    """One value as a cell: '-' for nothing, lists joined."""
    if isinstance(value, bool):
        return "yes" if value else "no"
    if isinstance(value, float | int) or value is None:
        return number(value)
    if isinstance(value, Mapping):
        return ", ".join(f"{k} {cell(v)}" for k, v in value.items()) or "-"
    if isinstance(value, list | tuple):
        return ", ".join(cell(v) for v in value) or "-"
    text = str(value)
    return " ".join(text.split()) or "-"


def table(rows: Sequence[Mapping[str, Any]], columns: Iterable[Column], *, widest: int = 60) -> str:
    """Aligned text; columns of numbers to the right, texts longer than `widest` cut with '…'."""
    columns = list(columns)
    cells = [[cell(row.get(key)) for key, _ in columns] for row in rows]
    cells = [[c if len(c) <= widest else c[: widest - 1] + "…" for c in line] for line in cells]
    right = [
        all(isinstance(row.get(key), int | float) or row.get(key) is None for row in rows)
        and any(row.get(key) is not None and not isinstance(row.get(key), bool) for row in rows)
        for key, _ in columns
    ]
    heads = [heading for _, heading in columns]
    widths = [max([len(h), *(len(line[i]) for line in cells)]) for i, h in enumerate(heads)]

    def line(parts: Sequence[str]) -> str:
        return "  ".join(p.rjust(w) if r else p.ljust(w) for p, w, r in zip(parts, widths, right, strict=True)).rstrip()

    return "\n".join([line(heads), line(["─" * w for w in widths]), *(line(c) for c in cells)])


def fields(pairs: Iterable[tuple[str, Any]]) -> str:
    """Names and values, one a line, values aligned."""
    shown = [(name, cell(value)) for name, value in pairs]
    width = max((len(name) for name, _ in shown), default=0)
    return "\n".join(f"{name.ljust(width)}  {value}" for name, value in shown)
