"""The zone to propose for local times: what the head of a file, or the names of all files, say."""

from __future__ import annotations

import re
from collections.abc import Sequence
from pathlib import PurePosixPath

from thermodata.reader.text.cells.time_forms.zone_words import stated_zone
from thermodata.reader.text.tables.sample.zone_named import named_in

EXAMPLE = "e.g. timezone: Europe/Prague, or UTC+1 of a clock on winter time all year"


def named_zone(head: str | None, paths: Sequence[PurePosixPath]) -> str:
    """How the question of a zone ends: with the zone that the note on a head names, or all names of files; else with
    an example."""
    told = re.search(r"timezone: (\S+)", head or "")
    if told is not None:
        return f"timezone: {told[1]}?"
    by_name = {stated_zone([path.stem]) or (named_in([path.stem]) or (None,))[0] for path in paths}
    zone = by_name.pop() if len(by_name) == 1 else None
    return EXAMPLE if zone is None else f"timezone: {zone}? as '{paths[0].name}' says"


def zone_in(ending: str) -> str | None:
    """The zone that such an ending names; None where it is an example."""
    told = re.match(r"timezone: ([^\s?]+)\?", ending)
    return None if told is None else told[1]
