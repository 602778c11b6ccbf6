"""One sample of the tidy layer and the raw rows behind it."""

from __future__ import annotations

from collections.abc import Callable, Mapping
from dataclasses import dataclass
from pathlib import Path
from typing import TYPE_CHECKING, Any

import numpy as np

from thermodata.errors import UsageError
from thermodata.schema.flag import Flag
from thermodata.schema.units.quantity import STATES
from thermodata.store.base.connection import fetch, quoted
from thermodata.store.raw.columns import read_column
from thermodata.store.raw.raw_stream import RawStream
from thermodata.store.tidy.plan import derive
from thermodata.store.tidy.plan.plan import SCHEDULE
from thermodata.store.tidy.values.series import Member, TestSeries
from thermodata.store.trace.replan import raw_row_of, read_series

if TYPE_CHECKING:
    import duckdb

Answer = dict[str, Any]
Again = Callable[[RawStream, int, str, str], Answer]


@dataclass(frozen=True, slots=True)
class _Place:
    """Where the sample of a channel stands: its stream, the row there, and its time. again: see `find_sample`."""

    series: TestSeries
    member: Member
    at: int
    t_ns: int
    again: Again | None


_NEAR_S, _NEAR = 1.0, 0.05  # a time that was rounded lies no farther beyond the test [s], [of its length]


def find_sample(
    con: duckdb.DuckDBPyConnection,
    store: Path,
    campaign: str,
    test: str,
    channel: Mapping[str, Any],
    t_s: float,
    again: Again | None,
) -> Answer:
    """The sample of a channel nearest to t_s [s from the test's start], and where it stands in the source files.

    raw: file, hash, row (counted from 0) and raw value; None for derived and scheduled channels, whose `operands`
    tell the rows that they were made from: two where one was interpolated, or a rate was taken. again: reads a row in
    its file once more.
    """
    row = _tidy_row(con, campaign, test, channel, t_s)
    series = read_series(con, store, campaign, test)
    member = (channel["source"], channel["stream"])
    rows = series.rows(member)
    at = (rows.start if row.pop("part") == "test" else rows.history) + row["tidy"]["row"]
    place = _Place(series, member, at, row["t_ns"], again)
    flags = row.pop("flags_set")
    sample = row | {
        "t": str(np.datetime64(row["t_ns"], "ns")) + "Z" if not series.span.relative else None,
        "flags": [f.word for f in Flag if f and flags & f],
        "raw": None,
    }
    bound = series.plan.bound.get(channel["channel"])
    if bound is not None and bound.signal is not None:
        sample["raw"] = _raw(place, member, at, bound.signal.name)
    elif bound is not None and bound.channel.derive is not None:
        rated = _rated_channels(series, channel["channel"])
        sample["operands"] = [
            item
            for name in _logged_channels(series, channel["channel"])
            for item in _behind(place, name, rated=name in rated)
        ]
    return sample


