"""The day that the name of a log says, and when it began where its rows tell times of day alone."""

from __future__ import annotations

from collections.abc import Sequence
from datetime import UTC, datetime
from itertools import pairwise

from thermodata.draft.files.raw_file import RawFile
from thermodata.draft.words.said_by_names import said_by

_DAY_NS = 86_400 * 10**9


def began_ns(file: RawFile) -> int | None:
    """Of a log without dates: its first time of day, on the day that its name says."""
    said = file.recording
    if not said.is_undated or said.of_day_ns is None:
        return None
    day = day_of_name(file)
    return None if day is None else day + said.of_day_ns


def day_of_name(file: RawFile) -> int | None:
    """The day that a name says, at midnight, since 1970 [ns]; None where it says none."""
    date = said_by([file.path.stem]).conditions.get("date")
    try:
        day = None if date is None else datetime.strptime(date, "%Y-%m-%d").replace(tzinfo=UTC)
    except ValueError:  # 31 April
        return None
    return None if day is None else round(day.timestamp()) * 10**9


def span_ns(file: RawFile) -> tuple[int, int] | None:
    """The first and the last time of a file whose name has its day; None where it has none, or was not read to its
    end."""
    seen = file.sample
    if not seen.whole or seen.first_ns is None or seen.last_ns is None:
        return None
    if (began := began_ns(file)) is not None:
        return began, began + seen.last_ns - seen.first_ns
    dated = file.recording.clock == "absolute" and day_of_name(file) is not None
    return (seen.first_ns, seen.last_ns) if dated else None


def follow_by_names(files: Sequence[RawFile]) -> bool:
    """Whether the days in the names of files and the times of day in them say when each began, and each as soon after
    the one before as its time of day can: so an ingest joins them."""
    spans = [span_ns(f) for f in files if began_ns(f) is not None]
    known = [span for span in spans if span is not None]
    return len(known) == len(files) and all(0 <= b[0] - a[1] < _DAY_NS for a, b in pairwise(known))
