"""The start of an MDF file: UTC of the zero of all masters."""

from __future__ import annotations

import datetime as dt
from typing import Any

import numpy as np

from thermodata.errors import FormatError
from thermodata.plugin import Source
from thermodata.reader.times.zone import local_to_utc_ns

Start = tuple[int | None, list[str]]
"""(UTC of the zero of all masters in ns since 1970, None where the header names no day; notes of what had to be
decided)."""


def start_of(header: Any, v4: bool, source: Source, where: str) -> Start:
    """When a file starts. FormatError: an impossible time."""
    if not v4:
        return _start_v3(header, source, where)
    abs_ns = int(header.abs_time)
    if not abs_ns:
        return None, []
    if int(header.time_flags) & 1:
        return _local(abs_ns, None, source, where)
    return _possible_start(abs_ns, where), []


def _start_v3(header: Any, source: Source, where: str) -> Start:
    try:
        text = f"{header.date.decode('ascii')} {header.time.decode('ascii')}".strip("\0 ")
        local = dt.datetime.strptime(text, "%d:%m:%Y %H:%M:%S")
    except (ValueError, UnicodeDecodeError):
        return None, []
    local_ns = (local - dt.datetime(1970, 1, 1)) // dt.timedelta(seconds=1) * 1_000_000_000
    abs_ns = int(getattr(header, "abs_time", 0) or 0) if int(header.block_len) > 164 else 0
    hours = int(getattr(header, "tz_offset", 0) or 0) if abs_ns else None
    # the norm wants local time in the count too; some writers put UTC there: the text beside it tells
    if abs_ns and abs(abs_ns - local_ns) < 2_000_000_000:
        local_ns = abs_ns
    elif abs_ns and hours is not None and abs(abs_ns + hours * 3_600_000_000_000 - local_ns) < 3_700_000_000_000:
        return _possible_start(abs_ns, where), []
    return _local(local_ns, hours, source, where)


def _local(local_ns: int, hours: int | None, source: Source, where: str) -> Start:
    """hours: the local time's from UTC, where the file says them."""
    if source.timezone is None and hours is not None:
        said = f"the start is local time, {hours:+d} h from UTC as the file says"
        return _possible_start(local_ns - hours * 3_600_000_000_000, where), [said]
    utc, notes = local_to_utc_ns(np.array([local_ns], np.int64).view("datetime64[ns]"), source.timezone)
    return _possible_start(int(utc[0]), where), notes


def _possible_start(utc_ns: int, where: str) -> int:
    if not 0 < utc_ns < 7_000_000_000_000_000_000:
        raise FormatError(
            "the file starts at an impossible time",
            where=where,
            got=f"{utc_ns} ns since 1970",
            hint="export the recording again: its header is damaged",
        )
    return utc_ns
