"""Bin means of many tests at once: one aggregate query for each group of files, spread over the cores."""

from __future__ import annotations

from collections.abc import Callable, Collection, Iterable, Mapping, Sequence
from dataclasses import dataclass, field
from functools import partial
from typing import TYPE_CHECKING

import numpy as np

from thermodata.plugin import Array, Float1D, Int1D
from thermodata.schema.flag import INVALID, Flag
from thermodata.schema.units.quantity import UNDIRECTED
from thermodata.store.base.connection import quoted
from thermodata.store.views.catalogue import Column, Group, read_catalogue
from thermodata.store.views.grid import ONE_WAY, bin_index, bin_value, held_sums
from thermodata.store.views.wide import file_list
from thermodata.view.grid.floats import floats

if TYPE_CHECKING:
    import duckdb

Key = tuple[str, str]
_SUMS = ("__sum", "__size", "__for")
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
    periods = {
        tuple(row[:4]): row[4]
        for row in con.execute("select campaign, test, source, stream, max(step_s) from source group by all").fetchall()
    }
    binning = _Binning(con, step_s, wanted, _histories(con), periods, shifted)
    for group in read_catalogue(con).groups:
        if group.campaign in campaigns:
            binning.add(group)
    return binning.binned


def _histories(con: duckdb.DuckDBPyConnection) -> dict[tuple[str, ...], list[str]]:
    rows = con.execute(
        "select campaign, test, source, stream, path from file where layer = 'tidy' and part = 'history' order by path"
    ).fetchall()
    paths: dict[tuple[str, ...], list[str]] = {}
    for *key, path in rows:
        paths.setdefault(tuple(key), []).append(path)
    return paths


@dataclass(frozen=True, slots=True)
class _Binning:
    """history: (campaign, test, source, stream) -> files before the test's window. periods: of the same -> from sample
    to sample [s]. binned: what is made so far. wanted, shifted: as `bin_tests` has them."""

    con: duckdb.DuckDBPyConnection
    step_s: float
    wanted: Callable[[str], bool]
    history: Mapping[tuple[str, ...], list[str]]
    periods: Mapping[tuple[str, ...], float | None]
    shifted: Collection[tuple[str, str, str]]
    binned: dict[Key, Binned] = field(default_factory=dict)

    def add(self, group: Group) -> None:
        """Every test of a group of files."""
        owners, files = [], []
        for test, paths in group.paths.items():
            for path in (*self.history.get((group.campaign, test, group.source, group.stream), ()), *paths):
                owners.append(test)
                files.append(path)
        columns = [c for c in group.columns if not c.text and self.wanted(c.name)]
        off = {(test, name) for campaign, test, name in self.shifted if campaign == group.campaign}
        numbers = self._queried(files, columns, {name for _, name in off})
        for test, slices in _by_test(numbers["file__index"], owners).items():
            own = {name for at, name in off if at == test}
            self._collect(group, test, _Rows(numbers, slices, own), columns)

    def _queried(self, files: Sequence[str], columns: Sequence[Column], off: Collection[str]) -> dict[str, Array]:
        """Column -> shape (rows,), of all files in their order. off: names of sensors that are off in a test."""
        # file_index instead of filename: hashing a number a row instead of a text is twice as fast
        values = "".join(f", {bin_value(c)} as {quoted(c.name)}" for c in columns)
        values += "".join(f", {bin_value(c, _SHIFTED)} as {quoted(_as_read(c.name))}" for c in columns if c.name in off)
        step, rows = repr(float(self.step_s)), f"read_parquet({file_list(files)}, hive_partitioning = false)"
        sums = [held_sums(c, step) for c in columns if c.on_change]
        sums += [held_sums(c, step, _SHIFTED, _as_read(c.name)) for c in columns if c.on_change and c.name in off]
        if sums:
            values += "".join(f", {s}" for s in sums) + ", min(r.t_s) as first__s"
            rows = (
                f"(select *, file_index, lead(t_s) over (partition by file_index order by t_s) as next__s from {rows})"
            )
        result = self.con.execute(
            f"select r.file_index as file__index, {bin_index(step)} as bin__k, count(*) as rows__n, "
            f"min(epoch_ns(r.t) - cast(round(r.t_s * 1e9) as bigint)) as zero__ns{values} "
            f"from {rows} r group by 1, 2 order by 1, 2"
        ).fetchnumpy()
        return {
            name: floats(array)
            if name not in ("file__index", "bin__k", "zero__ns")
            else np.ma.getdata(array).astype(np.int64)
            for name, array in result.items()
        }

    def _collect(self, group: Group, test: str, rows: _Rows, columns: Iterable[Column]) -> None:
        k, many, zeros_ns = (rows.of(name) for name in ("bin__k", "rows__n", "zero__ns"))
        zero_ns = int(zeros_ns.min())
        binned = self.binned.setdefault((group.campaign, test), Binned(int(k.min()), int(k.max()), zero_ns))
        binned.first, binned.last = min(binned.first, int(k.min())), max(binned.last, int(k.max()))
        binned.zero_ns = min(binned.zero_ns, zero_ns)
        period = self.periods.get((group.campaign, test, group.source, group.stream))
        if not period:
            period = float((k.max() - k.min() + 1) * self.step_s / many.sum())
        for column in columns:
            series = _series(column, k.astype(np.int64), partial(rows.told, column.name), self.step_s, period)
            old = binned.series.get(column.name)
            # a channel in two groups is another source's empty column in one of them
            if old is None or series.k.size > old.k.size:
                binned.series[column.name] = series


