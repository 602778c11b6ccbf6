"""The blocks of an MDF 2 or 3 file, walked before a library trusts them.

Format: MDF 3.3 specification, sections 3.1 to 3.9: blocks of two letters, a 16-bit length, 32-bit links.
"""

from __future__ import annotations

import struct
from pathlib import Path

from thermodata_reader_table.mdf.damage import damaged

_MOST = 500_000
_FIXED = {
    b"HD": 164,
    b"DG": 24,
    b"CG": 26,
    b"CN": 218,
    b"CC": 46,
    b"TX": 4,
    b"PR": 4,
    b"TR": 10,
    b"CE": 6,
    b"CD": 8,
    b"SR": 24,
}


class _File:
    def __init__(self, path: Path) -> None:
        self.where, self.data, self.seen = path.name, path.read_bytes() if path.stat().st_size < 1 << 28 else b"", 0
        if not self.data:
            with path.open("rb") as file:
                self.data = file.read(1 << 28)  # blocks of the header stand before the data, or not far behind
        self.size = path.stat().st_size
        self.order = ">" if self.data[24:26] not in (b"\0\0", b"") else "<"

    def block(self, at: int, kind: bytes, whose: str) -> int:
        """The length of the block at a place; FormatError where none of its kind is there."""
        self.seen += 1
        if self.seen > _MOST:
            raise damaged("blocks in a circle", where=self.where, got=whose)
        if not 64 <= at <= len(self.data) - 4:
            if at <= self.size - 4 and self.size > len(self.data):
                return _FIXED[kind]
            raise damaged("a link out of the file", where=self.where, got=f"{at} ({whose})")
        length = self.number("H", at + 2)
        if self.data[at : at + 2] != kind or length < _FIXED[kind] or at + length > self.size:
            raise damaged(
                "no whole block where a link leads",
                where=f"{self.where} byte {at}",
                expected=kind.decode(),
                got=f"{self.data[at : at + 2]!r} of {length} bytes ({whose})",
            )
        return length

    def number(self, form: str, at: int) -> int:
        if at + 4 > len(self.data):
            raise damaged("the file ends inside a block", where=f"{self.where} byte {at}")
        found: int = struct.unpack_from(self.order + form, self.data, at)[0]
        return found

    def links(self, at: int, first: int, last: int) -> list[int]:
        return [self.number("I", at + i) for i in range(first, last + 1, 4)]


def check3(path: Path) -> None:
    """FormatError where a link, a length or a channel's place in its record is damaged."""
    file = _File(path)
    file.block(64, b"HD", "the header")
    group, text, program = file.links(64, 4, 12)
    for at, kind in ((text, b"TX"), (program, b"PR")):
        if at:
            file.block(at, kind, "the header")
    while group:
        file.block(group, b"DG", "a list of data groups")
        after, channels, trigger, data = file.links(group, 4, 16)
        if trigger:
            file.block(trigger, b"TR", f"DG at byte {group}")
        if data > file.size:
            raise damaged("a link out of the file", where=file.where, got=f"{data} (DG at byte {group})")
        while channels:
            channels = _group(file, channels)
        group = after


def _group(file: _File, at: int) -> int:
    file.block(at, b"CG", "a list of channel groups")
    after, channel, text = file.links(at, 4, 12)
    if text:
        file.block(text, b"TX", f"CG at byte {at}")
    record, cycles = file.number("H", at + 20), file.number("I", at + 22)
    if record * cycles > file.size:
        raise damaged(
            "more rows than the file has bytes for",
            where=f"{file.where} byte {at}",
            got=f"{cycles} rows of {record} bytes",
            expected=f"{file.size} bytes at most",
        )
    while channel:
        length = file.block(channel, b"CN", f"CG at byte {at}")
        following, *rest = file.links(channel, 4, 20)
        for link, kind in zip(rest, (b"CC", b"CE", b"CD", b"TX"), strict=True):
            if link:
                file.block(link, kind, f"CN at byte {channel}")
        if rest[0]:
            _conversion(file, rest[0])
        start, bits = file.number("H", channel + 186), file.number("H", channel + 188)
        more = file.number("H", channel + 226) if length >= 228 else 0
        number = file.number("H", channel + 190)
        if start + bits + 8 * more > 8 * record or not bits or (number < 7 and bits > 64) or number > 16:
            raise damaged(
                "a channel that does not fit its record",
                where=f"{file.where} byte {channel}",
                expected=f"{8 * record} bits",
                got=f"{bits} bits of type {number} at bit {start + 8 * more}",
            )
        channel = following
    return after


def _conversion(file: _File, at: int) -> None:
    """Its count of parameters fits its length."""
    length, kind, count = file.number("H", at + 2), file.number("H", at + 42), file.number("H", at + 44)
    each = {0: 8, 1: 16, 2: 16, 6: 8, 7: 8, 8: 8, 9: 8, 10: 1, 11: 40, 12: 20}.get(kind)
    if each is None and kind != 65535:
        raise damaged("an unknown conversion", where=f"{file.where} byte {at}", got=str(kind))
    if each is not None and kind not in (10,) and 46 + each * count > length:
        raise damaged(
            "a conversion longer than its block",
            where=f"{file.where} byte {at}",
            got=f"{count} parameters in {length} bytes",
        )
