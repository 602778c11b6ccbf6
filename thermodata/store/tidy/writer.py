"""The tidy layer: calibrated channels of one (test, source, stream) as one wide Parquet file, flags beside values."""

from __future__ import annotations

from collections import Counter
from collections.abc import Mapping, Sequence
from dataclasses import dataclass, field, replace
from typing import TYPE_CHECKING, Any

import numpy as np

from thermodata.plugin import Bool1D, Float1D, Int1D, Loss
from thermodata.schema.flag import CONSTANT, INVALID, Flag
from thermodata.schema.units.quantity import MEASURED
from thermodata.store.base.arrow import to_arrow
from thermodata.store.base.encoder import Encoder
from thermodata.store.base.files import publish, temporary
from thermodata.store.raw.writer import group_rows
from thermodata.store.tidy.flags.beside.between import Sampler, Verdict
from thermodata.store.tidy.flags.event import Event
from thermodata.store.tidy.flags.flagged import Flagged
from thermodata.store.tidy.flags.overrule import overrule, overruled, rules_of
from thermodata.store.tidy.plan.plan import Bound
from thermodata.store.tidy.rows.on_change import SET, asked, told
from thermodata.store.tidy.rows.timeline import Timeline
from thermodata.store.tidy.values.chunk import Column
from thermodata.store.tidy.values.cut_start import driven_before
from thermodata.store.tidy.values.finer_steps import finer_than_declared
from thermodata.store.tidy.values.rated import told_of_rates, told_of_turns
from thermodata.store.tidy.values.series import Member, TestSeries

if TYPE_CHECKING:
    import pyarrow as pa

Columns = Sequence[tuple[str, bool]]
_FLAGS = [((f.name or "").lower(), int(f)) for f in Flag if f]


@dataclass(slots=True)
class TidyFile:
    """part: test | history. path: relative to the store."""

    part: str
    path: str
    key: str
    rows: int
    columns: list[str]
    to_s: float = 0.0  # of the last row
    levels: dict[str, Any] = field(default_factory=dict)  # see `between.Sampler`
    held: tuple[str, ...] = ()  # of the columns, what is written on change


@dataclass(slots=True)
class TidyResult:
    """The tidy files of one stream of a test, and what was found while they were made. flags: name -> samples;
    not_counting: samples that have a flag which keeps them out of means, or several; problems: why channels could not
    be made."""

    files: list[TidyFile] = field(default_factory=list)
    events: list[Event] = field(default_factory=list)
    flags: Counter[str] = field(default_factory=Counter)
    samples: int = 0
    not_counting: int = 0
    losses: list[Loss] = field(default_factory=list)
    problems: list[str] = field(default_factory=list)
    notes: tuple[str, ...] = ()
    filled: set[str] = field(default_factory=set)  # channels that have a value at all
    counting: dict[str, list[int]] = field(default_factory=dict)  # what a model explains -> [samples that count, all]


def write_member(series: TestSeries, member: Member, columns: Columns, key: str, verdict: Verdict) -> TidyResult:
    """Makes the tidy files of one stream of a test, one row group in memory at a time.

    columns: (channel, is text) of the campaign's stream, in the campaign's order; one that this test lacks is NULL.
    A channel that can't be calibrated is NULL and a problem; the others are written. verdict: what the other tests, and
    the test as a whole, say of its channels.
    """
    result = TidyResult()
    line, rows = series.timeline(member), series.rows(member)
    result.losses += line.losses
    result.notes = line.notes
    if rows.start == rows.stop:
        result.problems.append(f"no rows of '{member[0]}' lie in the test's window{_where_they_lie(series, member)}")
        return result
    here = [series.as_written(b) for b in series.plan.bound.values() if (b.source, b.stream) == member]
    held = tuple(b.name for b in here if b.is_held)
    result.notes += _as_written(series, member, here, line.rows)
    result.notes += driven_before(series, member, here, rows.start, rows.stop)
    result.notes += finer_than_declared(series, here, rows.start, rows.stop)
    verdict = verdict.of(b.name for b in here)
    rules = rules_of(series.plan.campaign, series.plan.test.id)
    flagged = Flagged(series, member, here, rows.history, rows.stop, result.problems, verdict)
    sampler = Sampler(here, rows.start, rows.stop)
    parts = [
        _TidyFile(series, name, columns, key, a, b)
        for name, a, b in (("history", rows.history, rows.start), ("test", rows.start, rows.stop))
        if a < b
    ]
    try:
        for first, t_ns, channels in flagged.chunks(group_rows(len(columns) + 1), [rows.start]):
            t_s = series.t_s(t_ns)
            overrule(rules, t_s, channels)
            sampler.take(first, t_s, channels)
            _pass(verdict, t_s, channels)
            overrule(rules, t_s, channels)
            part = parts[0] if first < parts[0].stop else parts[1]
            part.add(t_ns, channels)
            if part.name == "test":
                _count(result, channels)
        result.notes += flagged.never_measured()
        result.events += overruled(rules, flagged.events + _passed(series, line, rows.start, rows.stop, here, verdict))
        result.files += [replace(part.finish(), held=held) for part in parts]
        result.files[-1].levels = sampler.levels()
    finally:
        for part in parts:
            part.discard()
    result.problems = list(dict.fromkeys(result.problems))
    return result


