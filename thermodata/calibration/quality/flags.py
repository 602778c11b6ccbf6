"""Quality flags of one stream: what is wrong with its time, and with each column. Vectorised throughout.

Each finder is conservative: what may be real is left alone, and said. Flagged rows are kept.
"""

from __future__ import annotations

from collections.abc import Iterable, Mapping
from dataclasses import dataclass

import numpy as np

from thermodata.calibration.quality.edges import without_pauses
from thermodata.calibration.quality.frozen import drives_stand, frozen_runs
from thermodata.calibration.quality.limit import NO_VALUE, SAY_RANGE, clipped, impossible, no_values, sentinels
from thermodata.calibration.quality.range import Limits
from thermodata.calibration.quality.spike import spikes
from thermodata.calibration.quality.step import offset_steps, stood_before
from thermodata.calibration.quality.sun import RESTS_BELOW, is_clear_sky, least_count_of_sun, rests
from thermodata.calibration.quality.time import TimeFlags, time_flags
from thermodata.calibration.quality.value import RunStats, held_runs, run_stats, true_runs
from thermodata.plugin import Array, Bool1D, Float1D, Int1D
from thermodata.schema.flag import Flag
from thermodata.schema.units.quantity import HELD_QUANTITIES
from thermodata.schema.words.places import is_at_tool

# Quantities whose readings carry noise, so that an exactly constant stretch is suspicious ...
ANALOG = frozenset(
    {
        "displacement",
        "tilt",
        "temperature",
        "temperature_difference",
        "voltage",
        "resistance",
        "humidity",
        "irradiance",
        "pressure",
    }
)
# ... and which can't leave and come back within a few samples. (Position, speed, power and flow can.)
_INERT = frozenset({"displacement", "tilt", "temperature", "temperature_difference", "humidity"})
# ... and of these which rest on no end: no pump that is off holds them at 0, and no air is more than saturated.
_FREEZES = frozenset({"temperature", "temperature_difference"})
_TOLD = np.uint16(Flag.HELD | Flag.STUCK | Flag.SATURATED | Flag.OUT_OF_RANGE)
MOST_EVENTS = 2000  # of a channel and flag; `concise` makes fewer of them


@dataclass(frozen=True, slots=True)
class ColumnInput:
    """A column. values: shape (n,), in the canonical unit (text for a label). flags: those that it already has
    (from the reader and from `calibrate`), kept and reported. range: (low, high) in the canonical unit. at: its place,
    where it is known. elsewhere: how it reads in other tests, where this one does not tell. limits: the ends of
    its range that other tests show. held: it is written on change: that it stands still says nothing. codes: those for
    "no value" in the unit that it was logged in, as they are in the canonical one."""

    values: Array
    quantity: str
    flags: Array | None = None
    range: tuple[float, float] | None = None
    at: str | None = None
    elsewhere: RunStats | None = None
    limits: Limits = (None, None)
    held: bool = False
    codes: Float1D | None = None


@dataclass(frozen=True, slots=True)
class QualityEvent:
    """A stretch with one flag. channel None: the whole stream. times [ns] of its first and last sample; n samples."""

    channel: str | None
    flag: str
    from_ns: int
    to_ns: int
    n: int
    detail: str = ""


def flag_stream(t_ns: Int1D, columns: Mapping[str, ColumnInput]) -> tuple[dict[str, Array], list[QualityEvent]]:
    """(channel -> uint16 flags, shape (n,); events in order of time, at most MOST_EVENTS a channel and
    flag; see `concise`).

    t_ns: shape (n,), as recorded; need not be in order: times that go back or stand still are flagged.
    """
    t_ns = np.asarray(t_ns)
    time = time_flags(t_ns, on_change=bool(columns) and all(c.held for c in columns.values()))
    events = [QualityEvent(None, *event) for event in time.events]
    stats = {name: run_stats(x) for name, c in columns.items() if (x := _analog(c)) is not None}
    flags: dict[str, Array] = {}
    for name, column in columns.items():
        own = _column(name, column, t_ns, time, stats, columns)
        own_flags, own_events = own
        flags[name] = own_flags | time.flags
        events += own_events
    events.sort(key=lambda e: (e.from_ns, e.channel or ""))
    return flags, events


def _analog(column: ColumnInput) -> Float1D | None:
    if column.held or column.quantity not in ANALOG or column.values.dtype.kind not in "iuf" or len(column.values) < 3:
        return None
    return np.asarray(column.values, dtype=np.float64)


