"""The unit of each channel of an LVM file: that of its first heading, to which later ones are converted."""

from __future__ import annotations

from dataclasses import dataclass, field

from thermodata.reader.signals.row_units import converts_here
from thermodata.reader.text.names.header import split_unit
from thermodata.schema.units.conversion import linear_conversion
from thermodata.schema.units.unit import normal_unit
from thermodata_reader_crio.lvm.header import Packet


@dataclass(frozen=True, slots=True)
class Change:
    """A channel whose heading says another unit than its first one. scale: (factor, offset) to the first; None where
    they do not convert."""

    name: str
    first: str
    unit: str
    scale: tuple[float, float] | None

    def __str__(self) -> str:
        what = "converted" if self.scale is not None else "left out from there; split the file there"
        return f"its unit changes from '{self.first}' to '{self.unit}': {what}"


def unit_of(packet: Packet, channel: int) -> str | None:
    """The unit that a heading says of a channel, in its own line or behind its name."""
    return packet.key("Y_Unit_Label", channel) or split_unit(packet.names[channel])[1] or None


@dataclass
class Units:
    """Units by stream and channel, as the headings are met in their order."""

    first: dict[tuple[str, str], str] = field(default_factory=dict)
    told: set[tuple[str, str, str]] = field(default_factory=set)

    def changed(self, stream: str, packet: Packet, group: list[int]) -> list[Change]:
        """The channels of a group whose unit is another than before. A heading that says none means the same."""
        found = []
        for i in group:
            name, unit = packet.names[i], unit_of(packet, i)
            if unit is None:
                continue
            first = self.first.setdefault((stream, name), unit)
            if normal_unit(unit) != normal_unit(first):
                scale = linear_conversion(unit, first) if converts_here(unit, first) else None
                found.append(Change(name, first, unit, scale))
        return found

    def is_new(self, stream: str, change: Change) -> bool:
        """Whether a change was not told yet: a file may have a heading every few rows."""
        key = (stream, change.name, change.unit)
        new = key not in self.told
        self.told.add(key)
        return new
