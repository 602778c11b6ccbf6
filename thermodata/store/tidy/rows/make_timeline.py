"""The rows of the files of one stream, put in time order."""

from __future__ import annotations

from collections.abc import Callable, Iterator, Sequence
from itertools import accumulate, pairwise
from pathlib import Path

import numpy as np

from thermodata.plugin import Array, Int1D, Loss
from thermodata.reader.times.clock_leaps import LEAP_NS
from thermodata.reader.times.newest_first import Steps
from thermodata.reader.times.step_back import OLDER, SHARED, cause_of, said
from thermodata.reader.times.zone import NO_ZONE
from thermodata.schema.words.sentences import counted
from thermodata.store.raw.order import CHUNK_ROWS, Order, by_time, find_order, in_order
from thermodata.store.raw.raw_stream import RawStream
from thermodata.store.raw.repeats import Hashes, batches, find_repeats, keys_of
from thermodata.store.tidy.rows.timeline import Timeline

_LOOKED_AT = 10_000  # rows


def make_timeline(
    store: Path,
    raws: Sequence[tuple[RawStream, int]],
    correct: Callable[[Int1D], Int1D],
    *,
    suspect: bool,
    resets_allowed: bool,
    notes: Sequence[str],
    shared: bool = False,
) -> Timeline:
    """Puts the rows of the files of one stream in order.

    raws: (raw, what is added to its times) in file order. correct: recorded times -> the test's time line. shared:
    other tests have the same files.
    Rows that step back by a second at most are sorted in and flagged. What stands in the files twice is left out
    (`repeats`); `clock_faults` says what is done about strays and clocks that were set. What follows a long step back
    is lost with a reason where resets are not allowed.
    """
    n = sum(raw.rows for raw, _ in raws)
    line = Timeline(n, store, tuple(raws), correct, in_order(n), suspect, (), tuple(notes))
    if _known_ordered(raws):
        return line
    if all(raw.unordered or raw.ordered for raw, _ in raws) and any(raw.unordered for raw, _ in raws):
        order = by_time(line.file_times, n, resets_allowed=resets_allowed)
    else:
        begins = [0, *accumulate(raw.rows for raw, _ in raws)]
        held = all(s.held for raw, _ in raws for s in raw.signals)
        twice = find_repeats(line.file_times, _keys(line), n, begins, held=held)
        line.cut, n = twice.cut, n - int((twice.cut[:, 1] - twice.cut[:, 0]).sum())
        line.notes += twice.notes()
        order = find_order(line.file_times, n, resets_allowed=resets_allowed, sound=twice.left())
    if order.keep < n:
        line.losses = (_loss_of_rows(line, order, n, resets_allowed, shared),)
    line.notes += order.notes
    line.order, line.rows = order, order.keep
    return line


def _known_ordered(raws: Sequence[tuple[RawStream, int]]) -> bool:
    return all(raw.ordered for raw, _ in raws) and all(
        0 <= b.first_ns + r - a.last_ns - s <= LEAP_NS for (a, s), (b, r) in pairwise(raws)
    )


def _keys(line: Timeline) -> Callable[[int, int], Hashes]:
    """What tells the values of rows apart; a signal that a file lacks is one without a value."""
    text = {s.name: s.dtype == "str" for raw, _ in line.raws for s in raw.signals}

    def columns(start: int, stop: int) -> Iterator[Array]:
        for names in batches(list(text), stop - start):
            found = line.columns(names, start, stop)
            for name in names:
                yield found[name] if name in found else np.full(stop - start, None if text[name] else np.nan)

    def keys(start: int, stop: int) -> Hashes:
        return keys_of(columns(start, stop), stop - start)

    return keys


def _loss_of_rows(line: Timeline, order: Order, n: int, resets_allowed: bool, shared: bool) -> Loss:
    keep, steps = order.keep, Steps()
    steps.add(line.file_times(keep, min(n, keep + _LOOKED_AT)))
    at, before = int(line.file_times(keep, keep + 1)[0]), int(line.file_times(keep - 1, keep)[0])
    absolute, of_day = line.raws[0][0].clock == "absolute", line.raws[0][0].of_day_ns
    local = absolute and any(NO_ZONE in note for note in line.raws[0][0].notes)
    if steps.in_no_order:
        advice = "rows stand in no order of their times: sort the file by them"
    elif resets_allowed:
        times = counted(len(order.at), "reset")
        advice = f"behind {times} no time is left for what follows: are these its times? declare their format or column"
    elif (cause := cause_of(before, at, absolute, local, of_day, line.raws[0][0].notes)) is not None:
        advice = cause
    elif absolute and shared:
        advice = SHARED
    elif absolute and _latest(line, keep, n) < _earliest(line, keep):
        advice = OLDER
    else:
        advice = "split the test there or set clock: {resets: allow}"
    return Loss(
        where=f"{line.raws[0][0].source_path} row {keep}",
        from_ns=at,
        to_ns=int(line.file_times(n - 1, n)[0]),
        fraction=(n - keep) / n,
        reason=f"clock goes backwards by {said(before, at, absolute, local, of_day)}; {advice}",
    )


def _earliest(line: Timeline, stop: int) -> int:
    return min(int(line.file_times(a, min(stop, a + CHUNK_ROWS)).min()) for a in range(0, stop, CHUNK_ROWS))


def _latest(line: Timeline, start: int, stop: int) -> int:
    return max(int(line.file_times(a, min(stop, a + CHUNK_ROWS)).max()) for a in range(start, stop, CHUNK_ROWS))
