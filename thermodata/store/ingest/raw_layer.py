"""Finds the files of a campaign and brings them into the raw layer; one bad file doesn't stop the others."""

from __future__ import annotations

import os
from collections.abc import Collection, Iterable, Iterator, Mapping
from dataclasses import dataclass, field, replace
from pathlib import Path

from thermodata.errors import FormatError, StoreError, ThermodataError, UsageError, nearest
from thermodata.plugin import Reader, Source
from thermodata.reader import registry
from thermodata.schema.campaign import Campaign, JumpCalibration, SourceSpec, Test
from thermodata.store.base.files import DISK_FULL, is_whole, write_error
from thermodata.store.ingest.file_versions import pinned, read_otherwise, twins
from thermodata.store.ingest.inventory import Inventory
from thermodata.store.ingest.left_alone import TestNote
from thermodata.store.ingest.losses import Losses, Said, loss_row
from thermodata.store.ingest.progress import Progress, counted
from thermodata.store.ingest.resolve import SourceFiles, file_inside, natural, resolve
from thermodata.store.ingest.side_by_side import read_side_by_side, workers_for
from thermodata.store.ingest.unchanged import Seen, seen
from thermodata.store.ingest.worker import Task
from thermodata.store.raw.source_file import ChangedError, SourceFile, frozen, settled
from thermodata.store.raw.streams import RAW_VERSION, RawStream, declared, find_reader, raw_key, read_raw, version_of
from thermodata.store.tidy.keys import TIDY_VERSION
from thermodata.store.tidy.plan import SourcePlan, TestPlan
from thermodata.version import __version__


