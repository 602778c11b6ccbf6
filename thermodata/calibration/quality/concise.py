"""As many events as a person reads: many short ones of one kind and close to each other become one."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import replace

from thermodata.calibration.quality.event import QualityEvent

_FEW, _MOST = 8, 50  # of a channel and flag
_NEAR = 200  # the part of the whole time that may lie between two


def concise(events: Sequence[QualityEvent]) -> list[QualityEvent]:
    """Events in order of time; at most 50 a channel and flag, the last of which stands for the rest."""
    if not events:
        return []
    near_ns = (max(e.to_ns for e in events) - min(e.from_ns for e in events)) // _NEAR
    kinds: dict[tuple[str | None, str], list[QualityEvent]] = {}
    for event in sorted(events, key=lambda e: e.from_ns):
        kinds.setdefault((event.channel, event.flag), []).append(event)
    shortened = []
    for some in kinds.values():
        groups: list[list[QualityEvent]] = []
        for event in some:
            close = len(some) > _FEW and bool(groups) and event.from_ns - groups[-1][-1].to_ns <= near_ns
            if (close and _base(event) in (_base(groups[-1][0]), event.flag)) or len(groups) == _MOST:
                groups[-1].append(event)
            else:
                groups.append([event])
        shortened += [_as_one_event(group) for group in groups]
    return sorted(shortened, key=lambda e: (e.from_ns, e.channel or ""))


def _base(event: QualityEvent) -> str:
    """Why, without what differs from stretch to stretch."""
    same = event.flag in ("saturated", "out_of_range", "spike") and "further stretches" not in event.detail
    return event.detail if same else event.flag


def _as_one_event(group: Sequence[QualityEvent]) -> QualityEvent:
    if len(group) == 1:
        return group[0]
    reason = next((e.detail for e in group if e.detail), "")
    return replace(
        group[0],
        to_ns=max(e.to_ns for e in group),
        n=sum(e.n for e in group),
        detail=f"{reason}{'; ' if reason else ''}{len(group)} stretches",
    )
