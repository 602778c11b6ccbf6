"""MTConnect's time series: values at a fixed rate in one report, as rows of a stream of their own."""

from __future__ import annotations

import numpy as np

from thermodata.plugin import Block, Loss, Signal
from thermodata.reader.zone import NAT
from thermodata_reader_cnc.events import to_utc
from thermodata_reader_cnc.localclock import LocalClock

NOTE = "a time series' time stamp is taken as that of its last sample"


def stream(key: str) -> str:
    """The stream of an item's series."""
    return f"series {key}"


def signal(key: str, properties: dict[str, str] | None = None) -> Signal:
    """The signal of an item's series."""
    return Signal(key, stream(key), None, "float64", None, properties or {})


def rows(
    key: str, time: str, rate_hz: float | None, text: str, count: int | None, clock: LocalClock, at: str
) -> Block | Loss:
    """The rows of one report. count: the samples that it announces."""
    words = text.split()
    if len(words) == 1 and words[0] == "UNAVAILABLE":
        words = []
    last = int(to_utc([time], clock)[0])
    if rate_hz is None or not 1e-9 < rate_hz <= 1e9:
        return Loss(at, reason=f"'{key}': a time series without a sample rate is not read")
    if last == NAT:
        return Loss(at, reason=f"'{key}': the time '{time[:40]}' does not read")
    try:
        values = np.array(words, np.float64)
    except ValueError:
        return Loss(at, reason=f"'{key}': expected numbers, got '{text[:60]}'")
    if count is not None and count != values.size and (values.size or count):
        return Loss(at, reason=f"'{key}': the series announces {count} samples and holds {values.size}; it is not read")
    back = np.arange(values.size - 1, -1, -1) / rate_hz
    if values.size and (back[0] > 4e9 or abs(last - back[0] * 1e9) > 9e18):
        return Loss(at, reason=f"'{key}': a time series of {back[0]:g} s is not read")
    return Block(stream(key), last - np.round(back * 1e9).astype(np.int64), {key: values})
