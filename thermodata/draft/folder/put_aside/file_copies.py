"""Files that somebody copied in their folder: 'day 2 - Kopie.csv' beside 'day 2.csv', equal to the last byte;
and what else is another state of a file: its beginning, half-written, or corrected."""

from __future__ import annotations

import re
from bisect import bisect_left
from collections.abc import Mapping, Sequence
from pathlib import Path, PurePosixPath

from thermodata.draft.files.raw_file import RawFile

_UNFINISHED = (".part", ".partial", ".filepart", ".crdownload", ".download", ".tmp")
_ASIDE = re.compile(
    r"(?i)[\W_]*(?:bak|backups?|sicherung(?:en)?|kopien?|cop(?:y|ies)|old|alte?|archive?|záloha|sauvegarde)[\W_\d]*"
)
# what a program or a person calls the copy of a folder: 'a1 - Copy', 'Kopie von a1', 'a1 (2)'
_COPY = re.compile(
    r"(?i)[\W_]*(?:\(\d+\)|(?:cop(?:y|ies)|kopi[ae]?|copi[ae]|cópia|másolata?|kopio|копия|副本|コピー|사본|复件|複製|bak|backup|"
    r"sicherung|old|alt|záloha|sauvegarde)(?: (?:of|von|de|di|av|z) )?(?:[\W_]*\(?\d+\)?)?)[\W_]*"
)
_BAK = (".bak", ".old", ".orig")
_PART = 1 << 20
_WHOLE = 64 << 20  # larger ones are compared at both ends


def copies_in(folder: Path, paths: Sequence[PurePosixPath]) -> dict[PurePosixPath, PurePosixPath]:
    """Copy -> the file that it is of. Only where its name is the other's with a word or a number in brackets more: two
    tests may well have logs that are equal, as a hall's that lies in both folders."""
    alike: dict[tuple[PurePosixPath, str, int], list[PurePosixPath]] = {}
    for path in paths:
        try:
            size = (folder / path).stat().st_size
        except OSError:
            continue
        if size:
            named = _beside(path)
            alike.setdefault((named.parent, named.suffix.lower(), size), []).append(path)
    found: dict[PurePosixPath, PurePosixPath] = {}
    for together in alike.values():
        together.sort(key=lambda p: (len(_beside(p).stem), _beside(p).stem))
        for i, copy in enumerate(together):
            of = next((p for p in together[:i] if p not in found and is_named_after(copy, p)), None)
            if of is not None and _equal(folder / copy, folder / of, (folder / of).stat().st_size):
                found[copy] = of
    return found | _in_other_folders(folder, alike, found)


def _in_other_folders(
    folder: Path,
    alike: Mapping[tuple[PurePosixPath, str, int], Sequence[PurePosixPath]],
    known: Mapping[PurePosixPath, PurePosixPath],
) -> dict[PurePosixPath, PurePosixPath]:
    """The same of files in a folder that was put aside, 'backup/T1.csv' of 'T1/T1.csv', or copied as a whole: 'a1 -
    Copy/log.csv'. They are called as the other is."""
    named: dict[tuple[str, int], list[PurePosixPath]] = {}
    for (_, _, size), paths in alike.items():
        for path in paths:
            if path not in known:
                named.setdefault((path.name, size), []).append(path)
    found: dict[PurePosixPath, PurePosixPath] = {}
    for (_, size), paths in named.items():
        apart = [p for p in paths if any(map(_ASIDE.fullmatch, p.parts[:-1]))]
        kept = [p for p in paths if p not in apart]
        pairs = [(p, [o for o in kept if _is_folder_of(p, o)]) for p in kept] + [(p, kept) for p in apart]
        for copy, others in pairs:
            of = next((o for o in others if o not in found and _equal(folder / copy, folder / o, size)), None)
            if of is not None:
                found[copy] = of
    return found


def _is_folder_of(copy: PurePosixPath, original: PurePosixPath) -> bool:
    """Whether one lies where the other does, but for a folder that is called as a copy of the other's."""
    here, there = copy.parts[:-1], original.parts[:-1]
    other = [(a, b) for a, b in zip(here, there, strict=True) if a != b] if len(here) == len(there) else []
    if len(other) != 1 or other[0][1] not in other[0][0]:
        return False
    before, _, after = other[0][0].partition(other[0][1])
    return bool(_COPY.fullmatch(f"{before}{after}"))