@dataclass(slots=True)
class RawIngest:
    """Reads each file once, however many tests share it."""

    store: Path
    folder: Path
    campaign: Campaign
    inventory: Inventory
    watch: Progress
    # test -> what is said of it ('': of what belongs to none)
    said: dict[str, Said] = field(default_factory=lambda: {"": Said()})
    read: int = 0
    _test: str = ""
    # what was said of this time only, and not when the same is ingested again
    passing: bool = False
    _told: set[str] = field(default_factory=set)
    _settled: dict[str, SourceFile] = field(default_factory=dict)
    _odd: dict[str, str] = field(default_factory=dict)
    _source_files: dict[tuple[str, str], SourceFiles] = field(default_factory=dict)
    _sizes: dict[str, int] = field(default_factory=dict)
    _streams: dict[str, list[RawStream] | ThermodataError | OSError] = field(default_factory=dict)
    _readers: dict[str, Reader] = field(default_factory=dict)

    @property
    def losses(self) -> Losses:
        """Those of the test that is being planned."""
        return self.said[self._test].losses

    @property
    def notes(self) -> list[str]:
        """Those of the test that is being planned."""
        return self.said[self._test].notes

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

    def seen(self, campaign_path: Path) -> Seen:
        """What an answer depends on beside the content of the files that were found."""
        versions: dict[str, str | None] = {}
        for source, spec in self.campaign.sources.items():
            try:
                versions[spec.reader] = version_of(self._reader(spec.reader, source))
            except UsageError:  # told where a file needs it
                versions[spec.reader] = None
        jumps = [c.file for c in self.campaign.calibrations.values() if isinstance(c, JumpCalibration)]
        listed = {p for files in self._source_files.values() for p in files.paths}
        return seen(
            self.store,
            campaign_path,
            {path: self._full(path) for path in sorted(listed.union(jumps))},
            self.campaign.model_dump_json(by_alias=True),
            repr(list(self._source_files.items())),
            repr(versions),
            f"{__version__} {RAW_VERSION} {TIDY_VERSION}",
        )

    def narrow(self, tests: Collection[str]) -> None:
        """Leaves the files of all other tests alone."""
        self._source_files = {key: files for key, files in self._source_files.items() if key[0] in tests}
        wanted = {path for path, _, _ in self._listed()}
        for path in [p for p in self._sizes if p not in wanted]:
            self._done(path)

    def tests_with(self, paths: Collection[str]) -> set[str] | None:
        """The tests that have any of the files; None where a calibration has, which every test may need."""
        if any(isinstance(c, JumpCalibration) and c.file in paths for c in self.campaign.calibrations.values()):
            return None
        return {test for (test, _), files in self._source_files.items() if not files.isdisjoint(paths)}

    def files_of_tests(self) -> dict[str, list[str]]:
        """Test -> the source paths of its files."""
        found: dict[str, list[str]] = {}
        for (test, _), files in self._source_files.items():
            found.setdefault(test, []).extend(files.paths)
        return found

    def keys(self) -> set[str]:
        """The keys of the raw data of all listed files, as they stand now."""
        return {task.key for task in self._listed_tasks()}

    def read_ahead(self) -> None:
        """Reads what the store doesn't hold yet, several files side by side where that pays. What can't be read so is
        left to whoever asks for it."""
        known = {
            (row["source_path"], row["bytes"])
            for rows in self.inventory.rows.get("file", {}).values()
            for row in rows
            if row["layer"] == "raw"
        }
        new = [(p, size) for p, size in self._sizes.items() if (p, size) not in known]
        workers = workers_for(len(new), sum(size for _, size in new))
        if not workers:
            return
        self.watch.say(f"reading {workers} files at a time")
        for task, found in read_side_by_side(self._tasks(), workers, self.watch.samples):
            if isinstance(found, StoreError):
                raise _with_room(found, task.path, task.file)
            if isinstance(found, list | ThermodataError | OSError):
                self._streams[task.key] = found
                self.read += isinstance(found, list)
                self._done(task.path)
            elif found is not None:
                raise found

    def _tasks(self) -> Iterator[Task]:
        """Each file once that an installed reader is to read, in the order in which it will be asked for."""
        asked: set[str] = set()
        for task in self._listed_tasks():
            if (
                task.key in asked
                or task.key in self.inventory.raws
                or registry.readers().get(task.reader) is not self._readers[task.reader]
            ):
                continue
            asked.add(task.key)
            yield task

    def _listed_tasks(self) -> Iterator[Task]:
        for path, source, spec in self._listed():
            try:
                reader, file = self._reader(spec.reader, source), self._settle(path)
            except (ThermodataError, OSError):
                continue  # told where the file is read
            declaration = declared(source, spec)
            yield Task(raw_key(file.sha256, reader, declaration), self.store, path, file, spec.reader, declaration)

    def _listed(self) -> Iterator[tuple[str, str, SourceSpec]]:
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

    def _size(self, path: str) -> int | None:
        try:
            return os.stat(os.path.join(self.folder, self._odd.get(path, path))).st_size
        except (OSError, ValueError):
            return None

    def plan(self, test: Test) -> TestPlan:
        """A test with the raw streams of all its sources."""
        self._test, self.said[test.id] = test.id, Said()
        plan = TestPlan(self.campaign, test)
        for name, spec in self.campaign.sources.items():
            plan.sources[name] = self._source(test, name, spec.of_test(test.id))
        missing = [n for n, s in plan.sources.items() if not s.raws]
        if len(missing) == len(plan.sources):
            self.losses.append(loss_row("no data: no file of any source was found or could be read", test=test.id))
        for name in test.files:
            if name not in self.campaign.sources:
                plan.problems.append(f"test '{test.id}': files names an unknown source '{name}'")
        return plan

    def _source(self, test: Test, name: str, spec: SourceSpec) -> SourcePlan:
        files = self._source_files.get((test.id, name)) or resolve(self.folder, self.campaign, test, name)
        plan = SourcePlan(name, spec, shared=files.shared)
        for path, why in files.refused:
            self.losses.append(loss_row(f"refused: {why}", test=test.id, source=name, file=path))
        before: dict[str, list[RawStream]] = {}
        for raw in self.inventory.raw_rows(test.id, name):
            before.setdefault(raw.source_path, []).append(raw)
        there = set(files.paths)
        same = twins(files.paths, self._hashes(files.paths))
        for path in sorted({*there, *(p for p in before if p not in there and files.claims(p))}, key=natural):
            if path in same:
                self.notes.append(f"{path}: left out, its content is that of {same[path]}")
                self._done(path)
            elif path not in there and (new := self._renamed_to(before[path], files.paths)):
                self.notes.append(f"{path}: is {new} now, with the same content")
                self.passing = True
            else:
                plan.raws += self._file(
                    path, name, spec, before.get(path, []), test.id, (test.id, name), gone=path not in there
                )
        if not files.paths and not plan.raws and files.patterns:
            text = f"test '{test.id}': no file of source '{name}' ({', '.join(files.patterns)})"
            if files.explicit:
                self.losses.append(loss_row("no such file", test=test.id, source=name, file=files.patterns[0]))
            else:
                self.notes.append(text)
        return plan

    def empty_sources(self, tests: Collection[TestNote]) -> Losses:
        """A loss for each source that channels need and that has no file in any test: a pattern is wrong then."""
        found: Losses = []
        needed = {c.source for c in self.campaign.channels.values()}
        told = {row["source"] for losses in (self.said[""].losses, *(t.losses for t in tests)) for row in losses}
        for name, spec in self.campaign.sources.items():
            if name in needed - told and tests and not any(name in t.sources for t in tests):
                patterns = [spec.files] if isinstance(spec.files, str) else spec.files or ["no 'files'"]
                found.append(
                    loss_row(
                        f"no file in any test ({', '.join(patterns)}); try: correct 'files' of the source", source=name
                    )
                )
        return found

    def jump_files(self) -> dict[str, list[RawStream]]:
        """Calibration -> the raw streams of its jump test."""
        self._test = ""
        streams: dict[str, list[RawStream]] = {}
        for name, spec in self.campaign.calibrations.items():
            if not isinstance(spec, JumpCalibration):
                continue
            path = file_inside(self.folder, spec.file, f"calibrations.{name}.file")
            # a copy of another file is of another probe, or of another day
            before = [r for r in self.inventory.raw_rows("", name) if r.source_path == spec.file]
            source = self.campaign.sources[spec.source]
            if path.is_file() or before:
                streams[name] = self._file(
                    spec.file, spec.source, source, before, f"calibration {name}", ("", name), gone=not path.is_file()
                )
            else:
                near = nearest(path.name, [p.name for p in path.parent.glob("*")] if path.parent.is_dir() else [])
                self.losses.append(
                    loss_row(
                        "no such file: the calibration can't be evaluated"
                        + (f"; did you mean '{near}'?" if near else ""),
                        file=spec.file,
                        test=f"calibration {name}",
                        source=spec.source,
                    )
                )
        return streams

    def _file(
        self,
        path: str,
        source: str,
        spec: SourceSpec,
        before: list[RawStream],
        test: str,
        kept_as: tuple[str, str],
        gone: bool,
    ) -> list[RawStream]:
        """The raw streams of one file; [] and a loss where it can't be read. kept_as: test and source of its rows."""
        raws: list[RawStream] = []
        reader = self._reader(spec.reader, source)
        if path in self.campaign.versions:
            raws = pinned(self.inventory, *kept_as, path, self.campaign.versions[path])
            self.notes.append(f"{path}: version {raws[0].sha256[:12]}, as the campaign file wants")
        elif gone:
            raws = self._copy(path, before, reader, declared(source, spec))
        else:
            try:
                raws = self._read(path, source, spec, reader)
            except StoreError:
                raise
            except (ThermodataError, OSError) as error:
                if isinstance(error, OSError) and str(error.filename).startswith(str(self.store)):
                    raise write_error(Path(error.filename), error) from error
                self.passing = True  # the next time it may be read
                reason = "; ".join(str(error).splitlines())
                self.losses.append(loss_row(reason, test=test, source=source, file=path))
                raws = self._former(path, before)
                if not raws:
                    self._done(path)
                    return []
        self._done(path)
        fresh = {r.key for r in raws} - self._told  # of a workbook each sheet is raw data of its own
        self._told |= fresh
        if fresh:
            for loss in (x for r in raws for x in r.losses):
                self.losses.append(loss_row(loss.reason, test=test, source=source, file=path, loss=loss))
        return raws

    def _copy(self, path: str, before: list[RawStream], reader: Reader, declaration: Source) -> list[RawStream]:
        """The store's own copy of a file that isn't there any more."""
        if before and not all(is_whole(self.store / r.path) for r in before):
            raise StoreError(
                "a raw file of the store is gone or cut, and its source is gone",
                where=before[0].path,
                got=f"no {path}",
                hint="put the source file back, or forget the test",
            )
        if before:
            self.notes.append(f"{path}: not there any more; the store's raw copy is used")
            why = read_otherwise(before[0], reader, declaration)
            if why is not None:
                self.losses.append(loss_row(f"not there to be read again: the store's raw copy was {why}", file=path))
        return before

    def _former(self, path: str, before: list[RawStream]) -> list[RawStream]:
        """What the store holds of a file that can't be read now: what was read once isn't lost by that."""
        hashed = self._settled.get(path)
        if (
            not before
            or not all(is_whole(self.store / r.path) for r in before)
            or (hashed is not None and hashed.sha256 == before[0].sha256)
        ):
            return []  # a reader that refuses the bytes that an older one took has its reason
        self.notes.append(f"{path}: the version that was read before is used ({before[0].sha256[:12]})")
        return before

    def _hashes(self, paths: Iterable[str]) -> dict[str, str]:
        """Path -> SHA-256, of the files that can be read."""
        hashes: dict[str, str] = {}
        for path in paths:
            try:
                hashes[path] = self._settle(path).sha256
            except (OSError, ThermodataError):
                continue  # told where the file is read
        return hashes

    def _settle(self, path: str) -> SourceFile:
        if path not in self._settled:
            self._settled[path] = settled(self._full(path))
        return self._settled[path]

    def _done(self, path: str) -> None:
        size = self._sizes.pop(path, None)
        if size is not None:
            self.watch.done(path, size)

    def _full(self, path: str) -> Path:
        return self.folder / self._odd.get(path, path)

    def _renamed_to(self, before: list[RawStream], paths: Iterable[str]) -> str | None:
        """The present file with the bytes of one that is gone."""
        return next((p for p in paths if p in self._settled and self._settled[p].sha256 == before[0].sha256), None)

    def _reader(self, name: str, source: str) -> Reader:
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

    def _read(self, path: str, source: str, spec: SourceSpec, reader: Reader) -> list[RawStream]:
        file = self._settle(path)
        declaration = declared(source, spec)
        key = raw_key(file.sha256, reader, declaration)
        if key not in self._streams:
            if key in self.inventory.raws:
                self._streams[key] = self.inventory.raws[key]
            else:
                self.watch.say(f"reading {path}")
                try:
                    self._streams[key] = self._read_settled(path, file, reader, declaration)
                    self.read += 1
                except StoreError as error:
                    raise _with_room(error, path, file) from error
                except (ThermodataError, OSError) as error:
                    self._streams[key] = error
        streams = self._streams[key]
        if isinstance(streams, Exception):
            raise streams
        # the same bytes may stand under another name, in another test or campaign
        return [r if r.source_path == path else _renamed(r, path) for r in streams]

    def _read_settled(self, path: str, file: SourceFile, reader: Reader, declaration: Source) -> list[RawStream]:
        """Reads a file so that hash and rows agree: where it changes meanwhile, from a copy of what is there now."""
        try:
            try:
                return read_raw(
                    self.store, file.path, path, file.sha256, counted(reader, self.watch), declaration, file.check
                )
            except FormatError:
                file.check()  # half of a file that is being written may look like a damaged one
                raise
        except ChangedError:
            with frozen(self._full(path), self.store / "raw") as copy:
                raws = self.inventory.raws.get(raw_key(copy.sha256, reader, declaration)) or read_raw(
                    self.store, copy.path, path, copy.sha256, counted(reader, self.watch), declaration
                )
            self._settled[path] = copy
            self.notes.append(f"{path}: {copy.note}")
            self.passing = True
            return [replace(r, notes=tuple(dict.fromkeys((*r.notes, copy.note or "")))) for r in raws]


def _renamed(raw: RawStream, path: str) -> RawStream:
    return replace(raw, source_path=path)


def _with_room(error: StoreError, path: str, file: SourceFile) -> StoreError:
    """The same error; where the disk is full, with how much room the file takes."""
    if error.what != DISK_FULL:
        return error
    # raw Parquet takes about as much as the log, and the tidy layer as much again
    needed = f"about {max(1, 2 * file.bytes // 1_000_000)} MB for {path}"
    return StoreError(error.what, where=error.where, expected=needed, got=error.got, hint=error.hint)
