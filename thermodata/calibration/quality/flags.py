"""Quality flags of one stream: what is wrong with its time, and with each column. Vectorised throughout.

What is asked of a column stands in `rules`, one function a rule. Flagged rows are kept.
"""

from __future__ import annotations

from collections.abc import Mapping

import numpy as np

from thermodata.calibration.quality.column import ColumnInput, Marked, Stream
from thermodata.calibration.quality.event import QualityEvent, capped
from thermodata.calibration.quality.rules import RULES
from thermodata.calibration.quality.time import time_flags
from thermodata.plugin import Array, Int1D


def flag_stream(t_ns: Int1D, columns: Mapping[str, ColumnInput]) -> tuple[dict[str, Array], list[QualityEvent]]:
    """(channel -> uint16 flags, shape (n,); events in order of time, at most MOST_EVENTS a channel and
    flag; see `concise`).

    t_ns: shape (n,), as recorded; need not be in order: times that go back or stand still are flagged.
    """
    t_ns = np.asarray(t_ns)
    time = time_flags(t_ns, on_change=bool(columns) and all(c.held for c in columns.values()))
    stream = Stream(t_ns, time, columns)
    events = [QualityEvent(None, *event) for event in time.events]
    flags: dict[str, Array] = {}
    for name, column in columns.items():
        marked = Marked(name, column, stream)
        for rule in RULES:
            rule(marked)
        flags[name] = marked.flags | time.flags
        events += capped(marked.events)
    events.sort(key=lambda e: (e.from_ns, e.channel or ""))
    return flags, events
