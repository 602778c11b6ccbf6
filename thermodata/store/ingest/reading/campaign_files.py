"""The raw files that a campaign names: which there are, how large, whose, by which reader, and their hashes."""

from __future__ import annotations

import os
from collections.abc import Collection, Iterable, Iterator, Mapping
from dataclasses import dataclass, field
from pathlib import Path

from thermodata.archive.members import size_of, standing
from thermodata.errors import FormatError, ThermodataError, UsageError
from thermodata.plugin import Reader, Source
from thermodata.reader.contract.guard import described
from thermodata.reader.finding import registry
from thermodata.schema.files.campaign import Campaign, JumpCalibration, SourceSpec, Test
from thermodata.store.ingest.known.unchanged import FirstGlance, seen
from thermodata.store.ingest.progress import Progress
from thermodata.store.ingest.reading.resolve import SourceFiles, resolve
from thermodata.store.ingest.reading.worker import Task
from thermodata.store.raw.raw_stream import RawStream
from thermodata.store.raw.source_file import SourceFile, mark_of, settled
from thermodata.store.raw.streams import RAW_VERSION, declared, find_reader, raw_key, version_of
from thermodata.store.tidy.keys import TIDY_VERSION
from thermodata.version import __version__

_HUGE = 1 << 30  # [bytes] that are hashed in about a second: a smaller file is hashed sooner than looked at twice


