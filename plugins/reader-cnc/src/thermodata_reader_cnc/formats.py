"""The formats that this reader knows, and which of them a file is, by its first bytes.

Adding one: its module (see `Module`), and a line in `FORMATS`.
"""

from __future__ import annotations

from collections.abc import Iterator, Mapping, Sequence
from dataclasses import dataclass
from functools import lru_cache
from pathlib import Path
from typing import Protocol

from thermodata.plugin import Block, Head, Loss, Recording, Source
from thermodata.reader.text.claim import head_lines
from thermodata_reader_cnc import export
from thermodata_reader_cnc.heidenhain import sco
from thermodata_reader_cnc.messages import json_lines
from thermodata_reader_cnc.mtconnect import shdr, streams
from thermodata_reader_cnc.opcua import long_table
from thermodata_reader_cnc.sinumerik import capture, trace_csv, trace_xml
from thermodata_reader_cnc.twincat import scope


class Module(Protocol):
    """What the module of a format holds. EXAMPLE: the head of a small file, which no other reader may claim."""

    EXAMPLE: bytes

    def claims(self, lines: Sequence[str]) -> str | None:
        """The reason for claiming a file that begins with these lines, one or more, or None."""

    def describe(self, path: Path, source: Source) -> Recording:
        """As thermodata.plugin.Reader has it; so has blocks."""

    def blocks(self, path: Path, source: Source) -> Iterator[Block | Loss]: ...

    def locate(self, path: Path, source: Source, stream: str, row: int) -> str | None:
        """Where a row (counted from 0) of a stream stands in the file; None where that cannot be told."""


@dataclass(frozen=True, slots=True)
class Format:
    """xml: whether its files are XML; only these are asked of a text that begins with '<'."""

    name: str
    module: Module
    xml: bool = False


# in the order in which they are asked; the last reads the text that none of them claims
FORMATS = (
    Format("MTCONNECT", streams, xml=True),
    Format("TRACE_XML", trace_xml, xml=True),
    Format("SHDR", shdr),
    Format("TWINCAT", scope),
    Format("SCO", sco),
    Format("EDGE", capture),
    Format("JSON_LINES", json_lines),
    Format("OPCUA", long_table),
    Format("TRACE_CSV", trace_csv),
    Format("CONTROL_CSV", export),
)


@lru_cache(maxsize=32)  # one file is asked for when it is claimed, described and read
def claimed(head: Head) -> tuple[Format, str] | None:
    """(the format of a file, the reason for claiming it), or None."""
    lines = head_lines(head)
    if not lines or lines[0].startswith("LabVIEW"):
        return None
    xml = "".join(lines).lstrip().startswith("<")
    for each in FORMATS:
        if each.xml == xml and (reason := each.module.claims(lines)) is not None:
            return each, reason
    return None


def module_of(head: Head) -> Module:
    """The module that reads a file."""
    found = claimed(head)
    return FORMATS[-1].module if found is None else found[0].module


def heads() -> Mapping[str, bytes]:
    """The head of a small file of each format."""
    return {each.name: each.module.EXAMPLE for each in FORMATS}
