"""MTConnect's time series: values at a fixed rate in one report, as rows of a stream of their own."""

from __future__ import annotations

from collections.abc import Iterable
from dataclasses import dataclass

import numpy as np

from thermodata.plugin import Block, Loss, Signal
from thermodata.reader.text.cells.values.column import values_of
from thermodata.reader.text.times.local_clock import LocalClock
from thermodata.reader.times.zone import NAT
from thermodata_reader_cnc.events import GONE, to_utc

STREAM = "series "
NOTE = "a time series' time stamp is taken as that of its last sample"


@dataclass(frozen=True, slots=True)
class Report:
    """Values of one item at a fixed rate; the time stamp is that of the last. count: the samples that it announces;
    part, at: where it stands, as an event's."""

    time: str
    key: str
    rate_hz: float | None
    values: str
    at: int
    part: str
    count: int | None = None

    @property
    def where(self) -> str:
        return f"{self.part} {self.at}"


def stream(key: str) -> str:
    """The stream of an item's series."""
    return STREAM + key


def signal(key: str, properties: dict[str, str] | None = None) -> Signal:
    """The signal of an item's series."""
    return Signal(key, stream(key), None, "float64", None, properties or {})


def rows(report: Report, clock: LocalClock) -> Block | Loss:
    """The rows of one report, a value each; what is lost where it does not read."""
    key, where, rate_hz, count = report.key, report.where, report.rate_hz, report.count
    words = [] if report.values.strip() == GONE else report.values.split()
    last = int(to_utc([report.time], clock)[0])
    if rate_hz is None or not 1e-9 < rate_hz <= 1e9:
        return Loss(where, reason=f"'{key}': a time series without a sample rate is not read")
    if last == NAT:
        return Loss(where, reason=f"'{key}': the time '{report.time[:40]}' does not read")
    read = values_of(words, "float64")
    if read.odd:
        return Loss(where, reason=f"'{key}': expected numbers, got '{report.values[:60]}'")
    values = read.values
    if count is not None and count != values.size and (values.size or count):
        return Loss(
            where, reason=f"'{key}': the series announces {count} samples and holds {values.size}; it is not read"
        )
    back = np.arange(values.size - 1, -1, -1) / rate_hz
    if values.size and (back[0] > 4e9 or abs(last - back[0] * 1e9) > 9e18):
        return Loss(where, reason=f"'{key}': a time series of {back[0]:g} s is not read")
    t_ns = last - np.round(back * 1e9).astype(np.int64)
    return Block(stream(key), t_ns, {key: values}, None, np.full(values.size, report.at, np.int64))


def sample_of(items: Iterable[Block | Loss], name: str, row: int) -> tuple[int, str] | None:
    """(`at` of the report that holds a row of a series, counted from 0; 'sample 3 of 4'). None: no such row. items:
    blocks of one report each."""
    done = 0
    for item in items:
        if not isinstance(item, Block) or item.stream != name or item.at is None:
            continue
        if row < done + item.t_ns.size:
            return int(item.at[row - done]), f"sample {row - done + 1} of {item.t_ns.size}"
        done += item.t_ns.size
    return None
