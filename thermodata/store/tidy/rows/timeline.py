"""The rows of one stream of a test in time order, read as they are needed: as long as a year, and never all at once."""

from __future__ import annotations

from collections.abc import Callable, Iterable, Sequence
from dataclasses import dataclass, field
from pathlib import Path

import numpy as np

from thermodata.plugin import Array, Int1D, Loss
from thermodata.schema.flag import Flag
from thermodata.store.raw.columns import RawFiles
from thermodata.store.raw.order import Order, in_order
from thermodata.store.raw.raw_stream import RawStream
from thermodata.store.raw.repeats import pieces
from thermodata.store.tidy.rows.in_parts import InPart, Parts, joined_parts

_IN_MEMORY = 1_000_000  # rows: so many times are kept [8 MB]; of longer streams they are read again
_PROBE = 4096
WHOLE_CLOCK = "the whole clock is doubtful"
_MOST_STRETCHES = 50


@dataclass(slots=True)
class Timeline:
    """rows: how many. raws: (raw, what is added to its times [ns]) in file order. cut: (first, past-the-last) rows of
    them that are left out, shape (k, 2). doubt: why the whole clock is suspect. parts: what files have under other
    names, or in other units (`in_parts`).

    Row numbers count in time order. Not shared between threads.
    """

    rows: int
    store: Path | None = None
    raws: Sequence[tuple[RawStream, int]] = ()
    correct: Callable[[Int1D], Int1D] = field(default=lambda t: t)
    order: Order = field(default_factory=lambda: in_order(0))
    suspect: bool = False
    losses: tuple[Loss, ...] = ()
    notes: tuple[str, ...] = ()
    cut: Int1D = field(default_factory=lambda: np.empty((0, 2), np.int64))
    parts: Parts = field(default_factory=dict)
    doubt: str = ""
    _files: RawFiles = field(default_factory=RawFiles)
    _times: Int1D | None = None

    @property
    def t_ns(self) -> Int1D:
        """All times, shape (rows,), non-decreasing: for streams that are known to be short."""
        return self.times(0, self.rows)

    def times(self, start: int, stop: int) -> Int1D:
        """Times of rows start to stop, shape (stop - start,), non-decreasing [ns]."""
        if self._times is None and self.rows <= _IN_MEMORY:
            self._times = self._sorted_times(0, self.rows)
        if self._times is not None:
            return self._times[start:stop]
        return self._sorted_times(start, stop)

    def find(self, at_ns: int) -> int:
        """The first row that is no earlier."""
        low, high = 0, self.rows
        if self.rows <= _IN_MEMORY:
            return int(np.searchsorted(self.t_ns, at_ns))
        while high - low > _PROBE:
            middle = (low + high) // 2
            if int(self.times(middle, middle + 1)[0]) < at_ns:
                low = middle + 1
            else:
                high = middle
        return low + int(np.searchsorted(self.times(low, high), at_ns))

    def clock_flags(self, start: int, stop: int) -> Array | None:
        """CLOCK_SUSPECT, shape (stop - start,), where rows were moved or the whole clock is doubtful; None: nowhere."""
        whole_clock = np.full(stop - start, Flag.CLOCK_SUSPECT, np.uint16) if self.suspect else None
        low, high, order = self._window(start, stop)
        if order is None and not self._marked_in(low, high).size:
            return whole_clock
        t = self.file_times(low, high)
        late = np.zeros(high - low, dtype=bool)
        for a, b in [] if self.order.trusted else self._islands_in(low, high):
            part = t[a - low : b - low]
            late[a - low : b - low] = part < np.maximum.accumulate(part)
        late[self._marked_in(low, high) - low] = True
        late_rows = (late if order is None else late[order])[start - low : stop - low]
        moved = np.where(late_rows, np.uint16(Flag.CLOCK_SUSPECT), np.uint16(0))
        return moved if whole_clock is None else whole_clock | moved

    def clock_stretches(self) -> list[tuple[int, int, int, str]]:
        """(first time, last time [ns], rows, why) of the stretches with a doubtful time; at most 50."""
        if self.suspect and self.rows:
            return [
                (
                    int(self.times(0, 1)[0]),
                    int(self.times(self.rows - 1, self.rows)[0]),
                    self.rows,
                    f"{WHOLE_CLOCK}: {self.doubt}" if self.doubt else WHOLE_CLOCK,
                )
            ]
        marked, stretches = self.order.marked, []
        groups = np.split(marked, np.flatnonzero(np.diff(marked) > 1) + 1) if marked.size else []
        for rows in groups[:_MOST_STRETCHES]:
            t = self.file_times(int(rows[0]), int(rows[-1]) + 1)
            stretches.append((int(t.min()), int(t.max()), len(rows), "; ".join(self.order.notes)))
        unsorted = [] if self.order.trusted else self.order.islands.tolist()
        for a, b in unsorted[: _MOST_STRETCHES - len(stretches)]:
            t = self.file_times(a, b)
            late = int(np.count_nonzero(t < np.maximum.accumulate(t)))
            stretches.append((int(t.min()), int(t.max()), late, "rows out of order, sorted"))
        return sorted(stretches)

    def column(self, store: Path, signal: str, start: int, stop: int, *, flags: bool = False) -> Array | None:
        """A raw column, rows start to stop in time order; None where no file has it."""
        return self.columns([signal], start, stop, flags=flags).get(signal)

    def columns(self, signals: Sequence[str], start: int, stop: int, *, flags: bool = False) -> dict[str, Array]:
        """Raw columns (or the flags that the reader gave), rows start to stop; those that no file has are left out."""
        low, high, order = self._window(start, stop)
        parts: dict[str, list[Array | int]] = {s: [] for s in signals}
        for raw, a, b in self._parts_of_rows(low, high):
            names = {s: self._name(raw, s, flags) for s in signals}
            there = [n for n in names.values() if n is not None]
            read = dict(zip(there, self._read_rows(raw, there, a, b), strict=True)) if there else {}
            for signal, name in names.items():
                own = self.part(raw, signal)
                parts[signal].append(b - a if name is None else read[name] if flags else own.read(read[name]))
        arrays = {}
        for signal, some in parts.items():
            if all(isinstance(p, int) for p in some):
                continue
            joined = joined_parts(some, zero=flags)
            arrays[signal] = (joined if order is None else joined[order])[start - low : stop - low]
        return arrays

    def raw_row(self, row: int) -> tuple[RawStream, int]:
        """(raw stream, its row) behind a row."""
        low, _, order = self._window(row, row + 1)
        at = row if order is None else low + int(order[row - low])
        raw, file_row, _ = next(iter(self._parts_of_rows(at, at + 1)))
        return raw, raw.rows - 1 - file_row if raw.newest_first else file_row

    def flagged(self, signals: Iterable[str]) -> bool:
        """Whether a reader flagged any row of these signals."""
        wanted = list(signals)
        return any(self.part(raw, signal).name in raw.flagged for raw, _ in self.raws for signal in wanted)

    def part(self, raw: RawStream, signal: str) -> InPart:
        """A signal as one of the files has it."""
        return self.parts.get((raw.path, signal)) or InPart(signal)

    def _name(self, raw: RawStream, signal: str, flags: bool) -> str | None:
        name = self.part(raw, signal).name
        column = raw.columns.get(name)
        if flags:
            return f"{column}__flag" if name in raw.flagged else None
        return column

    def _read_rows(self, raw: RawStream, columns: Sequence[str], start: int, stop: int) -> list[Array]:
        assert self.store is not None
        file = self._files.get(self.store / raw.path)
        if raw.newest_first:
            return [a[::-1] for a in file.read(columns, raw.rows - stop, raw.rows - start)]
        return file.read(columns, start, stop)

    def _parts_of_rows(self, start: int, stop: int) -> Iterable[tuple[RawStream, int, int]]:
        """(raw, its rows a to b) that make up rows start to stop in file order; of a file that stands newest first
        they are counted from its end."""
        at = 0
        for k, low, high in pieces([raw.rows for raw, _ in self.raws], self.cut):
            a, b = max(start - at, 0), min(stop - at, high - low)
            at += high - low
            if a < b:
                yield self.raws[k][0], low + a, low + b

    def file_times(self, start: int, stop: int) -> Int1D:
        """Times in file order, corrected and with what resets add."""
        shifts = {id(raw): shift for raw, shift in self.raws}
        parts = [
            self._read_rows(raw, ["t_ns"], a, b)[0].astype(np.int64, copy=False) + np.int64(shifts[id(raw)])
            for raw, a, b in self._parts_of_rows(start, stop)
        ]
        if not parts:
            return np.empty(0, np.int64)
        return self.order.moved(self.correct(parts[0] if len(parts) == 1 else np.concatenate(parts)), start)

    def _sorted_times(self, start: int, stop: int) -> Int1D:
        if self.store is None:
            raise AssertionError("a timeline without files has its times")
        low, high, order = self._window(start, stop)
        t = self.file_times(low, high)
        return (t if order is None else t[order])[start - low : stop - low]

    def _window(self, start: int, stop: int) -> tuple[int, int, Int1D | None]:
        """(low, high, order): the rows in file order that hold rows start to stop, and the permutation that sorts
        them (None: they are sorted)."""
        some = self._islands_in(start, stop)
        if not len(some):
            return start, stop, None
        low, high = min(start, int(some[0, 0])), max(stop, int(some[-1, 1]))
        order = np.arange(high - low)
        t = self.file_times(low, high)
        for a, b in some.tolist():
            order[a - low : b - low] = a - low + np.argsort(t[a - low : b - low], kind="stable")
        return low, high, order

    def _islands_in(self, start: int, stop: int) -> Int1D:
        islands = self.order.islands
        a = int(np.searchsorted(islands[:, 1], start, side="right"))
        b = int(np.searchsorted(islands[:, 0], stop, side="left"))
        return islands[a:b]

    def _marked_in(self, start: int, stop: int) -> Int1D:
        marked = self.order.marked
        return marked[np.searchsorted(marked, start) : np.searchsorted(marked, stop)]


def given_timeline(t_ns: Int1D) -> Timeline:
    """Of times that no file holds."""
    return Timeline(len(t_ns), order=in_order(len(t_ns)), _times=t_ns)
