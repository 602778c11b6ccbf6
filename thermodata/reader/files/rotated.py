"""Pieces of one log that were put aside, as logrotate does: `a.log.2` is older than `a.log.1`, and `a.log` goes on; as
Campbell's LoggerNet does where the header of a table changed: `a.dat.backup`, then `a.dat.1.backup`, and `a.dat` goes
on."""

from __future__ import annotations

import re
from pathlib import PurePosixPath

_ROTATED = re.compile(r"(?<=[A-Za-z])(?:\.(?P<number>\d{1,3})|[.-](?P<day>\d{8})|(?:\.(?P<kept>\d{1,3}))?\.backup)$")
_PACKED = re.compile(r"(?i)(?<=[^.])\.(?:gz|bz2|xz)$")


def unrotated(path: PurePosixPath) -> PurePosixPath:
    """A path without the number, or the day, of a piece that was put aside: `a.log` of `a.log.2`, `a.log-20260403`; and
    of one that was packed, `a.log.2.gz`."""
    path = as_unpacked(path)
    bare = _ROTATED.sub("", path.name)
    return path.with_name(bare) if bare and PurePosixPath(bare).suffix else path


def as_unpacked(path: PurePosixPath) -> PurePosixPath:
    """A path as that of the log that was packed alone: `a.csv` of `a.csv.gz`."""
    return path.with_name(_PACKED.sub("", path.name))


def age(path: PurePosixPath) -> tuple[int, int]:
    """A sort key of the pieces of one log, the oldest first: numbered ones, by days, and the one that goes on."""
    path = as_unpacked(path)
    found = _ROTATED.search(path.name) if unrotated(path) != path else None
    if found is None:
        return 2, 0
    if found["number"]:
        return 0, -int(found["number"])
    return 1, int(found["day"] or found["kept"] or 0)
