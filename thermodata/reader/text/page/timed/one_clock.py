"""The one clock of a recording whose groups of columns have a time each."""

from __future__ import annotations

from collections.abc import Sequence
from typing import Literal

from thermodata.errors import FormatError
from thermodata.reader.text.page.timed.group import Group
from thermodata.reader.text.times.in_memory import Stamps
from thermodata.reader.times.zone import NAT


def one_clock(
    times: Sequence[Stamps], groups: Sequence[Group], where: str
) -> tuple[Literal["absolute", "relative"], int | None]:
    """(clock, start_ns) of a recording, by the times of each group. FormatError where some are dates and others not."""
    kinds = {t.absolute for t in times if t.t_ns.size}
    if len(kinds) > 1:
        raise FormatError(
            "some times are dates and others count from their start",
            where=where,
            got=", ".join(
                f"{g.stream}: {'dates' if t.absolute else 'relative'}" for g, t in zip(groups, times, strict=True)
            ),
            expected="one kind in a source",
            hint="declare one time: table: {time: {column: ...}}, and a second source for the others",
        )
    absolute = kinds.pop() if kinds else groups[0].seconds is None
    starts = [int(good[0]) for t in times if (good := t.t_ns[t.t_ns != NAT]).size]
    return ("absolute", min(starts, default=0)) if absolute else ("relative", None)
