"""The raw layer: what a file said, as Parquet, one file a stream. Final: made once from a source file's bytes."""

from __future__ import annotations

import dataclasses
import json
from collections.abc import Callable, Mapping
from dataclasses import dataclass, field
from functools import lru_cache
from pathlib import Path
from typing import Any

from thermodata.errors import FormatError, PluginError, ThermodataError
from thermodata.plugin import Loss, Reader, Recording, Scaling, Signal, Source
from thermodata.reader import newest_first, registry
from thermodata.reader.guard import described, guarded
from thermodata.schema.campaign import SourceSpec
from thermodata.store.base.files import key_of, safe_name
from thermodata.store.raw.loss_rows import losses_from_json, losses_to_json, plain
from thermodata.store.raw.writer import StreamWriter

RAW_VERSION = "1"


@dataclass(frozen=True, slots=True)
class RawStream:
    """One stream of one source file in the raw layer.

    path: relative to the store. columns: signal name -> column of the Parquet file. first_ns, last_ns: the smallest and
    the largest recorded time. ordered: whether no row is earlier than the one before it (None: nobody looked).
    newest_first: the rows stand from the last to the first; what reads them turns them round.
    unordered: the reader says that rows need not stand in the order of their times. of_day_ns: the time of day of the
    first row, where the file has no date.
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
    # as it was read; a copy that was changed has none
    _told: str | None = field(default=None, init=False, repr=False, compare=False)

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
    def _from(cls, row: Mapping[str, Any]) -> RawStream:
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

    def losses_json(self) -> str:
        return losses_to_json(self.losses)


_OF_ROW = ("key", "path", "source_path", "sha256", "bytes", "rows")


@lru_cache(maxsize=4096)
def _stream_of(*row: Any) -> RawStream:
    """An ingest meets each row twice: among all that the store holds, and as what a test was made of."""
    return RawStream._from(dict(zip((*_OF_ROW, "columns", "losses"), row, strict=True)))


def declared(name: str, spec: SourceSpec) -> Source:
    """What a reader is told about a source of the campaign file."""
    return Source(
        name=name,
        timezone=spec.timezone,
        encoding=spec.encoding,
        table=None if spec.table is None else spec.table.model_dump(mode="json"),
        topics=tuple(spec.topics),
        options=dict(spec.options),
    )


def find_reader(name: str) -> Reader:
    """The installed reader of that name."""
    return registry.reader(name)


def version_of(reader: Reader) -> str:
    """The version of the distribution that brought a reader; '' where it can't be told."""
    own = getattr(reader, "version", None)
    if isinstance(own, str):
        return own
    return registry.distribution_version(reader.name)


def raw_key(sha256: str, reader: Reader, source: Source) -> str:
    """The same bytes, read by the same reader as declared in the same way, are the same raw data."""
    said = {f.name: getattr(source, f.name) for f in dataclasses.fields(source) if f.name != "name"}
    descriptor = json.dumps(
        said | {"options": dict(source.options)},
        sort_keys=True,
        default=str,
    )
    return key_of(RAW_VERSION, sha256, reader.name, version_of(reader), descriptor)


def read_raw(
    store: Path,
    path: Path,
    source_path: str,
    sha256: str,
    reader: Reader,
    source: Source,
    check: Callable[[], None] = lambda: None,
) -> list[RawStream]:
    """Reads a source file into raw Parquet files, in bounded memory; FormatError where nothing can be read.

    A stream without rows leaves no file. Losses are kept with the file's first stream. check: called before any
    file appears under its name; raises where the source file is no longer what was hashed.
    """
    key = raw_key(sha256, reader, source)
    writers: dict[str, StreamWriter] = {}
    losses: list[Loss] = []
    try:
        try:
            recording = described(reader, path, source)
            by_stream: dict[str, list[Signal]] = {}
            for signal in recording.signals:
                by_stream.setdefault(signal.stream, []).append(signal)
            for item in guarded(reader, path, source, recording):
                if isinstance(item, Loss):
                    losses.append(item)
                    continue
                if item.stream not in writers:
                    if item.stream not in by_stream:
                        raise PluginError(
                            f"reader '{reader.name}' yields a stream that it did not describe",
                            where=source_path,
                            expected=", ".join(by_stream),
                            got=item.stream,
                        )
                    target = store / "raw" / f"{key}-{safe_name(item.stream, 40) or 'main'}.parquet"
                    writers[item.stream] = StreamWriter(
                        target, by_stream[item.stream], unordered=bool(getattr(reader, "unordered", False))
                    )
                writers[item.stream].add(item)
        except (ThermodataError, MemoryError, KeyboardInterrupt):
            raise
        except Exception as error:
            raise FormatError(
                "the file cannot be read", where=source_path, got=f"{type(error).__name__}: {error}"
            ) from error
        check()
        streams = [
            _finish(store, writer, stream, key, path, source_path, sha256, reader, recording, losses)
            for stream, writer in writers.items()
            if writer.rows
        ]
    finally:
        for writer in writers.values():
            writer.discard()
    if not streams:
        raise FormatError(
            "the file holds no data",
            where=source_path,
            expected="at least one row",
            got="; ".join(x.reason for x in losses) or "none",
        )
    streams[0] = dataclasses.replace(streams[0], losses=tuple(losses))
    return [_as_kept(m) for m in streams]


def _as_kept(raw: RawStream) -> RawStream:
    """As the catalogue will give it back: keys made from either must be the same."""
    row = {name: getattr(raw, name) for name in _OF_ROW}
    return RawStream.from_row(row | {"columns": raw.to_json(), "losses": raw.losses_json()})


def _finish(
    store: Path,
    writer: StreamWriter,
    stream: str,
    key: str,
    path: Path,
    source_path: str,
    sha256: str,
    reader: Reader,
    recording: Recording,
    losses: list[Loss],
) -> RawStream:
    writer.finish({"source_path": source_path, "sha256": sha256, "reader": reader.name, "stream": stream})
    return RawStream(
        key,
        writer.target.relative_to(store).as_posix(),
        stream,
        source_path,
        sha256,
        path.stat().st_size,
        writer.rows,
        writer.first_ns,
        writer.last_ns,
        writer.step_ns,
        recording.clock,
        recording.start_ns,
        False if losses else recording.complete,
        reader.name,
        version_of(reader),
        tuple(writer.signals),
        writer.columns,
        tuple(sorted(writer.flagged)),
        (*recording.notes, *([newest_first.NOTE] if writer.newest_first else [])),
        ordered=writer.ordered,
        newest_first=writer.newest_first,
        unordered=writer.unordered and not writer.ordered,
        of_day_ns=recording.of_day_ns,
    )