def _column(
    name: str,
    column: ColumnInput,
    t_ns: Int1D,
    time: TimeFlags,
    stats: Mapping[str, RunStats],
    columns: Mapping[str, ColumnInput],
) -> tuple[Array, list[QualityEvent]]:
    n = len(t_ns)
    flags = np.zeros(n, np.uint16) if column.flags is None else column.flags.astype(np.uint16)
    if column.values.shape != t_ns.shape or flags.shape != t_ns.shape:
        raise ValueError(f"column '{name}': shape {column.values.shape}, flags {flags.shape}, time {t_ns.shape}")
    events = _limits(name, column, flags, t_ns, stats.get(name))
    if name in stats:
        x = np.asarray(column.values, dtype=np.float64)
        count = least_count_of_sun(x, column.quantity, stats[name])
        others = {k: columns[k].values for k in stats if k != name} if len(stats[name].starts) else {}
        for start, stop, stuck, why in held_runs(x, t_ns, stats[name], others, stats, column.elsewhere):
            if (flags[start:stop] & np.uint16(Flag.SATURATED | Flag.OUT_OF_RANGE)).all():
                continue  # at the end of its range a reading stands still
            if rests(x, t_ns, start, stop, column.quantity) or (count and is_clear_sky(x, t_ns, start, stop, count)):
                continue
            flag = Flag.STUCK if stuck else Flag.HELD
            flags[start:stop] |= np.uint16(flag)
            events.append(_event(name, str(flag.name).lower(), t_ns, start, stop, why))
        if column.quantity in _FREEZES and not is_at_tool(column.at):
            beside = {k: v for k, v in others.items() if columns[k].quantity in _FREEZES}
            stand = drives_stand([(c.quantity, c.values) for c in columns.values()]) if beside else None
            for start, stop, why in frozen_runs(x, t_ns, stats[name], beside, stand):
                if not (flags[start:stop] & _TOLD).any():
                    flags[start:stop] |= np.uint16(Flag.STUCK)
                    events.append(_event(name, "stuck", t_ns, start, stop, why))
        if column.quantity in _INERT:
            events += _mark_spikes(name, x, flags, t_ns, stats[name], time)
        if column.quantity == "temperature" and not is_at_tool(column.at):
            for step in list(offset_steps(x, t_ns, flags, time.flags, stats[name])):
                neighbours = [
                    np.asarray(columns[k].values, dtype=np.float64)
                    for k in stats
                    if k != name and columns[k].quantity == "temperature"
                ]
                since = stood_before(x, t_ns, step, stats[name], neighbours)
                flag, start, stop = (Flag.OFFSET, step.start, step.stop)
                why = f"a step of {step.size:+.1f} K {step.how}"
                if since is not None:
                    flag, start, stop = Flag.HELD, since, step.start
                    why = f"on one tread, then {why}"
                flags[start:stop] |= np.uint16(flag)
                events.append(_event(name, str(flag.name).lower(), t_ns, start, stop, why))
    return flags, _capped(events)


