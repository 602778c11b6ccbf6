"""The start that stands above the rows of a sheet, which rows without a date count from, as those of a text do."""

from __future__ import annotations

from collections.abc import Sequence
from typing import Any

import numpy as np

from thermodata.plugin import Source
from thermodata.reader.text.begin import ROWS, FirstTimes, declared_start, find_begin
from thermodata.reader.text.time_formats import Stamps
from thermodata.reader.zone import NAT, local_to_utc_ns


def begun(times: Stamps, head: Sequence[Sequence[Any]], source: Source, zone: str | None, where: str) -> Stamps:
    """Times that count from a start, from that which stands above them; as they are where none does. head: the rows
    above the data. FormatError where what is declared of it fits nothing."""
    if times.absolute:
        return times
    first = times.t_ns[times.t_ns != NAT][:ROWS].tolist()
    lines = [[str(c) for c in row if c not in ("", None)] for row in head]
    begin, doubt = find_begin(lines, FirstTimes(tuple(first), False), declared_start(source.table or {}), where)
    if begin is None:
        return Stamps(times.t_ns, False, (*times.notes, *([doubt] if doubt else [])))
    notes = local_to_utc_ns(np.array([begin.ns]).view("datetime64[ns]"), zone)[1] if begin.local else []
    return Stamps(begin.utc(times.t_ns, zone), True, (*times.notes, begin.note(), *notes))
