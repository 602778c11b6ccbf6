"""What is told of a stretch of flagged samples."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass, fields
from typing import Any


@dataclass(frozen=True, slots=True)
class Event:
    """A stretch of flagged samples; times in seconds from the test's start. channel: None for the whole stream."""

    channel: str | None
    flag: str
    from_s: float
    to_s: float
    n: int
    detail: str | None = None


def event_of(row: Mapping[str, Any]) -> Event:
    """From a row of the table `quality_event`."""
    return Event(**{f.name: row[f.name] for f in fields(Event)})
