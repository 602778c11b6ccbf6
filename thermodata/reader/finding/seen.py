"""What the blocks of a file show while they pass: rows, rates, gaps and first rows of each stream."""

from __future__ import annotations

import math
from dataclasses import dataclass, field
from typing import Any

import numpy as np

from thermodata.plugin import Array, Block, Loss, Recording, Signal
from thermodata.reader.signals.units_met import units_met
from thermodata.reader.text.names.unit_in_name import other_unit_note
from thermodata.reader.times.clock_leaps import Leap
from thermodata.reader.times.newest_first import NOTE, Steps

_GAP_FACTOR = 3.0  # an interval of more than so many usual ones is a gap


class SeenRows:
    """Of the part of a file that was read. rows: of all streams."""

    def __init__(self, said: Recording, first_rows: int) -> None:
        self.rows = 0
        self._absolute = said.clock == "absolute"
        self._first_rows = first_rows
        self._streams: dict[str, _Stream] = {s.stream: _Stream() for s in said.signals}
        self._signals: dict[str, list[Signal]] = {name: [] for name in self._streams}
        for signal in said.signals:
            self._signals[signal.stream].append(signal)
        self._losses: list[Loss] = []
        self._units = units_met(said.signals)
        self._notes = [*said.notes, *filter(None, map(other_unit_note, said.signals))]

    def add(self, block: Block) -> None:
        self._streams[block.stream].add(block, self._absolute, self._first_rows)
        for met in self._units:
            met.add(block)
        self.rows += block.t_ns.size

    def add_loss(self, loss: Loss) -> None:
        self._losses.append(loss)

    def as_json(self) -> dict[str, Any]:
        """Keys: rows_read, notes, losses, streams."""
        return {
            "rows_read": self.rows,
            "notes": [
                *self._notes,
                *(n for met in self._units if (n := met.note(self._notes))),
                *self._of_clocks(),
            ],
            "losses": [_loss_as_json(loss, self._absolute) for loss in self._losses],
            "streams": [
                _stream_as_json(name, stream, self._signals[name], self._absolute)
                for name, stream in self._streams.items()
            ],
        }

    def _of_clocks(self) -> list[str]:
        """What the times say of the clocks, each once."""
        streams = self._streams.values()
        found = [NOTE] if any(s.clock.newest_first for s in streams) else []
        return found + list(dict.fromkeys(note for s in streams if self._absolute and (note := s.leap.note())))


@dataclass(slots=True)
class _Stream:
    """What is kept of a stream while its blocks pass: no values but the first rows. first, last: times [ns]; step_ns:
    the usual one, by the first block; gaps: steps of more than three of these; largest: step [ns]; backward, repeated:
    steps back, and of none."""

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
        columns = [_values_as_json(column[:n]) for column in block.values.values()] if n > 0 else []
        for i in range(n):
            values = zip(block.values, [column[i] for column in columns], strict=True)
            self.head.append({"t": time_shown(int(t[i]), absolute), **dict(values)})
        self.rows += t.size
        self.last = int(t[-1])


def _loss_as_json(loss: Loss, absolute: bool) -> dict[str, Any]:
    return {
        "where": loss.where,
        "reason": loss.reason,
        "fraction": loss.fraction,
        "from": None if loss.from_ns is None else time_shown(loss.from_ns, absolute),
        "to": None if loss.to_ns is None else time_shown(loss.to_ns, absolute),
    }


def _stream_as_json(name: str, stream: _Stream, signals: list[Signal], absolute: bool) -> dict[str, Any]:
    step = None if stream.step_ns is None else stream.step_ns / 1e9
    return {
        "stream": name,
        "rows": stream.rows,
        "start": None if stream.first is None else time_shown(stream.first, absolute),
        "end": None if stream.last is None else time_shown(stream.last, absolute),
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


def time_shown(t_ns: int, absolute: bool) -> str | float:
    """A time for people: ISO in UTC, or seconds of a relative clock."""
    if not absolute:
        return t_ns / 1e9
    return (
        str(np.datetime64(t_ns, "ns")).rstrip("0").rstrip(".") + "Z"
        if t_ns % 1_000_000_000
        else str(np.datetime64(t_ns // 1_000_000_000, "s")) + "Z"
    )


def _values_as_json(values: Array) -> list[Any]:
    """Values that JSON knows; NaN is None."""
    found: list[Any] = values.tolist()
    if values.dtype.kind in "fO" and any(isinstance(v, float) and not math.isfinite(v) for v in found):
        return [None if isinstance(v, float) and not math.isfinite(v) else v for v in found]
    return found
