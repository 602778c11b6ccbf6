"""The streams of an LVM file: channels that share their rows' times. Packets with the same channels go on in them, and
so does one that has a channel more, or lacks one: what a stream has not there, is not measured."""

from __future__ import annotations

from dataclasses import dataclass, field

import numpy as np

from thermodata.plugin import Float1D
from thermodata_reader_crio.lvm.header import Packet
from thermodata_reader_crio.lvm.units import Units
from thermodata_reader_crio.row_times import local_ns

STREAM = "data"
Key = tuple[str, ...]  # channels that share their times, sorted: a later heading may name them in another order
_SAME_SCAN_NS = 1_000_000  # channels of one scan may start up to this apart (a multiplexed converter)


def _key(packet: Packet, group: list[int]) -> Key:
    return tuple(sorted(packet.names[i] for i in group))


def is_time(packet: Packet, channel: int) -> bool:
    """Whether a channel stands over time: a spectrum stands over frequency."""
    return packet.key("X_Dimension", channel, "Time").strip().lower() in ("time", "")


@dataclass
class Streams:
    """Channels by stream. members: stream -> its channels, in the order in which headings name them; apart: channels
    whose X column differs from that of the others with equal headings, found by reading them; units: of the channels,
    as the headings say them."""

    members: dict[str, list[str]] = field(default_factory=dict)
    apart: dict[tuple[str, ...], list[int]] = field(default_factory=dict)
    units: Units = field(default_factory=Units)
    _names: dict[Key, str] = field(default_factory=dict)
    _placed: dict[tuple[Key, ...], dict[Key, str]] = field(default_factory=dict)
    _last: tuple[Packet, dict[Key, str]] | None = None

    def of(self, packet: Packet, group: list[int]) -> str:
        return self._of_packet(packet)[_key(packet, group)]

    def add(self, packet: Packet) -> None:
        """Takes the channels of a heading, so that the streams have them before any row is read."""
        self._of_packet(packet)

    def _of_packet(self, packet: Packet) -> dict[Key, str]:
        """The stream of each group of a heading: another one for each."""
        if self._last is not None and self._last[0] is packet:
            return self._last[1]
        groups = {_key(packet, group): group for group in self.groups(packet)}
        found = self._placed.setdefault(tuple(groups), {})
        for key in sorted(groups, key=lambda key: key not in self._names):
            if key not in found:
                found[key] = self._home(key, taken=set(found.values()))
                own = self.members.setdefault(found[key], [])
                own += [packet.names[i] for i in groups[key] if packet.names[i] not in own]
        self._last = packet, found
        return found

    def _home(self, key: Key, taken: set[str]) -> str:
        """The stream that channels go on in: one that had just these, or one alone that has half of them or more."""
        home = self._names.get(key)
        if home is None:
            alike = {s: n for s, own in self.members.items() if (n := len({*key} & {*own}))}
            near = [s for s, n in alike.items() if 2 * n >= min(len(key), len(self.members[s]))]
            home = near[0] if len(alike) == len(near) == 1 else None
        if home is None or home in taken:
            home = STREAM if not self.members else f"{STREAM}@{len(self.members) + 1}"
        self._names.setdefault(key, home)
        return home

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
