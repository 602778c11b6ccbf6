"""Reads one row of a source file once more, to hold the store against the file."""

from __future__ import annotations

from pathlib import Path
from typing import Any

from thermodata.errors import ThermodataError
from thermodata.plugin import Block
from thermodata.reader.contract.guard import guarded
from thermodata.reader.contract.locate import locate
from thermodata.schema.files.campaign import SourceSpec
from thermodata.store.raw.raw_stream import RawStream
from thermodata.store.raw.streams import declared, find_reader


def reread(path: Path, raw: RawStream, row: int, signal: str, source: str, spec: SourceSpec) -> dict[str, Any]:
    """{"value": the signal's value in that row (counted from 0) of the stream, "place": where the reader says that it
    stands (None: it can't tell), "problem": why there is no value}."""
    declaration = declared(source, spec)
    try:
        reader = find_reader(raw.reader)
        # a reader may know more than the row: a line, a segment, a byte
        where = locate(reader, path, declaration, raw.stream, row)
        at = 0
        for item in guarded(reader, path, declaration):
            if isinstance(item, Block) and item.stream == raw.stream:
                if row < at + len(item.t_ns):
                    value = item.values[signal][row - at]
                    return {"value": value.item() if hasattr(value, "item") else value, "place": where, "problem": None}
                at += len(item.t_ns)
    except (ThermodataError, OSError, KeyError) as error:
        return {"value": None, "place": None, "problem": "; ".join(str(error).splitlines())}
    return {"value": None, "place": None, "problem": f"the file has {at} rows in stream '{raw.stream}' now"}
