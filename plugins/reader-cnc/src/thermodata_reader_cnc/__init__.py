"""Reader of what controls write: delimited text with dates and times.

One module a format, in a folder a maker; `formats` tells them apart by content.
"""

from __future__ import annotations

from collections.abc import Iterator, Mapping
from pathlib import Path

from thermodata.plugin import Block, Head, Loss, Recording, Source


class Reader:
    """Tells the formats apart by their first bytes; what it does not know is read as delimited text."""

    name = "cnc"
    looks_for = "exports of controls as text: CSV with dates, Sinumerik, Heidenhain, TwinCAT, MTConnect, OPC UA"
    formats = (
        "CSV exports of a control (German, Czech, English)",
        "Sinumerik Trace XML",
        "Sinumerik Trace CSV",
        "SINUMERIK Edge (Capture4Analysis, JSON)",
        "Heidenhain TNCscope (.sco)",
        "TwinCAT Scope text export",
        "MTConnect streams (XML)",
        "MTConnect SHDR",
        "OPC UA and SIMATIC long tables",
        "lines of JSON: MQTT, Telegraf, Industrial Edge",
    )

    @property
    def heads(self) -> Mapping[str, bytes]:
        """The head of a small file of each format."""
        from thermodata_reader_cnc.formats import heads

        return heads()

    def sniff(self, head: Head) -> str | None:
        from thermodata_reader_cnc.formats import claimed

        found = claimed(head)
        return None if found is None else found[1]

    def describe(self, path: Path, source: Source) -> Recording:
        from thermodata.reader.finding.registry import head
        from thermodata_reader_cnc.formats import module_of

        return module_of(head(path)).describe(path, source)

    def blocks(self, path: Path, source: Source) -> Iterator[Block | Loss]:
        from thermodata.reader.finding.registry import head
        from thermodata_reader_cnc.formats import module_of

        return module_of(head(path)).blocks(path, source)

    def locate(self, path: Path, source: Source, stream: str, row: int) -> str:
        """Where a row (counted from 0) of a stream stands: its line, its report, or its record and byte."""
        from thermodata.reader.finding.registry import head
        from thermodata_reader_cnc.formats import module_of

        return module_of(head(path)).locate(path, source, stream, row) or f"row {row + 1}"

    place = locate
