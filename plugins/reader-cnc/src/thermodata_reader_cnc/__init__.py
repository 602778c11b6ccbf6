"""Reader of what controls write: delimited text with dates and times.

One module a format; `sniff` tells them apart by content.
"""

from __future__ import annotations

from collections.abc import Iterator
from importlib import import_module
from pathlib import Path
from typing import Any

from thermodata.plugin import Block, Head, Loss, Recording, Source


class Reader:
    """Tells the formats apart by their first bytes; what it does not know is read as delimited text."""

    name = "cnc"
    formats = (
        "CSV exports of a control (German, Czech, English)",
        "Sinumerik Trace XML",
        "Sinumerik Trace CSV",
        "Heidenhain TNCscope (.sco)",
        "TwinCAT Scope text export",
        "MTConnect streams (XML)",
        "MTConnect SHDR",
        "OPC UA and SIMATIC long tables",
    )

    def sniff(self, head: Head) -> str | None:
        from thermodata_reader_cnc.sniff import claim

        found = claim(head)
        return None if found is None else found[1]

    def describe(self, path: Path, source: Source) -> Recording:
        recording: Recording = _module(path).describe(path, source)
        return recording

    def blocks(self, path: Path, source: Source) -> Iterator[Block | Loss]:
        items: Iterator[Block | Loss] = _module(path).blocks(path, source)
        return items

    def place(self, path: Path, source: Source, stream: str, row: int) -> str:
        """Where a row (counted from 0) of a stream stands: its line, or its record and byte."""
        from thermodata_reader_cnc.place import place

        module = _module(path)
        return place(module.__name__.rsplit(".", 1)[-1], module, path, source, stream, row) or f"row {row + 1}"


def _module(path: Path) -> Any:
    from thermodata.reader.registry import head
    from thermodata_reader_cnc.sniff import claim

    found = claim(head(path))
    return import_module(f"thermodata_reader_cnc.{'plain' if found is None else found[0]}")
