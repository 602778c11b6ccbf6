"""How much a packed log may unpack to: a small file can be made to fill every disk."""

from __future__ import annotations

import shutil
from pathlib import Path

from thermodata.errors import FormatError

MOST_BYTES = 32 << 30
MOST_FILES = 20_000
"""In an archive."""
_SMALL, _RATIO = 256 << 20, 300  # [bytes]: so much is unpacked whatever it was packed to; logs are packed to a tenth
_ROOM = 1 << 30  # [bytes] that are left on the disk


def most_of(packed_bytes: int) -> int:
    """How much so many packed bytes may unpack to."""
    return min(MOST_BYTES, max(_SMALL, _RATIO * packed_bytes))


def more_than_logs(name: str, most: int, files: int, size: int) -> FormatError:
    """Of an archive that holds so many files, or bytes, at least."""
    return FormatError(
        "an archive that unpacks to more than logs do",
        where=name,
        expected=f"at most {MOST_FILES} files and {most} bytes",
        got=f"{files} files or folders and {size} bytes" if files else f"{size} bytes, and more",
        hint="unpack it yourself, beside the others",
    )


def no_room(path: Path) -> bool:
    """Whether the disk of a file is as good as full."""
    return shutil.disk_usage(path.parent).free < _ROOM
