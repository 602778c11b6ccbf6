"""Messages as they are collected: payloads and times, a batch a topic (or whatever they are kept apart by)."""

from __future__ import annotations

from collections.abc import Callable, Hashable
from dataclasses import dataclass, field

import numpy as np
import numpy.typing as npt

from thermodata.plugin import Int1D
from thermodata_reader_mcap.container.definitions import Channel
from thermodata_reader_mcap.container.records import Bytes

U64 = npt.NDArray[np.uint64]
_HEAD = 31  # bytes of a message's record before its payload


@dataclass(slots=True)
class Batch:
    """Messages in the order of the file: payloads, and parts of their log and publish times [ns], uint64.
    members: their channels; kinds: parts that say which of them each message has."""

    payloads: list[bytes] = field(default_factory=list)
    log_ns: list[U64] = field(default_factory=list)
    publish_ns: list[U64] = field(default_factory=list)
    members: dict[Channel, int] = field(default_factory=dict)
    kinds: list[npt.NDArray[np.int64]] = field(default_factory=list)

    def times(self) -> tuple[U64, U64]:
        """All log and publish times, shape (n,) each."""
        none = [np.empty(0, np.uint64)]
        return np.concatenate(self.log_ns or none), np.concatenate(self.publish_ns or none)

    def places(self) -> dict[Channel, Int1D]:
        """Which messages each channel has."""
        if len(self.members) == 1:
            return {channel: np.arange(len(self.payloads)) for channel in self.members}
        kinds = np.concatenate(self.kinds or [np.empty(0, np.int64)])
        return {channel: np.flatnonzero(kinds == kind) for channel, kind in self.members.items()}


Key = Callable[[Channel], Hashable | None]


def take(
    inner: Bytes,
    at: Int1D,
    channel_of: Callable[[int], Channel | None],
    key: Key,
    into: dict[Hashable, Batch],
    counts: dict[int, int],
    lost: dict[int, int],
) -> U64:
    """Puts the messages whose records begin at these places into the batches of their keys (None: not wanted);
    returns their log times. counts: messages by channel id; lost: those whose channel nothing defines."""
    data = np.frombuffer(inner, np.uint8)
    heads = np.lib.stride_tricks.sliding_window_view(data, _HEAD)[at]
    numbers = np.ascontiguousarray(heads[:, 9:11]).view("<u2")[:, 0]
    starts, stops = at + _HEAD, at + 9 + np.ascontiguousarray(heads[:, 1:9]).view("<i8")[:, 0]
    log_ns = np.ascontiguousarray(heads[:, 15:23]).view("<u8")[:, 0]
    publish_ns = np.ascontiguousarray(heads[:, 23:31]).view("<u8")[:, 0]
    groups: dict[Hashable, tuple[Batch, list[tuple[int, int]]]] = {}
    how_many = np.bincount(numbers)
    for number in np.flatnonzero(how_many).tolist():
        channel, n = channel_of(number), int(how_many[number])
        counts[number] = counts.get(number, 0) + n
        if channel is None:
            lost[number] = lost.get(number, 0) + n
            continue
        wanted = key(channel)
        if wanted is None:
            continue
        batch = into.setdefault(wanted, Batch())
        kind = batch.members.setdefault(channel, len(batch.members))
        groups.setdefault(wanted, (batch, []))[1].append((number, kind))
    for batch, members in groups.values():
        mine = _places(numbers, [number for number, _ in members])
        first, last = (starts, stops) if mine is None else (starts[mine], stops[mine])
        batch.payloads += (
            [bytes(inner[a:b]) for a, b in zip(first.tolist(), last.tolist(), strict=True)]
            if isinstance(inner, memoryview)
            else [inner[a:b] for a, b in zip(first.tolist(), last.tolist(), strict=True)]
        )
        batch.log_ns.append(log_ns if mine is None else log_ns[mine])
        batch.publish_ns.append(publish_ns if mine is None else publish_ns[mine])
        if len(members) == 1:
            batch.kinds.append(np.full(first.size, members[0][1], np.int64))
            continue
        table = np.zeros(65536, np.int64)
        table[[number for number, _ in members]] = [kind for _, kind in members]
        batch.kinds.append(table[numbers if mine is None else numbers[mine]])
    return log_ns


def _places(numbers: npt.NDArray[np.uint16], members: list[int]) -> Int1D | None:
    """Where the members' messages stand; None for everywhere."""
    mine = numbers == members[0] if len(members) == 1 else np.isin(numbers, members)
    return None if mine.all() else np.flatnonzero(mine)
