"""Whether the stamps in messages tell other times than their log times: a recorder that writes in bursts logs minutes
of messages at once, and the log times are what is read unless another time is asked for."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from typing import Any

import numpy as np

from thermodata_reader_mcap.container.definitions import Channel
from thermodata_reader_mcap.container.message_batches import Batch
from thermodata_reader_mcap.encodings.decoder import Decoder
from thermodata_reader_mcap.encodings.field_paths import Path
from thermodata_reader_mcap.encodings.topic import Topic
from thermodata_reader_mcap.signals.options import STAMPS

_LOOKED_AT = 200  # messages of a topic
_APART_NS = 1_000_000_000  # that a latency changes by less than


def apart(topic: Topic, batches: Mapping[Channel, Batch], made: Mapping[Channel, Decoder]) -> str | None:
    """A note where a topic's stamps do not keep one distance from its log times; None where they do, or are none."""
    found = _stamp([leaf.path for leaf in topic.leaves if leaf.dtype != "str"])
    if found is None:
        return None
    path, parts = found
    away: list[int] = []
    for channel, one in made.items():
        batch = batches[channel]
        logs = batch.times()[0]
        for i in range(0, len(batch.payloads), max(1, len(batch.payloads) // _LOOKED_AT)):
            stamp = _read(one, batch.payloads[i], (*path, parts[0])), _read(one, batch.payloads[i], (*path, parts[1]))
            if isinstance(stamp[0], int) and isinstance(stamp[1], int) and stamp[0] > 0:
                away.append(int(logs[i]) - stamp[0] * 10**9 - stamp[1])
    spread = int(np.ptp(np.array(away, np.float64))) if away else 0
    if spread <= _APART_NS:
        return None
    name = ".".join(map(str, path))
    return (
        f"topic '{topic.name}': the times that are read are log times, and {name} changes its distance from them by "
        f"{spread / 1e9:.3g} s; declare options: {{time: {name}}} if the recorder wrote in bursts"
    )


def _stamp(paths: Sequence[Path]) -> tuple[Path, tuple[str, str]] | None:
    """The first field of a stamp, with what its seconds and nanoseconds are called."""
    known = set(paths)
    for path in paths:
        for pair in STAMPS:
            if len(path) > 1 and path[-1] == pair[0] and "stamp" in str(path[-2]) and (*path[:-1], pair[1]) in known:
                return path[:-1], pair
    return None


def _read(one: Decoder, payload: bytes, path: Path) -> Any:
    try:
        value: Any = one.decode(payload)
        for part in path:
            value = value[part]
    except Exception:  # whatever a decoder raises: it says nothing
        return None
    return value
