"""What a recording holds beside messages: metadata and attachments, as notes."""

from __future__ import annotations

from collections.abc import Sequence

from thermodata_reader_mcap.container.records import METADATA, Record, ShortError, text, text_map, u64

_MOST = 20
_LONG = 300


def extras(view: memoryview, records: Sequence[Record]) -> list[str]:
    """One note a metadata record or attachment."""
    notes = []
    for record in records[:_MOST]:
        try:
            notes.append(_metadata(view, record) if record.opcode == METADATA else _attachment(view, record))
        except ShortError:
            notes.append(f"a record of metadata at byte {record.start} does not read")
    if len(records) > _MOST:
        notes.append(f"{len(records) - _MOST} more records of metadata and attachments")
    return notes


def _metadata(view: memoryview, record: Record) -> str:
    name, at = text(view, record.start, record.stop)
    pairs, _ = text_map(view, at, record.stop)
    said = ", ".join(f"{key}: {value}" for key, value in pairs.items())
    return f"metadata '{name}': {said[:_LONG]}" + ("..." if len(said) > _LONG else "")


def _attachment(view: memoryview, record: Record) -> str:
    name, at = text(view, record.start + 16, record.stop)
    kind, at = text(view, at, record.stop)
    size, _ = u64(view, at, record.stop)
    return f"attachment '{name}' ({kind or 'no type'}, {size} bytes) is not read"
