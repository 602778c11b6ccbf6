"""When the packets of an LVM file start: their local times are resolved together, for the order of the packets tells in
which pass of the hour that a zone repeats each one began."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import dataclass, field
from functools import cached_property
from pathlib import Path

import numpy as np

from thermodata_reader_crio.lvm.header import Header, Packet
from thermodata_reader_crio.lvm.scan import RowPart, has_heading_behind, scan
from thermodata_reader_crio.row_times import is_zero, local_ns, utc_ns


def said_start(header: Header, packet: Packet, channel: int) -> tuple[str, str]:
    """The date and the time of a channel as its heading has them, else, or where nobody set that, as the file has;
    ('', '') where nobody set that either."""
    if is_unset(packet, channel):
        return ("", "") if is_zero(header.date) else (header.date, header.time)
    date, time = packet.key("Date", channel) or header.date, packet.key("Time", channel) or header.time
    return ("", "") if is_zero(date) else (date, time)


def is_unset(packet: Packet, channel: int) -> bool:
    """Whether the heading of a channel dates it at LabVIEW's zero, in 1904."""
    return is_zero(packet.key("Date", channel) or "")


@dataclass
class Starts:
    """local: name of a channel -> (line of a heading, its place there) -> its local start [ns], in the file's order."""

    timezone: str | None
    local: dict[str, dict[tuple[int, int], int]] = field(default_factory=dict)

    def add(self, header: Header, packet: Packet) -> None:
        """Takes the starts of a heading's channels that are dates."""
        for i, name in enumerate(packet.names):
            if (local := local_ns(*said_start(header, packet, i))) is not None:
                self.local.setdefault(name, {})[packet.line, i] = local

    def utc(self, packet: Packet, channel: int) -> tuple[int | None, Sequence[str]]:
        """(UTC of a channel's start [ns], None where its heading has none; notes of what had to be decided).

        FormatError where the starts run straight on through a change of the zone.
        """
        starts, decided = self._resolved
        start = starts.get((packet.line, channel))
        return start, () if start is None else decided

    @cached_property
    def _resolved(self) -> tuple[Mapping[tuple[int, int], int], list[str]]:
        # only when one is asked for: a file whose rows count from 1904 needs none
        starts: dict[tuple[int, int], int] = {}
        notes: list[str] = []
        alike: dict[tuple[int, ...], list[int]] = {}
        for own in self.local.values():
            local = tuple(own.values())
            if local not in alike:  # channels of one scan start together
                utc, decided = utc_ns(np.array(local, np.int64), self.timezone)
                alike[local] = utc.tolist()
                notes += [note for note in decided if note not in notes]
            starts.update(zip(own, alike[local], strict=True))
        return starts, notes


def starts_of(path: Path, encoding: str, timezone: str | None) -> Starts:
    """The starts of all packets, by the headings of a file."""
    starts = Starts(timezone)
    header, fresh = Header(), False
    for item in scan(path, encoding):
        if isinstance(item, Header):
            header = item
        elif isinstance(item, Packet):
            starts.add(header, item)
            fresh = True
        elif isinstance(item, RowPart) and fresh:
            fresh = False
            if not has_heading_behind(path, encoding, item):
                break
    return starts
