"""The tidy layer: calibrated channels of one (test, source, stream) as one wide Parquet file, flags beside values."""

from __future__ import annotations

from collections import Counter
from collections.abc import Sequence
from concurrent.futures import ThreadPoolExecutor
from dataclasses import dataclass, field
from typing import TYPE_CHECKING, Any

import numpy as np

from thermodata.errors import ThermodataError
from thermodata.plugin import Array, Int1D, Loss
from thermodata.schema.flag import Flag
from thermodata.store.encoder import Encoder
from thermodata.store.files import publish, temporary
from thermodata.store.plan import Bound
from thermodata.store.quality import Event, Quality
from thermodata.store.series import Member, TestSeries

if TYPE_CHECKING:
    import pyarrow as pa

GROUP_VALUES = 1_000_000
HELD_VALUES = 40_000_000       # up to here a stream's values stay in memory between flagging and writing [320 MB]


@dataclass(slots=True)
class TidyFile:
    """part: test | history. path: relative to the store."""

    part: str
    path: str
    key: str
    rows: int
    columns: list[str]


@dataclass(slots=True)
class TidyResult:
    files: list[TidyFile] = field(default_factory=list)
    events: list[Event] = field(default_factory=list)
    flags: Counter[str] = field(default_factory=Counter)
    samples: int = 0
    losses: list[Loss] = field(default_factory=list)
    problems: list[str] = field(default_factory=list)


@dataclass(slots=True)
class _Column:
    bound: Bound
    values: Array | None           # None: read again when it is written
    flags: Array


def write_member(series: TestSeries, member: Member, columns: Sequence[tuple[str, bool]], key: str,
                 quality: Quality) -> TidyResult:
    """Makes the tidy files of one stream of a test.

    columns: (channel, is text) of the campaign's stream, in the campaign's order; one that this test lacks is NULL.
    A channel that can't be calibrated is NULL and a problem; the others are written.
    """
    result = TidyResult()
    line, rows = series.timeline(member), series.rows(member)
    result.losses += line.losses
    t_ns = line.t_ns[rows.history:rows.stop]
    if not len(t_ns):
        result.problems.append(f"test '{series.plan.test.id}': no rows of '{member[0]}' lie in the test's window")
        return result
    here = [b for b in series.plan.bound.values() if (b.source, b.stream) == member]
    hold = len(t_ns) * len(here) <= HELD_VALUES
    made = _flagged(series, here, rows.history, rows.stop, t_ns, quality, hold, result)
    for part, start, stop in (("history", rows.history, rows.start), ("test", rows.start, rows.stop)):
        if start == stop:
            continue
        name = f"{key}.parquet" if part == "test" else f"{key}.history.parquet"
        _write(series, t_ns, made, columns, rows.history, start, stop, name)
        result.files.append(TidyFile(part, f"tidy/{name}", key, stop - start, [c for c, _ in columns]))
    _count(result, made, rows.start - rows.history, rows.stop - rows.history)
    return result


def _flagged(series: TestSeries, here: Sequence[Bound], start: int, stop: int, t_ns: Int1D, quality: Quality,
             hold: bool, result: TidyResult) -> dict[str, _Column]:
    def one(bound: Bound) -> tuple[_Column, list[Event]] | str:
        try:
            values, flags = series.values(bound, start, stop)
        except ThermodataError as error:
            return f"channel '{bound.name}' in test '{series.plan.test.id}': " + "; ".join(str(error).splitlines())
        flags, events = quality.column(bound, t_ns, values, flags)
        return _Column(bound, values if hold else None, flags), events

    made: dict[str, _Column] = {}
    with ThreadPoolExecutor(2) as pool:
        for bound, answer in zip(here, pool.map(one, here), strict=True):
            if isinstance(answer, str):
                result.problems.append(answer)
            else:
                made[bound.name] = answer[0]
                result.events += answer[1]
    result.events += quality.stream(here, t_ns)
    return made


def _write(series: TestSeries, t_ns: Int1D, made: dict[str, _Column], columns: Sequence[tuple[str, bool]],
           base: int, start: int, stop: int, name: str) -> None:
    """Rows start to stop of the timeline, in row groups; base: the timeline row of t_ns[0]."""
    import pyarrow as pa

    schema = tidy_schema(columns)
    target = series.store / "tidy" / name
    target.parent.mkdir(exist_ok=True)
    step = max(2048, GROUP_VALUES // (len(columns) + 1))
    encoder = Encoder(temporary(target), schema)
    try:
        for a in range(start, stop, step):
            b = min(a + step, stop)
            t = t_ns[a - base:b - base]
            arrays: list[Any] = [pa.array(t.view("datetime64[ns]")), pa.array(series.t_s(t))]
            for channel, is_text in columns:
                arrays += _pair(series, made.get(channel), is_text, a, b, base)
            encoder.put(pa.Table.from_arrays(arrays, schema=schema))
        encoder.close({})
    except BaseException:
        encoder.abandon()
        raise
    publish(encoder.part, target)


def _pair(series: TestSeries, column: _Column | None, is_text: bool, a: int, b: int, base: int) -> list[Any]:
    import pyarrow as pa

    kind = pa.string() if is_text else pa.float64()
    if column is None:
        return [pa.nulls(b - a, kind), pa.nulls(b - a, pa.uint16())]
    values = column.values[a - base:b - base] if column.values is not None else \
        series.values(column.bound, a, b)[0]
    # no value is NULL, not NaN: SQL's means and counts leave it out
    array = pa.array(values, type=kind, from_pandas=True)
    return [array, pa.array(column.flags[a - base:b - base])]


def tidy_schema(columns: Sequence[tuple[str, bool]]) -> pa.Schema:
    """t, t_s, and for each channel `<channel>` and `<channel>__flag`."""
    import pyarrow as pa

    fields = [pa.field("t", pa.timestamp("ns"), nullable=False), pa.field("t_s", pa.float64(), nullable=False)]
    for channel, is_text in columns:
        fields += [pa.field(channel, pa.string() if is_text else pa.float64()),
                   pa.field(f"{channel}__flag", pa.uint16())]
    return pa.schema(fields)


def _count(result: TidyResult, made: dict[str, _Column], start: int, stop: int) -> None:
    for column in made.values():
        flags = column.flags[start:stop]
        result.samples += stop - start
        if not flags.any():
            continue
        seen = int(np.bitwise_or.reduce(flags))
        for flag in Flag:
            if flag and seen & flag:
                result.flags[(flag.name or "").lower()] += int(np.count_nonzero(flags & np.uint16(flag)))
