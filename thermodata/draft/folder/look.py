"""One look at each file of a folder: who reads it, and the parts of it that are logs; or why it is none. And the values
of those that are, as far as there is time."""

from __future__ import annotations

from collections.abc import Callable, Mapping
from dataclasses import dataclass, field, replace
from pathlib import Path, PurePosixPath

from thermodata.archive.members import size_of
from thermodata.draft.files.blocks import by_tests, is_of_series, not_as_series
from thermodata.draft.files.described_file import claimant, described_file, sample_of_file, sheet_by_sheet
from thermodata.draft.files.letters_of_files import common
from thermodata.draft.files.raw_file import RawFile
from thermodata.draft.files.sample import SMALL, Watch, short
from thermodata.draft.folder.files import shape_of, spread
from thermodata.draft.folder.into_sources.of_one_time import of_one_time
from thermodata.errors import ThermodataError
from thermodata.plugin import Reader, Recording
from thermodata.schema.agreed.left_out import CANT_READ
from thermodata.schema.strict.lines import is_text

_SAMPLES_S = 15.0  # of the whole folder, as are the headers
_HEADERS_S = 40.0
_UNREAD = (ThermodataError, OSError, MemoryError)  # of one file: the others are drafted all the same
Progress = Callable[[int, int, str], None]
"""Gets how many of how many are done, and the path of the next one."""