def _limits(name: str, column: ColumnInput, flags: Array, t_ns: Int1D, stats: RunStats | None) -> list[QualityEvent]:
    """Marks missing, impossible and clipped readings in `flags`; events for these and for flags that were there."""
    x, events = column.values, []
    told: Bool1D = np.zeros(len(x), dtype=bool)

    def mark(flag: Flag, hit: Bool1D, why: str) -> None:
        nonlocal told
        flags[hit] |= np.uint16(flag)
        events.extend(_events(name, str(flag.name).lower(), hit, t_ns, why))
        told = told | hit

    if x.dtype.kind == "f" and not (stats is not None and np.isfinite(stats.leap)):
        missing = ~np.isfinite(x)
        if missing.any():
            mark(Flag.OUT_OF_RANGE, missing, "no number")
            after = np.flatnonzero(missing[:-1] & ~missing[1:]) + 1
            flags[after] |= np.uint16(Flag.GAP)
    if x.dtype.kind == "f" and column.range is not None:
        flags |= _outside(x, *column.range)
    if x.dtype.kind in "iuf":
        beyond = impossible(x, column.quantity, stats) & ~told
        if beyond.any():
            mark(Flag.OUT_OF_RANGE, beyond, f"no {column.quantity.replace('_', ' ')} can be that")
    if stats is None and x.dtype.kind in "iuf" and column.quantity not in HELD_QUANTITIES:
        code = no_values(np.asarray(x, dtype=np.float64), column.quantity, column.codes) & ~told
        if code.any():
            mark(Flag.OUT_OF_RANGE, code, NO_VALUE)
    if stats is not None:
        y = np.asarray(x, dtype=np.float64)
        declared = bool((flags & np.uint16(Flag.SATURATED)).any())
        code = sentinels(y, stats, written=column.codes) & ~told
        if code.any():
            mark(Flag.OUT_OF_RANGE, code, NO_VALUE)
        at_end = np.zeros(len(y), dtype=bool)
        for limit, side in zip(column.limits, ("lower", "upper"), strict=True):
            here = (y == limit) & ~told
            at_end |= here
            if here.any():
                mark(Flag.SATURATED, here, f"{side} limit {limit:.6g}, as in other tests: {SAY_RANGE}")
        if not code.any() and not declared:
            count = least_count_of_sun(y, column.quantity, stats)
            for hit, _, why in clipped(y, stats, column.quantity, rests_below=RESTS_BELOW.get(column.quantity)):
                where = np.flatnonzero(hit)
                if count and is_clear_sky(y, t_ns, int(where[0]), int(where[-1]) + 1, count):
                    continue
                if (hit & ~at_end).any():
                    mark(Flag.SATURATED, hit & ~at_end, why)
    for flag in (Flag.OUT_OF_RANGE, Flag.SATURATED) if flags.any() else ():
        given = ((flags & np.uint16(flag)) != 0) & ~told
        if given.any():
            events += _events(name, str(flag.name).lower(), given, t_ns, "")
    return events


def _mark_spikes(
    name: str, x: Float1D, flags: Array, t_ns: Int1D, stats: RunStats, time: TimeFlags
) -> list[QualityEvent]:
    hit, many = spikes(x, stats)
    hit = without_pauses(hit, x, (time.flags & np.uint16(Flag.GAP)) != 0)
    where = np.flatnonzero(hit)
    if many and len(where):
        return [
            QualityEvent(
                name,
                "spike",
                int(t_ns[where[0]]),
                int(t_ns[where[-1]]),
                len(where),
                f"not flagged: {100 * len(where) / len(x):.1f} % of the samples stand out for 1 to 3 "
                "samples: measuring phases? say when with 'measuring'",
            )
        ]
    flags[hit] |= np.uint16(Flag.SPIKE)
    return _events(name, "spike", hit, t_ns, "")


def _outside(x: Array, low: float, high: float) -> Array:
    edge = 5e-4 * (high - low)
    flags = np.zeros(len(x), np.uint16)
    with np.errstate(invalid="ignore"):
        beyond = (x < low - edge) | (x > high + edge)
        at_edge = ((x <= low + edge) | (x >= high - edge)) & ~beyond
    flags[beyond], flags[at_edge] = np.uint16(Flag.OUT_OF_RANGE), np.uint16(Flag.SATURATED)
    return flags


def _event(name: str, flag: str, t_ns: Int1D, start: int, stop: int, detail: str) -> QualityEvent:
    return QualityEvent(name, flag, int(t_ns[start]), int(t_ns[stop - 1]), stop - start, detail)


def _events(name: str, flag: str, hit: Bool1D, t_ns: Int1D, detail: str) -> list[QualityEvent]:
    """One event a stretch of True; the last of too many stands for the rest."""
    starts, stops = true_runs(hit)
    events = [
        _event(name, flag, t_ns, int(a), int(b), detail)
        for a, b in zip(starts[: MOST_EVENTS - 1], stops[: MOST_EVENTS - 1], strict=True)
    ]
    if len(starts) >= MOST_EVENTS:
        a, b = int(starts[MOST_EVENTS - 1]), int(stops[-1])
        rest = int((stops - starts)[MOST_EVENTS - 1 :].sum())
        events.append(
            QualityEvent(
                name, flag, int(t_ns[a]), int(t_ns[b - 1]), rest, f"{len(starts) - MOST_EVENTS + 1} further stretches"
            )
        )
    return events


def _capped(events: Iterable[QualityEvent]) -> list[QualityEvent]:
    kept: list[QualityEvent] = []
    seen: dict[str, int] = {}
    for event in events:
        seen[event.flag] = seen.get(event.flag, 0) + 1
        if seen[event.flag] <= MOST_EVENTS:
            kept.append(event)
    return kept
