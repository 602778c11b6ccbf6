"""Events of stretches in which a test does not measure: a probe out of reach while the axis moves is no defect."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import dataclass, field

import numpy as np

from thermodata.calibration.quality.event import QualityEvent
from thermodata.plugin import Array, Bool1D, Int1D
from thermodata.schema.flag import NOT_FLAGGED

_OF_VALUES = frozenset({"held", "stuck", "saturated", "out_of_range", "spike", "offset"})


@dataclass(slots=True)
class Activity:
    """When a channel is measured: times [ns] at which its mask changes, gathered chunk by chunk."""

    _edges: list[Int1D] = field(default_factory=list)
    _on: bool = False

    def add(self, t_ns: Int1D, mask: Bool1D) -> None:
        """The next rows, shape (n,), with where the channel is measured."""
        if not len(mask):
            return
        changes = np.flatnonzero(np.diff(np.concatenate([[self._on], mask]).view(np.int8)))
        if len(changes):
            self._edges.append(t_ns[changes])
        self._on = bool(mask[-1])

    @property
    def ever(self) -> bool:
        """Whether the channel is measured at any time."""
        return bool(self._edges)

    def during(self, from_ns: Array, to_ns: Array) -> Bool1D:
        """Whether the channel is measured at any time from `from_ns` to `to_ns`; shape (k,)."""
        if len(self._edges) > 1:  # joined once: each event of a test asks
            self._edges[:] = [np.concatenate(self._edges)]
        edges = self._edges[0] if self._edges else np.empty(0, np.int64)
        before = np.searchsorted(edges, from_ns, side="right")
        after = np.searchsorted(edges, to_ns, side="right")
        return np.asarray((before % 2 == 1) | (after > before))


ONLY = "only while not measuring"  # detail of an event that says nothing against its channel


def joined(channel: str | None, flag: str, events: Sequence[QualityEvent], detail: str) -> QualityEvent:
    """Some events of a channel and flag as one, from the first to the last of them."""
    first, last = min(e.from_ns for e in events), max(e.to_ns for e in events)
    return QualityEvent(channel, flag, first, last, sum(e.n for e in events), detail)


def join_while_not_measuring(
    events: Sequence[QualityEvent],
    activity: Mapping[str, Activity],
    repeats: Mapping[tuple[str, str], Activity] | None = None,
) -> list[QualityEvent]:
    """Events of values, of channels that are measured at times only: those that fall wholly between the measuring
    phases become one event a channel and flag, which says so. The others are left as they are. What is told of a flag
    that no sample has asks for measuring phases, and is no more told of them.

    repeats: by channel and flag, when a measured sample has the flag: of flags that not all samples of an event keep.
    """
    kept: list[QualityEvent] = []
    idle: dict[tuple[str, str], list[QualityEvent]] = {}
    for event in events:
        times = (repeats or {}).get((event.channel or "", event.flag), activity.get(event.channel or ""))
        if (
            times is None
            or event.flag not in _OF_VALUES
            or event.channel is None
            or bool(times.during(np.array([event.from_ns]), np.array([event.to_ns]))[0])
        ):
            kept.append(event)
        elif not (event.detail or "").startswith(NOT_FLAGGED):
            idle.setdefault((event.channel, event.flag), []).append(event)
    for (channel, flag), some in idle.items():
        kept.append(joined(channel, flag, some, ONLY))
    return sorted(kept, key=lambda e: (e.from_ns, e.channel or ""))
