"""MDF 3 and 4 through asammdf: each channel group a stream with its master as the time, raw values with scalings."""

from __future__ import annotations

import datetime as dt
import logging
from collections.abc import Iterator
from contextlib import contextmanager
from dataclasses import dataclass
from pathlib import Path
from typing import Any

import numpy as np

from thermodata.errors import FormatError, ThermodataError, UsageError
from thermodata.plugin import Array, Block, Loss, Recording, Scaling, Signal, Source
from thermodata.reader.text.layout import unique
from thermodata.reader.zone import NAT, local_to_utc_ns
from thermodata.schema.flag import Flag
from thermodata_reader_table import clocks
from thermodata_reader_table.mdf3_check import check3
from thermodata_reader_table.mdf_check import check

INSTALL = "pip install 'thermodata-reader-table[mdf]'"
_FRAGMENT = 16 << 20
_TEXT_V4, _TEXT_V3 = {7, 8, 9, 10, 11}, {11, 12}
_LINEAR_V4, _LINEAR_V3 = 1, 0
_NONE_V4, _NONE_V3 = 0, 65535
_ENCODINGS = {6: "latin-1", 7: "utf-8", 8: "utf-16-le", 9: "utf-16-be"}


@contextmanager
def _ours(where: str) -> Iterator[None]:
    """asammdf raises errors of any class for a damaged file; all of them mean the same."""
    try:
        yield
    except (ThermodataError, GeneratorExit):
        raise
    except Exception as error:  # MemoryError too: pieces are small, so only a damaged length asks for that much
        raise FormatError("a damaged MDF file", where=where, got=f"{type(error).__name__}: {error}"[:200]) from None


