"""What the raw layer knows of one stream of one file: its row of the catalogue, there and back."""

from __future__ import annotations

import json
from collections.abc import Mapping
from dataclasses import dataclass, field
from functools import lru_cache
from typing import Any

from thermodata.plugin import Loss, Scaling, Signal
from thermodata.store.raw.loss_rows import losses_from_json, losses_to_json, plain


@dataclass(frozen=True, slots=True)
class RawStream:
    """One stream of one source file in the raw layer.

    path: relative to the store. columns: signal name -> column of the Parquet file. first_ns, last_ns: the smallest and
    the largest recorded time. ordered: whether no row is earlier than the one before it (None: nobody looked).
    newest_first: the rows stand from the last to the first; what reads them turns them round.
    unordered: the reader says that rows need not stand in the order of their times. of_day_ns: the time of day of the
    first row, where the file has no date. moved_ns: what is added to its times in a test, see `tidy.second_pass`.
    """

    key: str
    path: str
    stream: str
    source_path: str
    sha256: str
    bytes: int
    rows: int
    first_ns: int
    last_ns: int
    step_ns: int
    clock: str
    start_ns: int | None
    complete: bool | None
    reader: str
    reader_version: str
    signals: tuple[Signal, ...]
    columns: Mapping[str, str]
    flagged: tuple[str, ...] = ()
    notes: tuple[str, ...] = ()
    losses: tuple[Loss, ...] = field(default=())
    ordered: bool | None = None
    newest_first: bool = False
    unordered: bool = False
    of_day_ns: int | None = None
    moved_ns: int = 0
    # as it was read; a copy that was changed has none
    _told: str | None = field(default=None, init=False, repr=False, compare=False)

    @property
    def is_undated(self) -> bool:
        """Whether its file does not say when it was recorded, as `Recording.is_undated`."""
        return self.clock == "relative" and not self.start_ns

    def to_json(self) -> str:
        """Everything but what the table `file` has columns for."""
        return self._told or json.dumps(
            {
                "stream": self.stream,
                "first_ns": self.first_ns,
                "last_ns": self.last_ns,
                "step_ns": self.step_ns,
                "clock": self.clock,
                "start_ns": self.start_ns,
                "complete": self.complete,
                "reader": self.reader,
                "reader_version": self.reader_version,
                "flagged": list(self.flagged),
                "notes": list(self.notes),
                "signals": [
                    {
                        "name": s.name,
                        "column": self.columns[s.name],
                        "unit": s.unit,
                        "dtype": s.dtype,
                        "scaling": None
                        if s.scaling is None
                        else {"kind": s.scaling.kind, "properties": dict(s.scaling.properties)},
                        "properties": {k: str(v) for k, v in s.properties.items()},
                        **({"held": True} if s.held else {}),
                    }
                    for s in self.signals
                ],
                # older stores don't have it: their rows must stay as they are
                **({} if self.ordered is None else {"ordered": self.ordered}),
                **({"newest_first": True} if self.newest_first else {}),
                **({"unordered": True} if self.unordered else {}),
                **({} if self.of_day_ns is None else {"of_day_ns": self.of_day_ns}),
            },
            default=plain,
            sort_keys=True,
        )

    @classmethod
    def from_row(cls, row: Mapping[str, Any]) -> RawStream:
        """From a row of the table `file`."""
        return _stream_of(*(row[name] for name in (*_OF_ROW, "columns", "losses")))

    @classmethod
    def _from_row(cls, row: Mapping[str, Any]) -> RawStream:
        meta = json.loads(row["columns"])
        signals = tuple(
            Signal(
                s["name"],
                meta["stream"],
                s["unit"],
                s["dtype"],
                None if s["scaling"] is None else Scaling(s["scaling"]["kind"], s["scaling"]["properties"]),
                s["properties"],
                s.get("held", False),
            )
            for s in meta["signals"]
        )
        raw = cls(
            row["key"],
            row["path"],
            meta["stream"],
            row["source_path"],
            row["sha256"],
            row["bytes"],
            row["rows"],
            meta["first_ns"],
            meta["last_ns"],
            meta["step_ns"],
            meta["clock"],
            meta["start_ns"],
            meta["complete"],
            meta["reader"],
            meta["reader_version"],
            signals,
            {s["name"]: s["column"] for s in meta["signals"]},
            tuple(meta["flagged"]),
            tuple(meta["notes"]),
            losses_from_json(row["losses"]),
            meta.get("ordered"),
            meta.get("newest_first", False),
            meta.get("unordered", False),
            meta.get("of_day_ns"),
        )
        if "superseded_at" not in meta:
            object.__setattr__(raw, "_told", row["columns"])
        return raw

    def as_kept(self) -> RawStream:
        """As the catalogue will give it back: keys made from either must be the same."""
        row = {name: getattr(self, name) for name in _OF_ROW}
        return RawStream.from_row(row | {"columns": self.to_json(), "losses": self.losses_json()})

    def losses_json(self) -> str:
        return losses_to_json(self.losses)


_OF_ROW = ("key", "path", "source_path", "sha256", "bytes", "rows")


@lru_cache(maxsize=4096)
def _stream_of(*row: Any) -> RawStream:
    """An ingest meets each row twice: among all that the store holds, and as what a test was made of."""
    return RawStream._from_row(dict(zip((*_OF_ROW, "columns", "losses"), row, strict=True)))
