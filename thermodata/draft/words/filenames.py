"""What file names say: which part of them is the test, which the source, and which the number of a part."""

from __future__ import annotations

import re
from collections.abc import Iterator, Sequence
from dataclasses import dataclass, replace
from pathlib import PurePosixPath

from thermodata.archive.members import ARCHIVES
from thermodata.reader.files.rotated import as_unpacked, unrotated

_PIECE = re.compile(r"[_\-. ]+")
_GOES_ON = (
    "fortsetzung|forts|cont|contd|continued|continuation|suite|seguito|continuaci[oó]n|pokra[cč]ov[aá]n[ií]|続き|续"
)
_PART_WORD = re.compile(
    r"[_\-. ]\(?(?:(?:part|teil|cast|segment|seg|file|chunk|p|t)[_\-. ]?\d{1,5}"
    rf"|(?:{_GOES_ON})[_\-. ]?\d{{0,5}})\)?$",
    re.IGNORECASE,
)
_PIECES_COST = 0.1
_PART_NUMBER = re.compile(r"(?:[_\-. ]\(?|\()\d{1,5}\)?$")


@dataclass(frozen=True, slots=True)
class Naming:
    """One way to read the names of a group of files. ids: of the test, one a file; template: with {test} in it, or
    None; cost: how much of the names it leaves out; parts: several files may be one test."""

    ids: tuple[str, ...]
    template: str | None
    cost: float
    parts: bool = False

    @property
    def joins(self) -> bool:
        """Whether several files have one id."""
        return len(set(self.ids)) < len(self.ids)


def normal(test: str) -> str:
    """The same for 'Heat-01' and 'heat_1'."""
    bare = _PIECE.sub("_", test.lower()).strip("_")
    return re.sub(r"(?<!\d)0+(?=\d)", "", bare)


def without_part(name: str) -> str:
    """A name without the number of a part behind it, or the word of one that goes on: 'run' of 'run_2', 'log' of
    'log.part3', 'S3000' of 'S3000_cont'."""
    return next((s for strip in (_PART_WORD, _PART_NUMBER) if (s := strip.sub("", name)) and s != name), name)


def namings(paths: Sequence[PurePosixPath]) -> list[Naming]:
    """The ways to read these names, the plainest first. paths: at least one."""
    whole = [as_unpacked(p) for p in paths]
    if whole != list(paths):
        ends = {p.name[len(w.name) :] for p, w in zip(paths, whole, strict=True)}
        end = ends.pop() if len(ends) == 1 else "*"
        ways = [_packed(way, end) for way in namings(whole)]
        # 'a.csv' and 'a.csv.gz' are two where they are no parts of one
        each = Naming(tuple(str(p).replace("/", "_") for p in paths), None, 0.5)
        return ways if len(set(whole)) == len(whole) else [*ways, each]
    bare = [unrotated(p) for p in paths]
    if bare != list(paths):
        # pieces of one log are parts, whatever its name says beside that
        own = {n.ids: n for n in _namings(list(dict.fromkeys(bare)))}.values()
        rotated = [_of_pieces(n, bare) for n in own]
        # where these are no pieces of one recording, each has its whole name
        each = Naming(tuple(str(p).replace("/", "_") for p in paths), None, 0.5)
        return sorted([*rotated, *_namings(paths), each], key=lambda n: n.cost)
    return _namings(paths)


def _packed(way: Naming, end: str) -> Naming:
    """A way to read names without what packing added at their end."""
    bare = way.template
    return way if bare is None or (end == "*" and bare.endswith("*")) else replace(way, template=f"{bare}{end}")


def _of_pieces(way: Naming, bare: Sequence[PurePosixPath]) -> Naming:
    """A way to read the names of logs, of all their pieces. bare: the log of each piece."""
    of_log = dict(zip(dict.fromkeys(bare), way.ids, strict=True))
    template = None if way.template is None else f"{way.template}*"
    return Naming(tuple(of_log[p] for p in bare), template, way.cost + _PIECES_COST, True)


