"""Topics on which several sensors send: each message names whose it is (`header.frame_id`, `sensor`, `name`)."""

from __future__ import annotations

from collections.abc import Collection, Mapping, Sequence
from functools import partial
from typing import Any

import numpy as np

from thermodata.plugin import Array, Block
from thermodata.reader.signals.header_words import SENSOR_WORDS
from thermodata.reader.signals.interleaved import bare_header
from thermodata.reader.signals.series import Called, Declaration, FoundSeries, find_series
from thermodata_reader_mcap.container.definitions import Channel
from thermodata_reader_mcap.container.message_batches import Batch
from thermodata_reader_mcap.container.messages import LATEST_NS
from thermodata_reader_mcap.encodings.decoded_messages import as_array, as_dtype, at_path
from thermodata_reader_mcap.encodings.decoder import Decoder
from thermodata_reader_mcap.encodings.field_paths import Path
from thermodata_reader_mcap.encodings.topic import Leaf, Topic

_GLANCE, _LOOKED_AT = 100, 1000  # messages of a channel, in pieces: those that tell whether its words differ at all
_PIECES = 4
_MOST_LEAVES = 100  # of a topic; more are no sensor's messages


def senders(
    topic: Topic,
    batches: Mapping[Channel, Batch],
    made: Mapping[Channel, Decoder],
    taken: Collection[str],
    times: Collection[str],
    declared: Declaration,
) -> FoundSeries:
    """How the messages of a topic are taken apart, each sender a stream called as if it had a topic of its own; none
    where all are of one. taken: the names of other topics; times: signals that its times are, besides its fields."""
    leaves = [leaf for leaf in topic.leaves if not _is_time(leaf.path)]
    words = [leaf for leaf in leaves if _may_name(leaf)]
    if declared.columns is None:
        if not any(map(_may_name, topic.leaves)) or len(topic.leaves) > _MOST_LEAVES:
            return FoundSeries()
        if all(len(set(column)) < 2 for column in looked_at(words, batches, made, _GLANCE)[2]):
            return FoundSeries()
    logs, pieces, cells = looked_at(leaves, batches, made, _LOOKED_AT)
    order = np.argsort(np.array(logs, np.int64), kind="stable")
    values, flags = dict[str, Array](), dict[str, Array]()
    for leaf, column in zip(leaves, cells, strict=True):
        array, missing = as_array(column, leaf.dtype)
        values[leaf.name] = array[order]
        if missing is not None:
            flags[leaf.name] = missing[order]
    mine = declared.within(values, f"{topic.name}.")
    block = Block(topic.name, np.array(logs, np.int64)[order], values, flags)
    return find_series(
        block,
        absolute=True,
        declared=mine,
        pieces=np.array(pieces, np.int64)[order],
        called=Called(
            lambda one: f"{topic.name}/{_without_topic(topic.name, one)}", partial(_signal_of_series, topic.name), taken
        ),
        kept={*times, *({leaf.name for leaf in topic.leaves} - set(values))},
    )


def looked_at(
    leaves: Sequence[Leaf], batches: Mapping[Channel, Batch], made: Mapping[Channel, Decoder], most: int
) -> tuple[list[int], list[int], list[list[Any]]]:
    """Log times of some messages of each channel, in which piece they stand, and what they hold at each leaf."""
    logs: list[int] = []
    pieces: list[int] = []
    cells: list[list[Any]] = [[] for _ in leaves]
    for channel, one in made.items():
        batch = batches[channel]
        times = batch.times()[0]
        piece = before = -1
        for k in _places_looked_at(len(batch.payloads), most):
            piece, before = piece + (k != before + 1 or piece < 0), k
            try:
                message = one.decode(batch.payloads[k])
            except Exception:  # counted and named when it is read
                continue
            if times[k] < LATEST_NS:
                logs.append(int(times[k]))
                pieces.append(piece)
                for leaf, column in zip(leaves, cells, strict=True):
                    column.append(as_dtype(at_path(message, leaf.path), leaf.dtype))
    return logs, pieces, cells


def _may_name(leaf: Leaf) -> bool:
    """Whether a field may say whose its message is: a number beside no words only where it is called so, for counters
    look like an id."""
    return leaf.dtype == "str" or bare_header(leaf.name) in SENSOR_WORDS


def _signal_of_series(topic: str, series: str, name: str) -> str:
    """'/temperature.value' of the series 'bed' is '/temperature/bed.value'."""
    series = _without_topic(topic, series)
    return f"{topic}/{series}{name[len(topic) :]}" if name.startswith(topic) else f"{series}/{name}"


def _without_topic(topic: str, series: str) -> str:
    """A series that is called by a number and its field, without the topic: 'ch 1' of '/temps.ch 1'."""
    return series.removeprefix(f"{topic}.")


def _is_time(path: Path) -> bool:
    return "stamp" in map(str, path)


def _places_looked_at(count: int, most: int) -> list[int]:
    """Places of messages: all, or the first ones and pieces of the rest."""
    if count <= most:
        return list(range(count))
    size = most // (_PIECES + 1)
    starts = [(count - size) * k // _PIECES for k in range(_PIECES + 1)]
    return sorted({k for at in starts for k in range(at, at + size)})
