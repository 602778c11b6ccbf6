"""Looks at every file of a folder: who reads it, what it holds, and a bounded sample of its values.

A folder may hold 50 GB: heads and headers are read of every file, values of the first blocks only, and of a few files
of each kind once the time for it is used up.
"""

from __future__ import annotations

import re
from collections.abc import Callable, Iterator, Mapping, Sequence
from dataclasses import dataclass, field, replace
from pathlib import Path, PurePosixPath

from thermodata.archive.cut import cut_archives
from thermodata.archive.members import size_of
from thermodata.draft.files.blocks import by_tests, is_of_series, not_as_series
from thermodata.draft.files.letters_of_files import common
from thermodata.draft.files.raw_file import (
    RawFile,
    claimant,
    described_file,
    of_one_sheet,
    sample_of_file,
    sheet_by_sheet,
)
from thermodata.draft.files.sample import SMALL, Watch, short
from thermodata.draft.folder.into_sources.lent_names import with_lent_names
from thermodata.draft.folder.into_sources.of_one_time import in_every_file, of_one_time
from thermodata.draft.folder.put_aside.file_copies import beginnings_in, copies_in, unfinished_in
from thermodata.draft.folder.put_aside.packed_copies import by_archive, packed_copies
from thermodata.draft.folder.put_aside.settings import settings_in
from thermodata.errors import ThermodataError
from thermodata.plugin import Reader, Recording
from thermodata.reader.files.stores import within_stores
from thermodata.reader.finding.registry import files_in
from thermodata.schema.agreed.left_out import CANT_READ
from thermodata.schema.strict.lines import is_text
from thermodata.schema.words.sentences import counted

_SAMPLES_S, _HEADERS_S = 15.0, 40.0  # of the whole folder
_UNREAD = (ThermodataError, OSError, MemoryError)  # of one file: the others are drafted all the same
_NOT_LOGS = frozenset((".yaml", ".yml", ".md", ".tdms_index"))
Progress = Callable[[int, int, str], None]


@dataclass(frozen=True, slots=True)
class Scan:
    """logs: files to draft from; ignored: (path, reason) of the others; failed: (path, reader) of those among them that
    a reader claims and could not read; damaged: (path, what) of logs with a defect; others: files that are no logs but
    may be tables of tests."""

    logs: tuple[RawFile, ...]
    ignored: tuple[tuple[str, str], ...] = ()
    damaged: tuple[tuple[str, str], ...] = ()
    others: tuple[str, ...] = ()
    failed: tuple[tuple[str, str], ...] = ()


def scan(folder: Path, progress: Progress | None = None, encoding: str | None = None) -> Scan:
    """All files below the folder; hidden ones, stores and links are left out. progress: (done, of, path); encoding:
    what somebody declared for texts that are no UTF-8."""
    paths = list(_files(folder))
    tell = progress or (lambda done, of, path: None)
    copies, unfinished = copies_in(folder, paths) | packed_copies(folder, paths), unfinished_in(paths)
    beginnings = beginnings_in(folder, [p for p in paths if p not in copies and p not in unfinished])
    look = _Look(folder, encoding, copies, beginnings, unfinished)
    for done, path in enumerate(_spread(paths)):
        tell(done, len(paths), str(path))
        look.at(path)
    look.again_as_others()
    logs = look.logs
    for one, whole in in_every_file(look.apart).items():
        logs = {key: made for key, made in logs.items() if str(made.path) != one} | {one: whole}
    logs = _with_single_sheets(folder, logs)
    sampled = _sampled(folder, logs, tell)
    damaged = list(dict.fromkeys((str(f.path), _damage(f)) for f in sampled if _damage(f)))
    damaged += cut_archives(map(str, paths), lambda path: folder / path).items()
    position = {str(p): i for i, p in enumerate(paths)}
    ignored, failed = (sorted(told, key=lambda item: position[item[0]]) for told in (look.ignored, look.failed))
    ignored = by_archive(folder, ignored, [path for path, _ in failed], [str(f.path) for f in sampled])
    no_lists = {str(p) for p in (*copies, *unfinished, *beginnings)}  # a log is no list of tests
    return Scan(
        with_lent_names(folder, sorted(sampled, key=lambda f: position[str(f.path)])),
        (*ignored, *settings_in(folder)),
        tuple(damaged),
        tuple(dict.fromkeys(p for p, _ in ignored if p not in no_lists)),
        tuple(failed),
    )


