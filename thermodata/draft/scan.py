"""Looks at every file of a folder: who reads it, what it holds, and a bounded sample of its values.

A folder may hold 50 GB: heads and headers are read of every file, values of the first blocks only, and of a few files
of each kind once the time for it is used up.
"""

from __future__ import annotations

import re
from collections.abc import Callable, Iterator, Mapping, Sequence
from dataclasses import dataclass, field, replace
from pathlib import Path, PurePosixPath
from typing import Any

from thermodata.draft.sample import SMALL, Course, Sample, Watch, sample_of, short
from thermodata.errors import QuestionError, ThermodataError
from thermodata.plugin import Reader, Recording, Signal, Source
from thermodata.reader.explain import kind_of
from thermodata.reader.guard import described
from thermodata.reader.open_questions import UNKNOWN
from thermodata.reader.registry import claims, reader
from thermodata.schema.lines import is_text

_SAMPLES_S, _HEADERS_S = 15.0, 40.0  # of the whole folder
_MOST_QUESTIONS = 4
_ASSUMED = "counted as 1 s each|taken as seconds from a start"
_UNIT: Mapping[str, Any] = {"time": {"unit": UNKNOWN}}
_UNREAD = (ThermodataError, OSError, MemoryError)  # of one file: the others are drafted all the same
_NOT_LOGS = frozenset((".yaml", ".yml", ".md", ".tdms_index"))
__all__ = [
    "Asked",
    "Course",
    "Progress",
    "RawFile",
    "Sample",
    "Scan",
    "described_files",
    "merged",
    "natural",
    "sampled_file",
    "scan",
]
Progress = Callable[[int, int, str], None]


@dataclass(frozen=True, slots=True)
class Asked:
    """A question that a file leaves. declare: as in `sources.*.table`, 'unknown' where the answer goes."""

    ask: str
    declare: Mapping[str, Any]


@dataclass(frozen=True, slots=True)
class RawFile:
    """A file that one reader claims, or a sheet of it. path: relative to the folder. like: the file of the same kind
    whose header was taken for this one's, where there was no time to read it; asked: what it does not say; table: the
    answers by which it was looked at meanwhile; sheet: of a workbook whose sheets are tests; besides: why others of
    its sheets are none."""

    path: PurePosixPath
    reader: str
    recording: Recording
    size: int = 0
    sample: Sample = field(default_factory=Sample)
    like: str | None = None
    asked: tuple[Asked, ...] = ()
    table: Mapping[str, Any] | None = None
    sheet: str | None = None
    besides: tuple[str, ...] = ()

    @property
    def source(self) -> Source:
        """What the reader is told, so that it reads the file at all."""
        return Source(table=self.table)

    @property
    def signals(self) -> tuple[Signal, ...]:
        return self.recording.signals

    @property
    def start_ns(self) -> int | None:
        """Where its absolute clock starts; None on a relative clock."""
        if self.recording.clock != "absolute":
            return None
        return self.sample.first_ns if self.sample.first_ns is not None else self.recording.start_ns

    @property
    def local(self) -> bool:
        """Whether it logs local times of a zone that it does not name."""
        return self.recording.clock == "absolute" and any("no time zone" in n for n in self.recording.notes)


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


def scan(folder: Path, progress: Progress | None = None) -> Scan:
    """All files below the folder; hidden ones, stores and links are left out. progress: (done, of, path)."""
    paths = list(_files(folder))
    tell = progress or (lambda done, of, path: None)
    watch, spent = Watch(), 0.0
    logs: dict[str, RawFile] = {}
    ignored: list[tuple[str, str]] = []
    failed: list[tuple[str, str]] = []
    shapes: dict[str, RawFile] = {}
    for done, path in enumerate(_spread(paths)):
        tell(done, len(paths), str(path))
        full = folder / path
        if not is_text(str(path)):
            ignored.append((str(path), "its name is no UTF-8: no campaign file can say it; give it another name"))
            continue
        try:
            like = shapes.get(_shape(path)) if watch.spent_s > _HEADERS_S else None
            if like is not None and like.sheet is None:
                logs[str(path)] = RawFile(
                    path,
                    like.reader,
                    _without_start(like.recording),
                    full.stat().st_size,
                    like=str(like.path),
                    asked=like.asked,
                    table=like.table,
                )
                continue
            who, why = _claimant(full)
            if who is None:
                ignored.append((str(path), why))
                continue
            try:
                found = described_files(who, full, path)
            except _UNREAD as error:
                failed.append((str(path), who.name))
                ignored.append((str(path), f"reader '{who.name}' claims it and can't read it: {short(error)}"))
                continue
            ignored += [(str(path), why) for why in found[0].besides]
            for made in found:
                if made.size < SMALL and spent < _SAMPLES_S:  # now, for its reader has just looked at it
                    own = Watch()
                    made = replace(made, sample=_sample(full, made))
                    spent += own.spent_s
                key = str(path) if made.sheet is None else f"{path}/{made.sheet}"
                logs[key] = shapes[_shape(path)] = made
            if str(path) in logs and not logs[str(path)].signals:
                del logs[str(path)]
                ignored.append((str(path), f"{who.name}: it holds no signal"))
        except _UNREAD as error:
            ignored.append((str(path), short(error)))
    sampled = _sampled(folder, logs, tell)
    ordered = [str(p) for p in paths]
    damaged = list(dict.fromkeys((str(f.path), _damage(f)) for f in sampled if _damage(f)))
    position = {p: i for i, p in enumerate(ordered)}
    ignored.sort(key=lambda item: position[item[0]])
    return Scan(
        tuple(sorted(sampled, key=lambda f: position[str(f.path)])),
        tuple(ignored),
        tuple(damaged),
        tuple(dict.fromkeys(p for p, _ in ignored)),
        tuple(failed),
    )


