"""What to ask of files whose local times all lie in the hour that a zone repeats in autumn."""

from __future__ import annotations

import re
from collections.abc import Sequence

from thermodata.draft.files.raw_file import RawFile
from thermodata.reader.times.repeated_hour import repeated_hour
from thermodata.reader.times.zone import utc_offset_ns


def which_pass(files: Sequence[RawFile], proposed: str) -> str:
    """How the question of a zone goes on where one of the files lies in the hour that the proposed zone repeats."""
    named = re.search(r"timezone: ([\w/+-]+)", proposed)
    for file in files if named is not None else ():
        first, last = file.sample.first_ns, file.sample.last_ns
        if named is None or not file.local or first is None or last is None:
            continue
        # read as UTC meanwhile
        ahead = utc_offset_ns(named[1], first // 10**9 - 24 * 3600)
        hour = repeated_hour(named[1], first - ahead)
        if hour is not None and hour.in_first(last - ahead):
            told = [hour.written(first - ahead, second=x) for x in (False, True)]
            return (
                f"; all times of {file.path.name} lie in the hour that this zone repeats: with it give the test its "
                f"start: {told[0]} for the first pass, {told[1]} for the second"
            )
    return ""