@dataclass(slots=True)
class CampaignFiles:
    """Each is looked at once, however many tests share it. store: for which they are read."""

    store: Path
    folder: Path
    campaign: Campaign
    watch: Progress
    _settled: dict[str, SourceFile] = field(default_factory=dict)
    _odd: dict[str, str] = field(default_factory=dict)
    _source_files: dict[tuple[str, str], SourceFiles] = field(default_factory=dict)
    _sizes: dict[str, int] = field(default_factory=dict)
    _readers: dict[str, Reader] = field(default_factory=dict)
    _refused: dict[tuple[str, str], ThermodataError | OSError | None] = field(default_factory=dict)

    def survey(self) -> None:
        """Finds all files, and says how many and how much that is."""
        root, folders = self.folder.resolve(), dict[str, str]()
        for test in self.campaign.tests:
            for name in self.campaign.sources:
                self._source_files[test.id, name] = resolve(self.folder, self.campaign, test, name, root, folders)
                self._odd.update(self._source_files[test.id, name].odd)
        paths = {p for files in self._source_files.values() for p in files.paths}
        paths |= {c.file for c in self.campaign.calibrations.values() if isinstance(c, JumpCalibration)}
        self._sizes = {p: size for p in paths if (size := self._size(p)) is not None}
        self.watch.begin(len(self._sizes), sum(self._sizes.values()))

    def sizes(self) -> dict[str, int]:
        """Source path -> bytes, of those that are not done."""
        return dict(self._sizes)

    def seen(self, campaign_path: Path) -> FirstGlance:
        """What an answer depends on beside the content of the files that were found."""
        versions: dict[str, str | None] = {}
        for source, spec in self.campaign.sources.items():
            try:
                versions[spec.reader] = version_of(self.reader(spec.reader, source))
            except UsageError:  # told where a file needs it
                versions[spec.reader] = None
        jumps = [c.file for c in self.campaign.calibrations.values() if isinstance(c, JumpCalibration)]
        listed = {p for files in self._source_files.values() for p in files.paths}
        return seen(
            self.store,
            campaign_path,
            {path: self.full(path) for path in sorted(listed.union(jumps))},
            self.campaign.model_dump_json(by_alias=True),
            repr(list(self._source_files.items())),
            repr(versions),
            f"{__version__} {RAW_VERSION} {TIDY_VERSION}",
        )

    def narrow(self, tests: Collection[str]) -> None:
        """Leaves the files of all other tests alone."""
        self._source_files = {key: files for key, files in self._source_files.items() if key[0] in tests}
        wanted = {path for path, _, _ in self._wanted_files()}
        for path in [p for p in self._sizes if p not in wanted]:
            self.done(path)

    def tests_with(self, paths: Collection[str]) -> set[str] | None:
        """The tests that have any of the files; None where a calibration has, which every test may need."""
        if any(isinstance(c, JumpCalibration) and c.file in paths for c in self.campaign.calibrations.values()):
            return None
        return {test for (test, _), files in self._source_files.items() if not files.isdisjoint(paths)}

    def of_tests(self) -> dict[str, list[str]]:
        """Test -> the source paths of its files."""
        found: dict[str, list[str]] = {}
        for (test, _), files in self._source_files.items():
            found.setdefault(test, []).extend(files.paths)
        return found

    def of_source(self, test: Test, name: str) -> SourceFiles:
        """The files of one source in one test."""
        return self._source_files.get((test.id, name)) or resolve(self.folder, self.campaign, test, name)

    def keys(self) -> set[str]:
        """The keys of the raw data of all listed files, as they stand now."""
        return {task.key for task in self.tasks()}

    def tasks(self) -> Iterator[Task]:
        """Each listed file as it is to be read, but for those that can't be."""
        for path, source, spec in self._wanted_files():
            try:
                reader, declaration = self.reader(spec.reader, source), declared(source, spec)
                file = self.settle_readable(path, reader, declaration)
            except (ThermodataError, OSError):
                continue  # told where the file is read
            yield Task(raw_key(file.sha256, reader, declaration), self.store, path, file, spec.reader, declaration)

    def _wanted_files(self) -> Iterator[tuple[str, str, SourceSpec]]:
        """(path, source, what is declared of it) of the files whose present content is wanted."""
        for calibration in self.campaign.calibrations.values():
            if isinstance(calibration, JumpCalibration) and calibration.file in self._sizes:
                yield calibration.file, calibration.source, self.campaign.sources[calibration.source]
        for (test, source), files in self._source_files.items():
            for path in files.paths:
                if path not in self.campaign.versions:
                    yield path, source, self.campaign.sources[source].of_test(test)

    def hashed(self, files: Mapping[str, SourceFile]) -> None:
        """Files whose hash is known: they need not be read for it."""
        self._settled.update(files)

    def hashes(self) -> dict[str, str]:
        """Source path -> SHA-256, of all files that were looked at."""
        return {path: file.sha256 for path, file in self._settled.items()}

    def hashes_of(self, paths: Iterable[str], source: str, spec: SourceSpec) -> dict[str, str]:
        """Path -> SHA-256, of the files that can be read. spec: what is declared of the source."""
        hashes: dict[str, str] = {}
        for path in paths:
            try:
                reader = self.reader(spec.reader, source)
                hashes[path] = self.settle_readable(path, reader, declared(source, spec)).sha256
            except (OSError, ThermodataError):
                continue  # told where the file is read
        return hashes

    def settle(self, path: str) -> SourceFile:
        """A file with its hash; FormatError or OSError where it can't be read whole."""
        if path not in self._settled:
            self._settled[path] = settled(self.full(path))
        return self._settled[path]

    def settle_readable(self, path: str, reader: Reader, declaration: Source) -> SourceFile:
        """The same of a file that its reader can describe: a huge one that it refuses is not hashed for that, but where
        it is being written, and may end otherwise. What the reader says is raised."""
        if path in self._settled or (self._size(path) or 0) < _HUGE:
            return self.settle(path)
        asked = path, raw_key("", reader, declaration)
        if asked not in self._refused:
            full, self._refused[asked] = self.full(path), None
            before = mark_of(os.stat(standing(full)))
            try:
                described(reader, full, declaration)
            except (ThermodataError, OSError) as error:
                if mark_of(os.stat(standing(full))) == before:
                    self._refused[asked] = error
        if (refused := self._refused[asked]) is not None:
            raise refused
        return self.settle(path)

    def instead(self, path: str, copy: SourceFile) -> None:
        """A copy that stands for a file which changed while it was read."""
        self._settled[path] = copy

    def done(self, path: str) -> None:
        """Says that a file needs no more looking at."""
        size = self._sizes.pop(path, None)
        if size is not None:
            self.watch.done(path, size)

    def full(self, path: str) -> Path:
        """Where a source path stands on the disk."""
        return self.folder / self._odd.get(path, path)

    def renamed_to(self, before: list[RawStream], paths: Iterable[str]) -> str | None:
        """The present file with the bytes of one that is gone."""
        return next((p for p in paths if p in self._settled and self._settled[p].sha256 == before[0].sha256), None)

    def reader(self, name: str, source: str) -> Reader:
        """The reader of a source. One that isn't there is no defect of a file: ingest would drop all its data."""
        if name not in self._readers:
            try:
                self._readers[name] = find_reader(name)
            except UsageError as error:
                raise UsageError(
                    error.what,
                    where=f"sources.{source}.reader",
                    expected=error.expected,
                    got=error.got,
                    hint=error.hint,
                ) from error
        return self._readers[name]

    def is_installed(self, reader: str) -> bool:
        """Whether a reader of the campaign is the installed one, which other processes find too."""
        return registry.readers().get(reader) is self._readers[reader]

    def _size(self, path: str) -> int | None:
        try:
            return size_of(self.full(path))
        except (OSError, ValueError, FormatError):
            return None
