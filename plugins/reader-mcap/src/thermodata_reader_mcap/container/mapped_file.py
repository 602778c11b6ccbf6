"""The bytes of an MCAP file, mapped: none of them is in memory before it is looked at."""

from __future__ import annotations

import mmap
from collections.abc import Iterator
from contextlib import contextmanager, suppress
from pathlib import Path

from thermodata.errors import FormatError
from thermodata_reader_mcap.container.records import MAGIC

MAPPED = 64 << 20  # of the file that stays mapped behind a walk or a search


@contextmanager
def opened(path: Path) -> Iterator[memoryview]:
    """The file's bytes, mapped; FormatError where it is empty or no MCAP."""
    with path.open("rb") as file:
        start = file.read(len(MAGIC))
        if start != MAGIC:
            raise FormatError(
                "not an MCAP file",
                where=path.name,
                expected=repr(MAGIC),
                got=repr(start),
                hint="'thermodata sniff FILE' says what it is; a bag of ROS 1 or 2 is converted by the mcap tool",
            )
        mapped = mmap.mmap(file.fileno(), 0, access=mmap.ACCESS_READ)
    view = memoryview(mapped)
    try:
        yield view
    finally:
        with suppress(BufferError):  # a payload that somebody still holds points into it
            view.release()
            mapped.close()


def release_pages(view: memoryview, start: int, stop: int) -> int:
    """Unmaps pages that the walk has passed, for a mapped file of any size would count as memory of the process;
    they come back when they are looked at again. Returns where the mapped ones begin."""
    stop = stop // mmap.PAGESIZE * mmap.PAGESIZE
    if isinstance(view.obj, mmap.mmap) and hasattr(mmap, "MADV_DONTNEED"):
        view.obj.madvise(mmap.MADV_DONTNEED, start, stop - start)
    return stop