def _namings(paths: Sequence[PurePosixPath]) -> list[Naming]:
    found = list(_by_stem(paths)) + list(_by_folder(paths))
    whole = tuple(str(p.with_suffix("")).replace("/", "_") for p in paths)
    if not any(len(set(n.ids)) == len(n.ids) and not n.parts for n in found):
        found.append(Naming(whole, None, 0.5))
    found.sort(key=lambda n: n.cost)
    return found


def _by_stem(paths: Sequence[PurePosixPath]) -> Iterator[Naming]:
    """The test is the stem, without leading and trailing pieces that all share, and without the number of a part."""
    folder = _folder(paths)
    stems, suffixes = [p.stem for p in paths], {p.suffix for p in paths}
    pieces = [_PIECE.split(s) for s in stems]
    fewest = min(map(len, pieces))
    lead = next((i for i in range(fewest) if len({p[i].lower() for p in pieces}) > 1), fewest)
    trail = next((i for i in range(fewest) if len({p[-1 - i].lower() for p in pieces}) > 1), fewest)
    for i in range(min(lead, 4) + 1):
        for j in range(min(trail, 4) + 1):
            if len(paths) == 1 and not _may_cut(pieces[0], i, j):
                continue
            cut = [_cut(s, i, j) for s in stems]
            if any(not c[1] for c in cut):
                continue
            same = len({(c[0], c[2]) for c in cut}) == 1 and folder is not None and len(suffixes) == 1
            where = f"{folder}{_literal(cut[0][0])}{{test}}{_literal(cut[0][2])}{paths[0].suffix}"
            yield Naming(tuple(c[1] for c in cut), where if same else None, i + j)
            for n, strip in enumerate((_PART_WORD, _PART_NUMBER)):
                ids = tuple(strip.sub("", c[1]) or c[1] for c in cut)
                if ids == tuple(c[1] for c in cut):
                    continue
                seps = {c[1][len(d) :][:1] for c, d in zip(cut, ids, strict=True) if c[1] != d}
                sep = seps.pop() if len(seps) == 1 else ""
                sep = sep if sep and not sep.isalnum() else ""
                rest = f"{_literal(sep)}*{_literal(cut[0][2])}{paths[0].suffix}"
                where = f"{folder}{_literal(cut[0][0])}{{test}}{rest}"
                yield Naming(ids, where if same else None, i + j + (0.2 if n == 0 else 1.5), True)
    for n, strip in enumerate((_PART_WORD, _PART_NUMBER)):
        bare = [strip.sub("", s) or s for s in stems]
        if bare != stems and folder is not None and len(suffixes) == 1:
            yield from _before_parts(bare, trail, folder, paths[0].suffix, 0.2 if n == 0 else 1.5)


def _before_parts(stems: Sequence[str], shared: int, folder: str, suffix: str, cost: float) -> Iterator[Naming]:
    """The same of stems without the numbers of parts, where only some files have one: V1_Weg beside V2_Weg_1. shared:
    pieces at their end that all share with it."""
    pieces = [_PIECE.split(s) for s in stems]
    fewest = min(map(len, pieces))
    trail = next((i for i in range(fewest) if len({p[-1 - i].lower() for p in pieces}) > 1), fewest)
    for j in range(shared + 1, min(trail, 4) + 1):
        cut = [_cut(s, 0, j) for s in stems]
        if all(c[1] for c in cut) and len({c[2] for c in cut}) == 1:
            where = f"{folder}{{test}}{_literal(cut[0][2])}*{suffix}"
            yield Naming(tuple(c[1] for c in cut), where, j + cost, True)


def _may_cut(pieces: Sequence[str], lead: int, trail: int) -> bool:
    """Of a single name no pattern shows: only one piece of letters ('daq', 'nc') may be no part of the test."""
    gone = [*pieces[:lead], *pieces[len(pieces) - trail :]]
    return len(gone) <= 1 and all(p.isalpha() and len(p) > 1 for p in gone)


