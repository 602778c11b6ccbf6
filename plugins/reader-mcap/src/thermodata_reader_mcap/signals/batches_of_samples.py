"""Messages that hold several samples each: arrays of values with an array of their times, `{"t": [...], "dZ": [...]}`,
or with a first time and a step, `{"t0": ..., "dt": ..., "values": [...]}`. Each becomes a message of its time."""

from __future__ import annotations

import json
import re
from collections import Counter
from collections.abc import Iterable, Iterator, Mapping, Sequence
from dataclasses import dataclass
from datetime import datetime
from itertools import pairwise
from typing import Any

import numpy as np

from thermodata.plugin import Int1D
from thermodata.reader.time_units import EPOCHS, SECONDS, found_epoch
from thermodata_reader_mcap.container.definitions import Channel
from thermodata_reader_mcap.container.message_batches import U64, Batch
from thermodata_reader_mcap.encodings.json.text import loads

_TIMES = frozenset({"t", "time", "times", "timestamp", "timestamps", "ts", "stamp", "stamps"})
_BEGINS = frozenset(
    {"t0", "t_0", "start", "start_time", "starttime", "t_start", "begin", "first_time", "time0"}
    | {"timestamp", "stamp", "time", "t", "ts"}
)
_STEPS = frozenset(
    {"dt", "delta_t", "deltat", "step", "interval", "period", "sample_period", "sampling_period"}
    | {"sample_time", "sample_interval"}
)
_RATES = frozenset(
    {"fs", "rate", "sample_rate", "samplerate", "sampling_rate", "sampling_frequency", "sample_frequency"}
    | {"frequency", "hz"}
)
_UNIT = re.compile(r"^(?P<word>.+?)_?(?P<unit>ns|us|ms|s|sec|hz|khz)$")
_MOST = 1_000_000  # samples of a message
_LOOKED_AT = 200  # messages
_MOSTLY = 0.9
_NEAR = 0.1  # by which a step may differ from what the first times of two messages say
_LATE_NS = 60 * 10**9


@dataclass(frozen=True, slots=True)
class Samples:
    """inside: the keys that lead to the object of the samples. time: of its times, or of the first of them; step: of
    the time from sample to sample, '' where each has its own; each_ns: of a unit of the step; rate: whether it says
    samples a second. arrays: of values."""

    inside: tuple[str, ...]
    time: str
    step: str = ""
    each_ns: float = 1e9
    rate: bool = False

    def times(self, held: Mapping[str, Any]) -> Int1D | None:
        """The times of a message's samples [ns since 1970], shape (n,); None where it is none."""
        if not self.step:
            value = held.get(self.time)
            return _dated(value) if isinstance(value, list) else None
        first, step = _dated([held.get(self.time)]), _number(held.get(self.step))
        arrays = _arrays(held)
        if first is None or not arrays or step is None or step <= 0:
            return None
        n = max(Counter(map(len, arrays.values())).items(), key=lambda item: (item[1], item[0]))[0]
        step_ns = 1e9 / (step * self.each_ns) if self.rate else step * self.each_ns
        t_ns: Int1D = np.rint(np.arange(n) * step_ns).astype(np.int64) + first[0]
        return t_ns

    def parted(self, message: Any) -> tuple[list[dict[str, Any]], Int1D] | None:
        """The samples of a message as messages, and their times; what it holds once stands in the first, and words
        beside the arrays, as a unit, in all. None for a message that holds none."""
        held = _at(message, self.inside)
        t_ns = None if held is None else self.times(held)
        if held is None or t_ns is None or not 0 < t_ns.size <= _MOST:
            return None
        mine = {k: v for k, v in held.items() if k not in (self.time, self.step)}
        each = [k for k, v in mine.items() if isinstance(v, list) and len(v) == t_ns.size]
        if not each:
            return None
        once = {k: v for k, v in mine.items() if k not in each}
        words = {k: v for k, v in once.items() if isinstance(v, str)}
        rows = [
            _within(
                message if k == 0 else {},
                self.inside,
                {name: mine[name][k] for name in each} | (once if k == 0 else words),
            )
            for k in range(t_ns.size)
        ]
        return rows, t_ns


@dataclass(slots=True)
class Parted:
    """A batch in which each sample is a message. origin: the message of the batch that each came from, shape (n,)."""

    batch: Batch
    origin: Int1D


