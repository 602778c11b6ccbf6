"""The raw layer: what a file said, as Parquet, one file a stream. Final: made once from a source file's bytes."""

from __future__ import annotations

import dataclasses
import json
from collections.abc import Callable, Mapping
from pathlib import Path

from thermodata.archive.members import size_of
from thermodata.errors import FormatError, PluginError, ThermodataError
from thermodata.plugin import Loss, Reader, Recording, Signal, Source
from thermodata.reader.contract.guard import described, guarded
from thermodata.reader.finding import registry
from thermodata.reader.signals.units_met import units_met
from thermodata.reader.times import newest_first
from thermodata.schema.files.campaign import SourceSpec
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
    reading = _Reading(store, path, source_path, sha256, reader, source, raw_key(sha256, reader, source))
    try:
        try:
            recording, late = reading.read()
        except (ThermodataError, MemoryError, KeyboardInterrupt):
            raise
        except Exception as error:
            raise FormatError(
                "the file cannot be read",
                where=source_path,
                got=f"{type(error).__name__}: {error}",
                hint="copy it anew from where it was recorded, and ingest again",
            ) from error
        check()
        spans = [(w.first_ns, w.last_ns) for w in reading.writers.values() if w.rows]
        late += pass_notes(reader, path, source, recording, spans)
        recording = dataclasses.replace(recording, notes=(*recording.notes, *late))
        streams = [reading.finish(w, name, recording) for name, w in reading.writers.items() if w.rows]
    finally:
        for writer in reading.writers.values():
            writer.discard()
    if not streams:
        raise FormatError(
            "the file holds no data",
            where=source_path,
            expected="at least one row",
            got="; ".join(x.reason for x in reading.losses) or "none",
            hint="take it out of the campaign file, or copy it anew from where it was recorded",
        )
    streams[0] = dataclasses.replace(streams[0], losses=tuple(reading.losses))
    return [m.as_kept() for m in streams]


@dataclasses.dataclass(slots=True)
class _Reading:
    """A source file on its way into the store: a writer for each of its streams that has come so far."""

    store: Path
    path: Path
    source_path: str
    sha256: str
    reader: Reader
    source: Source
    key: str
    writers: dict[str, StreamWriter] = dataclasses.field(default_factory=dict)
    losses: list[Loss] = dataclasses.field(default_factory=list)

    def read(self) -> tuple[Recording, list[str]]:
        """(what the file says of itself, notes on units that it says row by row)."""
        recording = described(self.reader, self.path, self.source)
        by_stream: dict[str, list[Signal]] = {}
        for signal in recording.signals:
            by_stream.setdefault(signal.stream, []).append(signal)
        units = units_met(recording.signals)
        for item in guarded(self.reader, self.path, self.source, recording):
            if isinstance(item, Loss):
                self.losses.append(item)
                continue
            if item.stream not in self.writers:
                self.writers[item.stream] = self._writer(item.stream, by_stream)
            self.writers[item.stream].add(item)
            for met in units:
                met.add(item)
        return recording, [note for met in units if (note := met.note(recording.notes)) is not None]

    def _writer(self, stream: str, described: Mapping[str, list[Signal]]) -> StreamWriter:
        if stream not in described:
            raise PluginError(
                f"reader '{self.reader.name}' yields a stream that it did not describe",
                where=self.source_path,
                expected=", ".join(described),
                got=stream,
            )
        target = self.store / "raw" / f"{self.key}-{safe_name(stream, 40) or 'main'}.parquet"
        return StreamWriter(target, described[stream], unordered=bool(getattr(self.reader, "unordered", False)))

    def finish(self, writer: StreamWriter, stream: str, recording: Recording) -> RawStream:
        """The file of a stream appears under its name."""
        writer.finish(
            {
                "source_path": self.source_path,
                "sha256": self.sha256,
                "reader": self.reader.name,
                "stream": stream,
            }
        )
        return RawStream(
            self.key,
            writer.target.relative_to(self.store).as_posix(),
            stream,
            self.source_path,
            self.sha256,
            size_of(self.path),
            writer.rows,
            writer.first_ns,
            writer.last_ns,
            writer.step_ns,
            recording.clock,
            recording.start_ns,
            False if self.losses else recording.complete,
            self.reader.name,
            version_of(self.reader),
            tuple(writer.signals),
            writer.columns,
            tuple(sorted(writer.flagged)),
            (*recording.notes, *([newest_first.NOTE] if writer.newest_first else [])),
            ordered=writer.ordered,
            newest_first=writer.newest_first,
            unordered=writer.unordered and not writer.ordered,
            of_day_ns=recording.of_day_ns,
        )
