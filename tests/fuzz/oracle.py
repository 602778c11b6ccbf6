"""What a reading gave, and whether it is silently wrong beside the reading of the seed."""

from __future__ import annotations

from collections.abc import Iterable
from dataclasses import dataclass, field
from pathlib import Path
from typing import Any

import numpy as np

from thermodata.plugin import Block, Loss, Reader, Source
from thermodata.reader.contract.guard import described, guarded

_ROW = np.dtype([("t", "<i8"), ("v", "<i8")])


@dataclass
class Reading:
    """rows: signal -> sorted distinct (t, value) with the value's bits; text: the same for text, as a set.
    said: what the reader reported of itself (losses, notes, incomplete); flagged: (signal, t, bits)."""

    rows: dict[str, Any] = field(default_factory=dict)
    text: dict[str, set[tuple[int, str]]] = field(default_factory=dict)
    said: set[tuple[str, str]] = field(default_factory=set)
    flagged: set[tuple[str, int, int]] = field(default_factory=set)
    complete: bool | None = None
    delivered: int = 0


def read(reader: Reader, path: Path, source: Source) -> Reading:
    """The whole file through the guard. Raises what the reader raises."""
    recording = described(reader, path, source)
    found = Reading(complete=recording.complete)
    found.said.update(("note", note) for note in recording.notes)
    numbers: dict[str, list[Any]] = {}
    for item in guarded(reader, path, source, recording):
        if isinstance(item, Loss):
            found.said.add(("loss", f"{item.where}: {item.reason}"))
            continue
        _take(item, found, numbers)
    found.rows = {name: np.unique(np.concatenate(parts)) for name, parts in numbers.items()}
    return found


def _take(block: Block, found: Reading, numbers: dict[str, list[Any]]) -> None:
    for name, flags in (block.flags or {}).items():
        at = np.flatnonzero(flags)
        found.flagged.update(
            (name, t, bits) for t, bits in zip(block.t_ns[at].tolist(), flags[at].tolist(), strict=True)
        )
    for name, values in block.values.items():
        if values.dtype.kind in "OU":
            pairs = zip(block.t_ns.tolist(), values.tolist(), strict=True)
            kept = {(t, v) for t, v in pairs if v is not None and v != ""}
            found.text.setdefault(name, set()).update(kept)
            found.delivered += len(kept)
            continue
        v = values.astype(np.float64) + 0.0  # -0.0 is 0.0
        good = ~np.isnan(v)
        rows = np.empty(int(good.sum()), _ROW)
        rows["t"], rows["v"] = block.t_ns[good], v[good].view(np.int64)
        numbers.setdefault(name, []).append(rows)
        found.delivered += rows.size


def reports(got: Reading, seed: Reading) -> bool:
    """Whether something was reported that the seed's own reading does not say."""
    return bool(
        got.said - seed.said or got.flagged - seed.flagged or (got.complete is False and seed.complete is not False)
    )


def wrong_rows(got: Reading, seed: Reading) -> str | None:
    """A delivered row that the seed does not have, as a sentence, or None."""
    for name, rows in got.rows.items():
        if name not in seed.rows:
            continue  # a new name, or a column that was text: nothing to compare
        odd = rows[~np.isin(rows, seed.rows[name])]
        if odd.size:
            return (
                f"'{name}': {odd.size} of {rows.size} rows are not the seed's, first t_ns={int(odd['t'][0])} "
                f"value={odd['v'][:1].view(np.float64)[0]!r}"
            )
    for name, pairs in got.text.items():
        if name in seed.text and pairs - seed.text[name]:
            return f"'{name}': text rows that the seed does not have, first {min(pairs - seed.text[name])!r}"
    return None


def missing_rows(got: Reading, seed: Reading) -> str | None:
    """A row of the seed that was not delivered, as a sentence, or None."""
    for name, rows in seed.rows.items():
        have = got.rows.get(name)
        gone = rows if have is None else rows[~np.isin(rows, have)]
        if gone.size:
            return (
                f"'{name}': {gone.size} of {rows.size} rows are missing"
                f"{'' if have is not None else ' (no such signal of numbers)'}, first t_ns={int(gone['t'][0])}"
            )
    for name, pairs in seed.text.items():
        gone_text = pairs - got.text.get(name, set())
        if gone_text:
            return f"'{name}': {len(gone_text)} of {len(pairs)} text rows are missing, first {min(gone_text)!r}"
    return None


def left_beside(path: Path, known: Iterable[str]) -> list[str]:
    """Names in the file's folder that were not there."""
    return sorted({p.name for p in path.parent.iterdir()} - set(known))