def beginnings_in(folder: Path, paths: Sequence[PurePosixPath]) -> dict[PurePosixPath, PurePosixPath]:
    """File -> the longest one that goes on behind its last byte: 'R1_backup.csv' of a morning beside 'R1.csv', or
    'R1.csv' beside a later 'R1 (1).csv'. Only where one is called as the other with a word or a number in brackets
    more."""
    sizes: dict[PurePosixPath, int] = {}
    together: dict[tuple[PurePosixPath, str], list[PurePosixPath]] = {}
    for path in paths:
        try:
            sizes[path] = (folder / path).stat().st_size
        except OSError:
            continue
        if sizes[path]:
            named = _beside(path)
            together.setdefault((named.parent, named.suffix.lower()), []).append(path)
    found: dict[PurePosixPath, PurePosixPath] = {}
    for alike in together.values():
        alike.sort(key=lambda p: -sizes[p])
        kin = _names_within_names(alike)
        for short in alike:
            longer = (p for p in kin.get(short, ()) if sizes[p] > sizes[short] and p not in found)
            called = (p for p in longer if is_named_after(short, p) or is_named_after(p, short))
            of = next((p for p in called if _equal(folder / short, folder / p, sizes[short])), None)
            if of is not None:
                found[short] = of
    return found


def _names_within_names(paths: Sequence[PurePosixPath]) -> dict[PurePosixPath, list[PurePosixPath]]:
    """Path -> those of them that its name holds, or that hold its name, as they are listed."""
    stems: dict[str, list[int]] = {}
    for k, path in enumerate(paths):
        stems.setdefault(_beside(path).stem, []).append(k)
    lengths = sorted({len(stem) for stem in stems} - {0})
    found: dict[int, set[int]] = {}
    # by the pieces of each name, for pairs are too many in a folder of thousands of files
    for stem, own in stems.items():
        shorter = lengths[: bisect_left(lengths, len(stem))]
        pieces = {stem[i : i + n] for n in shorter for i in range(len(stem) - n + 1)}
        for other in pieces & stems.keys():
            for one in own:
                found.setdefault(one, set()).update(stems[other])
            for one in stems[other]:
                found.setdefault(one, set()).update(own)
    return {paths[one]: [paths[k] for k in sorted(others)] for one, others in found.items()}


def unfinished_in(paths: Sequence[PurePosixPath]) -> dict[PurePosixPath, PurePosixPath]:
    """File that is called as half-written ones are -> the finished one beside it: 'V2.csv.part' beside 'V2.csv'."""
    known = set(paths)
    return {p: p.with_suffix("") for p in paths if p.suffix.lower() in _UNFINISHED and p.with_suffix("") in known}


def other_versions(tests: Mapping[str, Sequence[RawFile]]) -> dict[str, RawFile]:
    """Test -> the file of another one of its source that has the same minutes, and whose name its own goes on:
    'V1_corrected.csv' beside 'V1.csv'."""
    alike: dict[tuple[object, ...], list[tuple[str, RawFile]]] = {}
    for test, files in tests.items():
        for f in files:
            if f.start_ns is not None and f.sample.whole:
                alike.setdefault((f.path.parent, f.start_ns, f.sample.last_ns), []).append((test, f))
    return {
        test: other
        for together in alike.values()
        for test, own in together
        for of, other in together
        if of != test and is_named_after(own.path, other.path)
    }


def _beside(path: PurePosixPath) -> PurePosixPath:
    """A file that was put aside as it would be called beside the one that it is of: 'backup/R1.csv' and 'R1.csv.bak' as
    'R1 backup.csv' and 'R1 bak.csv'."""
    if path.suffix.lower() in _BAK and path.with_suffix("").suffix:
        bare = path.with_suffix("")
        path = bare.with_name(f"{bare.stem} {path.suffix[1:]}{bare.suffix}")
    if _ASIDE.fullmatch(path.parent.name):
        path = path.parent.parent / f"{path.stem} {path.parent.name}{path.suffix}"
    return path


def is_named_after(copy: PurePosixPath, original: PurePosixPath) -> bool:
    """Whether a name is another one and more words: 'V1_corrected' of 'V1', 'backup/R1' of 'R1'."""
    copy, original = _beside(copy), _beside(original)
    before, named, after = copy.stem.partition(original.stem)
    more = f"{before}{after}".strip(" -_.")
    # 'run 12' is no copy of 'run 1'
    return bool(named) and bool(re.search(r"[^\W\d_]{2}|\(\d+\)", more)) and not re.match(r"\d", after)


def _equal(one: Path, other: Path, size: int) -> bool:
    """Whether so many bytes at their start are equal."""
    try:
        with one.open("rb") as a, other.open("rb") as b:
            starts = range(0, size, _PART) if size <= _WHOLE else (0, size - _PART)
            for start in starts:
                a.seek(start)
                b.seek(start)
                part = min(_PART, size - start)
                if a.read(part) != b.read(part):
                    return False
    except OSError:
        return False
    return True