@dataclass(slots=True)
class _Look:
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
        if (said := self._is_no_log(path)) is not None:
            self.ignored.append((str(path), said))
            return
        try:
            like = self._shapes.get(_shape(path)) if self._watch.spent_s > _HEADERS_S else None
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

    def _is_no_log(self, path: PurePosixPath) -> str | None:
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
                found = _by_rows(who, full, path, self.encoding, whole, _SAMPLES_S - self._spent_s) or found
            self._spent_s += watch.spent_s
        except _UNREAD as error:
            tests = _not_as_series(who, full, path, self.encoding, None, _SAMPLES_S - self._spent_s)
            if tests is not None:
                return tests[0], tests
            self.failed.append((str(path), who.name))
            self.ignored.append((str(path), f"reader '{who.name}' {CANT_READ}: {short(error)}{_try(error)}"))
            return None
        return whole, found

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
            self.logs[key] = self._shapes[_shape(path)] = made
        if str(path) in self.logs and not self.logs[str(path)].signals:
            del self.logs[str(path)]
            self.ignored.append((str(path), f"{who.name}: it holds no signal"))


def _with_single_sheets(folder: Path, logs: Mapping[str, RawFile]) -> dict[str, RawFile]:
    """The logs, those of one sheet as that where the sheets of others of their kind are tests."""
    apart = [f for f in logs.values() if f.sheet]
    found = {}
    for key, file in logs.items():
        made = of_one_sheet(folder / file.path, file, apart) if apart and file.part is None and not file.like else file
        found[key if made is file else f"{key}/{made.part}"] = made
    return found


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


def _by_rows(
    who: Reader, full: Path, path: PurePosixPath, encoding: str | None, whole: RawFile, left_s: float
) -> list[RawFile] | None:
    """The parts of a file that are tests, by its series or by words in its rows."""
    if is_of_series(whole):
        return _not_as_series(who, full, path, encoding, whole, left_s)
    return by_tests(who, full, whole, left_s)


def _not_as_series(
    who: Reader, full: Path, path: PurePosixPath, encoding: str | None, whole: RawFile | None, left_s: float
) -> list[RawFile] | None:
    try:
        return not_as_series(who, full, path, encoding, whole, left_s)
    except _UNREAD:
        return None


def _try(error: Exception) -> str:
    hint = getattr(error, "hint", None)
    return f"; try: {hint}" if hint else ""


def _files(folder: Path) -> Iterator[PurePosixPath]:
    in_store = within_stores(folder)
    for path in sorted(folder.rglob("*"), key=lambda p: natural(p.relative_to(folder).as_posix())):
        inside = PurePosixPath(path.relative_to(folder).as_posix())
        hidden = any(p.startswith((".", "~$")) for p in inside.parts) or in_store(path)
        if not hidden and path.is_file() and not path.is_symlink() and _may_be_log(path):
            yield from (PurePosixPath(p.relative_to(folder).as_posix()) for p in files_in(path) if _may_be_log(p))


def _may_be_log(path: Path) -> bool:
    return path.suffix.lower() not in _NOT_LOGS


def natural(text: str) -> list[tuple[int, int, str]]:
    """Sort key that puts run_2 before run_10."""
    return [(0, int(part), "") if part.isdecimal() else (1, 0, part) for part in re.split(r"(\d+)", text) if part]


def _shape(path: PurePosixPath) -> str:
    """Its name without digits: files of one kind have the same."""
    return re.sub(r"\d+", "#", str(path))


def _spread(paths: Sequence[PurePosixPath]) -> list[PurePosixPath]:
    """One of each kind first, then the second ones: whatever time there is, every kind is looked at."""
    seen: dict[str, int] = {}
    ranked = []
    for i, path in enumerate(paths):
        shape = _shape(path)
        seen[shape] = seen.get(shape, 0) + 1
        ranked.append((seen[shape], i, path))
    return [path for _, _, path in sorted(ranked)]


def _damage(file: RawFile) -> str:
    if file.sample.failed:
        return f"reader '{file.reader}' stopped in it: {file.sample.failed}"
    if file.recording.complete is False:
        wrong = [n for n in file.recording.notes if re.search(r"cut|damag|end|incomplete|lost|truncat|missing|past", n)]
        return wrong[0] if wrong else "it does not end as it should"
    lost = file.sample.losses
    return f"{counted(lost, 'loss')} in what was read of it" if lost else ""


def _sampled(folder: Path, logs: Mapping[str, RawFile], tell: Progress) -> list[RawFile]:
    """The logs with samples of their values, small files first: jump tests are small."""
    found = dict(logs)
    order = _spread([PurePosixPath(key) for key in sorted(logs, key=lambda key: logs[key].size)])
    watch = Watch()
    for done, path in enumerate(order):
        file = found[str(path)]
        if watch.spent_s > _SAMPLES_S or file.like or file.sample.rows:
            continue
        tell(done, len(order), str(path))
        found[str(path)] = replace(file, sample=sample_of_file(folder / file.path, file))
    return list(found.values())