def _tidy_row(
    con: duckdb.DuckDBPyConnection, campaign: str, test: str, channel: Mapping[str, Any], t_s: float
) -> Answer:
    name = channel["channel"]
    files = fetch(
        con,
        "select path, part from file where campaign = ? and test = ? and source = ? and stream = ? and "
        "layer = 'tidy' and list_contains(from_json(columns->'$.channels', '[\"VARCHAR\"]'), ?)",
        [campaign, test, channel["source"], channel["stream"], name],
    )
    best: Answer | None = None
    for file in files:
        listed = fetch(
            con,
            f"select file_row_number as row, epoch_ns(t) as t_ns, t_s, {quoted(name)} as value, "
            f"{quoted(name + '__flag')} as flag from read_parquet(?, file_row_number = true, "
            "hive_partitioning = false) order by abs(t_s - ?), row limit 1",
            [file["path"], t_s],
        )
        if listed and (best is None or abs(listed[0]["t_s"] - t_s) < abs(best["t_s"] - t_s)):
            best = {
                "t_ns": listed[0]["t_ns"],
                "t_s": listed[0]["t_s"],
                "value": listed[0]["value"],
                "flag": listed[0]["flag"],
                "flags_set": listed[0]["flag"] or 0,
                "part": file["part"],
                "tidy": {"path": file["path"], "row": listed[0]["row"]},
            }
    if best is None:
        raise UsageError(
            f"channel '{name}' has no samples in test '{test}'",
            hint="'thermodata channels' says which tests have it",
        )
    (known,) = fetch(con, "select duration_s from test where campaign = ? and test = ?", [campaign, test])
    end_s = max(float(known["duration_s"] or 0.0), best["t_s"])
    near_s = max(_NEAR_S, _NEAR * end_s)
    if t_s > end_s + near_s or t_s < min(best["t_s"], 0.0) - near_s:
        raise UsageError(
            f"test '{test}' has no sample at {t_s:g} s",
            where=f"channel {name}",
            expected=f"a time from {min(best['t_s'], 0.0):g} s to {end_s:g} s ({end_s / 3600:.4g} h)",
            got=f"{t_s:g} s ({t_s / 3600:.4g} h)",
            hint=f"its nearest sample is at {best['t_s']:g} s",
        )
    return best


def _logged_channels(series: TestSeries, name: str) -> list[str]:
    """The logged and scheduled channels that a derived one comes from."""
    bound = series.plan.bound[name]
    if bound.channel.derive is None:
        return [name]
    return list(
        dict.fromkeys(
            origin
            for n in sorted(derive.names(bound.channel.derive))
            if n in series.plan.bound
            for origin in _logged_channels(series, n)
        )
    )


def _rated_channels(series: TestSeries, name: str) -> set[str]:
    """Those among them whose rate it takes."""
    text = series.plan.bound[name].channel.derive if name in series.plan.bound else None
    if text is None:
        return set()
    return set(derive.rated(text)).union(*(_rated_channels(series, n) for n in derive.names(text)))


def _behind(place: _Place, name: str, *, rated: bool) -> list[Answer]:
    """The raw rows of a channel that a sample was made from. rated: whether its rate was taken."""
    series = place.series
    bound = series.plan.bound[name]
    member = (bound.source, bound.stream)
    if bound.signal is None or member[0] == SCHEDULE:
        return [{"channel": name, "schedule": True}]
    if member == place.member:
        rows = series.rows_of_rate(bound, place.at) if rated else [place.at]
    else:
        line = series.timeline(member)
        after = line.find(place.t_ns)
        exact = after < line.rows and int(line.times(after, after + 1)[0]) == place.t_ns
        held = bound.channel.quantity in STATES or series.as_written(bound).is_held
        rows = [after] if exact else [r for r in ((after - 1,) if held else (after - 1, after)) if 0 <= r < line.rows]
    return [{"channel": name, **_raw(place, member, r, bound.signal.name)} for r in rows]


def _raw(place: _Place, member: Member, at: int, signal: str) -> Answer:
    """A row of a stream in its raw file."""
    series, again = place.series, place.again
    placed = raw_row_of(series, member, at)
    if placed is None:
        return {}
    raw, row = placed
    signal = series.timeline(member).part(raw, signal).name
    column = raw.columns.get(signal)
    if column is None:
        return {"source_path": raw.source_path, "sha256": raw.sha256, "row": row, "raw_value": None}
    read = read_column(series.store / raw.path, column, row, row + 1)[0]
    flag = int(read_column(series.store / raw.path, f"{column}__flag", row, row + 1)[0]) if signal in raw.flagged else 0
    entry = {
        "source_path": raw.source_path,
        "sha256": raw.sha256,
        "stream": raw.stream,
        "signal": signal,
        "row": row,
        "rows": raw.rows,
        "t_ns": int(read_column(series.store / raw.path, "t_ns", row, row + 1)[0]),
        "clock": raw.clock,
        "raw_value": read.item() if hasattr(read, "item") else read,
        "raw_flag": flag,
    }
    return entry | ({"again": again(raw, row, signal, member[0])} if again else {})
