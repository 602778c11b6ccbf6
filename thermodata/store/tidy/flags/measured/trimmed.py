"""Events as the flags that stay have them: what was taken from single samples again is no part of them."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass, field, replace

import numpy as np

from thermodata.calibration.quality.event import QualityEvent
from thermodata.calibration.quality.value import true_runs
from thermodata.plugin import Array, Int1D
from thermodata.schema.flag import Flag

_NONE = np.empty(0, np.int64)


@dataclass(slots=True)
class _OfFlag:
    """Times [ns] of the samples that lost a flag, and of the ends of the stretches that kept it."""

    lost: list[Int1D] = field(default_factory=list)
    firsts: list[Int1D] = field(default_factory=list)
    lasts: list[Int1D] = field(default_factory=list)


@dataclass(slots=True)
class Trimmed:
    """Gathers window by window which samples lost a flag that they had been given."""

    _of: dict[tuple[str, str], _OfFlag] = field(default_factory=dict)

    def add(self, channel: str, t_ns: Int1D, before: Array, after: Array) -> None:
        """The next rows of a channel with its flags as they were given and as they stay, shape (n,) each."""
        for flag in Flag(int(np.bitwise_or.reduce(before, initial=0))):
            had, has = (before & np.uint16(flag)) != 0, (after & np.uint16(flag)) != 0
            of = self._of.setdefault((channel, flag.word), _OfFlag())
            of.lost.append(t_ns[had & ~has])
            starts, stops = true_runs(has)
            of.firsts.append(t_ns[starts])
            of.lasts.append(t_ns[stops - 1])

    def events(self, events: Sequence[QualityEvent]) -> list[QualityEvent]:
        """Those of which a sample is left, from the first to the last that is, with how many are."""
        return [e for event in events if (e := self._trimmed(event)) is not None]

    def _trimmed(self, event: QualityEvent) -> QualityEvent | None:
        of = self._of.get((event.channel or "", event.flag))
        lost = _concatenated(of.lost) if of else _NONE
        gone = int(np.searchsorted(lost, event.to_ns, "right") - np.searchsorted(lost, event.from_ns))
        if of is None or not gone:
            return event
        firsts, lasts = _concatenated(of.firsts), _concatenated(of.lasts)
        first, last = int(np.searchsorted(lasts, event.from_ns)), int(np.searchsorted(firsts, event.to_ns, "right")) - 1
        if gone >= event.n or first > last:
            return None
        begins, ends = max(event.from_ns, int(firsts[first])), min(event.to_ns, int(lasts[last]))
        return replace(event, from_ns=begins, to_ns=ends, n=event.n - gone)


def _concatenated(parts: list[Int1D]) -> Int1D:
    """The parts as one, which they are from then on: an event asks for them each."""
    if len(parts) > 1:
        parts[:] = [np.concatenate(parts)]
    return parts[0] if parts else _NONE
