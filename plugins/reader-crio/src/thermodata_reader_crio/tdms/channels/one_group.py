"""One group of a TDMS file alone, where the campaign file declares it as the sheet: each test may be a group."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import replace

from thermodata.errors import UsageError, nearest
from thermodata_reader_crio.tdms.channels.channel import Channel, names
from thermodata_reader_crio.tdms.raw.columns import Column

_MOST_NAMES = 30


def columns_of(cols: Mapping[str, list[Column]], wanted: int | str, where: str) -> dict[str, list[Column]]:
    """Path -> columns of the channels of one group. wanted: its name, or its number counted from 1 in the file's order;
    where: the file's name. UsageError where the file has no such group."""
    groups = list(dict.fromkeys(names(path)[0] for path in cols))
    if isinstance(wanted, int):
        group = groups[wanted - 1] if 1 <= wanted <= len(groups) else None
    else:
        group = wanted if wanted in groups else None
    if group is None:
        close = nearest(str(wanted), groups)
        raise UsageError(
            f"no group '{wanted}'",
            where=where,
            expected=", ".join(f"{n}: {name}" for n, name in enumerate(groups[:_MOST_NAMES], 1)),
            got=str(wanted),
            hint=f"did you mean '{close}'?" if close else "correct 'sheet' of the source's table",
        )
    return {path: found for path, found in cols.items() if names(path)[0] == group}


def without_its_name(group: str, members: list[Channel]) -> list[Channel]:
    """The channels of the one group that is read, called as they are in every other test: 'T_front', not
    'S4000/T_front'."""
    return [replace(c, signal=replace(c.signal, name=c.signal.name.removeprefix(f"{group}/"))) for c in members]