@contextmanager
def opened(path: Path) -> Iterator[Any]:
    """asammdf's file. FormatError: damaged; or the library is not installed."""
    try:
        import asammdf
    except ImportError:
        raise FormatError("MDF needs asammdf, which is not installed", where=path.name, hint=INSTALL) from None
    logging.getLogger("asammdf").setLevel(logging.CRITICAL)  # what it would say comes as losses and notes
    mdf = None
    try:
        with _ours(path.name):
            mdf = asammdf.MDF(path, raise_on_multiple_occurrences=False)
            mdf.configure(read_fragment_size=_FRAGMENT)
        yield mdf
    finally:
        if mdf is not None:
            mdf.close()


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
        self.notes: list[str] = []
        self.losses: list[Loss] = []
        self.start_ns = self._start()
        self.groups: list[Group] = []
        used: list[str] = []
        for index, group in enumerate(self.mdf.groups):
            rows = int(group.channel_group.cycles_nr)
            name = self._label(group, index)
            if not rows or not len(group.channels):
                self.notes.append(f"group '{name}' holds no rows")
                continue
            if not self._timed(group, index):
                self.losses.append(Loss(f"{where} group '{name}'", None, None, None, "it has no time"))
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
            )
        self.groups = kept

    def _label(self, group: Any, index: int) -> str:
        name = str(getattr(group.channel_group, "acq_name", "") or "").strip()
        return name or f"group {index + 1}"

    def _timed(self, group: Any, index: int) -> bool:
        master = self.inner.masters_db.get(index)
        if master is None:
            return bool(self.v4 and group.channel_group.flags & 8)
        return not self.v4 or int(group.channels[master].sync_type) in (0, 1)

    def _channels(self, group: Any, index: int, stream: str) -> list[Channel]:
        master = self.inner.masters_db.get(index)
        found: list[Channel] = []
        piece = next(iter(self._fragments(index, 1)), None)
        taken: list[str] = []
        for i, channel in enumerate(group.channels):
            if i == master or (self.v4 and int(channel.channel_type) in (2, 3)):
                continue
            name = str(channel.name) or f"channel {i + 1}"
            where = f"{self.where} channel '{stream}/{name}'"
            try:
                with _ours(where):
                    made = self._channel(channel, index, i, piece, stream, name)
            except FormatError as error:
                self.losses.append(Loss(where, None, None, None, f"it cannot be read: {error.got}"))
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
                    None,
                    None,
                    None,
                    f"an array of shape {values.shape[1:] or values.dtype} in each row",
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

    # ---- data --------------------------------------------------------------------------------------

    def _fragments(self, group: int, rows: int | None = None) -> Iterator[Any]:
        with _ours(f"{self.where} group {group + 1}"):
            yield from self.inner._load_data(self.mdf.groups[group], record_count=rows)

    def get(self, group: int, index: int, piece: Any, *, raw: bool) -> tuple[Array, Array | None]:
        """Values of one channel in a piece, and where they are invalid."""
        values, invalid = self.inner.get(
            group=group, index=index, data=piece, raw=raw, samples_only=True, ignore_invalidation_bits=True
        )
        return np.asarray(values), None if invalid is None else np.asarray(invalid, bool)

    def blocks(self, group: Group, rows: int | None) -> Iterator[Block | Loss]:
        done = missing = 0
        last: int | None = None
        where = f"{self.where} group '{group.stream}'"
        failed: str | None = None
        try:
            for piece in self._fragments(group.index):
                with _ours(where):
                    block, absent = self._block(group, piece)
                n = block.t_ns.size
                done, missing = done + n + absent, missing + absent
                last = int(block.t_ns[-1]) if n else last
                yield from _split(block, rows)
        except FormatError as error:
            failed = error.got
        if failed is not None or done != group.rows:
            reason = f"{done} of {group.rows} rows are there" + (f": {failed}" if failed else "")
            fraction = abs(group.rows - done) / max(group.rows, done, 1)
            yield Loss(where, last, None, min(1.0, fraction), reason)
        if missing:
            yield Loss(where, None, None, missing / max(done, 1), f"{missing} rows without a time")

    def _block(self, group: Group, piece: Any) -> tuple[Block, int]:
        seconds = np.asarray(self.inner.get_master(group.index, data=piece))
        t_ns = clocks.to_ns(seconds, 1.0)
        if self.start_ns is not None:
            t_ns = np.where(t_ns == NAT, NAT, t_ns + self.start_ns)
        good = t_ns != NAT
        values: dict[str, Array] = {}
        flags: dict[str, Array] = {}
        for channel in group.channels:
            name = channel.signal.name
            found, invalid = self.get(group.index, channel.index, piece, raw=channel.raw)
            if found.shape != t_ns.shape:
                raise FormatError("a channel as long as its time", where=self.where, got=f"'{name}': {found.shape}")
            if channel.text is not None:
                column: Array = _words(found, channel.text)
            else:
                column = found.astype(channel.signal.dtype)
            values[name] = column[good]
            if invalid is not None and invalid.any():
                flags[name] = np.where(invalid, np.uint16(Flag.NOT_MEASURING), np.uint16(0))[good]
        return Block(group.stream, t_ns[good], values, flags or None), int((~good).sum())

    # ---- the start ---------------------------------------------------------------------------------

    def _start(self) -> int | None:
        """UTC of the zero of all masters, or None where the header names no day."""
        header = self.mdf.header
        if not self.v4:
            return self._start_v3(header)
        abs_ns = int(header.abs_time)
        if not abs_ns:
            return None
        if int(header.time_flags) & 1:
            return self._local(abs_ns, None)
        return self._sane(abs_ns)

    def _start_v3(self, header: Any) -> int | None:
        try:
            text = f"{header.date.decode('ascii')} {header.time.decode('ascii')}".strip("\0 ")
            local = dt.datetime.strptime(text, "%d:%m:%Y %H:%M:%S")
        except (ValueError, UnicodeDecodeError):
            return None
        local_ns = (local - dt.datetime(1970, 1, 1)) // dt.timedelta(seconds=1) * 1_000_000_000
        abs_ns = int(getattr(header, "abs_time", 0) or 0) if int(header.block_len) > 164 else 0
        hours = int(getattr(header, "tz_offset", 0) or 0) if abs_ns else None
        # the norm wants local time in the count too; some writers put UTC there: the text beside it tells
        if abs_ns and abs(abs_ns - local_ns) < 2_000_000_000:
            local_ns = abs_ns
        elif abs_ns and hours is not None and abs(abs_ns + hours * 3_600_000_000_000 - local_ns) < 3_700_000_000_000:
            return self._sane(abs_ns)
        return self._local(local_ns, hours)

    def _local(self, local_ns: int, hours: int | None) -> int | None:
        if self.source.timezone is None and hours is not None:
            self.notes.append(f"the start is local time, {hours:+d} h from UTC as the file says")
            return self._sane(local_ns - hours * 3_600_000_000_000)
        utc, notes = local_to_utc_ns(np.array([local_ns], np.int64).view("datetime64[ns]"), self.source.timezone)
        self.notes.extend(notes)
        return self._sane(int(utc[0]))

    def _sane(self, utc_ns: int) -> int | None:
        if not 0 < utc_ns < 7_000_000_000_000_000_000:
            raise FormatError("the file starts at an impossible time", where=self.where, got=f"{utc_ns} ns since 1970")
        return utc_ns


