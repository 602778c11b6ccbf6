"""Which logs of a folder are one test, by the patterns of a known campaign. Where these read a name in several ways,
or fit another source's files too, the names of all sources, the signals and the clocks decide, as in a first draft."""

from __future__ import annotations

import re
from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from functools import lru_cache
from pathlib import Path, PurePosixPath

from thermodata.draft.files.described_file import described_file, sample_of_file
from thermodata.draft.files.raw_file import RawFile
from thermodata.draft.folder.into_sources.sources import Group
from thermodata.draft.folder.into_tests.group import agreeing, grouped, one_recording
from thermodata.draft.words.filenames import Naming, normal
from thermodata.errors import ThermodataError, UsageError
from thermodata.plugin import Recording
from thermodata.reader.finding.match import match_signal
from thermodata.reader.finding.registry import reader
from thermodata.schema.files.campaign import SourceSpec
from thermodata.schema.files.tests_from import pattern_of


@dataclass(frozen=True, slots=True)
class KnownSource:
    """A source of a known campaign. patterns: as the files of the folder are called; signals: that are wanted of it."""

    name: str
    spec: SourceSpec
    patterns: tuple[str, ...]
    signals: tuple[str, ...]


def tests_by_patterns(
    folder: Path, sources: Sequence[KnownSource], names: Sequence[str]
) -> dict[str, dict[str, list[str]]]:
    """Test -> source -> its files. names: of all files in the folder."""
    read: dict[tuple[str, str], RawFile] = {}

    def file(source: KnownSource, name: str) -> RawFile:
        if (source.name, name) not in read:
            read[source.name, name] = _looked_at(folder, source, name)
        return read[source.name, name]

    fitting = {s.name: {n: ids for n in names if (ids := ids_in(n, s.patterns))} for s in sources}
    for name in names:
        claims = [s for s in sources if name in fitting[s.name]]
        if len(claims) > 1:
            best = max(claims, key=lambda s, n=name: (_has(file(s, n), s.signals), _letters(s, n)))  # type: ignore[misc]
            for other in claims:
                if other is not best:
                    del fitting[other.name][name]
    if all(len(ids) == 1 for found in fitting.values() for ids in found.values()):
        return _joined({s: {n: ids[0] for n, ids in found.items()} for s, found in fitting.items()})
    groups = [
        Group(s.name, s.spec.reader, tuple(file(s, n) for n in fitting[s.name])) for s in sources if fitting[s.name]
    ]
    ways = {g.source: _ways(g, list(fitting[g.source].values())) for g in groups}
    chosen = agreeing(groups, ways)
    return _joined(
        {g.source: {str(f.path): t for t, fs in grouped(g, chosen[g.source]).items() for f in fs} for g in groups}
    )


def ids_in(name: str, patterns: Sequence[str]) -> list[str]:
    """What {test} may be in a name, the shortest first: it ends where a piece of the name does. [] where no pattern
    fits."""
    found: set[str] = set()
    for pattern in patterns:
        plain = pattern_of(pattern).fullmatch(name)
        if plain is None:
            continue
        ids = {m["test"] for n in range(1, len(name) + 1) if (m := _of_length(pattern, n).fullmatch(name))}
        found |= {t for t in ids if _ends_a_piece(name, t)} or {plain["test"]}
    return sorted(found, key=lambda t: (len(t), t))


@lru_cache(maxsize=4096)
def _of_length(pattern: str, letters: int) -> re.Pattern[str]:
    """A pattern whose test has so many letters."""
    return re.compile(pattern_of(pattern).pattern.replace("(?P<test>[^/]+?)", f"(?P<test>[^/]{{{letters}}})"))


def _ends_a_piece(name: str, test: str) -> bool:
    """Whether a name is parted behind a test in it: by a sign, or where digits and letters meet."""
    behind = name[name.rfind(test) + len(test) :][:1]
    return not (test[-1].isalnum() and behind.isalnum()) or test[-1].isdigit() is not behind.isdigit()


def _ways(group: Group, ids: Sequence[Sequence[str]]) -> list[Naming]:
    """The ways to read the names of a source, from the shortest test on, and from the longest; not those that make one
    test of files which did not follow each other."""
    most = max(map(len, ids))
    picks = [*range(most), *range(-1, -most - 1, -1)]
    read = dict.fromkeys(tuple(_pick(own, k) for own in ids) for k in picks)
    ways = [Naming(way, None, 0.1 * k, len(set(way)) < len(way)) for k, way in enumerate(read)]
    return [w for w in ways if not w.joins or one_recording(group, w) is not False] or ways


def _pick(ids: Sequence[str], k: int) -> str:
    return ids[min(k, len(ids) - 1)] if k >= 0 else ids[max(k, -len(ids))]


def _joined(tests: Mapping[str, Mapping[str, str]]) -> dict[str, dict[str, list[str]]]:
    """tests: source -> path -> test. 'Heat-01' of one source is 'heat_1' of another."""
    found: dict[str, dict[str, list[str]]] = {}
    spelled: dict[str, str] = {}
    for source, files in tests.items():
        own = {normal(t): t for t in files.values()}
        alone = len(own) == len(set(files.values()))  # of one source, names that differ are tests that differ
        for path, test in files.items():
            name = spelled.setdefault(normal(test), test) if alone else test
            found.setdefault(name, {}).setdefault(source, []).append(path)
    return found


def _has(file: RawFile, signals: Sequence[str]) -> int:
    """How many of the signals a file has."""
    return sum(_is_there(s, file) for s in signals)


def _is_there(signal: str, file: RawFile) -> bool:
    try:
        match_signal(signal, file.signals)
    except UsageError:
        return False
    return True


def _letters(source: KnownSource, name: str) -> int:
    """How much of a name the pattern says that fits it."""
    return max(len(re.sub(r"\{test\}|\*", "", p)) for p in source.patterns if pattern_of(p).fullmatch(name))


def _looked_at(folder: Path, source: KnownSource, name: str) -> RawFile:
    """A file as the source's reader tells of it, with a sample; without anything where it can't be read, which is told
    where it is."""
    path, table = PurePosixPath(name), source.spec.table
    try:
        who = reader(source.spec.reader)
        said = None if table is None else table.model_dump(mode="json", exclude_none=True)
        file = described_file(who, folder / path, path, source.spec.encoding, said)
        return RawFile(
            path, who.name, file.recording, file.size, sample_of_file(folder / path, file), delivered=file.delivered
        )
    except (ThermodataError, OSError, MemoryError):
        return RawFile(path, source.spec.reader, Recording((), "relative"))
