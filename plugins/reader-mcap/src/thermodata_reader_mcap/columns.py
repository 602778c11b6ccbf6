"""Messages of one topic as columns: JSON through Arrow's parser, cdr by its layout, all else one by one."""

from __future__ import annotations

from collections.abc import Iterator, Mapping, Sequence
from dataclasses import dataclass, field
from typing import Any, Protocol

import numpy as np

from thermodata.plugin import Array, Int1D
from thermodata_reader_mcap.leaves import Leaf
from thermodata_reader_mcap.seen import Path


class Decoder(Protocol):
    """json: payloads are JSON text. hint: what the schema says of a path."""

    json: bool

    def decode(self, payload: bytes) -> Any:
        """A payload as Python values: dict, list, numbers, bool, text, bytes; any exception where it is none."""


@dataclass(frozen=True, slots=True)
class Topic:
    """What the sample of a topic found. wrapped: messages are no objects but single values or arrays. long: arrays
    of which more elements than are read were seen; skipped: paths that are not read on purpose."""

    name: str
    leaves: tuple[Leaf, ...]
    wrapped: bool = False
    long: frozenset[Path] = frozenset()
    skipped: frozenset[Path] = frozenset()


@dataclass(frozen=True, slots=True)
class Wrong:
    """A value that is not what its signal holds, or a field that is none of the signals (expected: None)."""

    message: int
    name: str
    expected: str | None
    got: str


@dataclass(slots=True)
class Columns:
    """Columns of consecutive messages. kept: which are in, shape (n,), rising."""

    kept: Int1D
    values: dict[str, Array]
    flags: dict[str, Array]
    wrong: list[Wrong] = field(default_factory=list)


def columns(topic: Topic, decoder: Decoder, payloads: Sequence[bytes]) -> Iterator[Columns]:
    """The payloads as columns, in order; the places in `kept` and `wrong` count from the first one."""
    from thermodata_reader_mcap import arrow_json, one_by_one

    if not payloads:
        return
    if decoder.json:
        recoded = getattr(decoder, "encoding", None) is not None
        yield from arrow_json.columns(topic, [_utf8(decoder, p) for p in payloads] if recoded else payloads, 0)
        return
    many = getattr(decoder, "columns", None)
    if many is not None:
        yield many(topic, payloads)
        return
    yield one_by_one.columns(topic, decoder.decode, payloads, 0)


def _utf8(decoder: Any, payload: bytes) -> bytes:
    try:
        text: bytes = decoder.text(payload)
    except UnicodeDecodeError:
        return payload
    return text


def merged(parts: Mapping[int, list[Columns]], places: Mapping[int, Int1D]) -> Columns:
    """Columns of several decoders of one topic in the order of their messages. places: where the messages of each
    one's payloads stood."""
    kept = np.concatenate([places[k][part.kept] for k, each in parts.items() for part in each])
    order = np.argsort(kept, kind="stable")
    every = [part for each in parts.values() for part in each]
    result = Columns(kept[order], {}, {})
    for name in every[0].values:
        result.values[name] = np.concatenate([part.values[name] for part in every])[order]
        if any(name in part.flags for part in every):
            none = [part.flags.get(name, np.zeros(part.kept.size, np.uint16)) for part in every]
            result.flags[name] = np.concatenate(none)[order]
    result.wrong = [
        Wrong(int(places[k][w.message]), w.name, w.expected, w.got)
        for k, each in parts.items()
        for part in each
        for w in part.wrong
    ]
    return result
