"""Messages that hold several samples each: arrays of values with an array of their times, `{"t": [...], "dZ": [...]}`,
wherever in the message either stands; or with a first time and a step, `{"t0": ..., "dt": ..., "values": [...]}`; or
objects with a time each, `[{"t": ..., "dZ": ...}, ...]`. Each becomes a message of its time."""

from __future__ import annotations

import json
from collections import Counter
from collections.abc import Iterator, Mapping, Sequence
from copy import deepcopy
from dataclasses import dataclass
from typing import Any

import numpy as np

from thermodata.plugin import Int1D
from thermodata_reader_mcap.container.message_batches import U64, Batch
from thermodata_reader_mcap.encodings.json.text import loads
from thermodata_reader_mcap.encodings.named_elements import is_name_key
from thermodata_reader_mcap.signals.samples.sample_times import calls_times, dated, is_number

Keys = tuple[str, ...]
DEEPEST = 5
_MOST = 1_000_000  # samples of a message


@dataclass(frozen=True, slots=True)
class Samples:
    """Arrays of one clock. arrays: the keys that lead to them; time: to their times, or to the first of these; step: to
    the time from sample to sample, () where each has its own; each_ns: of a unit of the step; rate: whether it says
    samples a second."""

    time: Keys
    arrays: tuple[Keys, ...] = ()
    step: Keys = ()
    each_ns: float = 1e9
    rate: bool = False

    @property
    def own_time(self) -> Keys:
        """The keys that lead to all that is said of the times."""
        return self.time if calls_times(self.time[-1:]) or self.step else self.time[:-1]

    def times(self, message: Any) -> Int1D | None:
        """The times of a message's samples [ns since 1970], shape (n,); None where it is none."""
        value = value_at(message, self.time)
        if not self.step:
            return dated(_as_list(value))
        first, step = dated([value]), value_at(message, self.step)
        lengths = Counter(len(v) for a in self.arrays if isinstance(v := value_at(message, a), list) and are_numbers(v))
        if first is None or not lengths or not is_number(step) or step <= 0:
            return None
        n = max(lengths.items(), key=lambda item: (item[1], item[0]))[0]
        step_ns = 1e9 / (step * self.each_ns) if self.rate else step * self.each_ns
        t_ns: Int1D = np.rint(np.arange(n) * step_ns).astype(np.int64) + first[0]
        return t_ns

    def held(self, message: Any) -> tuple[Int1D, dict[Keys, list[Any]]] | None:
        """The times of a message's samples, and the arrays that have as many values; None where there are none."""
        t_ns = self.times(message)
        if t_ns is None or not 0 < t_ns.size <= _MOST:
            return None
        every = {a: _as_list(value_at(message, a)) for a in self.arrays}
        found = {a: v for a, v in every.items() if len(v) == t_ns.size}
        return (t_ns, found) if found else None


def samples_of(message: Any, clocks: Sequence[Samples]) -> tuple[list[dict[str, Any]], Int1D] | None:
    """The samples of a message as messages, and their times; what it holds once stands in the first, and words, as a
    unit, in all. None for a message that holds none. clocks: of its arrays; what they have at one time is one
    sample."""
    message = in_columns(message, clocks)
    found = [(one, held) for one in clocks if (held := one.held(message)) is not None]
    if not found:
        return None
    taken = {k for one, (_, arrays) in found for k in (one.own_time, one.step, *arrays)}
    once = _without_keys(message, taken)
    words = _words(once)
    t_ns, places = _rows([held[0] for _, held in found])
    rows = [once, *(deepcopy(words) for _ in range(t_ns.size - 1))]
    for (_, (_, arrays)), own in zip(found, places, strict=True):
        for keys, values in arrays.items():
            for place, value in zip(own, values, strict=True):
                _put_at(rows[place], keys, value)
    return rows, t_ns


def _rows(times: Sequence[Int1D]) -> tuple[Int1D, list[list[int]]]:
    """(the times of rows that the samples of clocks make, the row of each sample by clock), from the times by clock:
    what several have at one time is one row, what one has twice then are two."""
    if len(times) == 1:
        return times[0], [list(range(times[0].size))]
    keyed = [list(_numbered_times(t_ns.tolist())) for t_ns in times]
    rows = sorted({key for keys in keyed for key in keys})
    places = {key: place for place, key in enumerate(rows)}
    return np.array([t for t, _ in rows], np.int64), [[places[key] for key in keys] for keys in keyed]


def _numbered_times(times: Sequence[int]) -> Iterator[tuple[int, int]]:
    """Each time with how many of the same stand before it."""
    before = Counter[int]()
    for t in times:
        yield t, before[t]
        before[t] += 1


