"""Files whose local times end in the hour that their zone repeats: nothing in them says in which of its passes."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import replace
from pathlib import Path

from thermodata.errors import ThermodataError
from thermodata.plugin import Reader, Recording, Source
from thermodata.reader.contract.guard import described
from thermodata.reader.text.preamble.pass_words import lines_above, pass_said
from thermodata.reader.times.repeated_hour import ALL, ENDS, head_says, repeated_hour
from thermodata.reader.times.zone import NO_ZONE


def pass_notes(
    reader: Reader, path: Path, source: Source, recording: Recording, spans: Sequence[tuple[int, int]]
) -> list[str]:
    """The note on such a file; [] where its zone is not declared, or its times are not local. spans: the first and the
    last recorded time of each stream [ns]."""
    if source.timezone is None or not spans:
        return []
    if recording.is_undated:
        return []
    relative = recording.clock == "relative"
    first = recording.start_ns if relative and recording.start_ns is not None else min(a for a, _ in spans)
    # what counts from a local start hangs on it alone
    last = first if relative else max(b for _, b in spans)
    hour = repeated_hour(source.timezone, last)
    if hour is None or not _local(reader, path, source):
        return []
    said, at = (ALL, first) if hour.in_first(first) else (ENDS, last)
    told = pass_said(lines_above(path), hour, source.timezone) if said == ALL else None
    told_by = "" if told is None else head_says(told[1], second=told[0])
    return [f"{said}: {hour.written(at, second=False)}, or {hour.written(at, second=True)}{told_by}"]


def _local(reader: Reader, path: Path, source: Source) -> bool:
    """Whether a file tells times that hang on the declared zone."""
    try:
        return any(NO_ZONE in note for note in described(reader, path, replace(source, timezone=None)).notes)
    except ThermodataError:
        return False
