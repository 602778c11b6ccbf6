"""Files into sources: the same reader and like signals are one source, but for loggers that ran at once."""

from __future__ import annotations

import re
from collections.abc import Mapping, Sequence
from dataclasses import dataclass, field
from typing import Any

from thermodata.draft.files.described_file import merged
from thermodata.draft.files.file_question import STANDS, FileQuestion
from thermodata.draft.files.raw_file import RawFile
from thermodata.draft.folder.into_sources.loggers import loggers
from thermodata.draft.words.naming import parts_of, plain, words
from thermodata.plugin import Signal
from thermodata.reader.files.rotated import unrotated
from thermodata.reader.text import split_unit
from thermodata.reader.text.rows.changed_cells import CHANGES
from thermodata.schema.words.numbered import numbered

_NAMES = {"crio": "daq", "cnc": "nc", "mcap": "rec", "table": "log"}
_ALIKE = 0.5  # of the shorter list of signals


@dataclass(frozen=True, slots=True)
class Group:
    """A source. files: its logs of tests; calibrations: its jump tests; template: `files` with {test}, or a glob that
    all tests share (shared), or None; tests: id -> its files."""

    source: str
    reader: str
    files: tuple[RawFile, ...]
    calibrations: tuple[RawFile, ...] = ()
    template: str | None = None
    shared: bool = False
    tests: Mapping[str, tuple[RawFile, ...]] = field(default_factory=dict)
    questions: tuple[str, ...] = ()

    @property
    def table(self) -> dict[str, Any]:
        """What of `sources.*.table` has to be declared for its files."""
        found: dict[str, Any] = {"sheet": "{test}"} if any(f.sheet for f in self.files) else {}
        for asked in self._asked():
            found = merged(found, asked.declare)
        return found

    @property
    def asks(self) -> tuple[str, ...]:
        """What its files leave open, each once."""
        return self._said(told=False)

    @property
    def told(self) -> tuple[str, ...]:
        """What some of its files leave open, and others answer."""
        return self._said(told=True)

    def _said(self, told: bool) -> tuple[str, ...]:
        first: dict[str, str] = {}
        for asked in (a for a in self._asked() if a.told is told):
            first.setdefault(repr(asked.declare) if asked.declare else asked.ask, asked.ask)
        return tuple(first.values())

    def _asked(self) -> list[FileQuestion]:
        files = (*self.files, *self.calibrations)
        doubted = [f for f in files if any(a.ask.startswith(STANDS) for a in f.asked)]
        # what is too short to tell how its cells were written is read as the others of its recorder
        told = 2 * len(doubted) < len(files) and not any(CHANGES in n for f in files for n in f.recording.notes)
        return [a for f in files for a in f.asked if not (told and a.ask.startswith(STANDS))]

    @property
    def signals(self) -> list[tuple[Signal, list[RawFile]]]:
        """Every signal of any file, in the order of its first appearance, with the files that have it."""
        found: dict[tuple[str, str], tuple[Signal, list[RawFile]]] = {}
        for file in (*self.files, *self.calibrations):
            for signal in file.signals:
                found.setdefault((signal.stream, signal.name), (signal, []))[1].append(file)
        return list(found.values())


def sources_of(files: Sequence[RawFile], jumps: Sequence[RawFile]) -> list[Group]:
    """One group a source: one reader, one kind of file, and like signals; named after a word that all its names hold
    and no other's, else after what such files are."""
    clusters: list[list[RawFile]] = []
    names: list[set[str]] = []
    for file in sorted(files, key=lambda f: -len(f.signals)):
        own = {split_unit(s.name)[0] for s in file.signals}
        home = next(
            (
                i
                for i, c in enumerate(clusters)
                if _kind(c[0]) == _kind(file)
                and (len(own & names[i]) >= _ALIKE * min(len(own), len(names[i])) or _twin(file, c) or _sheet(file, c))
            ),
            None,
        )
        if home is None:
            clusters.append([file])
            names.append(own)
        else:
            clusters[home].append(file)
            names[home] |= own
    clusters = _with_their_tests(clusters, jumps)
    order = {id(f): i for i, f in enumerate(files)}
    clusters = [sorted(part, key=lambda f: order[id(f)]) for c in clusters for part in _loggers(c, jumps)]
    clusters.sort(key=lambda c: (c[0].reader, c[0].path.suffix, order[id(c[0])]))
    groups = []
    taken: set[str] = set()
    for cluster in clusters:
        logs = tuple(f for f in cluster if f not in jumps)
        groups.append(
            Group(_name(cluster, clusters, taken), cluster[0].reader, logs, tuple(f for f in cluster if f in jumps))
        )
    return groups


