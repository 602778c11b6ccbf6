"""Whether the stamps in messages tell other times than their log times: a recorder that writes in bursts logs minutes
of messages at once, and the log times are what is read unless another time is asked for."""

from __future__ import annotations

from collections.abc import Iterator, Mapping, Sequence
from typing import Any

import numpy as np

from thermodata.plugin import Array, Float1D
from thermodata.reader.times.time_units import EPOCHS, found_epoch
from thermodata_reader_mcap.container.definitions import Channel
from thermodata_reader_mcap.container.message_batches import Batch
from thermodata_reader_mcap.encodings.decoder import Decoder
from thermodata_reader_mcap.encodings.field_paths import Path
from thermodata_reader_mcap.encodings.topic import Topic
from thermodata_reader_mcap.signals.options import STAMPS, Options

_LOOKED_AT = 200  # messages of a topic
_APART_NS = 1_000_000_000  # that a latency changes by less than
_NEAR_NS = 7 * 86_400 * 10**9  # of the log times a stamp of its message is; another date is of something else
_DATED_NS = 940_000_000 * 10**9  # from 1999 on
_CLOCKS_APART_NS = 60 * 10**9  # beyond which no delay keeps two times apart
_RUSHED = 2  # times that publish times span log times, which no recorder's delays do
_RISING = 0.9  # of the steps from message to message, in a stamp of theirs; a job's start stands still
_MOST = 2**63  # beyond which a whole number is no time, and may be no float: JSON's have as many digits as they like
_UNITS = {"unix": "s", "unix_ms": "ms", "unix_us": "us", "unix_ns": "ns"}


def stamps_note(
    topic: Topic, batches: Mapping[Channel, Batch], made: Mapping[Channel, Decoder], relative: bool = False
) -> str | None:
    """A note where a topic's stamps do not keep one distance from its log times, or one that no delay explains, or
    these count from a start (relative) and the stamps have a date; None where none is so, or there are none."""
    paths = [leaf.path for leaf in topic.leaves if leaf.dtype != "str"]
    rows = list(_messages(batches, made))
    found = _stamp(paths)
    name, unit, away = ("", None, list[float]()) if found is None else _of_pair(*found, rows)
    if found is None:
        name, unit, away = _of_numbers(paths, rows, relative)
    if relative:
        return _note_of_dates(topic.name, name, unit, away)
    spread = int(np.ptp(np.array(away, np.float64))) if away else 0
    declared = name if unit is None else f"{name}, time_unit: {unit}"
    if spread <= _APART_NS:
        apart = _note_of_clocks(f"{name} is", np.array(away, np.float64), declared)
        return None if apart is None else f"topic '{topic.name}': {apart}"
    return (
        f"topic '{topic.name}': the times that are read are log times, and {name} changes its distance from them by "
        f"{spread / 1e9:.3g} s; declare options: {{time: {declared}}} if the recorder wrote in bursts"
    )


def _note_of_dates(topic: str, name: str, unit: str | None, away: Sequence[float]) -> str | None:
    """A note where the stamps of a recording whose log times have no date have one."""
    if not away or -max(away) < _DATED_NS:
        return None
    declared = name if unit is None else f"{name}, time_unit: {unit}"
    return f"topic '{topic}': {name} has dates, which the log times have not; declare options: {{time: {declared}}}"


def publish_notes(batches: Sequence[Batch]) -> list[str]:
    """A note where the publish times of a recording span far more than its log times: it was converted, and the log
    times are of the conversion; or where the two are of clocks that differ."""
    pairs = [batch.times() for batch in batches]
    logs, published = (np.concatenate([np.empty(0, np.uint64), *(pair[k] for pair in pairs)]) for k in (0, 1))
    if logs.size < 2 or not published.all():
        return []
    short, long = (int(np.ptp(np.quantile(t.astype(np.float64), (0.05, 0.95)))) for t in (logs, published))
    if long < _RUSHED * short or long - short < _APART_NS:
        apart = _note_of_clocks(
            "publish times are", logs.astype(np.float64) - published.astype(np.float64), "publish_time"
        )
        return [] if apart is None else [apart]
    return [
        f"log times span {short / 1e9:.3g} s, publish times {long / 1e9:.6g} s: the file looks converted, and its log "
        "times are of the conversion; declare options: {time: publish_time}"
    ]


def _note_of_clocks(others: str, behind_ns: Float1D, declared: str) -> str | None:
    """A note where other times keep one distance from the log times that is no delay. behind_ns: of the log times,
    shape (n,)."""
    if not behind_ns.size or np.ptp(np.quantile(behind_ns, (0.05, 0.95))) > _APART_NS:
        return None
    off = float(np.median(behind_ns))
    if not _CLOCKS_APART_NS < abs(off) < _NEAR_NS:
        return None
    return (
        f"{others} {abs(off) / 1e9:.6g} s {'before' if off > 0 else 'behind'} the log times, which are read, all the "
        f"way: two clocks; declare options: {{time: {declared}}} if the other one is right"
    )


