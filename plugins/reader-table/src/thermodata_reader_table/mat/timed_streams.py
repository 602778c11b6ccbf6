"""The streams of a MAT file with their clocks understood: units, dates as numbers or text, regular grids."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import dataclass, replace

import numpy as np

from thermodata.errors import FormatError
from thermodata.plugin import Int1D, Source
from thermodata.reader.text.clocks.counts_of_seconds import ask_what_counts
from thermodata.reader.text.clocks.time_groups import one_time
from thermodata.reader.text.names.header import unique
from thermodata.reader.text.page.timed.counted_from import counted_from
from thermodata.reader.text.times import in_memory
from thermodata.reader.text.times.one_cell.odd_stamps import guess_format
from thermodata.reader.times import time_units
from thermodata.reader.times.wrapped_counter import may_begin_anew
from thermodata_reader_table.mat.begun_beside import Begun, begun_beside
from thermodata_reader_table.mat.planned.planner import plan_streams
from thermodata_reader_table.mat.planned.stream_plan import Column, Stream, TimeVector
from thermodata_reader_table.mat.tree import Tree

LOOK = 2000  # rows by which a clock is judged


@dataclass(frozen=True)
class TimedStream:
    """A stream with its clock understood. unit: of clocks; None for dates as text (then whole holds all). begun: what
    its times count from, where that is declared."""

    name: str
    time: TimeVector
    columns: tuple[Column, ...]
    names: tuple[str, ...]
    unit: str | None
    absolute: bool
    properties: Mapping[str, str]
    whole: Int1D | None
    begun: Begun | None = None

    def times(self, start: int, stop: int) -> Int1D:
        """Times of rows [start, stop) in ns, shape (n,); NAT where a row has none."""
        own = self._own_times(start, stop)
        return own if self.begun is None else self.begun.utc(own)

    def _own_times(self, start: int, stop: int) -> Int1D:
        if self.whole is not None:
            return self.whole[start:stop]
        if self.time.load is None:
            rows = np.arange(start, min(stop, self.time.length), dtype=np.float64)
            return time_units.to_ns(self.time.zero_s + rows * self.time.step_s, 1.0)
        assert self.unit is not None
        return in_memory.times_of_numbers(self.time.load(start, stop), self.unit, None).t_ns


class Clocked:
    """All streams of a tree with their times; notes say what was taken for granted."""

    def __init__(self, tree: Tree, source: Source, where: str) -> None:
        plan = plan_streams(tree, source.table or {}, where)
        self.losses, self.notes = plan.losses, plan.notes
        self.source, self.where = source, where
        used: list[str] = []
        self.streams: list[TimedStream] = []
        for stream in plan.streams:
            # by its time, however many there are: a cut file keeps the names of the whole one
            name = unique([*used, stream.time.path])[-1]
            used.append(name)
            self.streams.append(self._timed_stream(name, stream))
        kinds = {s.absolute for s in self.streams}
        if len(kinds) > 1:
            raise FormatError(
                "some times are dates, others count from a start",
                where=where,
                got=", ".join(f"{s.time.path} ({'date' if s.absolute else s.unit})" for s in self.streams[:8]),
                expected="one kind of time in a file",
                hint="name the one to read: table: {time: {column: ...}}, and the others in a source "
                "of their own, or save them so",
            )
        self.absolute = kinds == {True}
        self._date_from_text(tree)

    def _date_from_text(self, tree: Tree) -> None:
        """Dates what counts from a start that a text beside the signals says, where it is declared to."""
        begun, notes = begun_beside(tree, self.streams, self.source, self.where)
        self._note(tuple(notes))
        if begun is not None:
            self.streams = [replace(s, begun=begun, absolute=True) for s in self.streams]
            self.absolute = True

    def _timed_stream(self, name: str, stream: Stream) -> TimedStream:
        time, unit = stream.time, None
        whole: Int1D | None = None
        absolute = False
        if time.texts is not None:
            form = one_time(self.source.table, self.where).get("format") or self._of_datestr(time.texts)
            found = in_memory.times_of_texts(time.texts, self.source.timezone, form, f"{self.where} {time.path}")
            whole, absolute = found.t_ns, found.absolute
            self._note(found.notes)
        elif time.load is not None:
            unit = self._unit(time, stream.properties)
            absolute = time_units.is_absolute(unit)
            # what the order of all rows tells: the hour that repeats, where a counter is full
            local = absolute and time_units.EPOCHS[unit].local
            if local or (not absolute and may_begin_anew(time.load, time.length)):
                values = time.load(0, time.length)
                found = in_memory.times_of_numbers(values, unit, self.source.timezone, time.path)
                whole = found.t_ns
                self._note(found.notes)
        names = tuple(unique([c.name for c in stream.columns]))
        return TimedStream(name, time, tuple(stream.columns), names, unit, absolute, stream.properties, whole)

    def _of_datestr(self, texts: Sequence[str]) -> str | None:
        """The format of dates with names of months, as MATLAB's `datestr` writes them by itself: they leave no order of
        day and month open. None of others."""
        form = guess_format([t for t in texts if t.strip()])
        if form is None or not ("%b" in form or "%B" in form):
            return None
        self._note((f"dates read as '{form}'",))
        return form

    def _unit(self, time: TimeVector, properties: Mapping[str, str]) -> str:
        assert time.load is not None
        declared = one_time(self.source.table, self.where).get("unit")
        text = time_units.with_step(declared or time.unit)
        if declared is None:
            values, name = time.load(0, LOOK), time.path.rsplit("/", 1)[-1]
            own = _called_after(name, properties)
            stated, notes = counted_from(time.path, values, text, ({**own, **time.said}, properties), self.where)
            self._note(tuple(notes))
            if stated is not None:
                return stated
            ask_what_counts(time.path, values, text, self.where)
        if text is not None:
            try:
                return time_units.check_unit(str(text), f"{self.where} {time.path}")
            except FormatError:
                if declared is not None:
                    raise
                self._note((f"unit '{text}' of '{time.path}' is none of time",))
        epoch = time_units.found_epoch(time.load(0, LOOK))
        if epoch is not None:
            self._note(
                (
                    f"'{time.path}' has no unit: by its size it is {epoch}; declare table: {{time: {{unit: ...}}}} "
                    "if that is wrong",
                )
            )
            return epoch
        if declared is None:
            ask_what_counts(time.path, time.load(0, LOOK), "s", self.where)
        self._note(
            (f"'{time.path}' has no unit: taken as seconds; declare table: {{time: {{unit: ...}}}} if that is wrong",)
        )
        return "s"

    def _note(self, notes: tuple[str, ...]) -> None:
        self.notes.extend(n for n in notes if n not in self.notes)


def _called_after(name: str, properties: Mapping[str, str]) -> dict[str, str]:
    """What variables say of a time that are called after it: 'epoch' of 'tvec_epoch', and 'time_epoch' of a time."""
    own = {key: said for key, said in properties.items() if key.startswith(f"{name}_")}
    return own if name.lower() in ("time", "zeit") else {key.removeprefix(f"{name}_"): own[key] for key in own}