def _with_their_tests(clusters: Sequence[list[RawFile]], jumps: Sequence[RawFile]) -> list[list[RawFile]]:
    """Jump tests with the one kind of tests that has their signals under another head: 'Fast/Z' beside 'Slow/Z'."""

    def own(cluster: Sequence[RawFile]) -> set[str]:
        return {parts_of(split_unit(s.name)[0])[-1] for f in cluster for s in f.signals}

    tests = [c for c in clusters if any(f not in jumps for f in c)]
    found = [list(c) for c in tests]
    for cluster in (c for c in clusters if c not in tests):
        names = own(cluster)
        homes = [
            i
            for i, c in enumerate(tests)
            if _kind(c[0]) == _kind(cluster[0]) and len(names & own(c)) >= _ALIKE * len(names)
        ]
        if len(homes) == 1:
            found[homes[0]] += cluster
        else:
            found.append(cluster)
    return found


def _kind(file: RawFile) -> tuple[object, ...]:
    """What the files of one source have in common: who reads them, and what has to be declared for it."""
    # a day above 12 settles the order of day and month in some files, and is asked of the others; so is the decimal
    # mark where only some tests turn at thousands, the start where only some have a line on it, names where only some
    # have a header, and what a quality of 0 means where only some have other codes
    told = [a.declare for a in file.asked if not {"format", "start"} & {*a.declare.get("time", {})}]
    # what asks and declares nothing parts no sources either
    told = [d for d in told if d and not {"decimal", "names", "quality_zero"} & {*d}]
    return file.reader, unrotated(file.path).suffix.lower(), file.sheet is not None, file.sensor, repr(told)


def _twin(file: RawFile, cluster: Sequence[RawFile]) -> bool:
    """Whether another file has the same name and signals but for axis letters and numbers: posuv_X, posuv_Y."""

    def shape(text: str) -> str:
        return re.sub(r"\d+", "#", re.sub(r"(?<![A-Za-z])[XYZABCxyzabc](?![A-Za-z])", "@", text))

    own = {shape(split_unit(s.name)[0]) for s in file.signals}
    return any(
        shape(str(other.path)) == shape(str(file.path)) and own == {shape(split_unit(s.name)[0]) for s in other.signals}
        for other in cluster[:20]
    )


def _sheet(file: RawFile, cluster: Sequence[RawFile]) -> bool:
    """Whether it is a sheet of a workbook whose other sheets are tests, whatever their columns are called."""
    return file.sheet is not None and any(other.path == file.path for other in cluster)


def _loggers(cluster: Sequence[RawFile], jumps: Sequence[RawFile]) -> list[list[RawFile]]:
    """A cluster, its loggers apart; jump tests with the one that writes where they lie, or else the first."""
    found = loggers([f for f in cluster if f not in jumps])
    for jump in (f for f in cluster if f in jumps):
        home = next((own for own in found if jump.path.parent in {f.path.parent for f in own}), found[0])
        home.append(jump)
    return found


def _name(cluster: Sequence[RawFile], clusters: Sequence[Sequence[RawFile]], taken: set[str]) -> str:
    def name_words(file: RawFile) -> set[str]:
        said = words(str(file.path.with_suffix("")).replace("/", " ")).split()
        return {p for p in said if p.isalpha() and len(p) > 1}

    everywhere = set.intersection(*(name_words(f) for f in cluster))
    elsewhere = set().union(*(name_words(f) for c in clusters if c is not cluster for f in c))
    own = sorted(everywhere - elsewhere - {"raw", "data", "log", "test"}, key=lambda p: (len(p), p))
    alone = len(cluster) == 1 or len(clusters) == 1
    base = _NAMES.get(cluster[0].reader, cluster[0].reader)
    sensor = plain(cluster[0].sensor or "")
    if sensor[:1].isalpha():
        base = sensor
    elif own and not alone and plain(own[0])[:1].isalpha():
        base = plain(own[0])
    name = numbered(base[:30], lambda name: name.lower() in taken, "")
    taken.add(name.lower())
    return name
