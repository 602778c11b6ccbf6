"""Looks at every file of a folder: who reads it, what it holds, and a bounded sample of its values.

A folder may hold 50 GB: heads and headers are read of every file, values of the first blocks only, and of a few files
of each kind once the time for it is used up.
"""

from __future__ import annotations

import re
from collections.abc import Callable, Iterator, Mapping, Sequence
from dataclasses import dataclass, replace
from pathlib import Path, PurePosixPath

from thermodata.draft.files.blocks import by_tests, is_of_series, not_as_series
from thermodata.draft.files.raw_file import RawFile, claimant, described_file, sample_of_file, sheet_by_sheet
from thermodata.draft.files.sample import SMALL, Watch, short
from thermodata.draft.folder.file_copies import beginnings_in, copies_in, unfinished_in
from thermodata.draft.folder.lent_names import with_lent_names
from thermodata.draft.folder.of_one_time import in_every_file, of_one_time
from thermodata.errors import ThermodataError
from thermodata.plugin import Reader, Recording
from thermodata.reader.stores import within_stores
from thermodata.schema.counted import counted
from thermodata.schema.left_out import CANT_READ
from thermodata.schema.lines import is_text

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
    watch, spent = Watch(), 0.0
    logs: dict[str, RawFile] = {}
    ignored: list[tuple[str, str]] = []
    failed: list[tuple[str, str]] = []
    shapes: dict[str, RawFile] = {}
    apart: dict[str, tuple[RawFile, list[RawFile]]] = {}
    copies, unfinished = copies_in(folder, paths), unfinished_in(paths)
    beginnings = beginnings_in(folder, [p for p in paths if p not in copies and p not in unfinished])
    for done, path in enumerate(_spread(paths)):
        tell(done, len(paths), str(path))
        full = folder / path
        if (said := _is_no_log(path, copies, beginnings, unfinished)) is not None:
            ignored.append((str(path), said))
            continue
        try:
            like = shapes.get(_shape(path)) if watch.spent_s > _HEADERS_S else None
            if like is not None and like.part is None:
                logs[str(path)] = _as_like(like, path, full)
                continue
            who, why = claimant(full)
            if who is None:
                ignored.append((str(path), why))
                continue
            try:
                whole = described_file(who, full, path, encoding)
                found = sheet_by_sheet(who, full, whole)
                looked = Watch()
                if len(found) == 1:
                    found = _by_rows(who, full, path, encoding, whole, _SAMPLES_S - spent) or found
                spent += looked.spent_s
            except _UNREAD as error:
                tests = _not_as_series(who, full, path, encoding, None, _SAMPLES_S - spent)
                if tests is None:
                    failed.append((str(path), who.name))
                    said = f"reader '{who.name}' {CANT_READ}: {short(error)}{_try(error)}"
                    ignored.append((str(path), said))
                    continue
                whole, found = tests[0], tests
            if whole.size < SMALL and spent < _SAMPLES_S:  # now, for its reader has just looked at it
                own = Watch()
                found = [made if made.block else replace(made, sample=sample_of_file(full, made)) for made in found]
                if (once := of_one_time(whole, found)) is not None:
                    found = [replace(once, sample=sample_of_file(full, once))]
                spent += own.spent_s
            elif (once := of_one_time(whole, found)) is not None:
                found = [once]
            ignored += [(str(path), why) for why in found[0].besides]
            if found[0].sheet:
                apart[str(path)] = (whole, found)
            for made in found:
                key = str(path) if made.part is None else f"{path}/{made.part}"
                logs[key] = shapes[_shape(path)] = made
            if str(path) in logs and not logs[str(path)].signals:
                del logs[str(path)]
                ignored.append((str(path), f"{who.name}: it holds no signal"))
        except _UNREAD as error:
            ignored.append((str(path), short(error)))
    for one, whole in in_every_file(apart).items():
        logs = {key: made for key, made in logs.items() if str(made.path) != one} | {one: whole}
    sampled = _sampled(folder, logs, tell)
    ordered = [str(p) for p in paths]
    damaged = list(dict.fromkeys((str(f.path), _damage(f)) for f in sampled if _damage(f)))
    position = {p: i for i, p in enumerate(ordered)}
    for found_out in (ignored, failed):
        found_out.sort(key=lambda item: position[item[0]])
    return Scan(
        with_lent_names(folder, sorted(sampled, key=lambda f: position[str(f.path)])),
        tuple(ignored),
        tuple(damaged),
        tuple(
            dict.fromkeys(p for p, _ in ignored if PurePosixPath(p) not in {*copies, *unfinished, *beginnings})
        ),  # a log is no list of tests
        tuple(failed),
    )


def _is_no_log(
    path: PurePosixPath,
    copies: Mapping[PurePosixPath, PurePosixPath],
    beginnings: Mapping[PurePosixPath, PurePosixPath],
    unfinished: Mapping[PurePosixPath, PurePosixPath],
) -> str | None:
    """Why a file is not even asked about: by its name, or another one that holds the same; None where it is."""
    if not is_text(str(path)):
        return "its name is no UTF-8: no campaign file can say it; give it another name"
    if path in copies:
        return f"a copy of {copies[path]}: their bytes are equal"
    if path in beginnings:
        return f"the beginning of {beginnings[path]}, byte by byte: an earlier state of it, and no test of its own"
    if path in unfinished:
        return f"by its name a half-written copy of {unfinished[path]}, which is there"
    return None


def _as_like(like: RawFile, path: PurePosixPath, full: Path) -> RawFile:
    """A file that nobody opened, as one of the same kind is; when it began is not known."""
    return RawFile(
        path,
        like.reader,
        Recording(like.recording.signals, like.recording.clock, None, None, ()),
        full.stat().st_size,
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
        if not hidden and path.is_file() and not path.is_symlink() and path.suffix.lower() not in _NOT_LOGS:
            yield inside


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
