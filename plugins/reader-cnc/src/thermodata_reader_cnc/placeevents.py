"""Where a row of a log of events stands: the lines, or the reports of an agent, that hold its time."""

from __future__ import annotations

from collections.abc import Iterator
from itertools import islice
from pathlib import Path
from typing import Any

from thermodata.plugin import Block, Loss, Source
from thermodata_reader_cnc import mtconnect, opcua, series, shdr
from thermodata_reader_cnc.events import Event, Plan, to_utc
from thermodata_reader_cnc.localclock import LocalClock
from thermodata_reader_cnc.mtparse import Names, Observation
from thermodata_reader_cnc.place import find
from thermodata_reader_cnc.shdrlines import Lines, Series

_SHOWN = 5
_BATCH = 20_000


def place(form: str, module: Any, path: Path, source: Source, stream: str, row: int) -> str | None:
    """`line 812` or `lines 812, 813` that hold the time of a row (counted from 0); of a time series, the report and the
    number of its sample."""
    plan, items = _all(form, path, source)
    clock = LocalClock(source.timezone)
    if stream.startswith("series ") and not any(plan.stream(key) == stream for key in plan.items):
        return _sample(items, clock, stream, row, path.name)
    wanted = find(module.blocks, path, source, stream, row)
    if wanted is None:
        return None
    found: list[str] = []
    more = 0
    events = (e for e in items if isinstance(e, Event) and e.key in plan.items and plan.stream(e.key) == stream)
    while part := list(islice(events, _BATCH)):
        times = to_utc([e.time for e in part], clock, plan.form)
        for k in (times == wanted[0]).nonzero()[0].tolist():
            at = _short(part[k].at, path.name)
            if at not in found:
                more += len(found) >= _SHOWN
                found += [at] if len(found) < _SHOWN else []
    if not found:
        return None
    lines = [at.removeprefix("line ") for at in found if at.startswith("line ")]
    text = f"line{'s' if len(lines) > 1 else ''} {', '.join(lines)}" if len(lines) == len(found) else ", ".join(found)
    return text + (f" and {more} more" if more else "")


def _all(form: str, path: Path, source: Source) -> tuple[Plan, Iterator[Any]]:
    """(what the first look found, all events of the file in order)."""
    if form == "shdr":
        look = shdr._Look(path, source)
        lines = Lines(path.name)
        return look.plan, (
            e
            for number, line in shdr._lines(path, look.encoding)
            if isinstance(number, int) and number >= 0
            for e in lines.events(line, number)
        )
    if form == "opcua":
        table = opcua._look(path, source)
        return table.plan, opcua._all(path, table)
    return mtconnect._Look(path).plan, mtconnect._events(path, Names())


def _sample(
    items: Iterator[Event | Series | Observation | Loss], clock: LocalClock, stream: str, row: int, name: str
) -> str | None:
    done = 0
    for item in items:
        if not isinstance(item, Series | Observation) or series.stream(item.key) != stream:
            continue
        if isinstance(item, Series):
            made, at = series.rows(item.key, item.time, item.rate_hz, item.values, None, clock, ""), item.at
        else:
            made = series.rows(item.key, item.time, item.rate_hz, item.value, item.count, clock, "")
            at = f"sequence {item.sequence}"
        if isinstance(made, Block):
            if row < done + made.t_ns.size:
                return f"{_short(at, name)}, sample {row - done + 1} of {made.t_ns.size}"
            done += made.t_ns.size
    return None


def _short(at: str, name: str) -> str:
    return at.removeprefix(f"{name} ")
