"""How much a packed log may unpack to: a small file can be made to fill every disk."""

from __future__ import annotations

import shutil
from pathlib import Path

MOST_BYTES = 32 << 30
_SMALL, _RATIO = 256 << 20, 300  # [bytes]: so much is unpacked whatever it was packed to; logs are packed to a tenth
_ROOM = 1 << 30  # [bytes] that are left on the disk


def most_of(packed_bytes: int) -> int:
    """How much so many packed bytes may unpack to."""
    return min(MOST_BYTES, max(_SMALL, _RATIO * packed_bytes))


def no_room(path: Path) -> bool:
    """Whether the disk of a file is as good as full."""
    return shutil.disk_usage(path.parent).free < _ROOM
