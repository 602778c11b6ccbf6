"""Where in a file a row stands, in the words of the reader that read it."""

from __future__ import annotations

from pathlib import Path

from thermodata.plugin import Reader, Source


def locate(reader: Reader, path: Path, source: Source, stream: str, row: int) -> str | None:
    """What the reader says of a row of a stream, counted from 0 over all its blocks: "line 812".

    None where the reader has no `locate`, nor `place`, as readers called it first. It may take as long as reading the
    file. What the reader raises is passed on.
    """
    method = getattr(reader, "locate", None) or getattr(reader, "place", None)
    return None if method is None else str(method(path, source, stream, row))
