"""What would be ingested: header, units, start, rate, gaps and first rows of a file. Stores nothing."""

from __future__ import annotations

import math
import time
from collections.abc import Callable, Iterable
from dataclasses import dataclass, field
from pathlib import Path
from typing import Any

import numpy as np

from thermodata.archive.members import size_of
from thermodata.archive.regular import refuse_what_never_ends
from thermodata.plugin import Array, Block, Loss, Reader, Recording, Signal, Source
from thermodata.reader.contract.guard import asking, described, guarded, held_for
from thermodata.reader.finding.registry import claims, sniff
from thermodata.reader.signals.units_met import units_met
from thermodata.reader.times.clock_leaps import Leap
from thermodata.reader.times.newest_first import NOTE, Steps

FIRST_ROWS = 5
MOST_ROWS, MOST_S = 3_000_000, 8.0  # a preview of a file of any size takes seconds
_SMALL = 4_000_000  # bytes; a smaller file is read whole, however busy the machine is
_GAP_FACTOR = 3.0  # an interval of more than so many usual ones is a gap


@dataclass
class _Stream:
    """What is kept of a stream while its blocks pass: no values but the first rows."""

    rows: int = 0
    first: int | None = None
    last: int | None = None
    backward: int = 0
    repeated: int = 0
    step_ns: float | None = None
    gaps: int = 0
    largest: int = 0
    head: list[dict[str, Any]] = field(default_factory=list)
    clock: Steps = field(default_factory=Steps)
    leap: Leap = field(default_factory=Leap)

    def add(self, block: Block, absolute: bool, first_rows: int) -> None:
        t = block.t_ns
        self.clock.add(t)
        self.leap.add(t)
        joined = t if self.last is None else np.concatenate(([self.last], t))
        steps = np.diff(joined)
        self.first = int(t[0]) if self.first is None else self.first
        self.backward += int((steps < 0).sum())
        self.repeated += int((steps == 0).sum())
        ahead = steps[steps > 0]
        if self.step_ns is None and ahead.size:
            self.step_ns = float(np.median(ahead))
        if self.step_ns is not None and ahead.size:
            self.gaps += int((ahead > _GAP_FACTOR * self.step_ns).sum())
            self.largest = max(self.largest, int(ahead.max()))
        n = min(t.size, first_rows - len(self.head))
        columns = [_plain(column[:n]) for column in block.values.values()] if n > 0 else []
        for i in range(n):
            values = zip(block.values, [column[i] for column in columns], strict=True)
            self.head.append({"t": when(int(t[i]), absolute), **dict(values)})
        self.rows += t.size
        self.last = int(t[-1])


def preview(
    path: Path | str,
    source: Source | None = None,
    reader: Reader | None = None,
    *,
    rows: int = FIRST_ROWS,
    most_rows: int = MOST_ROWS,
    most_s: float = MOST_S,
    watch: Callable[[Block], None] | None = None,
    recording: Recording | None = None,
    beginning: bool = False,
) -> dict[str, Any]:
    """A file as plain data, ready for JSON. reader: which one (default: the one that claims the file).

    rows: first rows a stream; most_rows, most_s: where reading ends in a large file ('whole' is False then, and what is
    said of rows, gaps and losses holds for the part that was read); watch: sees every block that is read; recording:
    what describe() said, where the caller has it already; beginning: whether the reader reads the first rows alone.

    Keys: file, size_bytes, reader, reason, clock, timezone, start, complete, whole, rows_read, notes, losses, and
    streams, each with stream, rows, start, end, duration_s, step_s, rate_hz, gaps, largest_step_s, backward, repeated,
    signals (name, unit, dtype, scaling) and first_rows. Values that do not apply are None. Errors: those of sniff
    and of the reader.
    """
    path = Path(path)
    source = source or Source()
    chosen, whole = reader if reader is not None else sniff(path), not beginning
    if recording is None:
        chosen, whole = beginning_of(chosen, path, source)
    said = described(chosen, path, source) if recording is None else recording
    absolute = said.clock == "absolute"
    streams: dict[str, _Stream] = {s.stream: _Stream() for s in said.signals}
    signals: dict[str, list[Signal]] = {name: [] for name in streams}
    for signal in said.signals:
        signals[signal.stream].append(signal)
    losses: list[Loss] = []
    units = units_met(said.signals)
    began, read = time.monotonic(), 0
    hurried = size_of(path) > _SMALL
    for item in guarded(chosen, path, source, said):
        if isinstance(item, Loss):
            losses.append(item)
            continue
        streams[item.stream].add(item, absolute, rows)
        for met in units:
            met.add(item)
        read += item.t_ns.size
        if watch is not None:
            watch(item)
        if read >= most_rows or (hurried and time.monotonic() - began > most_s):
            whole = False
            break
    return {
        "file": path.name,
        "size_bytes": size_of(path),
        "reader": chosen.name,
        "reason": claims(path).get(chosen.name),
        "clock": said.clock,
        "timezone": source.timezone,
        "start": None if said.start_ns is None else when(said.start_ns, absolute),
        "complete": said.complete,
        "whole": whole,
        "rows_read": read,
        "notes": [
            *said.notes,
            *(n for met in units if (n := met.note(said.notes))),
            *_of_clocks(streams.values(), absolute),
        ],
        "losses": [_lost(x, absolute) for x in losses],
        "streams": [_shown(name, stream, signals[name], absolute) for name, stream in streams.items()],
    }