def first_stamp(options: Options, batches: Mapping[Channel, Batch], made: Mapping[Channel, Decoder]) -> int | None:
    """The earliest of some declared stamps [ns]; None where none is declared, or no message has one."""
    found: list[int] = []
    for _, message in _messages(batches, made):
        for paths in options.stamps():
            parts = [_value_at(message, path) for path in paths]
            if all(isinstance(part, int | float) and 0 <= part < _MOST for part in parts) and any(parts):
                scales = (10**9, 1) if len(parts) == 2 else (options.scale or 1,)
                found.append(sum(int(part * scale) for part, scale in zip(parts, scales, strict=True)))
                break
    return min(found, default=None)


def unit_of(path: Path, batches: Mapping[Channel, Batch], made: Mapping[Channel, Decoder]) -> str | None:
    """The unit that a field of numbers counts in since 1970, by their size; None where it holds none, or others."""
    values = _numbers(path, [message for _, message in _messages(batches, made)])
    values = values[values != 0]  # stamps that are not set
    return _UNITS.get(found_epoch(values) or "") if values.size else None


def _messages(batches: Mapping[Channel, Batch], made: Mapping[Channel, Decoder]) -> Iterator[tuple[int, Any]]:
    """(log time [ns], message) of some messages of each channel; None for one that does not decode."""
    for channel, one in made.items():
        batch = batches[channel]
        logs = batch.times()[0]
        for i in range(0, len(batch.payloads), max(1, len(batch.payloads) // _LOOKED_AT)):
            try:
                yield int(logs[i]), one.decode(batch.payloads[i])
            except Exception:  # whatever a decoder raises: it says nothing
                yield int(logs[i]), None


def _stamp(paths: Sequence[Path]) -> tuple[Path, tuple[str, str]] | None:
    """The first field of a stamp, with what its seconds and nanoseconds are called."""
    known = set(paths)
    for path in paths:
        for pair in STAMPS:
            if len(path) > 1 and path[-1] == pair[0] and "stamp" in str(path[-2]) and (*path[:-1], pair[1]) in known:
                return path[:-1], pair
    return None


def _of_pair(
    path: Path, parts: tuple[str, str], rows: Sequence[tuple[int, Any]]
) -> tuple[str, str | None, list[float]]:
    """(name, None, how far the log times are behind) of a stamp in seconds and nanoseconds."""
    away: list[float] = []
    for log, message in rows:
        whole, rest = _value_at(message, (*path, parts[0])), _value_at(message, (*path, parts[1]))
        if isinstance(whole, int) and isinstance(rest, int) and 0 < whole < _MOST and abs(rest) < _MOST:
            away.append(log - whole * 10**9 - rest)
    return _name(path), None, away


def _of_numbers(
    paths: Sequence[Path], rows: Sequence[tuple[int, Any]], relative: bool
) -> tuple[str, str | None, list[float]]:
    """The same of the first field that counts from 1970 and rises from message to message, near their log times; with
    the unit that it counts in."""
    logs = np.array([log for log, _ in rows], np.float64)
    messages = [message for _, message in rows]
    for path in paths:
        values = _numbers(path, messages[:1])
        if not values.size or found_epoch(values) not in _UNITS:
            continue
        values = _numbers(path, messages)
        epoch = found_epoch(values) or ""
        if epoch not in _UNITS or values.size != logs.size or values.size < 2:
            continue
        away: Float1D = logs - values * (EPOCHS[epoch].seconds * 1e9)
        near = np.ptp(away) < np.ptp(logs) / 2 if relative else np.abs(away).max() < _NEAR_NS
        if near and float((np.diff(values) > 0).mean()) >= _RISING:
            return _name(path), _UNITS[epoch], away.tolist()
    return "", None, []


def _numbers(path: Path, messages: Sequence[Any]) -> Array:
    """The numbers that a field holds, those of messages that have one, as floats."""
    found = [_value_at(message, path) for message in messages]
    some = [v for v in found if isinstance(v, int | float) and not isinstance(v, bool)]
    return np.array([v for v in some if isinstance(v, float) or abs(v) < _MOST], np.float64)


def _name(path: Path) -> str:
    return ".".join(map(str, path))


def _value_at(message: Any, path: Path) -> Any:
    try:
        for part in path:
            message = message[part]
    except (KeyError, IndexError, TypeError):
        return None
    return message
