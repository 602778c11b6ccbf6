"""What would be ingested: header, units, start, rate, gaps and first rows of a file. Stores nothing."""

from __future__ import annotations

import time
from collections.abc import Callable
from dataclasses import dataclass
from pathlib import Path
from typing import Any

from thermodata.archive.members import size_of
from thermodata.archive.regular import refuse_what_never_ends
from thermodata.plugin import Block, Loss, Reader, Recording, Source
from thermodata.reader.contract.guard import asking, described, guarded, held_for
from thermodata.reader.finding.registry import claims, sniff
from thermodata.reader.finding.seen import SeenRows, time_shown

FIRST_ROWS = 5
MOST_ROWS, MOST_S = 3_000_000, 8.0  # a preview of a file of any size takes seconds
_SMALL = 4_000_000  # bytes; a smaller file is read whole, however busy the machine is


@dataclass(frozen=True, slots=True)
class Until:
    """first_rows: of a stream, that are shown; most_rows, most_s: after which a large file is read no more."""

    first_rows: int = FIRST_ROWS
    most_rows: int = MOST_ROWS
    most_s: float = MOST_S


A_LOOK = Until()


@dataclass(frozen=True, slots=True)
class Begun:
    """Who reads a file for a look at it, and what it says of it. whole: whether that is all of it, and not its first
    rows alone."""

    reader: Reader
    recording: Recording
    whole: bool


def preview(
    path: Path | str,
    source: Source | None = None,
    reader: Reader | None = None,
    *,
    until: Until = A_LOOK,
    watch: Callable[[Block], None] | None = None,
    begun: Begun | None = None,
) -> dict[str, Any]:
    """A file as plain data, ready for JSON. reader: which one (default: the one that claims the file).

    until: where reading ends in a large file ('whole' is False then, and what is said of rows, gaps and losses holds
    for the part that was read); watch: sees every block that is read; begun: who reads it and what that says, where the
    caller has it already, in place of `reader`.

    Keys: file, size_bytes, reader, reason, clock, timezone, start, complete, whole, rows_read, notes, losses, and
    streams, each with stream, rows, start, end, duration_s, step_s, rate_hz, gaps, largest_step_s, backward, repeated,
    signals (name, unit, dtype, scaling) and first_rows. Values that do not apply are None. Errors: those of sniff
    and of the reader.
    """
    path = Path(path)
    source = source or Source()
    begun = begun or begin(reader if reader is not None else sniff(path), path, source)
    chosen, said, whole = begun.reader, begun.recording, begun.whole
    absolute = said.clock == "absolute"
    seen = SeenRows(said, until.first_rows)
    began = time.monotonic()
    hurried = size_of(path) > _SMALL
    for item in guarded(chosen, path, source, said):
        if isinstance(item, Loss):
            seen.add_loss(item)
            continue
        seen.add(item)
        if watch is not None:
            watch(item)
        if seen.rows >= until.most_rows or (hurried and time.monotonic() - began > until.most_s):
            whole = False
            break
    return {
        "file": path.name,
        "size_bytes": size_of(path),
        "reader": chosen.name,
        "reason": claims(path).get(chosen.name),
        "clock": said.clock,
        "timezone": source.timezone,
        "start": None if said.start_ns is None else time_shown(said.start_ns, absolute),
        "complete": said.complete,
        "whole": whole,
        **seen.as_json(),
    }


def begin(reader: Reader, path: Path, source: Source) -> Begun:
    """Who reads a file for a look at it, and what that says of it: of the first rows alone where the reader can do that
    and the file is large. FormatError for what is no file; what `described` raises."""
    refuse_what_never_ends(path)
    beginning = getattr(reader, "beginning", None)
    with asking(f"reader '{reader.name}' failed to begin a file", str(path)), held_for(reader, path) as real:
        first: Reader | None = None if beginning is None else beginning(real, source)
    chosen = reader if first is None else first
    return Begun(chosen, described(chosen, path, source), whole=first is None)


__all__ = ["FIRST_ROWS", "MOST_ROWS", "MOST_S", "Begun", "Until", "begin", "preview"]
