"""Whether the messages of a topic hold several samples each: which of their arrays, and what their times are."""

from __future__ import annotations

from collections.abc import Iterator, Mapping, Sequence
from dataclasses import replace
from itertools import pairwise
from typing import Any

import numpy as np

from thermodata.plugin import Int1D
from thermodata_reader_mcap.container.definitions import Channel
from thermodata_reader_mcap.container.message_batches import Batch
from thermodata_reader_mcap.signals.samples.batches_of_samples import (
    DEEPEST,
    Keys,
    Samples,
    are_numbers,
    arrays_in,
    decoded,
    in_columns,
    samples_of,
    value_at,
)
from thermodata_reader_mcap.signals.samples.messages_of_each_form import messages_of_each_form
from thermodata_reader_mcap.signals.samples.sample_times import (
    BEGINS,
    RATES,
    STEPS,
    calls_times,
    is_number,
    sizes,
    word,
)

_LOOKED_AT = 200  # messages, and of each array
_FORMS = 20  # messages, by which arrays and times are known
_MOSTLY = 0.9
_NEAR = 0.1  # by which a step may differ from what the first times of two messages say
_LATE_NS = 60 * 10**9


def find_samples(batches: Mapping[Channel, Batch]) -> tuple[dict[str, tuple[Samples, ...]], list[str]]:
    """(topic -> the clocks of the samples in its messages, notes), of topics in JSON."""
    found: dict[str, tuple[Samples, ...]] = {}
    notes: list[str] = []
    topics = dict.fromkeys(c.topic for c in batches if c.encoding == "json")
    for topic in topics:
        mine = [b for c, b in batches.items() if c.topic == topic]
        if any(c.encoding != "json" for c in batches if c.topic == topic):
            continue
        payloads = [p for b in mine for p in b.payloads]
        places = messages_of_each_form(payloads, _LOOKED_AT)
        every = [(k, m, in_columns(m)) for k in places if (m := decoded(payloads[k])) is not None]
        held = [(k, whole, made) for k, whole, made in every if isinstance(made, Mapping)]
        if not held or len(held) < _MOSTLY * len(places):
            continue
        messages = [made for _, _, made in held]
        logs = np.concatenate([b.times()[0] for b in mine])[[k for k, _, _ in held]].astype(np.int64)
        clocks = _clocks(messages)
        if clocks:  # whose arrays stand where only what they date is in columns
            messages = [in_columns(whole, clocks) for _, whole, _ in held]
            clocks = _clocks(messages)
        if clocks:
            found[topic] = clocks
            notes.append(_note(topic, clocks, messages, logs))
        else:
            notes += _undated(topic, max(messages, key=lambda m: sum(1 for _ in arrays_in(m))))
    return found, notes


def _clocks(messages: Sequence[Mapping[str, Any]]) -> tuple[Samples, ...]:
    """Each clock with the arrays that are nearest to it; () where not nearly all messages with such arrays hold
    samples."""
    arrays = list(dict.fromkeys(keys for m in messages for keys, _ in arrays_in(m)))
    objects = list(dict.fromkeys(keys for m in messages[:_FORMS] for keys in _objects(m)))
    timed: dict[Keys, Samples] = {}
    for inside in objects:
        listed = [a for a in arrays if calls_times(a) and _object_around(a) == inside]
        one = next((c for c in (_of_times(t, arrays, messages) for t in listed) if c is not None), None)
        timed |= {} if one is None else {inside: one}
    taken = {k for o, one in timed.items() for k in (one.time, *one.arrays) if o and k[: len(o)] == o}
    rest = [a for a in arrays if a not in taken]  # of which a step may be
    found = (timed.get(inside) or _of_steps(inside, rest, messages) for inside in objects)
    clocks = [one for one in found if one is not None]
    times = {c.time for c in clocks}
    made: list[Samples] = []
    for one in clocks:
        own = tuple(a for a in one.arrays if a not in times and _nearest_clock(a, clocks) is one)
        if own:
            made.append(replace(one, arrays=own))
    wanted = {a for c in made for a in c.arrays}
    holding = [any(c.held(m) for c in made) for m in messages if any(_is_filled(value_at(m, a)) for a in wanted)]
    return tuple(made) if sum(holding) >= _MOSTLY * len(holding) else ()


def _is_filled(value: Any) -> bool:
    return isinstance(value, list) and bool(value)


def _object_around(keys: Keys) -> Keys:
    """The object that a time is of: of 'data.t' and of 'data.time.values' it is 'data'."""
    return Samples(keys).own_time[:-1]


def _nearest_clock(array: Keys, clocks: Sequence[Samples]) -> Samples:
    """The clock of an array, of those that it fits: that which stands beside it, or around it."""
    fitting = [c for c in clocks if array in c.arrays]

    def common(one: Samples) -> int:
        inside = one.time[:-1] if one.step else _object_around(one.time)
        return sum(1 for _ in _while_same(inside, array))

    return max(fitting, key=common)


