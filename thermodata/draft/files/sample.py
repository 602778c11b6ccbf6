"""A bounded sample of a file's values, for a draft: their ranges, and the courses that tell what a test was."""

from __future__ import annotations

import time
from collections.abc import Mapping, Sequence
from dataclasses import dataclass, field
from pathlib import Path

import numpy as np

from thermodata.draft.files.set_back import Clock, SetBack, extent_of, first_of, notes_of
from thermodata.draft.files.where_it_steps import where_it_steps
from thermodata.draft.signals.guess import guess_of, says_nothing
from thermodata.draft.signals.numerals import bare_word
from thermodata.draft.signals.values import Values, joined, values_of
from thermodata.errors import ThermodataError
from thermodata.plugin import Array, Block, Float1D, Int1D, Loss, Reader, Recording, Signal, Source
from thermodata.reader.contract.guard import guarded

_SAMPLE_ROWS, _SAMPLE_S = 400_000, 1.0  # of one file
_MOST_LOST, _TOLD_SHARE = 2, 0.01
SMALL = 4_000_000  # bytes; smaller files are read whole
_PATIENCE = 4.0  # times as long on the wall, for others may keep the machine busy
LONGEST_JUMP_NS = 3600 * 10**9
HEAD_NS = 1800 * 10**9  # of a jump test at the beginning of a test
MOST_WORDS = 2  # of what may be a switch
_PROBES = ("displacement", "voltage")
_KEPT_ROWS = 3000  # of a signal whose course tells what a test is
_PROBE_ROWS = 20_000  # of a block of a probe, which may be moved for seconds within hours
_COURSE = ("rotational_speed", "feed", "displacement", "voltage", "position", "state")
_COURSE_IF_ROOM = ("power", None)  # None: what no name says its values may, as of a switch
_MOST_COURSES = 40


class Watch:
    """Counts the processor's time, and a share of that on the wall: what is looked at must not hang on what else the
    machine does, and nobody waits for ever for a slow disk."""

    def __init__(self) -> None:
        self._cpu, self._wall = time.process_time(), time.monotonic()

    @property
    def spent_s(self) -> float:
        return max(time.process_time() - self._cpu, (time.monotonic() - self._wall) / _PATIENCE)


@dataclass(frozen=True, slots=True)
class Course:
    """How a signal went, thinned out. t_ns, values: shape (n,), n <= 3000."""

    t_ns: Int1D
    values: Float1D


@dataclass(frozen=True, slots=True)
class RepeatedTimes:
    """Rows at the time of the row before. rows: how many; period_s: how far rows are apart if they are even."""

    rows: int = 0
    period_s: float = 0.0

    def beside(self, t_ns: Int1D) -> RepeatedTimes:
        """With those of another block of times, shape (n,)."""
        same = int(np.count_nonzero(np.diff(t_ns) == 0))
        if not same:
            return self
        stamps, times = np.unique(t_ns, return_counts=True)
        steps = np.diff(stamps) if stamps.size > 1 else np.zeros(1, np.int64)
        return RepeatedTimes(self.rows + same, float(np.median(steps)) / float(np.median(times)) / 1e9 or self.period_s)


@dataclass(frozen=True, slots=True)
class Sample:
    """Of a file's values. whole: to its end; hurried: for want of time fewer of them than there would have been rows
    for; first_ns, last_ns: of what was read, where a clock was set ahead by years as if it had been right before;
    failed: what ended the reading of it; repeats: of times; set_back: the clock, within the file;
    lost: what the first losses say;
    mended: what an ingest will say that it mended of the clock; extents: the lowest and highest value in the part of
    the file that the courses are of, where that is not all of it; periods_s: how far the rows of a stream are usually
    apart; heads: the first half hour of each probe, of whose jump test a course may have no point on a plateau; steps:
    the stretches of a long log in which a probe goes in sudden steps, as in a jump test; words: some of those that
    signals have which are no switch."""

    values: Mapping[tuple[str, str], Values] = field(default_factory=dict)
    courses: Mapping[tuple[str, str], Course] = field(default_factory=dict)
    whole: bool = False
    hurried: bool = False
    first_ns: int | None = None
    last_ns: int | None = None
    losses: int = 0
    lost: tuple[str, ...] = ()
    rows: int = 0
    failed: str = ""
    repeats: RepeatedTimes = RepeatedTimes()
    set_back: SetBack | None = None
    mended: tuple[str, ...] = ()
    extents: Mapping[tuple[str, str], tuple[float, float]] = field(default_factory=dict)
    periods_s: Mapping[str, float] = field(default_factory=dict)
    heads: Mapping[tuple[str, str], Course] = field(default_factory=dict)
    steps: Mapping[tuple[str, str], tuple[Course, ...]] = field(default_factory=dict)
    words: Mapping[tuple[str, str], frozenset[str]] = field(default_factory=dict)


