"""What somebody deleted from a campaign file stays out of the next draft: the file remembers, in its last line, which
tests and channels it was drafted with."""

from __future__ import annotations

import hashlib
import re
from collections.abc import Iterator, Mapping
from pathlib import Path
from typing import Any

from thermodata.draft.campaign.parts import Draft
from thermodata.draft.folder.into_sources.sources_before import names_in_draft, with_sources_called
from thermodata.draft.writing.by_hand import entries_of, place_in
from thermodata.errors import ThermodataError
from thermodata.schema.strict.lines import parse_document
from thermodata.schema.words.sentences import with_dots

# sums, for a name in a comment of a campaign file leaves its log out at an ingest
_DRAFTED = "# as drafted, so that what is deleted above stays out of the next draft: "
_LENGTH, _SHOWN = 8, 12


def drafted_with(draft: Draft) -> list[str]:
    """The line that remembers the tests and channels of a draft; none of a draft without them."""
    signals = [_sum("channels", c.source, c.signal) for c in draft.channels if c.said.quantity]
    tests = [_sum("tests", t.id) for t in draft.tests]
    return [_DRAFTED + " ".join(dict.fromkeys((*signals, *tests)))] if signals or tests else []


def without_deleted(text: str, before: str) -> str:
    """A draft without the tests and channels that the file before was drafted with and no longer has, with a note.
    Where none would be left of a kind, all are: such a file was emptied to be drafted anew."""
    remembered = set(re.findall(rf"\b[0-9a-f]{{{_LENGTH}}}\b", _memory(before)))
    try:
        own, made = (parse_document(t, Path("campaign.yaml")) for t in (before, text))
    except ThermodataError:
        return text
    if not remembered or not isinstance(own.data, dict):
        return text
    there = with_sources_called(own.data, names_in_draft(own.data, made.data))
    kept = set(_entries(there).values()) | set(_entries(own.data).values())
    gone: list[tuple[str, str]] = []
    for section in ("channels", "tests"):
        every = {place: of for place, of in _entries(made.data).items() if place[0] == section}
        out = [p for p, of in every.items() if of in remembered and of not in kept]
        gone += out if len(out) < len(every) else []
    if not gone:
        return text
    drop = {made.line[place] - 1 for g in gone if (place := place_in(made, *g)) is not None}
    lines = [line for i, line in enumerate(text.splitlines()) if i not in drop]
    said = with_dots([name for _, name in gone], _SHOWN)
    note = f"# note: left out, as deleted from the campaign file before: {said}; to have one again, write its line"
    at = next((i for i, line in enumerate(lines) if line.startswith(_DRAFTED)), len(lines))
    return "\n".join([*lines[:at], note, *lines[at:]]) + "\n"


def _memory(text: str) -> str:
    return next((x.removeprefix(_DRAFTED) for x in text.splitlines() if x.startswith(_DRAFTED)), "")


def _entries(data: Mapping[str, Any]) -> dict[tuple[str, str], str]:
    """(section, name) -> its sum, of channels by their signal."""
    return dict(_each(data))


def _each(data: Mapping[str, Any]) -> Iterator[tuple[tuple[str, str], str]]:
    for name, entry in entries_of(data, "channels"):
        if "signal" in entry:
            yield ("channels", name), _sum("channels", str(entry.get("source")), str(entry["signal"]))
    for name, _ in entries_of(data, "tests"):
        yield ("tests", name), _sum("tests", name)


def _sum(*said: str) -> str:
    return hashlib.sha256("\0".join(said).encode()).hexdigest()[:_LENGTH]
