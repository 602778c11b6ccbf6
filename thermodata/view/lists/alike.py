"""Flagged stretches that are alike as one row: which channels, which flag, how many, from when to when, how long.

A probe at its limit once a stroke has a hundred of them: a row each hides everything else."""

from __future__ import annotations

from collections.abc import Iterable
from dataclasses import dataclass

from thermodata.view.lists.events import Flagged


@dataclass(frozen=True, slots=True)
class Alike:
    """Stretches of one flag. channels: those that have it in the very same stretches and for the same reason; none
    where it is of a source. stretches: of each of them, in order of time, at least one."""

    channels: tuple[str, ...]
    source: str
    flag: str
    stretches: tuple[Flagged, ...]

    @property
    def from_s(self) -> float:
        """Where the first begins [s]."""
        return self.stretches[0].from_s

    @property
    def to_s(self) -> float:
        """Where the last ends [s]."""
        return max(one.to_s for one in self.stretches)

    @property
    def total_s(self) -> float:
        """How long they are in all [s]."""
        return sum(one.to_s - one.from_s for one in self.stretches)

    @property
    def n(self) -> int:
        """Samples of all channels."""
        return max(1, len(self.channels)) * sum(one.n for one in self.stretches)

    @property
    def details(self) -> tuple[str, ...]:
        """The reasons, each once."""
        return tuple(dict.fromkeys(one.detail for one in self.stretches if one.detail))


def folded(flagged: Iterable[Flagged]) -> list[Alike]:
    """In the order of their first stretches."""
    each: dict[tuple[str, str, str], list[Flagged]] = {}
    for one in flagged:
        each.setdefault((one.source, one.flag, one.channel), []).append(one)
    alike: dict[tuple[object, ...], list[list[Flagged]]] = {}
    for (source, flag, _), stretches in each.items():
        same = tuple((one.from_s, one.to_s, one.n, one.detail) for one in stretches)
        alike.setdefault((source, flag, same), []).append(stretches)
    return [
        Alike(tuple(some[0].channel for some in of if some[0].channel), of[0][0].source, of[0][0].flag, tuple(of[0]))
        for of in alike.values()
    ]