def sample_of(path: Path, who: Reader, source: Source, recording: Recording, size: int) -> Sample:
    """A file's values: of a small one all, of others the first rows. recording: as its reader describes it; size: in
    bytes."""
    watch, rows, losses, whole, hurried, failed = Watch(), 0, 0, True, False, ""
    lost: list[str] = []
    repeats, clocks = RepeatedTimes(), dict[str, Clock]()
    values: dict[tuple[str, str], Values] = {}
    parts: dict[tuple[str, str], list[tuple[Int1D, Array]]] = {}
    worded: dict[tuple[str, str], frozenset[str]] = {}
    probes = {(s.stream, s.name) for s in recording.signals if guess_of(s).quantity in _PROBES}
    wanted = {k: _PROBE_ROWS if k in probes else _KEPT_ROWS for k in _courses(recording.signals)}
    first: int | None = None
    last: int | None = None
    unseen = {s.stream for s in recording.signals}
    items = guarded(who, path, source, recording)
    try:
        for item in items:
            if isinstance(item, Loss):
                losses += 1
                lost += [_said(item)] if len(lost) < _MOST_LOST else []
                continue
            _take(item, values, parts, wanted, worded)
            unseen.discard(item.stream)
            repeats = repeats.beside(item.t_ns)
            clocks.setdefault(item.stream, Clock()).add(item)
            first = min(x for x in (first, int(item.t_ns[0])) if x is not None)
            last = max(x for x in (last, int(item.t_ns[-1])) if x is not None)
            rows += item.t_ns.size
            spent = watch.spent_s
            if size < SMALL and spent < 10 * _SAMPLE_S:
                continue
            if spent > 2 * _SAMPLE_S or (not unseen and (rows >= _SAMPLE_ROWS or spent > _SAMPLE_S)):
                whole, hurried = False, rows < _SAMPLE_ROWS
                break
    except (ThermodataError, OSError, MemoryError) as error:
        losses, whole, failed = losses + 1, False, short(error)
    finally:
        items.close()  # type: ignore[attr-defined]
    first, last = extent_of(clocks) or (first, last)
    brief = whole and (last or 0) - (first or 0) <= LONGEST_JUMP_NS  # a jump test may be of what nothing tells of
    told = {(s.stream, s.name) for s in recording.signals if brief or _tells(s, values.get((s.stream, s.name)))}
    return Sample(
        values,
        {k: _thinned(_coarse(v)) for k, v in parts.items() if k in told},
        whole,
        hurried,
        first,
        last,
        losses,
        tuple(lost),
        rows,
        failed,
        repeats,
        first_of(clocks),
        notes_of(clocks),
        periods_s={stream: clock.period_s for stream, clock in clocks.items()},
        heads={k: _thinned(_head(v, first or 0)) for k, v in parts.items() if k in told and k in probes},
        steps={} if brief else {k: _in_steps(v) for k, v in parts.items() if k in told and k in probes},
        words=worded,
    )


def _said(loss: Loss) -> str:
    """What a loss says of where, why, and how much of a file that is."""
    share = f" ({loss.fraction:.0%} of the file)" if loss.fraction and loss.fraction >= _TOLD_SHARE else ""
    return f"{loss.where}: {loss.reason}{share}"


def short(error: Exception) -> str:
    """What an error says and what it got, in one line."""
    got = getattr(error, "got", None)
    what = getattr(error, "what", None) or str(error) or type(error).__name__
    return "; ".join(str(what).splitlines()) + (f" ({got})" if got else "")


