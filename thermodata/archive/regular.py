"""Regular files: whatever else stands in a folder is no log, and opening it may wait for ever."""

from __future__ import annotations

import os
import stat
from collections.abc import Iterator
from contextlib import contextmanager
from io import BufferedReader
from pathlib import Path

from thermodata.errors import FormatError

_KINDS = (
    (stat.S_ISDIR, "a folder"),
    (stat.S_ISFIFO, "a pipe"),
    (stat.S_ISSOCK, "a socket"),
    (stat.S_ISCHR, "a device"),
    (stat.S_ISBLK, "a device"),
)


def kind_of(status: os.stat_result) -> str | None:
    """What stands in place of a file: 'a folder', 'a pipe', ...; None where it is a file."""
    if stat.S_ISREG(status.st_mode):
        return None
    return next((kind for is_kind, kind in _KINDS if is_kind(status.st_mode)), "no file")


@contextmanager
def opened(path: Path) -> Iterator[BufferedReader]:
    """A regular file for reading; FormatError for anything else. Never waits, as opening a pipe would."""
    fd = os.open(path, os.O_RDONLY | getattr(os, "O_NONBLOCK", 0) | getattr(os, "O_BINARY", 0))
    with os.fdopen(fd, "rb") as handle:
        kind = kind_of(os.fstat(fd))
        if kind is not None:
            raise _no_file(path, kind)
        yield handle


def refuse_what_never_ends(path: Path) -> None:
    """FormatError for a pipe, a socket or a device. What is not there is told by who opens it."""
    try:
        kind = kind_of(os.stat(path))
    except OSError:
        return
    if kind not in (None, "a folder"):
        raise _no_file(path, kind)


def _no_file(path: Path, kind: str | None) -> FormatError:
    return FormatError(f"this is {kind}", where=path.name, expected="a file", got=kind)
