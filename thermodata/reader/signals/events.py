"""Logs of changes (time, signal, new value) as rows: each signal holds its last value until the next one.

The one way that readers of event logs share (SHDR, MTConnect, OPC UA, on-change traces), so that all of them hold,
start and break off alike. No value (before the first, while the source says UNAVAILABLE) is NaN or None and flagged
as not measuring; the first value after such a hole is flagged as the first after a gap; a value that the source itself
calls bad is kept and flagged as not measuring for as long as it holds. Of a signal that is written at a steady beat a
value ends where that is missed (`Beat`).
"""

from __future__ import annotations

from collections.abc import Callable, Mapping
from typing import Generic, TypeVar

import numpy as np

from thermodata.plugin import Array, Block, Bool1D, Int1D
from thermodata.reader.signals.beat import Beat
from thermodata.schema.flag import Flag

Value = float | str | None
Stamp = TypeVar("Stamp", int, str)

NAT = np.iinfo(np.int64).min
_NONE = int(Flag.NOT_MEASURING)
_STEP_NS = 60 * 10**9


class HeldRows(Generic[Stamp]):
    """Collects values into blocks of rows. Values that share a time stamp and stand together share a row; of several
    values of one signal in a row the last stands, for a state has one value at a time.

    keep_all: each value of one signal at one time has a row of its own, for samples under coarse stamps are no states.

    dtypes: signal -> "str" or a number's. ordered: the log's own order is the order of its rows, as recorded; else
    rows are sorted by time inside a block, so that stamps of several clocks in one table do not step back (a step of
    a minute or more is no such jitter and stays where it is). beats: of signals that are written at one.
    """

    def __init__(
        self,
        dtypes: Mapping[str, str],
        stream: str,
        ordered: bool = True,
        keep_all: bool = False,
        beats: Mapping[str, Beat] | None = None,
    ) -> None:
        self.stream, self._ordered, self._keep_all = stream, ordered, keep_all
        self._beats = beats or {}
        self._written: dict[str, int] = {}  # when the value that is held was [ns]
        self._dtypes = dict(dtypes)
        self._held: dict[str, tuple[Value, int]] = dict.fromkeys(self._dtypes, (None, _NONE))
        self._seen: set[str] = set()
        self._stamps: list[Stamp] = []
        self._at: list[int | None] = []
        self._changes: dict[str, tuple[list[int], list[Value], list[int]]] = {}

    def __len__(self) -> int:
        return len(self._stamps)

    @property
    def last(self) -> Stamp | None:
        """The time stamp of the row that still grows."""
        return self._stamps[-1] if self._stamps else None

    def add(self, stamp: Stamp, name: str, value: Value, flag: int = 0, at: int | None = None) -> None:
        """Takes a value (None: the source has none). flag: what the source itself says of it, as a Flag; at: where it
        stands in the log: a row stands where its first value does. KeyError: no such signal."""
        if name not in self._dtypes:
            raise KeyError(name)
        rows, values, flags = self._changes.setdefault(name, ([], [], []))
        again = self._keep_all and bool(rows) and rows[-1] == len(self._stamps) - 1
        if again or not self._stamps or self._stamps[-1] != stamp:
            self._stamps.append(stamp)
            self._at.append(at)
        rows.append(len(self._stamps) - 1)
        values.append(value)
        flags.append(flag | _NONE if value is None else flag)

    def drop_last(self) -> None:
        """Forgets the row that still grows."""
        if not self._stamps:
            return
        self._stamps.pop()
        self._at.pop()
        for rows, values, flags in self._changes.values():
            while rows and rows[-1] == len(self._stamps):
                del rows[-1], values[-1], flags[-1]

    def take(self, to_ns: Callable[[list[Stamp]], Int1D]) -> tuple[Block | None, list[Stamp]]:
        """(the rows so far as a block, the stamps that are no time). to_ns gives NAT for such a stamp; its rows are
        left out."""
        if not self._stamps:
            return None, []
        t_ns = to_ns(self._stamps)
        good = t_ns != NAT
        bad = [s for s, fine in zip(self._stamps, good, strict=True) if not fine]
        place, times = self._places(t_ns, good)
        values: dict[str, Array] = {}
        flags: dict[str, Array] = {}
        for name, dtype in self._dtypes.items():
            values[name], flag = self._column(name, dtype, place, times)
            if flag.any():
                flags[name] = flag
        at = self._first_at(place, times.size)
        self._stamps, self._at, self._changes = [], [], {}
        return (Block(self.stream, times, values, flags or None, at) if times.size else None), bad

    def _places(self, t_ns: Int1D, good: Bool1D) -> tuple[Int1D, Int1D]:
        """The block's row of each collected row (-1: none), and the rows' times."""
        place = np.where(good, np.cumsum(good) - 1, -1)
        times = t_ns[good]
        steps = np.diff(times)
        if self._ordered or not (steps < 0).any() or steps.min() <= -_STEP_NS:
            return place, times
        unique, inverse = np.unique(times, return_inverse=True)
        if self._keep_all and (twice := self._have_several_values(place, inverse)).any():
            # rows of a time at which a signal has two values stay as they are, one behind the other
            turn = np.where(twice[inverse], _place_among_equal_times(times), 0)
            unique, inverse = np.unique(np.stack([times, turn]), axis=1, return_inverse=True)
            unique = unique[0]
        place[good] = inverse.ravel()
        return place, unique

    def _have_several_values(self, place: Int1D, inverse: Int1D) -> Bool1D:
        """At which times a signal has several values; inverse: which time each row has."""
        found = np.zeros(int(inverse.max(initial=-1)) + 1, bool)
        for rows, _, _ in self._changes.values():
            at = place[rows]
            found |= np.bincount(inverse[at[at >= 0]], minlength=found.size) > 1
        return found

    def _first_at(self, place: Int1D, n: int) -> Int1D | None:
        """Where the block's rows stand; None where the values did not say so."""
        known = [at for at in self._at if at is not None]
        if len(known) < len(self._at):
            return None
        first: Int1D = np.full(n, np.iinfo(np.int64).max)
        np.minimum.at(first, place[place >= 0], np.array(known, np.int64)[place >= 0])
        return first

    def _column(self, name: str, dtype: str, place: Int1D, times: Int1D) -> tuple[Array, Array]:
        n = times.size
        kind = object if dtype == "str" else np.float64
        rows, values, flags = self._changes.get(name, ([], [], []))
        at = place[rows] if rows else np.empty(0, np.int64)
        order = np.argsort(at, kind="stable")[np.count_nonzero(at < 0) :]
        known = np.empty(order.size + 1, kind)
        marks = np.empty(order.size + 1, np.uint16)
        known[0], marks[0] = _cell(self._held[name][0], dtype), self._held[name][1]
        which = np.zeros(n, np.int64)
        gaps = []
        for number, k in enumerate(order, 1):
            known[number], marks[number] = _cell(values[k], dtype), flags[k]
            which[at[k]] = number
            if values[k] is not None:
                if known[number - 1] is None or (kind is np.float64 and np.isnan(known[number - 1])):
                    gaps += [int(at[k])] if name in self._seen else []
                self._seen.add(name)
        which = np.maximum.accumulate(which)
        marked = marks[which]
        if gaps:
            marked[gaps] |= np.uint16(Flag.GAP)
        last = known[-1]
        self._held[name] = (None if last is None or last != last else last, int(marks[-1]))
        column = known[which]
        if name in self._beats:
            self._end(name, column, marked, np.append(self._written.get(name, NAT), times[at[order]])[which], times)
        return column, marked

    def _end(self, name: str, column: Array, marked: Array, written: Int1D, times: Int1D) -> None:
        """Ends values that stand for longer than their beat. written: when each row's was, shape (n,), NAT before the
        first; column, marked: values and flags, changed in place."""
        beat = self._beats[name]
        none = column.dtype.type(np.nan) if column.dtype.kind == "f" else None
        told = written != NAT
        before = np.append(self._written.get(name, NAT), written[:-1])
        anew = told & (before != NAT) & (written != before)
        held = np.append(column[:1], column[:-1])
        again = anew & beat.ended(held, np.where(anew, written - before, 0))
        old = told & beat.ended(column, np.where(told, times - written, 0))
        column[old], marked[old] = none, marked[old] | np.uint16(_NONE)
        marked[again] |= np.uint16(Flag.GAP)
        self._written[name] = int(written[-1]) if written.size else NAT


def _place_among_equal_times(times: Int1D) -> Int1D:
    """How many of the times before it are the same as each, shape (n,)."""
    order = np.argsort(times, kind="stable")
    t = times[order]
    starts = np.flatnonzero(np.concatenate([[True], t[1:] != t[:-1]]))
    turns = np.empty(times.size, np.int64)
    turns[order] = np.arange(times.size) - np.repeat(starts, np.diff(np.append(starts, times.size)))
    return turns


def _cell(value: Value, dtype: str) -> Value:
    if dtype == "str":
        return None if value is None else str(value)
    return np.nan if value is None else float(value)


def fill_forward(values: Array, written: Bool1D) -> Array:
    """The last written value at each row; rows before the first written one keep what they have.

    values: shape (n,); written: shape (n,), True where the log holds a value of its own.
    """
    last: Int1D = np.maximum.accumulate(np.where(written, np.arange(values.size), -1))
    return np.where(last >= 0, values[np.maximum(last, 0)], values)