def _where_they_lie(series: TestSeries, member: Member) -> str:
    """Behind 'in the test's window': which it is, and when the recording has rows."""
    line, window = series.timeline(member), series.plan.test.window
    if window is None or not line.rows:
        return ""
    ends = np.concatenate([line.times(0, 1), line.times(line.rows - 1, line.rows)])
    first, last = ((series.t_s(ends) + window[0]) / 3600).tolist()
    return (
        f", from {window[0] / 3600:.4g} to {window[1] / 3600:.4g} h after the recording's start: "
        f"they run from {first:.4g} to {last:.4g} h"
    )


def _as_written(series: TestSeries, member: Member, here: Sequence[Bound], rows: int) -> tuple[str, ...]:
    """What is told of channels that are held for what their rows show, or may have to be."""
    held = [b for b in here if b.on_change and b.signal is not None]
    rests = [b.name for b in here if b.on_change and b.signal is None]
    by_hand = [b.name for b in held if b.channel.quantity not in SET or not series.has_no_rate(member)]
    asked_of = [b.name for b in here if not b.on_change and series.by_hand(b) == "asked"]
    no_rate = [b.name for b in held if b.name not in by_hand]
    of_hands = told(no_rate) + told(by_hand, by_hand=True) + tuple(asked(n, rows) for n in asked_of)
    paces = {b.name: pace for b in here if (pace := series.pace_of_rates(b)) is not None}
    return of_hands + told_of_rates(rests) + told_of_turns(paces)


def _pass(verdict: Verdict, t_s: Float1D, channels: Mapping[str, Column]) -> None:
    """Flags what other tests, and the test as a whole, say of its channels."""
    for name, (_, since) in verdict.offsets.items():
        if name in channels:
            off = np.uint16(Flag.OFFSET) * (t_s > (-np.inf if since is None else since))
            channels[name].flags = channels[name].flags | off.astype(np.uint16)
    for name in verdict.dead:
        if name in channels:
            channels[name].flags = channels[name].flags | np.uint16(Flag.STUCK)
    if verdict.foreign is not None:
        within = _from_a_to_b(t_s, verdict.foreign[0], verdict.foreign[1])
        if within.any():
            for column in channels.values():
                column.flags = column.flags | np.where(within, np.uint16(Flag.FOREIGN), np.uint16(0))


def _from_a_to_b(t_s: Float1D, a: float | None, b: float | None) -> Bool1D:
    """Where a time lies from a to b [s], ends included; None: no end."""
    return np.asarray((t_s >= (-np.inf if a is None else a)) & (t_s <= (np.inf if b is None else b)))