def parted(batch: Batch, samples: Samples) -> Parted:
    """Takes the messages of a batch apart; those that hold no samples stay as they are."""
    logs, publishes = batch.times()
    kinds = np.concatenate(batch.kinds) if batch.kinds else np.zeros(len(batch.payloads), np.int64)
    payloads: list[bytes] = []
    times: list[U64] = []
    origin: list[Int1D] = []
    for k, payload in enumerate(batch.payloads):
        found = None if (message := _decoded(payload)) is None else samples.parted(message)
        own = np.array([logs[k]], np.uint64) if found is None else found[1].astype(np.uint64)
        payloads += [payload] if found is None else [json.dumps(row).encode() for row in found[0]]
        times.append(own)
        origin.append(np.full(own.size, k))
    of: Int1D = np.concatenate(origin or [np.empty(0, np.int64)])
    t_ns: U64 = np.concatenate(times or [np.empty(0, np.uint64)])
    # where nothing was taken apart, the publish times are their own
    same = publishes[of] if of.size == len(batch.payloads) else t_ns
    return Parted(Batch(payloads, [t_ns], [same], dict(batch.members), [kinds[of]]), of)


def find_samples(batches: Mapping[Channel, Batch]) -> tuple[dict[str, Samples], list[str]]:
    """(topic -> how its messages hold samples, notes), of topics in JSON."""
    found: dict[str, Samples] = {}
    notes: list[str] = []
    topics = dict.fromkeys(c.topic for c in batches if c.encoding == "json")
    for topic in topics:
        mine = [b for c, b in batches.items() if c.topic == topic]
        if any(c.encoding != "json" for c in batches if c.topic == topic):
            continue
        payloads = [p for b in mine for p in b.payloads]
        messages = [m for p in payloads[:_LOOKED_AT] if isinstance(m := _decoded(p), Mapping)]
        if not messages or len(messages) < _MOSTLY * min(len(payloads), _LOOKED_AT):
            continue
        logs = np.concatenate([b.times()[0] for b in mine])[: len(messages)].astype(np.int64)
        for inside in _objects(messages[0]):
            one = _samples([h for m in messages if (h := _at(m, inside)) is not None], inside, len(messages))
            if one is not None:
                found[topic] = one
                notes.append(_note(topic, one, messages, logs))
                break
        else:
            notes += _undated(topic, messages[0])
    return found, notes


def _undated(topic: str, message: Any) -> list[str]:
    """A note where arrays look like samples, and nothing dates these."""
    for inside in _objects(message):
        arrays = _arrays(_at(message, inside) or {})
        for key, times in arrays.items():
            beside = [k for k, v in arrays.items() if k != key and len(v) == len(times)]
            if _word(key)[0] in _TIMES and beside and len(times) > 1 and all(a < b for a, b in pairwise(times)):
                return [
                    f"topic '{topic}': '{key}' looks like the times of samples in '{beside[0]}', and counts from no "
                    f"date: they are read as {beside[0]}[0], [1], ... at the log times of their messages"
                ]
    return []


def _note(topic: str, samples: Samples, messages: Sequence[Any], logs: Int1D) -> str:
    names = [samples.time, *([samples.step] if samples.step else [])]
    said = f"topic '{topic}': each message holds several samples, which stand at the times of '{' and '.join(names)}'"
    last = [p[1][-1] for m in messages if (p := samples.parted(m)) is not None]
    late_ns = np.median(np.abs(logs[: len(last)] - np.array(last[: logs.size], np.int64)))
    if late_ns < _LATE_NS:
        return said
    return f"{said}; they are {late_ns / 1e9:.0f} s from the log times of the messages: one of the clocks is wrong"


def _samples(objects: Sequence[Mapping[str, Any]], inside: tuple[str, ...], many: int) -> Samples | None:
    """How objects hold samples; None where they hold none, or nothing dates these."""
    if len(objects) < _MOSTLY * many:
        return None
    keys = list(objects[0])
    for time in (k for k in keys if _word(k)[0] in _TIMES and isinstance(objects[0][k], list)):
        one = Samples(inside, time)
        if _fits(one, objects):
            return one
    steps = [k for k in keys if _word(k)[0] in _STEPS | _RATES and _is_number(objects[0][k])]
    for time in (k for k in keys if _word(k)[0] in _BEGINS and not isinstance(objects[0][k], list | Mapping)):
        for step in steps:
            rate = _word(step)[0] in _RATES
            for each_ns in _sizes(step, rate):
                one = Samples(inside, time, step, each_ns, rate)
                if _fits(one, objects) and _follow(one, objects):
                    return one
    return None