@dataclass(slots=True)
class Look:
    """One look at each file. copies, beginnings, unfinished: file -> the other one that holds the same. logs: by file,
    or file and part; shapes: a log of each kind of name; apart: file -> (as a whole, its sheets). spent_s: on what
    costs more than the headers."""

    folder: Path
    encoding: str | None
    copies: Mapping[PurePosixPath, PurePosixPath]
    beginnings: Mapping[PurePosixPath, PurePosixPath]
    unfinished: Mapping[PurePosixPath, PurePosixPath]
    logs: dict[str, RawFile] = field(default_factory=dict)
    ignored: list[tuple[str, str]] = field(default_factory=list)
    failed: list[tuple[str, str]] = field(default_factory=list)
    apart: dict[str, tuple[RawFile, list[RawFile]]] = field(default_factory=dict)
    _shapes: dict[str, RawFile] = field(default_factory=dict)
    _watch: Watch = field(default_factory=Watch)
    _spent_s: float = 0.0

    def at(self, path: PurePosixPath) -> None:
        """Takes a file for a log, or says why it is none."""
        if (said := self._why_no_log(path)) is not None:
            self.ignored.append((str(path), said))
            return
        try:
            like = self._shapes.get(shape_of(path)) if self._watch.spent_s > _HEADERS_S else None
            if like is not None and like.part is None:
                self.logs[str(path)] = _as_like(like, path, self.folder / path)
                return
            who, why = claimant(self.folder / path)
            if who is None:
                self.ignored.append((str(path), why))
            elif (read := self._parts(who, path)) is not None:
                self._keep(who, path, read[0], self._sampled_now(path, *read))
        except _UNREAD as error:
            self.ignored.append((str(path), short(error)))

    def again_as_others(self) -> None:
        """Looks once more at files that no reader could read, in the one encoding that the others tell."""
        told = common(f.letters for f in self.logs.values())
        if self.encoding is not None or told is None:
            return
        self.encoding, again = told, {path for path, _ in self.failed}
        self.failed = []
        self.ignored = [(path, why) for path, why in self.ignored if path not in again]
        for path in sorted(again):
            self.at(PurePosixPath(path))

    def _why_no_log(self, path: PurePosixPath) -> str | None:
        """Why a file is not even asked about: by its name, or another one that holds the same; None where it is."""
        if not is_text(str(path)):
            return "its name is no UTF-8: no campaign file can say it; give it another name"
        if path in self.copies:
            return f"a copy of {self.copies[path]}: their bytes are equal"
        if path in self.beginnings:
            of = self.beginnings[path]
            return f"the beginning of {of}, byte by byte: an earlier state of it, and no test of its own"
        if path in self.unfinished:
            return f"by its name a half-written copy of {self.unfinished[path]}, which is there"
        return None

    def _parts(self, who: Reader, path: PurePosixPath) -> tuple[RawFile, list[RawFile]] | None:
        """(the file as a whole, the parts of it that are logs); None where its reader can't read it."""
        full = self.folder / path
        try:
            whole = described_file(who, full, path, self.encoding)
            found = sheet_by_sheet(who, full, whole)
            watch = Watch()
            if len(found) == 1:
                found = self._by_rows(who, path, whole) or found
            self._spent_s += watch.spent_s
        except _UNREAD as error:
            tests = self._not_as_series(who, path, None)
            if tests is not None:
                return tests[0], tests
            self.failed.append((str(path), who.name))
            self.ignored.append((str(path), f"reader '{who.name}' {CANT_READ}: {short(error)}{_try(error)}"))
            return None
        return whole, found

    def _by_rows(self, who: Reader, path: PurePosixPath, whole: RawFile) -> list[RawFile] | None:
        """The parts of a file that are tests, by its series or by words in its rows."""
        if is_of_series(whole):
            return self._not_as_series(who, path, whole)
        return by_tests(who, self.folder / path, whole, self._left_s)

    def _not_as_series(self, who: Reader, path: PurePosixPath, whole: RawFile | None) -> list[RawFile] | None:
        """The parts of a file whose series are read as one table; None where that can't be read either."""
        try:
            return not_as_series(who, self.folder / path, path, self.encoding, whole, self._left_s)
        except _UNREAD:
            return None

    @property
    def _left_s(self) -> float:
        """Of the time for samples [s]."""
        return _SAMPLES_S - self._spent_s

    def _sampled_now(self, path: PurePosixPath, whole: RawFile, found: list[RawFile]) -> list[RawFile]:
        """The parts, or the one log that they are; of a small file with samples now, for its reader has just
        looked at it."""
        full = self.folder / path
        small = whole.size < SMALL and self._spent_s < _SAMPLES_S
        watch = Watch()
        if small:
            found = [made if made.block else replace(made, sample=sample_of_file(full, made)) for made in found]
        if (once := of_one_time(whole, found)) is not None:
            found = [replace(once, sample=sample_of_file(full, once)) if small else once]
        if small:
            self._spent_s += watch.spent_s
        return found

    def _keep(self, who: Reader, path: PurePosixPath, whole: RawFile, found: list[RawFile]) -> None:
        self.ignored += [(str(path), why) for why in found[0].besides]
        if found[0].sheet:
            self.apart[str(path)] = (whole, found)
        for made in found:
            key = str(path) if made.part is None else f"{path}/{made.part}"
            self.logs[key] = self._shapes[shape_of(path)] = made
        if str(path) in self.logs and not self.logs[str(path)].signals:
            del self.logs[str(path)]
            self.ignored.append((str(path), f"{who.name}: it holds no signal"))


def _as_like(like: RawFile, path: PurePosixPath, full: Path) -> RawFile:
    """A file that nobody opened, as one of the same kind is; when it began is not known."""
    return RawFile(
        path,
        like.reader,
        Recording(like.recording.signals, like.recording.clock, None, None, ()),
        size_of(full),
        like=str(like.path),
        asked=like.asked,
        table=like.table,
        letters=like.letters,
    )


def _try(error: Exception) -> str:
    hint = getattr(error, "hint", None)
    return f"; try: {hint}" if hint else ""


def sampled(folder: Path, logs: Mapping[str, RawFile], tell: Progress) -> list[RawFile]:
    """The logs with samples of their values, small files first: jump tests are small."""
    found = dict(logs)
    order = spread([PurePosixPath(key) for key in sorted(logs, key=lambda key: logs[key].size)])
    watch = Watch()
    for done, path in enumerate(order):
        file = found[str(path)]
        if watch.spent_s > _SAMPLES_S or file.like or file.sample.rows:
            continue
        tell(done, len(order), str(path))
        found[str(path)] = replace(file, sample=sample_of_file(folder / file.path, file))
    return list(found.values())
