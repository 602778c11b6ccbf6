"""Where a row stands in an MDF file: its channel group, and the record of it."""

from __future__ import annotations

from pathlib import Path

import numpy as np

from thermodata.plugin import Source
from thermodata.reader.times import time_units
from thermodata_reader_table.mdf.groups import File
from thermodata_reader_table.mdf.library import opened
from thermodata_reader_table.timed_rows import nth_timed_row


def locate(path: Path, source: Source, stream: str, row: int) -> str | None:
    """`group 2 ('daq'), record 812 of 86400`."""
    with opened(path) as mdf:
        file = File(mdf, source, path.name)
        group = next((g for g in file.groups if g.stream == stream), None)
        if group is None:
            return None
        times = (
            time_units.to_ns(np.asarray(file.inner.get_master(group.index, data=piece)), 1.0)
            for piece in file.fragments(group.index)
        )
        at = nth_timed_row(times, row)
        return None if at is None else f"group {group.index + 1} ('{stream}'), record {at + 1} of {group.rows}"