def _sizes(step: str, rate: bool) -> Iterable[float]:
    unit = _word(step)[1]
    if rate:
        return (1e3 if unit == "khz" else 1.0,)
    return (SECONDS[unit] * 1e9,) if unit in SECONDS else (1e9, 1e6, 1e3, 1.0)


def _fits(one: Samples, objects: Sequence[Mapping[str, Any]]) -> bool:
    """Whether nearly all objects hold samples in the order of their times, more than one in some."""
    times = [found[1] for held in objects if (found := one.parted(_within({}, one.inside, held))) is not None]
    rise = [t for t in times if t.size < 2 or bool((np.diff(t) > 0).all())]
    return len(rise) >= _MOSTLY * len(objects) and any(t.size > 1 for t in rise)


def _follow(one: Samples, objects: Sequence[Mapping[str, Any]]) -> bool:
    """Whether messages begin where those before them end, by the step: so its unit is known, and no vector is taken for
    samples."""
    times = [t for held in objects if (t := one.times(held)) is not None and t.size]
    if len(times) < 2:
        return _word(one.step)[1] is not None or one.rate or one.each_ns == 1e9
    gaps = np.array([b[0] - a[0] for a, b in pairwise(times)], np.float64)
    lasts = np.array([(a[1] - a[0]) * a.size if a.size > 1 else 0 for a in times[:-1]], np.float64)
    return bool(abs(float(np.median(gaps / np.maximum(lasts, 1))) - 1) <= _NEAR)


def _objects(message: Any, inside: tuple[str, ...] = ()) -> Iterator[tuple[str, ...]]:
    """Where a message holds objects with arrays, the outermost first."""
    if isinstance(message, Mapping) and len(inside) < 3:
        yield inside
        for key, inner in message.items():
            yield from _objects(inner, (*inside, str(key)))


def _at(message: Any, inside: tuple[str, ...]) -> Mapping[str, Any] | None:
    for key in inside:
        message = message.get(key) if isinstance(message, Mapping) else None
    return message if isinstance(message, Mapping) else None


def _within(message: Mapping[str, Any], inside: tuple[str, ...], held: Mapping[str, Any]) -> dict[str, Any]:
    """A message with the object inside of it replaced."""
    if not inside:
        return dict(held)
    inner = message.get(inside[0])
    return {**message, inside[0]: _within(inner if isinstance(inner, Mapping) else {}, inside[1:], held)}


def _arrays(held: Mapping[str, Any]) -> dict[str, list[Any]]:
    return {k: v for k, v in held.items() if isinstance(v, list) and v and all(x is None or _is_number(x) for x in v)}


def _dated(values: Sequence[Any]) -> Int1D | None:
    """Times since 1970 [ns], of numbers by their size, or of texts with a zone; None where they are none."""
    if values and all(isinstance(v, str) for v in values):
        try:
            moments = [datetime.fromisoformat(v) for v in values]
        except ValueError:
            return None
        if any(m.tzinfo is None for m in moments):
            return None
        return np.array([round(m.timestamp() * 1e6) * 1000 for m in moments], np.int64)
    if not values or not all(map(_is_number, values)):
        return None
    numbers = np.array(values)
    epoch = found_epoch(numbers) if numbers.dtype.kind in "if" else None
    return EPOCHS[epoch].ns(numbers) if epoch is not None and epoch.startswith("unix") else None


def _word(key: str) -> tuple[str, str | None]:
    """(the word of a key, the unit at its end): 'dt_ms' -> ('dt', 'ms')."""
    low = key.strip().lower().replace("-", "_").replace(" ", "_")
    match = _UNIT.match(low)
    known = _TIMES | _BEGINS | _STEPS | _RATES
    return (match["word"], match["unit"]) if match and low not in known and match["word"] in known else (low, None)


def _number(value: Any) -> float | None:
    return value if _is_number(value) else None


def _is_number(value: Any) -> bool:
    return isinstance(value, int | float) and not isinstance(value, bool)


def _decoded(payload: bytes) -> Any:
    try:
        return loads(payload)
    except (ValueError, RecursionError):
        return None
