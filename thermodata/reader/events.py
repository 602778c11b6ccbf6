"""Logs of changes (time, signal, new value) as rows: each signal holds its last value until the next one.

The one way that readers of event logs share (SHDR, MTConnect, OPC UA, on-change traces), so that all of them hold,
start and break off alike.
"""

from __future__ import annotations

from collections.abc import Iterable, Iterator, Sequence

import numpy as np

from thermodata.plugin import Array, Block, Bool1D, Int1D, Signal
from thermodata.schema.flag import Flag

Event = tuple[int, str, float | str | None]


def held_blocks(
    events: Iterable[Event], signals: Sequence[Signal], stream: str, rows: int = 100_000
) -> Iterator[Block]:
    """Blocks with one row for each time at which anything changed, in the order of the events.

    events: (t_ns, signal name, value); of several values of one signal at one time the last stands; None means that
    the source says it has no value (UNAVAILABLE): NaN or '' flagged as a gap, until the next value. Before its first
    value a signal is NaN or '', flagged the same way. Names that are none of `signals` raise KeyError.
    """
    wanted = [s for s in signals if s.stream == stream]
    column = {s.name: i for i, s in enumerate(wanted)}
    state: list[float | str | None] = [None] * len(wanted)
    buffer: list[Event] = []
    for event in events:
        # a block ends only between two times, so that no row is torn
        if len(buffer) >= rows and event[0] != buffer[-1][0]:
            yield _block(buffer, wanted, column, state, stream)
            buffer = []
        buffer.append(event)
    if buffer:
        yield _block(buffer, wanted, column, state, stream)


def _block(events: list[Event], signals: list[Signal], column: dict[str, int], state: list[float | str | None],
           stream: str) -> Block:
    """One block; `state` (the value that each signal holds) is carried on to the next."""
    t = np.array([e[0] for e in events], np.int64)
    new = np.concatenate(([True], t[1:] != t[:-1]))
    row = np.cumsum(new) - 1
    n = int(row[-1]) + 1
    which = np.array([column[e[1]] for e in events], np.int64)
    values: dict[str, Array] = {}
    flags: dict[str, Array] = {}
    for i, signal in enumerate(signals):
        own = np.flatnonzero(which == i)
        changes: list[float | str | None] = [state[i], *(events[k][2] for k in own)]
        at = np.searchsorted(row[own], np.arange(n), "right")
        missing = np.array([c is None for c in changes], bool)[at]
        if signal.dtype == "str":
            held = np.array(["" if c is None else str(c) for c in changes], object)[at]
        else:
            held = np.array([np.nan if c is None else float(c) for c in changes], np.float64)[at]
        values[signal.name] = held
        if missing.any():
            flags[signal.name] = np.where(missing, np.uint16(Flag.GAP | Flag.NOT_MEASURING), np.uint16(0))
        state[i] = changes[-1]
    return Block(stream, t[new], values, flags or None)


def fill_forward(values: Array, written: Bool1D) -> Array:
    """The last written value at each row; rows before the first written one keep what they have.

    values: shape (n,); written: shape (n,), True where the log holds a value of its own.
    """
    last: Int1D = np.maximum.accumulate(np.where(written, np.arange(values.size), -1))
    return np.where(last >= 0, values[np.maximum(last, 0)], values)
