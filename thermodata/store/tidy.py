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
from thermodata.store.arrow import to_arrow
from thermodata.store.encoder import Encoder
from thermodata.store.files import publish, temporary
from thermodata.store.plan import Bound
from thermodata.store.quality import Event, flagged
from thermodata.store.series import Member, TestSeries

if TYPE_CHECKING:
    import pyarrow as pa

GROUP_VALUES = 1_000_000
# a day at 10 Hz of 40 channels is 35 M values: flagged as a whole [320 MB]; longer streams go piece by piece
SEGMENT_VALUES = 40_000_000
Columns = Sequence[tuple[str, bool]]


@dataclass(slots=True)
class TidyFile:
    """part: test | history. path: relative to the store."""

    part: str
    path: str
    key: str
    rows: int
    columns: list[str]
    to_s: float = 0.0          # of the last row


@dataclass(slots=True)
class TidyResult:
    files: list[TidyFile] = field(default_factory=list)
    events: list[Event] = field(default_factory=list)
    flags: Counter[str] = field(default_factory=Counter)
    samples: int = 0
    losses: list[Loss] = field(default_factory=list)
    problems: list[str] = field(default_factory=list)


@dataclass(slots=True)
class Column:
    """A calibrated channel on some rows: values and uint16 flags, shape (n,)."""

    bound: Bound
    values: Array
    flags: Array


def write_member(series: TestSeries, member: Member, columns: Columns, key: str) -> TidyResult:
    """Makes the tidy files of one stream of a test, in memory bounded by SEGMENT_VALUES.

    columns: (channel, is text) of the campaign's stream, in the campaign's order; one that this test lacks is NULL.
    A channel that can't be calibrated is NULL and a problem; the others are written.
    """
    result = TidyResult()
    line, rows = series.timeline(member), series.rows(member)
    result.losses += line.losses
    if rows.history == rows.stop:
        result.problems.append(f"no rows of '{member[0]}' lie in the test's window")
        return result
    here = [b for b in series.plan.bound.values() if (b.source, b.stream) == member]
    step = max(4096, SEGMENT_VALUES // max(1, len(here)))
    parts = [_Part(series, name, columns, key, a, b)
             for name, a, b in (("history", rows.history, rows.start), ("test", rows.start, rows.stop)) if a < b]
    try:
        for start in range(rows.history, rows.stop, step):
            stop = min(start + step, rows.stop)
            t_ns = line.t_ns[start:stop]
            made = _calibrated(series, here, start, stop, result)
            result.events += flagged(series, member, t_ns, made, result.problems)
            for part in parts:
                part.add(t_ns, made, start, stop)
            _count(result, made, max(rows.start - start, 0))
        result.files += [part.finish() for part in parts]
    finally:
        for part in parts:
            part.discard()
    result.problems = list(dict.fromkeys(result.problems))
    return result


def _calibrated(series: TestSeries, here: Sequence[Bound], start: int, stop: int,
                result: TidyResult) -> dict[str, Column]:
    def one(bound: Bound) -> Column | str:
        try:
            values, flags = series.values(bound, start, stop)
        except ThermodataError as error:
            return f"channel '{bound.name}': " + "; ".join(str(error).splitlines())
        return Column(bound, values, flags)

    made: dict[str, Column] = {}
    with ThreadPoolExecutor(2) as pool:
        for bound, answer in zip(here, pool.map(one, here), strict=True):
            if isinstance(answer, str):
                result.problems.append(answer)
            else:
                made[bound.name] = answer
    return made


class _Part:
    """One tidy file in the making: rows start to stop of the timeline."""

    def __init__(self, series: TestSeries, name: str, columns: Columns, key: str, start: int, stop: int) -> None:
        self.series, self.name, self.columns, self.key, self.start, self.stop = series, name, columns, key, start, stop
        self.target = series.store / "tidy" / (f"{key}.parquet" if name == "test" else f"{key}.{name}.parquet")
        self.schema = tidy_schema(columns)
        self._encoder: Encoder | None = None
        self._to_s = 0.0

    def add(self, t_ns: Int1D, made: dict[str, Column], start: int, stop: int) -> None:
        """Takes those of the rows start to stop that are this part's, in row groups."""
        import pyarrow as pa

        if self._encoder is None:
            self.target.parent.mkdir(exist_ok=True)
            self._encoder = Encoder(temporary(self.target), self.schema)
        step = max(2048, GROUP_VALUES // (len(self.columns) + 1))
        for a in range(max(start, self.start), min(stop, self.stop), step):
            b = min(a + step, stop, self.stop)
            here = slice(a - start, b - start)
            t = t_ns[here]
            self._to_s = float(self.series.t_s(t[-1:])[0])
            arrays: list[Any] = [to_arrow(t.view("datetime64[ns]")), to_arrow(self.series.t_s(t))]
            for channel, is_text in self.columns:
                column = made.get(channel)
                kind = pa.string() if is_text else pa.float64()
                if column is None:
                    arrays += [pa.nulls(b - a, kind), pa.nulls(b - a, pa.uint16())]
                else:
                    arrays += [to_arrow(column.values[here], nan_is_null=True), to_arrow(column.flags[here])]
            self._encoder.put(pa.Table.from_arrays(arrays, schema=self.schema))

    def finish(self) -> TidyFile:
        assert self._encoder is not None
        self._encoder.close({})
        publish(self._encoder.part, self.target)
        self._encoder = None
        return TidyFile(self.name, f"tidy/{self.target.name}", self.key, self.stop - self.start,
                        [c for c, _ in self.columns], self._to_s)

    def discard(self) -> None:
        """Drops an unfinished file; nothing where it is finished."""
        if self._encoder is not None:
            self._encoder.abandon()
            self._encoder = None


def tidy_schema(columns: Columns) -> pa.Schema:
    """t, t_s, and for each channel `<channel>` and `<channel>__flag`."""
    import pyarrow as pa

    fields = [pa.field("t", pa.timestamp("ns"), nullable=False), pa.field("t_s", pa.float64(), nullable=False)]
    for channel, is_text in columns:
        fields += [pa.field(channel, pa.string() if is_text else pa.float64()),
                   pa.field(f"{channel}__flag", pa.uint16())]
    return pa.schema(fields)


def _count(result: TidyResult, made: dict[str, Column], start: int) -> None:
    """Counts samples and flags of the test's own rows, those from `start` on."""
    for column in made.values():
        flags = column.flags[start:]
        result.samples += len(flags)
        seen = int(np.bitwise_or.reduce(flags)) if len(flags) else 0
        for flag in Flag:
            if flag and seen & flag:
                result.flags[(flag.name or "").lower()] += int(np.count_nonzero(flags & np.uint16(flag)))