def _while_same(one: Keys, other: Keys) -> Iterator[str]:
    for a, b in zip(one, other, strict=False):
        if a != b:
            return
        yield a


def _of_times(time: Keys, arrays: Sequence[Keys], messages: Sequence[Any]) -> Samples | None:
    """The clock of an array of times; None where they are not dated, in order, or of no other array."""
    one = Samples(time)
    holding = [(m, t) for m in messages if isinstance(value_at(m, time), list) for t in [one.times(m)]]
    if not _rise([t for _, t in holding]):
        return None
    dated = [(m, t) for m, t in holding if t is not None]
    fitting = tuple(a for a in arrays if a != time and _as_long(a, dated))
    return replace(one, arrays=fitting) if fitting else None


def _as_long(array: Keys, dated: Sequence[tuple[Any, Int1D]]) -> bool:
    """Whether nearly all messages that hold an array hold as many values in it as times."""
    lengths = [(len(v), t.size) for m, t in dated if isinstance(v := value_at(m, array), list) and v]
    return bool(lengths) and sum(a == b for a, b in lengths) >= _MOSTLY * len(lengths)


def _of_steps(inside: Keys, arrays: Sequence[Keys], messages: Sequence[Any]) -> Samples | None:
    """The clock of a first time with a step: both in one object, whose arrays they are of, or of all where it has
    none."""
    held = next((h for m in messages if isinstance(h := value_at(m, inside), Mapping)), {})
    steps = [k for k in held if word(k)[0] in STEPS | RATES and is_number(held[k])]
    begins = [k for k in held if word(k)[0] in BEGINS and not isinstance(held[k], list | Mapping)]
    of = tuple(a for a in arrays if a[: len(inside)] == inside) or tuple(arrays)
    for begin in begins if of else ():
        for step in steps:
            rate = word(step)[0] in RATES
            for each_ns in sizes(step, rate):
                one = Samples((*inside, begin), of, (*inside, step), each_ns, rate)
                holding = [t for m in messages if isinstance(value_at(m, inside), Mapping) for t in [one.times(m)]]
                if _rise(holding) and _follow(one, [t for t in holding if t is not None]):
                    return one
    return None


def _rise(times: Sequence[Int1D | None]) -> bool:
    """Whether nearly all messages hold times in order, more than one in some."""
    rise = [t for t in times if t is not None and (t.size < 2 or bool((np.diff(t) > 0).all()))]
    return len(rise) >= _MOSTLY * len(times) and any(t.size > 1 for t in rise)


def _follow(one: Samples, times: Sequence[Int1D]) -> bool:
    """Whether messages begin where those before them end, by the step: so its unit is known, and no vector is taken for
    samples."""
    if len(times) < 2:
        return word(one.step[-1])[1] is not None or one.rate or one.each_ns == 1e9
    gaps = np.array([b[0] - a[0] for a, b in pairwise(times)], np.float64)
    lasts = np.array([(a[1] - a[0]) * a.size if a.size > 1 else 0 for a in times[:-1]], np.float64)
    return bool(abs(float(np.median(gaps / np.maximum(lasts, 1))) - 1) <= _NEAR)


def _objects(message: Any, inside: Keys = ()) -> Iterator[Keys]:
    """Where a message holds objects, the outermost first."""
    if isinstance(message, Mapping) and len(inside) < DEEPEST:
        yield inside
        for key, inner in message.items():
            yield from _objects(inner, (*inside, str(key)))


def _undated(topic: str, message: Any) -> list[str]:
    """A note where arrays look like samples, and nothing dates these."""
    arrays = {keys: v for keys, v in arrays_in(message) if are_numbers(v)}
    for keys, times in arrays.items():
        beside = [k for k, v in arrays.items() if k != keys and len(v) == len(times)]
        rise = None not in times and all(a < b for a, b in pairwise(times))
        if calls_times(keys) and beside and len(times) > 1 and rise:
            told, of = ".".join(keys), ".".join(beside[0])
            return [
                f"topic '{topic}': '{told}' looks like the times of samples in '{of}', and counts from no date: they "
                f"are read as {of}[0], [1], ... at the log times of their messages"
            ]
    return []


def _note(topic: str, clocks: Sequence[Samples], messages: Sequence[Any], logs: Int1D) -> str:
    names = dict.fromkeys(".".join(k) for c in clocks for k in (c.time, c.step) if k)
    said = f"topic '{topic}': each message holds several samples, which stand at the times of '{' and '.join(names)}'"
    parted = [(int(ns), p[1][-1]) for ns, m in zip(logs, messages, strict=True) if (p := samples_of(m, clocks))]
    late_ns = np.median([abs(ns - last) for ns, last in parted])
    if late_ns < _LATE_NS:
        return said
    return f"{said}; they are {late_ns / 1e9:.0f} s from the log times of the messages: one of the clocks is wrong"
