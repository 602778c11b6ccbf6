"""Bin means of many tests at once: one aggregate query for each group of files, spread over the cores."""

from __future__ import annotations

from collections.abc import Callable, Collection, Iterable, Sequence
from dataclasses import dataclass, field
from typing import TYPE_CHECKING

import numpy as np

from thermodata.plugin import Float1D, Int1D
from thermodata.schema.flag import INVALID, Flag
from thermodata.store.base.connection import quoted
from thermodata.store.views.catalogue import Column, Group, read_catalogue
from thermodata.store.views.grid import bin_index, bin_value, held_sums
from thermodata.store.views.wide import file_list
from thermodata.view.grid.floats import floats

if TYPE_CHECKING:
    import duckdb

Key = tuple[str, str]
_SHIFTED = int(INVALID & ~Flag.OFFSET)  # the flags that rule a sample of a sensor out that is off by one number


@dataclass(frozen=True, slots=True)
class Series:
    """One channel of one test in the bins that have a valid sample.

    k: shape (n,), increasing bin numbers. value: shape (n,). period_s: of its source. stands: shape (n,), what stands
    from the end of each bin until the next one, NaN where nothing does; None of what is not held. on_change: it was
    logged when it changed, so that between its rows it is known.
    """

    k: Int1D
    value: Float1D
    period_s: float
    stands: Float1D | None = None
    on_change: bool = False


@dataclass(slots=True)
class Binned:
    """One test: its extent in bins over all sources, the time of t_s == 0, and its channels."""

    first: int
    last: int
    zero_ns: int
    series: dict[str, Series] = field(default_factory=dict)


def bin_tests(
    con: duckdb.DuckDBPyConnection,
    campaigns: Sequence[str],
    step_s: float,
    wanted: Callable[[str], bool],
    shifted: Collection[tuple[str, str, str]],
) -> dict[Key, Binned]:
    """(campaign, test) -> Binned, of every test that has tidy files; histories before windows included. shifted:
    (campaign, test, channel) of sensors that are off by one number through the test: as they read."""
    by_test: dict[Key, Binned] = {}
    history = _histories(con)
    periods = {
        tuple(row[:4]): row[4]
        for row in con.execute("select campaign, test, source, stream, max(step_s) from source group by all").fetchall()
    }
    for group in read_catalogue(con).groups:
        if group.campaign in campaigns:
            off = {(test, name) for campaign, test, name in shifted if campaign == group.campaign}
            _bin_group(con, group, step_s, wanted, history, periods, by_test, off)
    return by_test


def _histories(con: duckdb.DuckDBPyConnection) -> dict[tuple[str, ...], list[str]]:
    rows = con.execute(
        "select campaign, test, source, stream, path from file where layer = 'tidy' and part = 'history' order by path"
    ).fetchall()
    paths: dict[tuple[str, ...], list[str]] = {}
    for *key, path in rows:
        paths.setdefault(tuple(key), []).append(path)
    return paths


