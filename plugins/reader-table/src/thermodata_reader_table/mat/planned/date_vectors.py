"""Dates in several columns: a matrix of year, month, day, hour, minute and second in each row, as MATLAB's `datevec`
has them; a vector of weeks of GPS beside one of the times in them."""

from __future__ import annotations

import numpy as np

from thermodata.plugin import Array
from thermodata.reader.text.times.several_cells.gps_weeks import find_weeks, seconds_of_weeks
from thermodata_reader_table.mat.planned.stream_plan import LOOK, Plan, Scope, TimeVector, upwards
from thermodata_reader_table.mat.tree import Numbers

_RANGES = ((1900, 2200), (1, 12), (1, 31), (0, 23), (0, 59), (0, 60))
_PARTS = len(_RANGES)


def take_date_vectors(plan: Plan, scope: Scope) -> None:
    """The first matrix of dates of each length as the time of that length, where nothing else is it; another one that
    the campaign file names comes first."""
    for path, node in list(scope.matrices):
        if plan.wanted is not None and plan.wanted not in (path, path.rsplit("/", 1)[-1]):
            continue
        if plan.wanted is None and any(a.length == node.rows for level in upwards(scope) for a in level.times):
            continue
        dates = dates_of(node)
        if dates is not None:
            scope.times.append(TimeVector(path, len(dates), texts=dates))
            scope.matrices.remove((path, node))


def take_weeks(plan: Plan, scope: Scope) -> None:
    """A vector of weeks of GPS and one of the times in them as one time, where nothing else is the time."""
    names = [c.name.rsplit("/", 1)[-1] for c in scope.columns]
    rows = max((c.length for c in scope.columns), default=0)
    if plan.wanted is not None or any(level.times for level in upwards(scope)) or len(set(names)) < len(names):
        return
    first = [c.load(0, LOOK).tolist() if c.length == rows and c.dtype != "str" else [] for c in scope.columns]
    whole = [k for k, cells in enumerate(first) if cells]
    data = [list(row) for row in zip(*(first[k] for k in whole), strict=True)]
    found = find_weeks([names[k] for k in whole], data)
    if found is None:
        return
    (at, beside), form = found
    week, in_week = scope.columns[whole[at]], scope.columns[whole[beside]]

    def load(start: int, stop: int) -> Array:
        return seconds_of_weeks(week.load(start, stop), in_week.load(start, stop), form)

    scope.columns = [c for c in scope.columns if c not in (week, in_week)]
    scope.times.append(TimeVector(week.name, rows, load, unit="gps"))
    plan.notes.append(f"'{week.name}' and '{in_week.name}' are read as weeks of GPS and the times in them, in UTC")


def dates_of(node: Numbers) -> tuple[str, ...] | None:
    """The rows of a matrix as dates and times of day in text, '2026-03-02 07:00:00.500000'; None where its columns are
    none of a date in every row, or do not go on."""
    if node.columns != _PARTS or node.rows < 2 or not _are_dates(_parts(node, LOOK)):
        return None
    parts = _parts(node, node.rows)
    return None if not _are_dates(parts) else tuple(_text(row) for row in parts.T.tolist())


def _parts(node: Numbers, rows: int) -> Array:
    """Shape (6, n)."""
    return np.stack([np.asarray(node.line(i, 0, 0, rows), np.float64) for i in range(_PARTS)])


def _are_dates(parts: Array) -> bool:
    if not np.isfinite(parts).all() or (parts[:-1] % 1).any():
        return False
    inside = all(low <= p.min() and p.max() <= high for p, (low, high) in zip(parts, _RANGES, strict=True))
    return inside and bool((parts != parts[:, :1]).any()) and float(parts[-1].max()) < _RANGES[-1][1]


def _text(row: list[float]) -> str:
    year, month, day, hour, minute = (int(v) for v in row[:-1])
    micro = min(round(row[-1] * 1e6), 59_999_999)
    return f"{year:04d}-{month:02d}-{day:02d} {hour:02d}:{minute:02d}:{micro // 10**6:02d}.{micro % 10**6:06d}"
