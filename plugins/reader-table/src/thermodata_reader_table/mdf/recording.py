"""MDF 3 and 4: each channel group a stream with its master as the time, raw values with scalings."""

from __future__ import annotations

from collections.abc import Iterator
from pathlib import Path

from thermodata.errors import FormatError
from thermodata.plugin import Block, Loss, Recording, Source
from thermodata_reader_table.mdf.block_check3 import check3
from thermodata_reader_table.mdf.block_check4 import check
from thermodata_reader_table.mdf.groups import File
from thermodata_reader_table.mdf.library import damage_as_format_error, opened
from thermodata_reader_table.mdf.records import group_blocks


def _check_file(path: Path) -> tuple[str | None, bool]:
    with path.open("rb") as file:
        head = file.read(64)
    if head[8:9] == b"4":
        found = check(path)
        return found.cut, found.finished
    check3(path)
    return None, head[:8].strip() == b"MDF"


def describe(path: Path, source: Source) -> Recording:
    """Streams and signals of a file. FormatError: damaged, or no channel group with rows and a time."""
    cut, finished = _check_file(path)
    with opened(path) as mdf, damage_as_format_error(path.name):
        file = File(mdf, source, path.name)
        if not file.groups:
            raise FormatError(
                "no channel group with rows and a time",
                where=path.name,
                got="; ".join([*file.notes, *(x.reason for x in file.losses)][:4]) or "an empty file",
                hint="export the recording again with its time channels",
            )
        signals = tuple(c.signal for g in file.groups for c in g.channels)
        notes = [cut] if cut else []
        if not finished:
            notes.append("the file was not finished by its writer")
        start = file.start_ns
        return Recording(
            signals, "relative" if start is None else "absolute", start, not cut and finished, (*notes, *file.notes)
        )


def blocks(path: Path, source: Source) -> Iterator[Block | Loss]:
    """The values as stored, times in ns since 1970 UTC (or since the start), and what is lost."""
    cut, _ = _check_file(path)
    rows = source.options.get("block_rows")
    with opened(path) as mdf:
        with damage_as_format_error(path.name):
            file = File(mdf, source, path.name)
        yield from file.losses
        for group in file.groups:
            yield from group_blocks(file, group, int(rows) if rows is not None else None)
    if cut:
        yield Loss(path.name, reason=cut)