def _bin_group(
    con: duckdb.DuckDBPyConnection,
    group: Group,
    step_s: float,
    wanted: Callable[[str], bool],
    history: dict[tuple[str, ...], list[str]],
    periods: dict[tuple[str, ...], float | None],
    binned: dict[Key, Binned],
    shifted: Collection[tuple[str, str]],
) -> None:
    owners, files = [], []
    for test, paths in group.paths.items():
        for path in (*history.get((group.campaign, test, group.source, group.stream), ()), *paths):
            owners.append(test)
            files.append(path)
    columns = [c for c in group.columns if not c.text and wanted(c.name)]
    # file_index instead of filename: hashing a number a row instead of a text is twice as fast
    values = "".join(f", {bin_value(c)} as {quoted(c.name)}" for c in columns)
    off = {name for _, name in shifted}
    values += "".join(f", {bin_value(c, _SHIFTED)} as {quoted(_as_read(c.name))}" for c in columns if c.name in off)
    step, rows = repr(float(step_s)), f"read_parquet({file_list(files)}, hive_partitioning = false)"
    sums = [held_sums(c, step) for c in columns if c.on_change]
    sums += [held_sums(c, step, _SHIFTED, _as_read(c.name)) for c in columns if c.on_change and c.name in off]
    if sums:
        values += "".join(f", {s}" for s in sums) + ", min(r.t_s) as first__s"
        rows = f"(select *, file_index, lead(t_s) over (partition by file_index order by t_s) as next__s from {rows})"
    result = con.execute(
        f"select r.file_index as file__index, {bin_index(step)} as bin__k, count(*) as rows__n, "
        f"min(epoch_ns(r.t) - cast(round(r.t_s * 1e9) as bigint)) as zero__ns{values} "
        f"from {rows} r group by 1, 2 order by 1, 2"
    ).fetchnumpy()
    numbers = {
        name: floats(array)
        if name not in ("file__index", "bin__k", "zero__ns")
        else np.ma.getdata(array).astype(np.int64)
        for name, array in result.items()
    }
    by_test: dict[str, list[slice]] = {}
    index = numbers["file__index"]
    for i, test in enumerate(owners):
        start, stop = np.searchsorted(index, [i, i + 1])
        if stop > start:
            by_test.setdefault(test, []).append(slice(int(start), int(stop)))
    for test, slices in by_test.items():
        _collect(
            binned,
            group,
            test,
            slices,
            columns,
            numbers,
            step_s,
            periods.get((group.campaign, test, group.source, group.stream)),
            {name for at, name in shifted if at == test},
        )


def _as_read(name: str) -> str:
    return f"{name}__read"


def _joined(numbers: dict[str, Float1D | Int1D], name: str, slices: Sequence[slice]) -> Float1D:
    return np.concatenate([numbers[name][s] for s in slices]).astype(float)


def _series(column: Column, k: Int1D, told: Callable[[str], Float1D], step_s: float, period: float) -> Series:
    """k: bins that have rows, shape (n,). told: a column of the aggregate query, shape (n,)."""
    value = told(column.name)
    if not column.on_change:
        good = np.isfinite(value)
        return Series(k[good], value[good], period, value[good] if column.held else None)
    # a history stands before its test
    order = np.argsort(k, kind="stable")
    k, stands = k[order], value[order]
    total, lasted, first_s = (told(name)[order] for name in (f"{column.name}__sum", f"{column.name}__for", "first__s"))
    until_then = np.concatenate([[np.nan], stands[:-1]])
    before = np.where(np.isfinite(until_then), np.maximum(first_s - k * step_s, 0.0), 0.0)
    lasted = lasted + before
    mean = (total + np.nan_to_num(until_then) * before) / np.where(lasted > 0, lasted, np.nan)
    return Series(k, mean, period, stands, True)


def _collect(
    by_test: dict[Key, Binned],
    group: Group,
    test: str,
    slices: Sequence[slice],
    columns: Iterable[Column],
    numbers: dict[str, Float1D | Int1D],
    step_s: float,
    period: float | None,
    shifted: Collection[str],
) -> None:
    k, rows = (np.concatenate([numbers[name][s] for s in slices]) for name in ("bin__k", "rows__n"))
    zero_ns = min(int(numbers["zero__ns"][s].min()) for s in slices)
    binned = by_test.setdefault((group.campaign, test), Binned(int(k.min()), int(k.max()), zero_ns))
    binned.first, binned.last = min(binned.first, int(k.min())), max(binned.last, int(k.max()))
    binned.zero_ns = min(binned.zero_ns, zero_ns)
    if not period:
        period = float((k.max() - k.min() + 1) * step_s / rows.sum())
    for column in columns:

        def told(name: str, own: str = column.name) -> Float1D:
            is_own = own in shifted and name.removeprefix(own) in ("", "__sum", "__for")
            return _joined(numbers, _as_read(own) + name.removeprefix(own) if is_own else name, slices)

        series = _series(column, k.astype(np.int64), told, step_s, period)
        old = binned.series.get(column.name)
        # a channel in two groups is another source's empty column in one of them
        if old is None or series.k.size > old.k.size:
            binned.series[column.name] = series
