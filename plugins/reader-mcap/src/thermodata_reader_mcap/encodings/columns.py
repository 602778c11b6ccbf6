"""Messages of one topic as columns, and the values in them that do not fit."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass, field

import numpy as np

from thermodata.plugin import Array, Int1D
from thermodata.schema.flag import Flag

MISSING = np.uint16(Flag.NOT_MEASURING)  # no NaN in integers and booleans: 0, and not valid


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
