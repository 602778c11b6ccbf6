"""What a reader finds in one file: its clock, its signals, and the first rows of each stream."""

from __future__ import annotations

from datetime import UTC, datetime
from pathlib import Path
from typing import Any

from thermodata.cli.table import fields, table
from thermodata.plugin import Block, Source


def preview(path: Path, name: str | None, timezone: str | None, rows: int) -> dict[str, Any]:
    """The description of a file and `rows` first rows a stream; stops reading once it has them."""
    from thermodata.reader import reader, sniff
    from thermodata.reader.guard import guarded

    used, source = reader(name) if name else sniff(path), Source(name="preview", timezone=timezone)
    recording = used.describe(path, source)
    wanted = {s.stream for s in recording.signals}
    first: dict[str, list[dict[str, Any]]] = {}
    for item in guarded(used, path, source) if rows else ():
        if isinstance(item, Block) and item.stream not in first:
            first[item.stream] = [
                {"t": _time(int(item.t_ns[i]), recording.clock), **{k: v[i] for k, v in item.values.items()}}
                for i in range(min(rows, len(item.t_ns)))]
        if first.keys() >= wanted:
            break
    start = recording.start_ns
    return {"file": str(path), "reader": used.name, "clock": recording.clock,
            "start": None if start is None else _time(start, recording.clock), "complete": recording.complete,
            "notes": list(recording.notes),
            "signals": [{"stream": s.stream, "signal": s.name, "unit": s.unit, "dtype": s.dtype,
                         "scaling": s.scaling.kind if s.scaling else None} for s in recording.signals],
            "first_rows": first}


def preview_text(found: dict[str, Any]) -> str:
    """A preview for a person."""
    parts = [fields((k, found[k]) for k in ("file", "reader", "clock", "start", "complete", "notes")),
             table(found["signals"], [("stream", "stream"), ("signal", "signal"), ("unit", "unit"),
                                      ("dtype", "dtype"), ("scaling", "scaling")])]
    for stream, rows in found["first_rows"].items():
        names = list(rows[0]) if rows else []
        shown = names[:9]
        more = f"   (and {len(names) - len(shown)} more columns)" if len(names) > len(shown) else ""
        parts.append(f"{stream}{more}\n" + table(rows, [(n, n) for n in shown], widest=26))
    return "\n\n".join(parts)


def _time(t_ns: int, clock: str) -> str:
    if clock == "relative":
        return f"{t_ns / 1e9:.3f} s"
    return datetime.fromtimestamp(t_ns / 1e9, UTC).isoformat(timespec="milliseconds")
