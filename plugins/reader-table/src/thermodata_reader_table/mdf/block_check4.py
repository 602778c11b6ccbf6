"""The blocks of an MDF 4 file, walked before a library trusts them: each link leads to a whole block, none in a circle.

Format: ASAM MDF 4.2, "Block structure": each block has its id ("##XX"), length, number of links, and the links.
"""

from __future__ import annotations

import struct
from dataclasses import dataclass
from pathlib import Path
from typing import BinaryIO

from thermodata.errors import FormatError
from thermodata_reader_table.mdf.damage import damaged

_MOST_BLOCKS = 2_000_000
_DATA = {b"##DT", b"##SD", b"##RD", b"##DV", b"##DI", b"##RV", b"##RI"}
_KNOWN = _DATA | {
    b"##" + k
    for k in (
        b"HD",
        b"MD",
        b"TX",
        b"FH",
        b"CH",
        b"AT",
        b"EV",
        b"DG",
        b"CG",
        b"SI",
        b"CN",
        b"CC",
        b"CA",
        b"SR",
        b"DL",
        b"DZ",
        b"HL",
        b"LD",
        b"GL",
    )
}
# link numbers of the lists that a program follows one by one, and what must stand there
_NEXT = {
    b"##DG": {0: {b"##DG"}, 1: {b"##CG"}, 2: _DATA | {b"##DZ", b"##DL", b"##HL", b"##LD"}},
    b"##CG": {0: {b"##CG"}, 1: {b"##CN"}, 2: {b"##TX"}},
    b"##CN": {0: {b"##CN"}, 1: {b"##CN", b"##CA"}, 2: {b"##TX"}, 4: {b"##CC"}},
    b"##HD": {0: {b"##DG"}},
    b"##DL": {0: {b"##DL"}},
}
_FIXED = {
    b"##HD": 104,
    b"##DG": 64,
    b"##CG": 104,
    b"##CN": 160,
    b"##CC": 80,
    b"##DL": 40,
    b"##HL": 40,
    b"##DZ": 48,
    b"##FH": 56,
    b"##SI": 56,
}
_LINKS = {b"##HD": 6, b"##DG": 4, b"##CG": 6, b"##CN": 8, b"##CC": 4, b"##DL": 1, b"##HL": 1}
_ZIP_MOST = 1100  # deflate packs to a thousandth at best
_UNPACKED = 1 << 31  # of one block


@dataclass(frozen=True, slots=True)
class Checked:
    """cut: the first data block that passes the end of the file, or None. finished: False where the writer left
    counters open."""

    cut: str | None
    finished: bool


def check(path: Path) -> Checked:
    """FormatError where a link, a length or a list of an MDF 4 file is damaged."""
    size = path.stat().st_size
    with path.open("rb") as file:
        head = file.read(64)
        if len(head) < 64:
            raise damaged("the file ends inside its header", where=path.name, expected="64 bytes", got=str(len(head)))
        finished = head[:8].strip() == b"MDF" and struct.unpack("<H", head[60:62])[0] == 0
        return Checked(_walk_blocks(file, path.name, size), finished)


def _walk_blocks(file: BinaryIO, where: str, size: int) -> str | None:
    cut: str | None = None
    groups: dict[int, tuple[int, int]] = {}  # first channel of a group -> bytes of its record
    seen: dict[int, bytes] = {}
    ahead: list[tuple[int, frozenset[bytes] | None, str, bool]] = [(64, frozenset({b"##HD"}), "the header", False)]
    while ahead:
        at, wanted, whose, listed = ahead.pop()
        if at in seen:
            if wanted is not None and seen[at] not in wanted:
                raise _wrong_kind(where, at, whose, wanted, seen[at])
            if listed:
                raise damaged("blocks in a circle, or shared", where=f"{where} byte {at}", got=whose)
            continue
        if len(seen) > _MOST_BLOCKS:
            raise damaged("more blocks than any log has", where=where, expected=f"at most {_MOST_BLOCKS}")
        kind, length, links, body = _block(file, where, at, size, whose)
        if wanted is not None and kind not in wanted:
            raise _wrong_kind(where, at, whose, wanted, kind)
        seen[at] = kind
        if at + length > size:
            if kind not in _DATA and kind != b"##DZ":
                raise damaged(
                    "a block passes the end of the file",
                    where=f"{where} byte {at}",
                    expected=f"{size - at} bytes at most",
                    got=f"{kind[2:].decode()} of {length}",
                )
            cut = cut or f"data block at byte {at} needs {length} bytes, {size - at} are there: the file is cut"
        if kind == b"##DZ":
            _check_packed(body, where, at, length)
        elif kind == b"##CG":
            groups[links[1]] = struct.unpack("<II", body[24:32]) if len(body) >= 32 else (0, 0)
        elif kind == b"##CN":
            record = groups.pop(at, None) or (0, 0)
            _channel(body, where, at, *record)
            # the next of the list, and the parts of a structure, stand in the same record
            groups.update({link: record for link in links[:2] if link})
        follow = _NEXT.get(kind, {})
        for i, link in enumerate(links):
            if link:
                kinds = follow.get(i)
                ahead.append(
                    (
                        link,
                        None if kinds is None else frozenset(kinds),
                        f"link {i} of {kind[2:].decode()} at byte {at}",
                        kind in (b"##DG", b"##CG", b"##CN") and i < 2,
                    )
                )
    return cut


