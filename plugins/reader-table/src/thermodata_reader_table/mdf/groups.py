"""The channel groups of an MDF file, and their channels: streams and signals."""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import dataclass
from typing import Any

import numpy as np

from thermodata.errors import FormatError, UsageError
from thermodata.plugin import Array, Loss, Scaling, Signal, Source
from thermodata.reader.text.names.header import unique
from thermodata_reader_table.mdf.library import damage_as_format_error
from thermodata_reader_table.mdf.start_time import start_of

_TEXT_V4, _TEXT_V3 = {7, 8, 9, 10, 11}, {11, 12}
_LINEAR_V4, _LINEAR_V3 = 1, 0
_NONE_V4, _NONE_V3 = 0, 65535
_ENCODINGS = {6: "latin-1", 7: "utf-8", 8: "utf-16-le", 9: "utf-16-be"}


@dataclass(frozen=True)
class Channel:
    """One signal. index: of the channel in its group; raw: whether its raw values are taken; text: encoding of
    text, "" for numbers turned into words."""

    index: int
    signal: Signal
    raw: bool
    text: str | None


@dataclass(frozen=True)
class Group:
    """One stream. rows: as the file counts them; factor: seconds of one unit of its master."""

    index: int
    stream: str
    rows: int
    channels: tuple[Channel, ...]


class File:
    """What an open file holds."""

    def __init__(self, mdf: Any, source: Source, where: str) -> None:
        self.mdf, self.inner, self.where, self.source = mdf, mdf._mdf, where, source
        self.v4 = str(mdf.version) >= "4"
        self.start_ns, self.notes = start_of(mdf.header, self.v4, source, where)
        self.losses: list[Loss] = []
        self.groups: list[Group] = []
        used: list[str] = []
        for index, group in enumerate(self.mdf.groups):
            rows = int(group.channel_group.cycles_nr)
            name = self._label(group, index)
            if not rows or not len(group.channels):
                self.notes.append(f"group '{name}' holds no rows")
                continue
            if not self._has_time(group, index):
                self.losses.append(Loss(f"{where} group '{name}'", reason="it has no time"))
                continue
            stream = unique([*used, name])[-1]
            used.append(stream)
            channels = self._channels(group, index, stream)
            if channels:
                self.groups.append(Group(index, stream, rows, tuple(channels)))
        wanted = (source.table or {}).get("sheet")
        if wanted is not None:
            self._choose(wanted)

    def _choose(self, wanted: int | str) -> None:
        kept = [g for g in self.groups if wanted in (g.stream, g.index + 1)]
        if not kept:
            raise UsageError(
                f"no channel group '{wanted}'",
                where=self.where,
                got=str(wanted),
                expected=", ".join(f"{g.index + 1}: {g.stream}" for g in self.groups[:30]),
                hint="correct table: {sheet: ...}, or leave it out: every group is read",
            )
        self.groups = kept

    def _label(self, group: Any, index: int) -> str:
        name = str(getattr(group.channel_group, "acq_name", "") or "").strip()
        return name or f"group {index + 1}"

    def _has_time(self, group: Any, index: int) -> bool:
        master = self.inner.masters_db.get(index)
        if master is None:
            return bool(self.v4 and group.channel_group.flags & 8)
        return not self.v4 or int(group.channels[master].sync_type) in (0, 1)

    def _channels(self, group: Any, index: int, stream: str) -> list[Channel]:
        master = self.inner.masters_db.get(index)
        found: list[Channel] = []
        piece = next(iter(self.fragments(index, 1)), None)
        taken: list[str] = []
        for i, channel in enumerate(group.channels):
            if i == master or (self.v4 and int(channel.channel_type) in (2, 3)):
                continue
            name = str(channel.name) or f"channel {i + 1}"
            where = f"{self.where} channel '{stream}/{name}'"
            try:
                with damage_as_format_error(where):
                    made = self._channel(channel, index, i, piece, stream, name)
            except FormatError as error:
                self.losses.append(Loss(where, reason=f"it cannot be read: {error.got}"))
                continue
            for one in made:
                own = unique([*taken, one.signal.name])[-1]
                taken.append(own)
                s = one.signal
                found.append(
                    Channel(one.index, Signal(own, stream, s.unit, s.dtype, s.scaling, s.properties), one.raw, one.text)
                )
        return found

    def _channel(self, channel: Any, group: int, index: int, piece: Any, stream: str, name: str) -> list[Channel]:
        values, _ = self.get(group, index, piece, raw=True)
        if values.dtype.names is not None or values.ndim != 1:
            if values.dtype.names is not None and self.v4 and not _is_array(self.mdf.groups[group], index):
                return []  # its parts are channels of their own
            self.losses.append(
                Loss(
                    f"{self.where} channel '{stream}/{name}'",
                    reason=f"an array of shape {values.shape[1:] or values.dtype} in each row",
                )
            )
            return []
        conversion = channel.conversion
        unit = str((conversion is not None and conversion.unit) or getattr(channel, "unit", "") or "").strip() or None
        kind = _NONE_V4 if conversion is None else int(conversion.conversion_type)
        if conversion is None and not self.v4:
            kind = _NONE_V3
        comment = str(channel.comment or "")
        properties = {k: v for k, v in (("comment", comment[:1000]),) if v}
        if values.dtype.kind in "SUO":
            code = _ENCODINGS.get(int(channel.data_type), "utf-8") if self.v4 else "latin-1"
            return [Channel(index, Signal(name, stream, unit, "str", None, properties), True, code)]
        raw = Signal(name, stream, unit, values.dtype.newbyteorder("=").name, None, properties)
        if kind == (_NONE_V4 if self.v4 else _NONE_V3):
            return [Channel(index, raw, True, None)]
        if kind == (_LINEAR_V4 if self.v4 else _LINEAR_V3):
            gain, offset = float(conversion.a), float(conversion.b)
            scaling = None if (gain, offset) == (1.0, 0.0) else Scaling("linear", {"gain": gain, "offset": offset})
            return [Channel(index, Signal(name, stream, unit, raw.dtype, scaling, properties), True, None)]
        if kind in (_TEXT_V4 if self.v4 else _TEXT_V3):
            return [
                Channel(index, Signal(name, stream, None, "str", None, properties), False, ""),
                Channel(index, Signal(f"{name}.raw", stream, None, raw.dtype, None, properties), True, None),
            ]
        self.notes.append(f"'{stream}/{name}' is given in physical values: its conversion (type {kind}) is not linear")
        return [Channel(index, Signal(name, stream, unit, "float64", None, properties), False, None)]

    def fragments(self, group: int, rows: int | None = None) -> Iterator[Any]:
        """The raw records of a group in pieces of bounded size. rows: how many at most. FormatError: damaged."""
        with damage_as_format_error(f"{self.where} group {group + 1}"):
            yield from self.inner._load_data(self.mdf.groups[group], record_count=rows)

    def get(self, group: int, index: int, piece: Any, *, raw: bool) -> tuple[Array, Array | None]:
        """Values of one channel in a piece, and where they are invalid."""
        values, invalid = self.inner.get(
            group=group, index=index, data=piece, raw=raw, samples_only=True, ignore_invalidation_bits=True
        )
        return np.asarray(values), None if invalid is None else np.asarray(invalid, bool)


def _is_array(group: Any, index: int) -> bool:
    found = group.channel_dependencies[index]
    return bool(found) and not isinstance(found[0], tuple)