def _by_test(index: Array, owners: Sequence[str]) -> dict[str, list[slice]]:
    """Test -> the rows of its files. index: of the file of each row, increasing. owners: the test of each file."""
    by_test: dict[str, list[slice]] = {}
    for i, test in enumerate(owners):
        start, stop = np.searchsorted(index, [i, i + 1])
        if stop > start:
            by_test.setdefault(test, []).append(slice(int(start), int(stop)))
    return by_test


@dataclass(frozen=True, slots=True)
class _Rows:
    """Of the aggregate query the rows of one test. off: names of its sensors that are off, which are told as they
    read."""

    numbers: Mapping[str, Array]
    slices: Sequence[slice]
    off: Collection[str]

    def of(self, name: str) -> Array:
        """A column, shape (n,)."""
        return np.concatenate([self.numbers[name][s] for s in self.slices])

    def told(self, channel: str, name: str) -> Float1D:
        """A column of a channel's, shape (n,)."""
        ending = name.removeprefix(channel)
        as_read = channel in self.off and ending in ("", *_SUMS)
        return self.of(_as_read(channel) + ending if as_read else name).astype(float)


def _as_read(name: str) -> str:
    return f"{name}__read"


def _series(column: Column, k: Int1D, told: Callable[[str], Float1D], step_s: float, period: float) -> Series:
    """k: bins that have rows, shape (n,). told: a column of the aggregate query, shape (n,)."""
    value = told(column.name)
    if not column.on_change:
        good = np.isfinite(value)
        return Series(k[good], value[good], period, value[good] if column.held else None)
    # a history stands before its test
    order = np.argsort(k, kind="stable")
    k, stands = k[order], value[order]
    total, size, lasted = (told(column.name + ending)[order] for ending in _SUMS)
    first_s = told("first__s")[order]
    until_then = np.concatenate([[np.nan], stands[:-1]])
    before = np.where(np.isfinite(until_then), np.maximum(first_s - k * step_s, 0.0), 0.0)
    earlier = np.nan_to_num(until_then) * before
    total, size, lasted = total + earlier, size + np.abs(earlier), lasted + before
    if column.quantity in UNDIRECTED:
        total = np.where(np.abs(total) < ONE_WAY * size, size, total)
    mean = total / np.where(lasted > 0, lasted, np.nan)
    return Series(k, mean, period, stands, True)
