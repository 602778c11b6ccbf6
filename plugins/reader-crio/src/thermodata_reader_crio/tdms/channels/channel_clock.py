"""The clock of a TDMS channel over the whole file: starts that are written anew, and holes that damage left."""

from __future__ import annotations

from collections.abc import Mapping
from typing import Any

import numpy as np

from thermodata_reader_crio.tdms.channels.waveform_clock import Clock, Waveform, counted, waveform
from thermodata_reader_crio.tdms.raw.columns import Column
from thermodata_reader_crio.tdms.segments.index import CLOCK, Hole, Index


class _ClockPieces:
    """Pieces of a clock in the making."""

    def __init__(self) -> None:
        self.row: list[int] = []
        self.base: list[int] = []
        self.origin: list[int] = []
        self.waves: list[Waveform] = []
        self.suspect: list[bool] = []

    def start(self, row: int, wave: Waveform, base: int, origin: int, suspect: bool) -> None:
        if self.row and self.row[-1] == row:
            for part in (self.row, self.base, self.origin, self.waves, self.suspect):
                part.pop()
        self.row.append(row if self.row else 0)
        self.base.append(base)
        self.origin.append(origin)
        self.waves.append(wave)
        self.suspect.append(suspect)

    def sample(self, row: int) -> int:
        """The number, in the last piece, of the sample in a row."""
        return row - self.row[-1] + self.origin[-1]

    def time(self, row: int) -> int:
        return self.base[-1] + self.sample(row) * self.waves[-1].step.numerator // self.waves[-1].step.denominator

    def clock(self, absolute: bool) -> Clock:
        row, base, origin = (np.array(part, np.int64) for part in (self.row, self.base, self.origin))
        return Clock(row, base, origin, tuple(w.step for w in self.waves), np.array(self.suspect, bool), absolute)


def clock_of(index: Index, column: Column, own: Mapping[str, Any], known: dict[Any, Clock | None]) -> Clock | None:
    """The clock that a channel's waveform properties give it; None where it has no increment. known: those of other
    channels, for a file may have 100,000 with the same."""
    if "wf_increment" not in own:
        return None
    changes = index.clock_changes.get(column.path, [])
    if len(changes) > 8:
        return _clock(index, column)
    # columns share their runs and equal counts, and objects of the index their changes: mostly these are the same ones
    same = id(column.runs), id(column.n), *map(id, changes)
    if same not in known:
        key = (id(column.runs), column.n.tobytes(), tuple((c.piece, *c.properties.items()) for c in changes))
        if key not in known:
            known[key] = _clock(index, column)
        known[same] = known[key]
    return known[same]


def _clock(index: Index, column: Column) -> Clock | None:
    made, state = _ClockPieces(), dict[str, Any]()
    for piece, change in _events(index, column.path):
        row = column.row_at(piece)
        if isinstance(change, Hole):
            _skip(made, index, column, change, row)
            continue
        state.update(change)
        wave = waveform(state)
        if wave is None:
            continue
        if not made.row or "wf_start_time" in change or (row and row == column.length):
            after_all = made.row and row == column.length
            # a start that is written when all values are there is the start of all of them
            if not (after_all and len(made.row) > 1):
                made.start(made.row[-1] if after_all else row, wave, wave.base_ns, 0, False)
        elif wave != made.waves[-1]:
            made.start(row, wave, made.time(row), 0, made.suspect[-1])
    if not made.row:
        return None
    return made.clock(made.waves[0].start_ns is not None)


def counted_clock(index: Index, column: Column, step_s: float) -> Clock:
    """The clock of a channel without a time of its own: its rows are counted."""
    clock, made = counted(step_s), _ClockPieces()
    made.start(0, Waveform(None, 0, clock.steps[0]), 0, 0, False)
    for hole in index.holes:
        _skip(made, index, column, hole, column.row_at(hole.piece))
    return made.clock(False)


def _events(index: Index, path: str) -> list[tuple[int, dict[str, Any] | Hole]]:
    """Holes and changed properties in the file's order, a hole before what follows it."""
    found: list[tuple[int, int, dict[str, Any] | Hole]] = [(h.piece, 0, h) for h in index.holes]
    found += [
        (c.piece, 1, {k: v for k, v in c.properties.items() if k in CLOCK}) for c in index.clock_changes.get(path, [])
    ]
    return [(piece, what) for piece, _, what in sorted(found, key=lambda e: e[:2])]


def _skip(made: _ClockPieces, index: Index, column: Column, hole: Hole, row: int) -> None:
    """A hole: the samples that are gone are counted where their number is known."""
    if not made.row or (row == 0 and hole.chunks is None):
        if made.row:
            made.suspect[-1] = True
        return
    wave, missing = made.waves[-1], 0
    if hole.chunks is not None:
        shapes = [i for i, place in enumerate(column.n) if place and _is_full(index, column, i, hole.layout)]
        missing = hole.chunks * int(column.n[shapes[0]]) if shapes else 0
        if missing == 0:
            return
    made.start(row, wave, made.base[-1], made.sample(row) + missing, made.suspect[-1] or hole.chunks is None)


def _is_full(index: Index, column: Column, place: int, layout: int) -> bool:
    """Whether one of a column's places is in full chunks of a layout."""
    shape = index.shapes[column.shapes[place]]
    return shape.layout == layout and shape.tail is None