def _lost(loss: Loss, absolute: bool) -> dict[str, Any]:
    return {
        "where": loss.where,
        "reason": loss.reason,
        "fraction": loss.fraction,
        "from": None if loss.from_ns is None else when(loss.from_ns, absolute),
        "to": None if loss.to_ns is None else when(loss.to_ns, absolute),
    }


def _of_clocks(streams: Iterable[_Stream], absolute: bool) -> list[str]:
    """What the times of a file say of its clocks, each once."""
    streams = list(streams)
    found = [NOTE] if any(s.clock.newest_first for s in streams) else []
    return found + list(dict.fromkeys(note for s in streams if absolute and (note := s.leap.note())))


def beginning_of(reader: Reader, path: Path, source: Source) -> tuple[Reader, bool]:
    """(who reads a file for a look at it, whether that is all of it): the first rows alone where the reader can do that
    and the file is large. FormatError for what is no file."""
    refuse_what_never_ends(path)
    begin = getattr(reader, "beginning", None)
    with asking(f"reader '{reader.name}' failed to begin a file", str(path)), held_for(reader, path) as real:
        first: Reader | None = None if begin is None else begin(real, source)
    return (reader, True) if first is None else (first, False)


def _shown(name: str, stream: _Stream, signals: list[Signal], absolute: bool) -> dict[str, Any]:
    step = None if stream.step_ns is None else stream.step_ns / 1e9
    return {
        "stream": name,
        "rows": stream.rows,
        "start": None if stream.first is None else when(stream.first, absolute),
        "end": None if stream.last is None else when(stream.last, absolute),
        "duration_s": None if stream.first is None or stream.last is None else (stream.last - stream.first) / 1e9,
        "step_s": step,
        "rate_hz": None if not step else 1.0 / step,
        "gaps": stream.gaps,
        "largest_step_s": stream.largest / 1e9 if stream.largest else None,
        "backward": stream.backward,
        "repeated": stream.repeated,
        "signals": [
            {"name": s.name, "unit": s.unit, "dtype": s.dtype, "scaling": None if s.scaling is None else s.scaling.kind}
            for s in signals
        ],
        "first_rows": stream.head,
    }


def when(t_ns: int, absolute: bool) -> str | float:
    """A time for people: ISO in UTC, or seconds of a relative clock."""
    if not absolute:
        return t_ns / 1e9
    return (
        str(np.datetime64(t_ns, "ns")).rstrip("0").rstrip(".") + "Z"
        if t_ns % 1_000_000_000
        else str(np.datetime64(t_ns // 1_000_000_000, "s")) + "Z"
    )


def _plain(values: Array) -> list[Any]:
    """Values that JSON knows; NaN is None."""
    found: list[Any] = values.tolist()
    if values.dtype.kind in "fO" and any(isinstance(v, float) and not math.isfinite(v) for v in found):
        return [None if isinstance(v, float) and not math.isfinite(v) else v for v in found]
    return found


__all__ = ["FIRST_ROWS", "MOST_ROWS", "MOST_S", "preview", "when"]