def sampled_file(folder: Path, path: PurePosixPath) -> RawFile | None:
    """One file of a folder with a sample of its values; None where no reader, or more than one, claims it.

    ThermodataError where it cannot be read at all.
    """
    who, _ = _claimant(folder / path)
    if who is None:
        return None
    file = described_files(who, folder / path, path)[0]
    return replace(file, sample=_sample(folder / path, file))


def described_files(who: Reader, full: Path, path: PurePosixPath) -> list[RawFile]:
    """A file as its reader describes it, with what it leaves open; a workbook whose sheets are alike sheet by sheet.

    ThermodataError where it cannot be read at all.
    """
    size = full.stat().st_size
    whole = _asking(who, full, RawFile(path, who.name, Recording((), "relative"), size))
    names, besides = _sheets(whole.recording)
    if not names:
        return [whole]
    found = []
    left = [f"its sheet '{n}' is not like the {len(names)} others: a list of tests, or notes?" for n in besides]
    left += [f"its {note}" for note in whole.recording.notes if re.match(r"sheet '.*' is not read", note)]
    for name in names:
        one = replace(whole, sheet=name, besides=tuple(left), table={**(whole.table or {}), "sheet": name}, asked=())
        found.append(_asking(who, full, one))
    return found


def _asking(who: Reader, full: Path, file: RawFile) -> RawFile:
    """The file described, each of its questions answered for the time being."""
    asked: list[Asked] = []
    table: dict[str, Any] = dict(file.table or {})
    while True:
        try:
            recording = described(who, full, Source(table=table or None))
            break
        except QuestionError as question:
            if len(asked) == _MOST_QUESTIONS:
                raise
            asked.append(Asked(question.ask, question.declare))
            table = merged(table, question.meanwhile)
    if not any("time" in a.declare for a in asked):  # what a reader takes by custom, MATLAB's seconds, is asked here
        asked += [Asked("unit of the time: s, min or h?", _UNIT) for n in recording.notes if "taken as seconds;" in n]
        asked += [Asked(f"time: {n}", {}) for n in recording.notes if re.search(_ASSUMED, n)]
    return replace(file, recording=recording, asked=tuple(asked), table=table or None)


def merged(one: Mapping[str, Any], other: Mapping[str, Any]) -> dict[str, Any]:
    """Both declarations; of what is in both, the parts of both."""
    out = dict(one)
    for key, value in other.items():
        out[key] = (
            merged(out[key], value) if isinstance(out.get(key), Mapping) and isinstance(value, Mapping) else value
        )
    return out


def _sheets(recording: Recording) -> tuple[list[str], list[str]]:
    """(the sheets of a workbook that are tests of one kind, the others): each a stream, and with mostly the same
    signals. No sheets where fewer than two are alike, or fewer than three beside one that is unlike them."""
    streams = list(dict.fromkeys(s.stream for s in recording.signals))
    if len(streams) < 2 or not all(s.name.startswith(f"{s.stream}/") for s in recording.signals):
        return [], []
    own = {n: {s.name.removeprefix(f"{n}/") for s in recording.signals if s.stream == n} for n in streams}

    def like(one: str) -> list[str]:
        return [n for n in streams if len(own[one] & own[n]) >= 0.5 * max(len(own[one]), len(own[n]))]

    alike = max((like(n) for n in streams), key=len)
    others = [n for n in streams if n not in alike]
    # an overview or notes beside the tests; half of the sheets of another kind are two loggers of the same tests
    enough = len(alike) >= 2 and (not others or len(alike) >= max(3, 2 * len(others)))
    return (alike, others) if enough else ([], [])


def _files(folder: Path) -> Iterator[PurePosixPath]:
    for path in sorted(folder.rglob("*"), key=lambda p: natural(p.relative_to(folder).as_posix())):
        inside = PurePosixPath(path.relative_to(folder).as_posix())
        hidden = any(p.startswith((".", "~$")) or p.endswith(".store") for p in inside.parts)
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


def _claimant(path: Path) -> tuple[Reader | None, str]:
    found = claims(path)
    if len(found) == 1:
        return reader(next(iter(found))), ""
    if not path.stat().st_size:
        return None, "an empty file"
    if not found:
        return None, f"no reader claims it ({kind_of(path)}): thermodata sniff says why"
    said = " and ".join(f"{name} ({why})" for name, why in found.items())
    return None, f"two readers claim it: {said}; declare one as the reader of a source"


def _without_start(recording: Recording) -> Recording:
    return Recording(recording.signals, recording.clock, None, None, ())


def _damage(file: RawFile) -> str:
    if file.sample.failed:
        return f"reader '{file.reader}' stopped in it: {file.sample.failed}"
    if file.recording.complete is False:
        wrong = [n for n in file.recording.notes if re.search(r"cut|damag|end|incomplete|lost|truncat|missing|past", n)]
        return wrong[0] if wrong else "it does not end as it should"
    return f"{file.sample.losses} losses in what was read of it" if file.sample.losses else ""


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
        found[str(path)] = replace(file, sample=_sample(folder / file.path, file))
    return list(found.values())


def _sample(path: Path, file: RawFile) -> Sample:
    return sample_of(path, reader(file.reader), file.source, file.recording, file.size)
