"""Reader of MCAP recordings: each topic a stream, each leaf of its messages a signal `/topic.field.sub`."""

from __future__ import annotations

from collections.abc import Iterator
from pathlib import Path

from thermodata.plugin import Block, Head, Loss, Recording, Source

MAGIC = b"\x89MCAP0\r\n"


class Reader:
    """JSON messages through Arrow; ROS 2 (cdr) and protobuf where their packages are installed."""

    name = "mcap"
    unordered = True  # several writers put their messages into one file, each when it comes to it
    formats = ("MCAP with JSON, protobuf, ROS 2 (ros2msg, ros2idl) or ROS 1 messages",)

    def sniff(self, head: Head) -> str | None:
        """Why this reader claims a file by its first bytes; None where it does not."""
        return "MCAP: the file starts with its magic bytes" if head.start.startswith(MAGIC) else None

    def describe(self, path: Path, source: Source) -> Recording:
        """The topics as streams with their signals, by samples. FormatError: no MCAP, or no topic that reads."""
        from thermodata_reader_mcap.signals import recording

        return recording.describe(path, source)

    def blocks(self, path: Path, source: Source) -> Iterator[Block | Loss]:
        """The messages, times in ns since 1970 UTC (or since the start), and a loss for all that is damaged."""
        from thermodata_reader_mcap.signals import recording

        return recording.blocks(path, source)

    def locate(self, path: Path, source: Source, stream: str, row: int) -> str:
        """Where a row (counted from 0) of a topic stands: message, chunk, byte and log time."""
        from thermodata_reader_mcap.signals.row_location import locate

        return locate(path, source, stream, row) or f"row {row + 1}"

    place = locate