@dataclass(slots=True)
class Parted:
    """A batch in which each sample is a message. origin: the message of the batch that each came from, shape (n,)."""

    batch: Batch
    origin: Int1D


def parted(batch: Batch, clocks: Sequence[Samples]) -> Parted:
    """Takes the messages of a batch apart; those that hold no samples stay as they are."""
    logs, publishes = batch.times()
    kinds = np.concatenate(batch.kinds) if batch.kinds else np.zeros(len(batch.payloads), np.int64)
    payloads: list[bytes] = []
    times: list[U64] = []
    origin: list[Int1D] = []
    for k, payload in enumerate(batch.payloads):
        found = None if (message := decoded(payload)) is None else samples_of(message, clocks)
        own = np.array([logs[k]], np.uint64) if found is None else found[1].astype(np.uint64)
        payloads += [payload] if found is None else [json.dumps(row).encode() for row in found[0]]
        times.append(own)
        origin.append(np.full(own.size, k))
    of: Int1D = np.concatenate(origin or [np.empty(0, np.int64)])
    t_ns: U64 = np.concatenate(times or [np.empty(0, np.uint64)])
    # where nothing was taken apart, the publish times are their own
    same = publishes[of] if of.size == len(batch.payloads) else t_ns
    return Parted(Batch(payloads, [t_ns], [same], dict(batch.members), [kinds[of]]), of)


def in_columns(message: Any, clocks: Sequence[Samples] | None = None, inside: Keys = ()) -> Any:
    """A message with its arrays of objects that have a time each as an object of arrays. Objects that have names are
    left: these are no samples of one thing. clocks: only arrays that hold the times of one of these become objects,
    others, as events beside samples, stay; inside: where the message stands in that around it."""
    if isinstance(message, Mapping) and len(inside) < DEEPEST:
        held = {str(k): v for k, v in message.items()}
        return {k: in_columns(v, clocks, (*inside, k)) if isinstance(v, Mapping | list) else v for k, v in held.items()}
    if not isinstance(message, list) or not message or not all(isinstance(each, Mapping) for each in message):
        return message
    if clocks is not None and not any(one.time[: len(inside)] == inside for one in clocks):
        return message
    keys = list(dict.fromkeys(str(k) for each in message for k in each))
    timed = any(
        calls_times([k]) and all(is_number(e.get(k)) or isinstance(e.get(k), str) for e in message) for k in keys
    )
    if not timed or any(is_name_key(k) for k in keys):
        return message
    return {k: [each.get(k) for each in message] for k in keys}


def arrays_in(message: Any, inside: Keys = ()) -> Iterator[tuple[Keys, list[Any]]]:
    """The arrays of a message with the keys that lead to them, the outermost first."""
    if isinstance(message, Mapping) and len(inside) < DEEPEST:
        yield from (((*inside, str(k)), v) for k, v in message.items() if isinstance(v, list))
        for key, inner in message.items():
            yield from arrays_in(inner, (*inside, str(key)))


def value_at(message: Any, keys: Keys) -> Any:
    """What keys lead to; None where they end before."""
    for key in keys:
        message = message.get(key) if isinstance(message, Mapping) else None
    return message


def _as_list(value: Any) -> list[Any]:
    """An array, or a single value, as some write one sample, as an array of it; nothing of none."""
    return value if isinstance(value, list) else [] if value is None or isinstance(value, Mapping) else [value]


def are_numbers(values: Sequence[Any]) -> bool:
    """Whether an array holds numbers, of which some may be missing."""
    return bool(values) and all(x is None or is_number(x) for x in values)


def decoded(payload: bytes) -> Any:
    """A message of JSON; None of what is none."""
    try:
        return loads(payload)
    except (ValueError, RecursionError):
        return None


def _without_keys(message: Any, taken: set[Keys], inside: Keys = ()) -> dict[str, Any]:
    """A message without what some keys lead to, and without objects that are empty then."""
    made = dict[str, Any]()
    for key, value in message.items():
        keys = (*inside, str(key))
        if keys in taken or value == []:
            continue
        left = _without_keys(value, taken, keys) if isinstance(value, Mapping) else value
        if left != {} or value == {}:
            made[str(key)] = left
    return made


def _words(message: Mapping[str, Any]) -> dict[str, Any]:
    """The texts of a message, in the objects that hold them."""
    made = {k: _words(v) if isinstance(v, Mapping) else v for k, v in message.items() if isinstance(v, str | Mapping)}
    return {k: v for k, v in made.items() if v != {}}


def _put_at(message: dict[str, Any], keys: Keys, value: Any) -> None:
    for key in keys[:-1]:
        message = message.setdefault(key, {})
    message[keys[-1]] = value
