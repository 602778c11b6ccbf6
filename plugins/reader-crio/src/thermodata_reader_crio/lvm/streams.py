"""The streams of an LVM file: channels that share their rows' times. Packets with the same channels go on in them."""

from __future__ import annotations

from dataclasses import dataclass, field

import numpy as np

from thermodata.plugin import Float1D
from thermodata_reader_crio.lvm.header import Packet
from thermodata_reader_crio.lvm.units import Units
from thermodata_reader_crio.row_times import local_ns

STREAM = "data"
_SAME_SCAN_NS = 1_000_000  # channels of one scan may start up to this apart (a multiplexed converter)


def is_time(packet: Packet, channel: int) -> bool:
    """Whether a channel stands over time: a spectrum stands over frequency."""
    return packet.key("X_Dimension", channel, "Time").strip().lower() in ("time", "")


@dataclass
class Streams:
    """Channels by stream. names: channels of a stream, sorted -> its name; apart: channels whose X column differs from
    that of the others with equal headings, found by reading them; units: of the channels, as the headings say them."""

    names: dict[tuple[str, ...], str] = field(default_factory=dict)
    apart: dict[tuple[str, ...], list[int]] = field(default_factory=dict)
    units: Units = field(default_factory=Units)

    def of(self, packet: Packet, group: list[int]) -> str:
        key = tuple(sorted(packet.names[i] for i in group))  # a later heading may name them in another order
        return self.names.setdefault(key, STREAM if not self.names else f"{STREAM}@{len(self.names) + 1}")

    def groups(self, packet: Packet) -> list[list[int]]:
        """Channels that share rows: all where there is one X column; else those with equal headings."""
        wanted = [i for i in range(len(packet.names)) if is_time(packet, i)]
        if packet.x and packet.x[0] is not None and not packet.multi:
            return [wanted] if wanted else []
        found: dict[tuple[object, ...], list[int]] = {}
        starts: list[int] = []
        classes = self.apart.get(packet.names, [0] * len(packet.names))
        for i in wanted:
            own = (packet.key("X0", i), packet.key("Delta_X", i)) if not packet.multi else (classes[i],)
            key = (packet.key("Samples", i), *own, _start(packet, i, starts))
            found.setdefault(key, []).append(i)
        return list(found.values())

    def compare(self, packet: Packet, columns: list[Float1D]) -> None:
        """Tells channels apart whose X columns differ in these rows; columns: of each channel."""
        classes = self.apart.setdefault(packet.names, [0] * len(packet.names))
        lead: dict[int, list[int]] = {}
        for i, column in enumerate(columns):
            twins = lead.setdefault(classes[i], [])
            twin = next((t for t in twins if np.array_equal(columns[t], column, equal_nan=True)), None)
            if twin is not None:
                classes[i] = classes[twin]
                continue
            if twins:
                classes[i] = max(classes) + 1
            twins.append(i)


def _start(packet: Packet, channel: int, starts: list[int]) -> object:
    """A key of the channel's start: one for all that start in the same scan."""
    date, time = packet.key("Date", channel), packet.key("Time", channel)
    local = local_ns(date, time)
    if local is None:
        return date, time
    near = next((s for s in starts if abs(s - local) < _SAME_SCAN_NS), None)
    if near is None:
        starts.append(local)
        near = local
    return near
