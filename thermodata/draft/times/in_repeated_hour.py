"""What to ask of files whose local times all lie in the hour that a zone repeats in autumn."""

from __future__ import annotations

import re
from collections.abc import Sequence

from thermodata.draft.files.raw_file import RawFile
from thermodata.draft.folder.sources import Group
from thermodata.reader.times.repeated_hour import repeated_hour
from thermodata.reader.times.zone import utc_offset_ns


def which_pass(group: Group, groups: Sequence[Group], proposed: str) -> str:
    """How the question of a zone goes on where a test begins with a file that lies in the hour that the proposed zone
    repeats; of any other file a start tells nothing."""
    named = re.search(r"timezone: ([\w/+-]+)", proposed)
    for test, files in group.tests.items() if named is not None else ():
        zone = "" if named is None else named[1]
        first = next((f for f in files if _passes(f, zone)), None)
        passes = None if first is None else _passes(first, zone)
        if first is None or passes is None:
            continue
        others = [f for g in groups for f in g.tests.get(test, ()) if _passes(f, zone) is None]
        began = _local_ns(first, zone) or 0
        if all((at := _local_ns(f, zone)) is None or at >= began for f in others):
            return (
                f"; all times of {first.path.name} lie in the hour that this zone repeats: with it give the test its "
                f"start: {passes[0]} for the first pass, {passes[1]} for the second"
            )
    return ""


def _passes(file: RawFile, zone: str) -> tuple[str, str] | None:
    """When a file began, as of either pass; None where it does not lie in that hour."""
    first, last = file.sample.first_ns, file.sample.last_ns
    if not file.local or first is None or last is None:
        return None
    # read as UTC meanwhile
    ahead = utc_offset_ns(zone, first // 10**9 - 24 * 3600)
    hour = repeated_hour(zone, first - ahead)
    if hour is None or not hour.in_first(last - ahead):
        return None
    return hour.written(first - ahead, second=False), hour.written(first - ahead, second=True)


def _local_ns(file: RawFile, zone: str) -> int | None:
    """When a file began, in local times of a zone [ns]; None where it has no date."""
    at = file.start_ns
    return at if at is None or file.local else at + utc_offset_ns(zone, at // 10**9)
