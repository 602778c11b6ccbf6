"""Where in a file a row stands, in the words of the reader that read it."""

from __future__ import annotations

from pathlib import Path

from thermodata.plugin import Reader, Source
from thermodata.reader.contract.guard import asking, held_for


def locate(reader: Reader, path: Path, source: Source, stream: str, row: int) -> str | None:
    """What the reader says of a row of a stream, counted from 0 over all its blocks: "line 812".

    None where the reader has no `locate`, nor `place`, as readers called it first. It may take as long as reading the
    file. PluginError for what the reader raises that is none of ours.
    """
    method = getattr(reader, "locate", None) or getattr(reader, "place", None)
    if method is None:
        return None
    where = f"{path.name} stream '{stream}' row {row}"
    with asking(f"reader '{reader.name}' failed to locate a row", where), held_for(reader, path) as real:
        return str(method(real, source, stream, row))
