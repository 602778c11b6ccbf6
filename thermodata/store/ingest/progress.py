"""What an ingest says while it works: files, bytes and samples, for whoever draws a line of it."""

from __future__ import annotations

from collections.abc import Callable, Iterator
from pathlib import Path
from typing import Any, Protocol, cast

from thermodata.plugin import Block, Loss, Reader, Source


class Progress(Protocol):
    """Told about the work as it goes on. Sizes in bytes; a sample is one value."""

    def begin(self, files: int, size_bytes: int) -> None:
        """How much there is to look at."""

    def samples(self, count: int) -> None:
        """So many more samples were read."""

    def done(self, path: str, size_bytes: int) -> None:
        """A file is finished with: read, known already, or given up."""

    def say(self, text: str) -> None:
        """What is being done now."""


class TextProgress:
    """A Progress that passes on the words only."""

    def __init__(self, say: Callable[[str], None]) -> None:
        self.say = say

    def begin(self, files: int, size_bytes: int) -> None:
        """Nothing to say."""

    def samples(self, count: int) -> None:
        """Nothing to say."""

    def done(self, path: str, size_bytes: int) -> None:
        """Nothing to say."""


class _Counted:
    """A reader whose blocks are counted as they pass."""

    def __init__(self, reader: Reader, progress: Progress) -> None:
        self._reader, self._progress = reader, progress

    def __getattr__(self, name: str) -> Any:
        return getattr(self._reader, name)

    def blocks(self, path: Path, source: Source) -> Iterator[Block | Loss]:
        for item in self._reader.blocks(path, source):
            if isinstance(item, Block):
                self._progress.samples(len(item.t_ns) * len(item.values))
            yield item


def counted(reader: Reader, progress: Progress) -> Reader:
    """The reader, telling how many samples it reads."""
    return cast(Reader, _Counted(reader, progress))


__all__ = ["Progress", "TextProgress", "counted"]