def _passed(
    series: TestSeries, line: Timeline, start: int, stop: int, here: Sequence[Bound], verdict: Verdict
) -> list[Event]:
    """One event for each sensor that is off since an earlier test or drifted away, and one for a foreign part."""
    if start >= stop:
        return []

    def stretch(a: float | None, b: float | None, after: int) -> tuple[float, float, int] | None:
        """(from_s, to_s, rows) of the test's own rows from a to b; after: 1 without a itself."""
        zero = series.span.zero_ns
        first = start if a is None else max(start, line.find(zero + round(a * 1e9) + after))
        last = stop if b is None else min(stop, line.find(zero + round(b * 1e9) + 1))
        if first >= last:
            return None
        ends = np.concatenate([line.times(first, first + 1), line.times(last - 1, last)])
        from_s, to_s = series.t_s(ends).tolist()
        return from_s, to_s, last - first

    events = []
    for name in (b.name for b in here if b.name in verdict.offsets):
        size, since = verdict.offsets[name]
        found = stretch(since, None, 1)
        if found is not None:
            drifted = "since an earlier test" if since is None else "from here on, and in later tests"
            constant = CONSTANT if name in verdict.constant else ""
            events.append(Event(name, "offset", *found, f"{size:+.1f} K against its neighbours {drifted}{constant}"))
    for name in (b.name for b in here if b.name in verdict.dead):
        found = stretch(None, None, 0)
        if found is not None:
            why = "one reading throughout, while the others move as they do elsewhere, and it does in other tests"
            events.append(Event(name, "stuck", *found, why))
    if verdict.foreign is not None:
        found = stretch(verdict.foreign[0], verdict.foreign[1], 0)
        if found is not None:
            events.append(Event(None, "foreign", *found, verdict.foreign[2]))
    return events


class _TidyFile:
    """One tidy file in the making: rows start to stop of the timeline."""

    def __init__(self, series: TestSeries, name: str, columns: Columns, key: str, start: int, stop: int) -> None:
        self.series, self.name, self.columns, self.key, self.start, self.stop = series, name, columns, key, start, stop
        self.target = series.store / "tidy" / (f"{key}.parquet" if name == "test" else f"{key}.{name}.parquet")
        self.schema = tidy_schema(columns)
        self._encoder: Encoder | None = None
        self._to_s = 0.0

    def add(self, t_ns: Int1D, channels: dict[str, Column]) -> None:
        """Takes the next rows, as one row group."""
        import pyarrow as pa

        if self._encoder is None:
            self.target.parent.mkdir(exist_ok=True)
            self._encoder = Encoder(temporary(self.target), self.schema)
        self._to_s = float(self.series.t_s(t_ns[-1:])[0])
        n = len(t_ns)
        unflagged = to_arrow(np.zeros(n, np.uint16))
        arrays: list[Any] = [to_arrow(t_ns.view("datetime64[ns]")), to_arrow(self.series.t_s(t_ns))]
        for channel, is_text in self.columns:
            column = channels.get(channel)
            if column is None:
                arrays += [pa.nulls(n, pa.string() if is_text else pa.float64()), pa.nulls(n, pa.uint16())]
            else:
                arrays += [
                    to_arrow(column.values, nan_is_null=True),
                    to_arrow(column.flags) if column.flags.any() else unflagged,
                ]
        self._encoder.put(pa.Table.from_arrays(arrays, schema=self.schema))

    def finish(self) -> TidyFile:
        assert self._encoder is not None
        self._encoder.close({})
        publish(self._encoder.part, self.target)
        self._encoder = None
        return TidyFile(
            self.name,
            f"tidy/{self.target.name}",
            self.key,
            self.stop - self.start,
            [c for c, _ in self.columns],
            self._to_s,
        )

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
        fields += [
            pa.field(channel, pa.string() if is_text else pa.float64()),
            pa.field(f"{channel}__flag", pa.uint16()),
        ]
    return pa.schema(fields)


def _count(result: TidyResult, channels: dict[str, Column]) -> None:
    """Counts samples and flags of the test's own rows."""
    for name, column in channels.items():
        result.samples += len(column.flags)
        if name not in result.filled and (column.values.dtype.kind != "f" or not np.isnan(column.values).all()):
            result.filled.add(name)
        if column.bound.channel.quantity in MEASURED:
            of = result.counting.setdefault(name, [0, 0])
            of[0] += int(np.count_nonzero((column.flags & np.uint16(INVALID)) == 0))
            of[1] += len(column.flags)
        if not column.flags.any():
            continue
        seen = int(np.bitwise_or.reduce(column.flags))
        result.not_counting += int(np.count_nonzero(column.flags & np.uint16(INVALID)))
        for name, bit in _FLAGS:
            if seen & bit:
                result.flags[name] += int(np.count_nonzero(column.flags & np.uint16(bit)))
