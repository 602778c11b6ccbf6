"""Why there is no room to write: a full disk, a used-up quota, a file that may be no longer. Each has its remedy."""

from __future__ import annotations

import errno
import shutil
from collections.abc import Callable
from dataclasses import dataclass
from pathlib import Path


@dataclass(frozen=True, slots=True)
class NoRoom:
    """One way to have no room. what: the error's first line. todo: what makes room again. got: what there is, of a path
    and the error's own words."""

    what: str
    todo: str
    got: Callable[[Path, str], str]
    numbers: tuple[int, ...]
    words: tuple[str, ...]  # as Arrow and DuckDB have it in their texts, where they drop the number
    gc_helps: bool = True

    @property
    def todo_in_store(self) -> str:
        """What makes room where the file is the store's."""
        return self.todo + " ('thermodata gc' deletes what the store no longer needs)" * self.gc_helps


def _text_only(_: Path, text: str) -> str:
    return text  # what else is free on the disk is not to be had


def _free(path: Path, text: str) -> str:
    folder = next((p for p in path.absolute().parents if p.is_dir()), Path("/"))
    try:
        return f"{shutil.disk_usage(folder).free / 1e6:,.0f} MB free ({text})"
    except OSError:
        return text


# in this order: DuckDB's "Could not write file" may be followed by what the system said
WAYS = (
    NoRoom(
        "the file is longer than it may be",
        "raise the limit of this shell ('ulimit -f' shows it), or write to a file system that takes longer files",
        _text_only,
        (errno.EFBIG,),
        ("File too large",),
        gc_helps=False,
    ),
    NoRoom(
        "the quota of the disk is used up",
        "free space of your own on that disk, or ask its keeper for more",
        _text_only,
        (errno.EDQUOT,),
        ("Disk quota",),
    ),
    NoRoom(
        "the disk is full",
        "free space",
        _free,
        (errno.ENOSPC,),
        ("No space left", "not enough space", "Could not write file"),
    ),
)


def no_room(error: Exception) -> NoRoom | None:
    """Which way an error says that there is no room; None where it says something else."""
    number = getattr(error, "errno", None)
    for way in WAYS:
        if number in way.numbers:
            return way
    text = str(error)
    return next((way for way in WAYS if any(word.lower() in text.lower() for word in way.words)), None)
