"""The start that a text beside the signals says (`start_time`), from which times count where that is declared."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass
from typing import Protocol

import numpy as np

from thermodata.plugin import Int1D, Source
from thermodata.reader.text.preamble.begin import (
    BY_HALF,
    ROWS,
    Begin,
    FirstTimes,
    declared_start,
    find_begin,
    not_taken_note,
    unused_start,
)
from thermodata.reader.text.preamble.head_start import head_start
from thermodata.reader.text.preamble.head_words import TimeLabel
from thermodata.reader.times.zone import NAT, local_to_utc_ns
from thermodata_reader_table.mat.planned.stream_plan import TimeVector
from thermodata_reader_table.mat.tree import Text, Tree

_BESIDE = "a text beside the signals"


class _Timed(Protocol):
    @property
    def time(self) -> TimeVector: ...
    @property
    def absolute(self) -> bool: ...
    def times(self, start: int, stop: int) -> Int1D: ...


@dataclass(frozen=True, slots=True)
class Begun:
    """A start, and the zone of the place where it is in its time."""

    begin: Begin
    timezone: str | None

    def utc(self, since_ns: Int1D) -> Int1D:
        """UTC of times that count from the start [ns], shape (n,); NAT stays."""
        return self.begin.utc(since_ns, self.timezone)


def begun_beside(tree: Tree, streams: Sequence[_Timed], source: Source, where: str) -> tuple[Begun | None, list[str]]:
    """(what the times count from, where `time.start` says that they do; notes). A file may hold the start of another
    run than its signals, so that without a declaration it is asked.

    FormatError where what is declared fits nothing."""
    declared = declared_start(source.table or {})
    if any(s.absolute for s in streams):
        unused = unused_start(declared)
        return None, [unused] if unused else []
    lines = [[name, *node.lines] for name, node in tree.variables.items() if isinstance(node, Text)]
    if not streams or (declared is None and not _may_begin(lines, streams)):
        return None, []
    begin, doubt = find_begin(lines, _first_times(streams), declared, where)
    if begin is None or declared is None:
        text = not_taken_note(begin.text, _BESIDE) if begin is not None else doubt
        return None, [text.replace("the head says", f"{_BESIDE} says")] if text else []
    zoneless: Sequence[str] = ()
    if begin.local:
        zoneless = local_to_utc_ns(np.array([begin.ns]).view("datetime64[ns]"), source.timezone)[1]
    supposed = f", read {BY_HALF}" if begin.supposed else ""
    told = f"times count from the start beside them: '{begin.text}'{supposed}"
    return Begun(begin, source.timezone), [told, *zoneless]


def _may_begin(lines: Sequence[Sequence[str]], streams: Sequence[_Timed]) -> bool:
    """Whether one of the texts may say when the signals began. Times of day as text count from the first of them."""
    said = head_start(lines)
    return said is not None and said.says is TimeLabel.BEGAN and all(s.time.texts is None for s in streams)


def _first_times(streams: Sequence[_Timed]) -> FirstTimes:
    """Of the stream that begins first."""
    each = [t[t != NAT].tolist() for s in streams if (t := s.times(0, ROWS)).size]
    return FirstTimes(tuple(min((t for t in each if t), default=[])), False)
