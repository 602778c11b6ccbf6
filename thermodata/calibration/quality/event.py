"""What is told of a stretch of readings with one flag."""

from __future__ import annotations

from collections.abc import Iterable
from dataclasses import dataclass

from thermodata.calibration.quality.value import true_runs
from thermodata.plugin import Bool1D, Int1D
from thermodata.schema.flag import Flag

MOST_EVENTS = 2000  # of a channel and flag; `concise` makes fewer of them


@dataclass(frozen=True, slots=True)
class QualityEvent:
    """A stretch with one flag. channel None: the whole stream. times [ns] of its first and last sample; n samples."""

    channel: str | None
    flag: str
    from_ns: int
    to_ns: int
    n: int
    detail: str = ""


def event_of(channel: str, flag: Flag, t_ns: Int1D, start: int, stop: int, detail: str) -> QualityEvent:
    """The event of rows [start, stop). t_ns: shape (n,)."""
    return QualityEvent(channel, flag.word, int(t_ns[start]), int(t_ns[stop - 1]), stop - start, detail)


def events_of(channel: str, flag: Flag, hit: Bool1D, t_ns: Int1D, detail: str) -> list[QualityEvent]:
    """One event a stretch of True in `hit`, shape (n,); the last of too many stands for the rest."""
    starts, stops = true_runs(hit)
    events = [
        event_of(channel, flag, t_ns, int(a), int(b), detail)
        for a, b in zip(starts[: MOST_EVENTS - 1], stops[: MOST_EVENTS - 1], strict=True)
    ]
    if len(starts) >= MOST_EVENTS:
        a, b = int(starts[MOST_EVENTS - 1]), int(stops[-1])
        rest = int((stops - starts)[MOST_EVENTS - 1 :].sum())
        further = f"{len(starts) - MOST_EVENTS + 1} further stretches"
        events.append(QualityEvent(channel, flag.word, int(t_ns[a]), int(t_ns[b - 1]), rest, further))
    return events


def capped(events: Iterable[QualityEvent]) -> list[QualityEvent]:
    """The first MOST_EVENTS of each flag."""
    kept: list[QualityEvent] = []
    seen: dict[str, int] = {}
    for event in events:
        seen[event.flag] = seen.get(event.flag, 0) + 1
        if seen[event.flag] <= MOST_EVENTS:
            kept.append(event)
    return kept
