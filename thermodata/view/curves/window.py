"""A stretch of a test's channels for a screen: every sample where there are few, the extremes of each bin where there
are many."""

from __future__ import annotations

from collections.abc import Iterator, Mapping, Sequence
from contextlib import contextmanager
from dataclasses import dataclass
from pathlib import Path
from typing import TYPE_CHECKING

import numpy as np

from thermodata.errors import unknown_name
from thermodata.plugin import Float1D
from thermodata.schema.flag import INVALID
from thermodata.store.base.connection import damaged_file, fetch, quoted
from thermodata.store.views.wide import file_list
from thermodata.view.grid.floats import floats

if TYPE_CHECKING:
    import duckdb

    from thermodata.store import Store

MOST_SAMPLES = 2_400
_CLEARLY = 4  # times as many samples as are drawn: by far, though a logger's rate changes
_MOST_FACTS = 256
Extent = tuple[float, float, int]  # first and last time [s], number of samples
_FACTS: dict[tuple[tuple[str, int, int], ...], tuple[set[str], Extent]] = {}


@dataclass(frozen=True, slots=True)
class Channel:
    """A channel of numbers in a test. held: a state that stands until its next sample."""

    name: str
    quantity: str
    unit: str
    at: str | None
    axis: str | None
    source: str
    stream: str
    held: bool = False


@dataclass(frozen=True, slots=True)
class Window:
    """Channels of one stream. t_s: shape (n,) [s] from the test's start. values: channel -> shape (n,), NaN where no
    sample counts. each: whether these are the samples themselves, else the lowest and the highest of each bin."""

    t_s: Float1D
    values: dict[str, Float1D]
    each: bool


def channels_of(store: Store, campaign: str, test: str) -> list[Channel]:
    """In the campaign's order. UsageError for a campaign or a test that there is not."""
    with store.reader() as con:
        tests = [r["test"] for r in fetch(con, "select test from test where campaign = ?", [campaign])]
        if not tests:
            campaigns = [r["campaign"] for r in fetch(con, "select campaign from campaign")]
            raise unknown_name("campaign", campaign, campaigns)
        if test not in tests:
            raise unknown_name("test", test, tests)
        rows = fetch(
            con,
            'select channel, quantity, unit, "at", axis, source, stream from channel '
            "where campaign = ? and test = ? and quantity <> 'label' order by rowid",
            [campaign, test],
        )
    return [
        Channel(
            r["channel"],
            r["quantity"],
            r["unit"],
            r["at"],
            r["axis"],
            r["source"] or "",
            r["stream"] or "",
            r["quantity"] == "state",
        )
        for r in rows
    ]


def read_window(
    store: Store,
    campaign: str,
    test: str,
    channels: Sequence[Channel],
    span: tuple[float, float] | None = None,
    *,
    flagged: bool = False,
    most: int = MOST_SAMPLES,
) -> list[Window]:
    """One window a stream that has any of the channels. span: (from, to) [s], all where None. flagged: samples that do
    not count are shown too. Reads the columns that are asked for, and no more of the file than the span. StoreError
    where a file is gone, cut or altered."""
    streams: dict[tuple[str, str], list[str]] = {}
    for channel in channels:
        streams.setdefault((channel.source, channel.stream), []).append(channel.name)
    found = []
    with store.reader() as con:
        for (source, stream), names in streams.items():
            files = fetch(
                con,
                "select path from file where layer = 'tidy' and part = 'test' and campaign = ? and test = ? "
                "and source = ? and stream = ? order by path",
                [campaign, test, source, stream],
            )
            if files:
                paths = [f["path"] for f in files]
                with _damage_named([store.path / p for p in paths]):
                    found.append(_window(con, store.path, paths, names, _AskedStretch(span, flagged, most)))
    return found


@contextmanager
def _damage_named(files: Sequence[Path]) -> Iterator[None]:
    """StoreError with the file's name where one of these is gone, cut or altered."""
    import duckdb

    from thermodata.store.keep.check import altered

    try:
        yield
    except (duckdb.Error, OSError) as error:
        # DuckDB does not name the file in all of its errors
        found = ((p, "gone" if not p.exists() else altered(p)) for p in files)
        damaged = next(((p, problem) for p, problem in found if problem), None)
        if damaged is None:
            raise
        raise damaged_file(*damaged) from error


