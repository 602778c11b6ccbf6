"""Archives of files that are no file themselves: a workbook is a ZIP as well, but its parts are XML. And files that
were packed one by one, as logs that were put aside are."""

from __future__ import annotations

import struct
from pathlib import PurePosixPath

_ZIP = b"PK\x03\x04"
# of Office files, and of arrays of NumPy
_PARTS = ("", ".xml", ".rels", ".vml", ".bin", ".png", ".jpg", ".jpeg", ".emf", ".wmf", ".gif", ".npy")

# first bytes and name
_PACKERS = (
    (b"\x1f\x8b", "gzip"),
    *((b"BZh%d1AY&SY" % level, "bzip2") for level in range(1, 10)),
    (b"\xfd7zXZ\0", "xz"),
    (b"\x28\xb5\x2f\xfd", "Zstandard"),
    (b"7z\xbc\xaf", "7-Zip"),
    (b"Rar!", "RAR"),
)


# what unpacks a file and leaves it there: where Python has it, by what runs on every system
_UNPACK = {
    "ZIP": "python -m zipfile -e {} .",
    "tar": "python -m tarfile -e {} .",
    "gzip": "python -m gzip -d {}",
    "bzip2": "bzip2 -dk {}",
    "xz": "xz -dk {}",
    "Zstandard": "zstd -d {}",
    "7-Zip": "7z x {}",
    "RAR": "unrar x {}",
}


def how_to_unpack(packer: str, name: str) -> str:
    """The command that unpacks a file of a packer, in the folder that it stands in."""
    return _UNPACK[packer].format(f'"{name}"' if " " in name else name)


def packed_by(start: bytes) -> str | None:
    """The packer of a file that is no ZIP archive ('gzip'), by its first bytes; None where it is not packed."""
    return next((name for magic, name in _PACKERS if start.startswith(magic)), None)


def is_tar(start: bytes) -> bool:
    """Whether a file is a TAR archive, by its first 512 bytes."""
    return start[257:262] == b"ustar"


def packed(start: bytes) -> str | None:
    """The first file of a ZIP archive that holds files rather than the parts of one; None for all else. start: the
    first bytes of a file. What stands behind them is not asked: a workbook that is packed unchanged has its own parts
    there."""
    if start[:4] != _ZIP or len(start) < 30:
        return None
    flags, length = struct.unpack("<H", start[6:8])[0], struct.unpack("<H", start[26:28])[0]
    name = start[30 : 30 + length].decode("utf-8" if flags & 0x800 else "cp437", "replace")
    part = name.startswith("[") or PurePosixPath(name).suffix.lower() in _PARTS  # [trash]/0000.dat
    if part or not name.isprintable():
        return None
    return name