def _is_array(group: Any, index: int) -> bool:
    found = group.channel_dependencies[index]
    return bool(found) and not isinstance(found[0], tuple)


def _words(values: Array, encoding: str) -> Array:
    """Text of a channel; numbers among the words (ranges without a word) as they print."""

    def word(value: Any) -> str:
        if isinstance(value, bytes):
            try:
                return value.decode(encoding or "utf-8").rstrip("\0 ")
            except UnicodeDecodeError:
                return value.decode("latin-1").rstrip("\0 ")
        return str(value).rstrip("\0 ")

    return np.array([word(v) for v in values.tolist()], object)


def _split(block: Block, rows: int | None) -> Iterator[Block]:
    if rows is None or block.t_ns.size <= rows:
        yield block
        return
    for i in range(0, block.t_ns.size, rows):
        part = slice(i, i + rows)
        yield Block(
            block.stream,
            block.t_ns[part],
            {k: v[part] for k, v in block.values.items()},
            None if block.flags is None else {k: v[part] for k, v in block.flags.items()},
        )


def _checked(path: Path) -> tuple[str | None, bool]:
    with path.open("rb") as file:
        head = file.read(64)
    if head[8:9] == b"4":
        found = check(path)
        return found.cut, found.finished
    check3(path)
    return None, head[:8].strip() == b"MDF"


def describe(path: Path, source: Source) -> Recording:
    cut, finished = _checked(path)
    with opened(path) as mdf, _ours(path.name):
        file = File(mdf, source, path.name)
        if not file.groups:
            raise FormatError(
                "no channel group with rows and a time",
                where=path.name,
                got="; ".join([*file.notes, *(x.reason for x in file.losses)][:4]) or "an empty file",
            )
        signals = tuple(c.signal for g in file.groups for c in g.channels)
        notes = [cut] if cut else []
        if not finished:
            notes.append("the file was not finished by its writer")
        start = file.start_ns
        return Recording(
            signals, "relative" if start is None else "absolute", start, not cut and finished, (*notes, *file.notes)
        )


def blocks(path: Path, source: Source) -> Iterator[Block | Loss]:
    cut, _ = _checked(path)
    rows = source.options.get("block_rows")
    with opened(path) as mdf:
        with _ours(path.name):
            file = File(mdf, source, path.name)
        yield from file.losses
        for group in file.groups:
            yield from file.blocks(group, int(rows) if rows is not None else None)
    if cut:
        yield Loss(path.name, None, None, None, cut)