def _facts(con: duckdb.DuckDBPyConnection, table: str, files: Sequence[Path]) -> tuple[set[str], Extent]:
    """Columns and extent of a stream's files, asked once: a tidy file is final, under the name of its content."""
    key = tuple((str(p), at.st_mtime_ns, at.st_size) for p in files for at in [p.stat()])
    known = _FACTS.get(key)  # held here: another thread may clear the store of facts at any moment
    if known is None:
        there = {row[0] for row in con.execute(f"describe select * from {table}").fetchall()}
        row = con.execute(f"select min(t_s), max(t_s), count(*) from {table}").fetchone()
        if len(_FACTS) >= _MOST_FACTS:
            _FACTS.clear()
        known = there, (row[0], row[1], row[2]) if row and row[2] else (0.0, 0.0, 0)
        _FACTS[key] = known
    return known


@dataclass(frozen=True, slots=True)
class _AskedStretch:
    """What a screen asks of a stretch. span: (from, to) [s], all where None; most: samples that it draws."""

    span: tuple[float, float] | None
    flagged: bool
    most: int

    def value(self, name: str) -> str:
        """A channel's value as SQL, NULL where it does not count and only what does is asked for."""
        counts = f"{quoted(name + '__flag')} & {int(INVALID)} = 0"
        return quoted(name) if self.flagged else f"case when {counts} then {quoted(name)} end"


@dataclass(frozen=True, slots=True)
class _Stretch:
    """Rows of a stream's files. table: these, as SQL; values: channel -> its value, as SQL; low, high: first and last
    time [s]."""

    con: duckdb.DuckDBPyConnection
    table: str
    values: Mapping[str, str]
    low: float
    high: float

    @property
    def where(self) -> str:
        return f"t_s between {self.low!r} and {self.high!r}"

    def each(self) -> Window:
        """The samples themselves."""
        columns = ", ".join(f"cast({v} as double) as {quoted(n)}" for n, v in self.values.items())
        got = self.con.execute(
            f"select t_s as t__s, {columns} from {self.table} where {self.where} order by t_s"
        ).fetchnumpy()
        return Window(floats(got["t__s"]), {n: floats(got[n]) for n in self.values}, True)

    def binned(self, bins: int) -> tuple[Window, int]:
        """The lowest and the highest of each bin, and how many samples there are in all: one pass tells both."""
        width = (self.high - self.low) / bins or 1.0
        columns = ", ".join(
            f"min(cast({v} as double)) as {quoted(n + '__low')}, max(cast({v} as double)) as {quoted(n + '__high')}"
            for n, v in self.values.items()
        )
        got = self.con.execute(
            f"select least(cast(floor((t_s - {self.low!r}) / {width!r}) as integer), {bins - 1}) as bin__k, "
            f"count(*) as bin__n, {columns} from {self.table} where {self.where} group by 1 order by 1"
        ).fetchnumpy()
        at = np.asarray(got["bin__k"], dtype=np.int64)
        t_s = self.low + (np.repeat(np.arange(bins), 2) + np.tile([0.25, 0.75], bins)) * width
        out = {}
        for n in self.values:
            both = np.full((bins, 2), np.nan)
            both[at, 0], both[at, 1] = floats(got[n + "__low"]), floats(got[n + "__high"])
            out[n] = both.ravel()
        return Window(t_s, out, False), int(np.sum(got["bin__n"]))


def _window(
    con: duckdb.DuckDBPyConnection, folder: Path, paths: Sequence[str], names: Sequence[str], asked: _AskedStretch
) -> Window:
    table = f"read_parquet({file_list(paths)}, hive_partitioning = false)"
    there, (low, high, count) = _facts(con, table, [folder / p for p in paths])
    names = [n for n in names if n in there]
    if asked.span is not None:
        start, stop = asked.span
        share = (min(high, stop) - max(low, start)) / (high - low or 1.0)
        low, high = max(low, start), min(high, stop)
        if count * share < _CLEARLY * asked.most:  # where there are clearly many, how many exactly decides nothing
            inside = con.execute(f"select count(*) from {table} where t_s between ? and ?", [low, high]).fetchone()
            count = inside[0] if inside else 0
    if not names or not count:
        return _empty_window(names)
    stretch = _Stretch(con, table, {n: asked.value(n) for n in names}, low, high)
    if count > asked.most:
        window, count = stretch.binned(asked.most // 2)
        if count > asked.most:
            return window
        if not count:
            return _empty_window(names)
    # few samples, also where a logger that was fast elsewhere promised many
    return stretch.each()


def _empty_window(names: Sequence[str]) -> Window:
    return Window(np.empty(0), {n: np.empty(0) for n in names}, True)
