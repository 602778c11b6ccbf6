"""The signals of one topic: which field of its messages each is, and in which numbers."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass

from thermodata_reader_mcap.encodings.field_paths import Path


@dataclass(frozen=True, slots=True)
class Leaf:
    """One signal. path: keys and places of arrays. dtype: float64, int64, uint64, bool or str."""

    path: Path
    name: str
    dtype: str
    unit: str | None = None
    properties: tuple[tuple[str, str], ...] = ()


@dataclass(frozen=True, slots=True)
class Hint:
    """What a schema says of a field. kind: number, integer, boolean or string (JSON Schema's words), or uint64."""

    kind: str | None = None
    unit: str | None = None
    properties: tuple[tuple[str, str], ...] = ()


Declared = Callable[[Path], Hint | None]


@dataclass(frozen=True, slots=True)
class Topic:
    """What the sample of a topic found. wrapped: messages are no objects but single values or arrays. long: arrays
    of which more elements than are read were seen; skipped: paths that are not read on purpose."""

    name: str
    leaves: tuple[Leaf, ...]
    wrapped: bool = False
    long: frozenset[Path] = frozenset()
    skipped: frozenset[Path] = frozenset()


def time_name(topic: Topic, kind: str) -> str:
    """The signal of a topic's log or publish times; another name where the messages have a field of this one."""
    name = f"{topic.name}.{kind}"
    return name if all(leaf.name != name for leaf in topic.leaves) else f"{name}#header"