def _by_folder(paths: Sequence[PurePosixPath]) -> Iterator[Naming]:
    """The test is one of the folders above."""
    depth = min(len(p.parts) for p in paths) - 1
    for level in range(depth):
        names = [p.parts[level] for p in paths]
        end = _archives(names)
        if len(set(names)) < 2 or end is None:
            continue
        ids = tuple(name.removesuffix(end) for name in names)
        above = {p.parts[:level] for p in paths}
        below = {p.parts[level + 1 :] for p in paths}
        suffixes = {p.suffix for p in paths}
        one = len(above) == 1 and len({len(p.parts) for p in paths}) == 1 and len(suffixes) == 1
        first = "/".join((*map(_literal, paths[0].parts[:level]), f"{{test}}{end}"))
        if one and len(below) == 1:
            yield Naming(ids, f"{first}/{'/'.join(map(_literal, paths[0].parts[level + 1 :]))}", 0.0)
        elif one and level == depth - 1:
            stems = [p.stem for p in paths]
            lead = _common(stems)
            yield Naming(
                ids,
                f"{first}/{_literal(lead)}*{paths[0].suffix}",
                0.4 if len(set(ids)) < len(ids) else 0.1,
                len(set(ids)) < len(ids),
            )
        else:
            yield Naming(ids, None, 0.8, len(set(ids)) < len(ids))


def _cut(stem: str, lead: int, trail: int) -> tuple[str, str, str]:
    """(what is cut before, the rest, what is cut after)."""
    gaps = [m.span() for m in _PIECE.finditer(stem)]
    if lead + trail > len(gaps):
        return stem, "", ""
    start = gaps[lead - 1][1] if lead else 0
    stop = gaps[len(gaps) - trail][0] if trail else len(stem)
    return stem[:start], stem[start:stop], stem[stop:]


def _common(stems: Sequence[str]) -> str:
    """The letters that all stems begin with, without digits at the end."""
    lead = stems[0]
    for stem in stems[1:]:
        while not stem.startswith(lead):
            lead = lead[:-1]
    return re.sub(r"\d+$", "", lead)


def _folder(paths: Sequence[PurePosixPath]) -> str | None:
    """The folder of all paths with '/' at its end, '*' for a part that differs; None where their depths differ, or
    where some are in archives and others are not."""
    parents = {p.parts[:-1] for p in paths}
    if len({len(p) for p in parents}) != 1:
        return None
    levels = [(level, _archives(level)) for level in zip(*parents, strict=True)]
    if any(end is None for _, end in levels):
        return None
    parts = [_literal(level[0]) if len(set(level)) == 1 else f"*{end}" for level, end in levels]
    return "".join(f"{part}/" for part in parts)


def _archives(names: Sequence[str]) -> str | None:
    """What the names of archives end with, '' where none is one; None where only some do."""
    longest = sorted(ARCHIVES, key=len, reverse=True)  # '.tar.gz' is one end
    found = {name: next((end for end in longest if name.lower().endswith(end)), "") for name in names}
    ends = {name[len(name) - len(end) :] for name, end in found.items()}
    return ends.pop() if len(ends) == 1 else None


def _literal(text: str) -> str:
    """Glob signs in a name as they are."""
    return re.sub(r"([*?[])", r"[\1]", text)


def matches(template: str, test: str, paths: Sequence[str]) -> list[str]:
    """The paths that a template finds for a test, as `ingest` does."""
    import glob

    near = [p for p in paths if test in p]  # a template holds {test}, so a path that fits holds the test
    pattern = re.compile(_regex(template.replace("{test}", glob.escape(test)))) if near else None
    return [p for p in near if pattern is not None and pattern.fullmatch(p)]


def _regex(pattern: str) -> str:
    out, i = "", 0
    while i < len(pattern):
        if pattern[i] == "*":
            out, i = out + "[^/]*", i + 1
        elif pattern[i] == "?":
            out, i = out + "[^/]", i + 1
        elif pattern[i] == "[" and "]" in pattern[i + 2 :]:
            end = pattern.index("]", i + 2)
            inside = re.sub(r"([\[\\&~|])", r"\\\1", pattern[i + 1 : end])
            out, i = out + "[" + re.sub(r"^!", "^", inside) + "]", end + 1
        else:
            out, i = out + re.escape(pattern[i]), i + 1
    return out