def _block(file: BinaryIO, where: str, at: int, size: int, whose: str) -> tuple[bytes, int, tuple[int, ...], bytes]:
    if not 64 <= at <= size - 24:
        raise damaged("a link out of the file", where=where, expected=f"64 to {size - 24}", got=f"{at} ({whose})")
    file.seek(at)
    head = file.read(24)
    kind, length, count = head[:4], *struct.unpack("<QQ", head[8:])
    if kind not in _KNOWN:
        raise damaged(
            "no block where a link leads", where=f"{where} byte {at}", expected="##XX", got=f"{kind!r} ({whose})"
        )
    if length < max(24 + 8 * count, _FIXED.get(kind, 24)) or count > _MOST_BLOCKS or (count < _LINKS.get(kind, 0)):
        raise damaged(
            "a block whose length and links do not fit",
            where=f"{where} byte {at}",
            got=f"{kind[2:].decode()} of {length} bytes with {count} links",
        )
    if kind in _DATA:
        return kind, length, (), b""
    body = file.read(8 * count + 72)
    if len(body) < 8 * count:
        raise damaged("the file ends inside a block", where=f"{where} byte {at}", got=kind[2:].decode())
    return kind, length, struct.unpack(f"<{count}Q", body[: 8 * count]), body[8 * count :]


def _channel(body: bytes, where: str, at: int, record: int, invalid: int) -> None:
    """A channel's place in its record: a library that trusts it reads beyond its own memory."""
    kind, _, number, bit, start, bits, flags, invalid_bit = struct.unpack("<BBBBIIII", body[:20])
    wanted = {0: 64, 1: 64, 2: 64, 3: 64, 4: 64, 5: 64}.get(number)
    wrong = (
        kind > 6
        or number > 16
        or bit > 7
        or (wanted is not None and bits > wanted)
        or (number in (4, 5) and bits not in (16, 32, 64))
        or (kind not in (3, 6) and record and start + (bit + bits + 7) // 8 > record + invalid)
        or (flags & 2 and invalid_bit >= max(8 * invalid, 1))
    )
    if wrong:
        raise damaged(
            "a channel that does not fit its record",
            where=f"{where} byte {at}",
            expected=f"{record} bytes, and {invalid} of invalidation bits",
            got=f"channel type {kind}, data type {number}, {bits} bits at byte {start} bit {bit}",
        )


def _check_packed(body: bytes, where: str, at: int, length: int) -> None:
    if len(body) < 24:
        raise damaged("the file ends inside a block", where=f"{where} byte {at}", got="DZ")
    unpacked, packed = struct.unpack("<QQ", body[8:24])
    if packed > length - 48 or unpacked > min(packed * _ZIP_MOST + 1000, _UNPACKED):
        raise damaged(
            "a packed block of impossible size",
            where=f"{where} byte {at}",
            expected=f"{length - 48} packed bytes at most",
            got=f"{packed} that unpack to {unpacked}",
        )


def _wrong_kind(where: str, at: int, whose: str, wanted: frozenset[bytes], kind: bytes) -> FormatError:
    names = " or ".join(sorted(k[2:].decode() for k in wanted))
    return damaged(
        "a link leads to a block of another kind",
        where=f"{where} byte {at}",
        expected=names,
        got=f"{kind[2:].decode()} ({whose})",
    )
