"""Finds the files of a campaign and brings them into the raw layer; one bad file doesn't stop the others."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass, field
from pathlib import Path
from typing import Any

from thermodata.errors import StoreError, ThermodataError, UsageError
from thermodata.plugin import Loss, Reader
from thermodata.schema.campaign import Campaign, JumpCalibration, SourceSpec, Test
from thermodata.store.files import sha256_of
from thermodata.store.known import Known
from thermodata.store.plan import SourcePlan, TestPlan
from thermodata.store.raw import RawStream, declared, find_reader, raw_key, read_raw
from thermodata.store.resolve import inside, natural, resolve

Losses = list[dict[str, Any]]


def loss_row(reason: str, *, test: str | None = None, source: str | None = None, file: str | None = None,
             loss: Loss | None = None) -> dict[str, Any]:
    """A loss as the summary tells it; times in seconds of the file's own clock."""
    return {"test": test, "source": source, "file": file, "where": loss.where if loss else None,
            "from_ns": loss.from_ns if loss else None, "to_ns": loss.to_ns if loss else None,
            "fraction": loss.fraction if loss else None, "reason": reason}


@dataclass(slots=True)
class Gatherer:
    """Reads each file once, however many tests share it."""

    store: Path
    folder: Path
    campaign: Campaign
    known: Known
    say: Callable[[str], None]
    losses: Losses = field(default_factory=list)
    notes: list[str] = field(default_factory=list)
    files: set[str] = field(default_factory=set)
    read: int = 0
    _hashes: dict[str, str] = field(default_factory=dict)
    _made: dict[str, list[RawStream] | ThermodataError] = field(default_factory=dict)
    _readers: dict[str, Reader] = field(default_factory=dict)

    def plan(self, test: Test) -> TestPlan:
        """A test with the raw streams of all its sources."""
        plan = TestPlan(self.campaign, test)
        for name, spec in self.campaign.sources.items():
            plan.sources[name] = self._source(test, name, spec)
        missing = [n for n, s in plan.sources.items() if not s.raws]
        if len(missing) == len(plan.sources):
            self.losses.append(loss_row("no data: no file of any source was found or could be read", test=test.id))
        for name in test.files:
            if name not in self.campaign.sources:
                plan.problems.append(f"test '{test.id}': files names an unknown source '{name}'")
        return plan

    def _source(self, test: Test, name: str, spec: SourceSpec) -> SourcePlan:
        found = resolve(self.folder, self.campaign, test, name)
        plan = SourcePlan(name, spec, shared=found.shared)
        for path, why in found.refused:
            self.losses.append(loss_row(f"refused: {why}", test=test.id, source=name, file=path))
        before: dict[str, list[RawStream]] = {}
        for raw in self.known.raw_rows(test.id, name):
            before.setdefault(raw.source_path, []).append(raw)
        for path in sorted({*found.paths, *(p for p in before if found.claims(p))}, key=natural):
            raws = self._file(path, name, spec, before.get(path, []), test.id, gone=path not in found.paths)
            plan.raws += raws
        if not found.paths and not plan.raws and found.patterns:
            text = f"test '{test.id}': no file of source '{name}' ({', '.join(found.patterns)})"
            if found.explicit:
                self.losses.append(loss_row("no such file", test=test.id, source=name, file=found.patterns[0]))
            else:
                self.notes.append(text)
        return plan

    def empty_sources(self, plans: list[TestPlan]) -> None:
        """A loss for each source that channels need and that has no file in any test: a pattern is wrong then."""
        needed = {c.source for c in self.campaign.channels.values()}
        for name, spec in self.campaign.sources.items():
            if name in needed and plans and not any(p.sources[name].raws for p in plans):
                if any(row["source"] == name for row in self.losses):
                    continue
                patterns = [spec.files] if isinstance(spec.files, str) else spec.files or ["no 'files'"]
                self.losses.append(loss_row(f"no file in any test ({', '.join(patterns)}); try: correct "
                                            f"'files' of the source", source=name))

    def jump_files(self) -> dict[str, list[RawStream]]:
        """Calibration -> the raw streams of its jump test."""
        found: dict[str, list[RawStream]] = {}
        for name, spec in self.campaign.calibrations.items():
            if not isinstance(spec, JumpCalibration):
                continue
            path = inside(self.folder, spec.file, f"calibrations.{name}.file")
            before = self.known.raw_rows("", name)
            source = self.campaign.sources[spec.source]
            if path.is_file() or before:
                found[name] = self._file(spec.file, spec.source, source, before, f"calibration {name}",
                                         gone=not path.is_file())
            else:
                self.losses.append(loss_row("no such file: the calibration can't be evaluated", file=spec.file,
                                            test=f"calibration {name}", source=spec.source))
        return found

    def _file(self, path: str, source: str, spec: SourceSpec, before: list[RawStream], test: str,
              gone: bool) -> list[RawStream]:
        """The raw streams of one file; [] and a loss where it can't be read."""
        raws: list[RawStream] = []
        if gone:
            if before and all((self.store / r.path).exists() for r in before):
                self.notes.append(f"{path}: not there any more; the store's raw copy is used")
                raws = before
            elif before:
                raise StoreError("a raw file of the store is gone, and so is its source", where=before[0].path,
                                 got=f"no {path}", hint="put the source file back, or forget the test")
        else:
            reader = self._reader(spec.reader, source)
            try:
                raws = self._read(path, source, spec, reader)
            except StoreError:
                raise
            except (ThermodataError, OSError) as error:
                reason = "; ".join(str(error).splitlines())
                self.losses.append(loss_row(reason, test=test, source=source, file=path))
                return []
        if path not in self.files:
            for loss in (x for r in raws for x in r.losses):
                self.losses.append(loss_row(loss.reason, test=test, source=source, file=path, loss=loss))
        self.files.add(path)
        return raws

    def _reader(self, name: str, source: str) -> Reader:
        """The reader of a source. One that isn't there is no defect of a file: ingest would drop all its data."""
        if name not in self._readers:
            try:
                self._readers[name] = find_reader(name)
            except UsageError as error:
                raise UsageError(error.what, where=f"sources.{source}.reader", expected=error.expected,
                                 got=error.got, hint=error.hint) from error
        return self._readers[name]

    def _read(self, path: str, source: str, spec: SourceSpec, reader: Reader) -> list[RawStream]:
        full = self.folder / path
        if path not in self._hashes:
            self._hashes[path] = sha256_of(full)
        said = declared(source, spec)
        key = raw_key(self._hashes[path], reader, said)
        if key not in self._made:
            if key in self.known.raws:
                self._made[key] = self.known.raws[key]
            else:
                self.say(f"reading {path}")
                try:
                    self._made[key] = read_raw(self.store, full, path, self._hashes[path], reader, said)
                    self.read += 1
                except ThermodataError as error:
                    self._made[key] = error
        made = self._made[key]
        if isinstance(made, ThermodataError):
            raise made
        # the same bytes may stand under another name, in another test or campaign
        return [r if r.source_path == path else _renamed(r, path) for r in made]


def _renamed(raw: RawStream, path: str) -> RawStream:
    import dataclasses

    return dataclasses.replace(raw, source_path=path)
