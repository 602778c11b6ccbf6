"""The records of a channel group as blocks."""

from __future__ import annotations

from collections.abc import Iterator
from typing import Any

import numpy as np

from thermodata.errors import FormatError
from thermodata.plugin import Array, Block, Loss
from thermodata.reader.times import time_units
from thermodata.reader.times.zone import NAT
from thermodata.schema.flag import Flag
from thermodata.schema.words.sentences import counted
from thermodata_reader_table.mdf.groups import File, Group
from thermodata_reader_table.mdf.library import damage_as_format_error


def group_blocks(file: File, group: Group, rows: int | None) -> Iterator[Block | Loss]:
    """The blocks of a channel group, of at most `rows` rows each (None: as the library gives them), and what of it is
    missing."""
    done = missing = 0
    last: int | None = None
    where = f"{file.where} group '{group.stream}'"
    failed: str | None = None
    try:
        for piece in file.fragments(group.index):
            with damage_as_format_error(where):
                block, absent = _block(file, group, piece)
            n = block.t_ns.size
            done, missing = done + n + absent, missing + absent
            last = int(block.t_ns[-1]) if n else last
            yield from _split_rows(block, rows)
    except FormatError as error:
        failed = error.got
    if failed is not None or done != group.rows:
        reason = f"{done} of {group.rows} rows are there" + (f": {failed}" if failed else "")
        fraction = abs(group.rows - done) / max(group.rows, done, 1)
        yield Loss(where, last, None, min(1.0, fraction), reason)
    if missing:
        yield Loss(where, None, None, missing / max(done, 1), f"{counted(missing, 'row')} without a time")


def _block(file: File, group: Group, piece: Any) -> tuple[Block, int]:
    seconds = np.asarray(file.inner.get_master(group.index, data=piece))
    t_ns = time_units.to_ns(seconds, 1.0)
    if file.start_ns is not None:
        t_ns = np.where(t_ns == NAT, NAT, t_ns + file.start_ns)
    good = t_ns != NAT
    values: dict[str, Array] = {}
    flags: dict[str, Array] = {}
    for channel in group.channels:
        name = channel.signal.name
        found, invalid = file.get(group.index, channel.index, piece, raw=channel.raw)
        if found.shape != t_ns.shape:
            raise FormatError(
                "a channel as long as its time",
                where=file.where,
                got=f"'{name}': {found.shape}",
                hint="export the recording again from the program that wrote it",
            )
        if channel.text is not None:
            column: Array = _words(found, channel.text)
        else:
            column = found.astype(channel.signal.dtype)
        values[name] = column[good]
        if invalid is not None and invalid.any():
            flags[name] = np.where(invalid, np.uint16(Flag.NOT_MEASURING), np.uint16(0))[good]
    return Block(group.stream, t_ns[good], values, flags or None), int((~good).sum())


def _words(values: Array, encoding: str) -> Array:
    """Text of a channel; numbers among the words (ranges without a word) as they print."""

    def word(value: Any) -> str:
        if isinstance(value, bytes):
            try:
                return value.decode(encoding or "utf-8").rstrip("\0 ")
            except UnicodeDecodeError:
                return value.decode("latin-1").rstrip("\0 ")
        return str(value).rstrip("\0 ")

    return np.array([word(v) for v in values.tolist()], object)


def _split_rows(block: Block, rows: int | None) -> Iterator[Block]:
    if rows is None or block.t_ns.size <= rows:
        yield block
        return
    for i in range(0, block.t_ns.size, rows):
        part = slice(i, i + rows)
        yield Block(
            block.stream,
            block.t_ns[part],
            {k: v[part] for k, v in block.values.items()},
            None if block.flags is None else {k: v[part] for k, v in block.flags.items()},
        )
