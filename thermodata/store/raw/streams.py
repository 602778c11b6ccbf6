"""The raw layer: what a file said, as Parquet, one file a stream. Final: made once from a source file's bytes."""

from __future__ import annotations

import dataclasses
import json
from collections.abc import Callable
from pathlib import Path

from thermodata.errors import FormatError, PluginError, ThermodataError
from thermodata.plugin import Loss, Reader, Recording, Signal, Source
from thermodata.reader import newest_first, registry
from thermodata.reader.guard import described, guarded
from thermodata.reader.units_met import units_met
from thermodata.schema.campaign import SourceSpec
from thermodata.store.base.files import key_of, safe_name
from thermodata.store.raw.open_pass import pass_notes
from thermodata.store.raw.raw_stream import RawStream
from thermodata.store.raw.writer import StreamWriter

RAW_VERSION = "1"


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
            units = units_met(recording.signals)
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
                for met in units:
                    met.add(item)
        except (ThermodataError, MemoryError, KeyboardInterrupt):
            raise
        except Exception as error:
            raise FormatError(
                "the file cannot be read", where=source_path, got=f"{type(error).__name__}: {error}"
            ) from error
        check()
        late = [note for met in units if (note := met.note(recording.notes)) is not None]
        late += pass_notes(
            reader, path, source, recording, [(w.first_ns, w.last_ns) for w in writers.values() if w.rows]
        )
        recording = dataclasses.replace(recording, notes=(*recording.notes, *late))
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
    return [m.as_kept() for m in streams]


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