def _courses(signals: Sequence[Signal]) -> set[tuple[str, str]]:
    """The signals whose course is kept: what tells the kind of a test, a jump, a clock, or when it measures."""
    found: list[tuple[int, tuple[str, str]]] = []
    for signal in signals:
        quantity = guess_of(signal).quantity
        if signal.dtype == "str" or quantity not in (*_COURSE, *_COURSE_IF_ROOM):
            continue
        rank = 0 if quantity in _COURSE else 1 + _COURSE_IF_ROOM.index(quantity)
        # what a bare 'value' is, its file's name may say
        rank -= quantity is None and says_nothing(signal.name)
        found.append((rank, (signal.stream, signal.name)))
    found.sort(key=lambda one: one[0])
    return {key for _, key in found[:_MOST_COURSES]}


def _tells(signal: Signal, values: Values | None) -> bool:
    """Whether a course is kept to the end: of what neither its name nor its values say, only that of a bare 'value'."""
    said = guess_of(signal)
    return said.quantity is not None or says_nothing(signal.name) or guess_of(signal, values).quantity == "state"


def _take(
    block: Block,
    values: dict[tuple[str, str], Values],
    parts: dict[tuple[str, str], list[tuple[Int1D, Array]]],
    wanted: Mapping[tuple[str, str], int],
    worded: dict[tuple[str, str], frozenset[str]],
) -> None:
    """wanted: signals whose course is kept -> about how many rows of a block; worded: signals so far with words that
    are none of a switch; they have no values. -> some of these words"""
    for name, column in block.values.items():
        key = (block.stream, name)
        seen = values_of(column)
        if seen is None and column.dtype.kind in "OUS":
            worded |= _worded(key, column, worded, values)
        if key in worded:
            values.pop(key, None)
            continue
        both = joined(values.get(key), seen)
        if both is not None:
            values[key] = both
        if key in wanted and column.dtype.kind in "biuf":
            step = max(1, column.size // wanted[key])
            parts.setdefault(key, []).append((block.t_ns[::step], column[::step].astype(np.float64)))


def _worded(
    key: tuple[str, str],
    column: Array,
    worded: Mapping[tuple[str, str], frozenset[str]],
    values: Mapping[tuple[str, str], Values],
) -> dict[tuple[str, str], frozenset[str]]:
    """The words of a signal with those of another block of it, which are none of a switch; none of an empty one."""
    before = worded.get(key, frozenset())
    if len(before) > MOST_WORDS:
        return {}
    # those of a block that had values are not kept, but are others than these
    before |= {"on", "off", "or a number"} if key in values else frozenset()
    said = {bare for word in set(column.tolist()) if (bare := bare_word(word))}
    return {key: before | frozenset(sorted(said)[: MOST_WORDS + 1])} if said else {}


def _coarse(parts: Sequence[tuple[Int1D, Array]]) -> list[tuple[Int1D, Array]]:
    """The parts of a course, of each as many rows as one that tells what a test is needs."""
    steps = [max(1, t.size // _KEPT_ROWS) for t, _ in parts]
    return [(t[::step], x[::step]) for (t, x), step in zip(parts, steps, strict=True)]


def _head(parts: Sequence[tuple[Int1D, Array]], first_ns: int) -> list[tuple[Int1D, Array]]:
    """What of the parts of a course lies in the first half hour, though that be nothing."""
    return [(t[early], x[early]) for t, x in parts for early in [t < first_ns + HEAD_NS]]


def _in_steps(parts: Sequence[tuple[Int1D, Array]]) -> tuple[Course, ...]:
    """The stretches in which a signal goes in sudden steps, as they were logged."""
    t_ns, x = (np.concatenate(p) for p in zip(*parts, strict=True))
    found = where_it_steps(t_ns, x)
    return tuple(_thinned([(t_ns[a:b], x[a:b])]) for a, b in (np.searchsorted(t_ns, ends) for ends in found))


def _thinned(parts: Sequence[tuple[Int1D, Array]]) -> Course:
    t_ns, x = (np.concatenate(p) for p in zip(*parts, strict=True))
    step = max(1, -(-t_ns.size // _KEPT_ROWS))
    return Course(t_ns[::step], x[::step])
