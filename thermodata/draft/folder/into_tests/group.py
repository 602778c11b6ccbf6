"""Files of a source into tests: names, and where they fail times, tell which files are one test."""

from __future__ import annotations

import re
from collections.abc import Iterable, Mapping, Sequence
from dataclasses import replace
from itertools import pairwise

from thermodata.draft.files.on_one_clock import on_one_clock
from thermodata.draft.files.raw_file import RawFile
from thermodata.draft.folder.into_sources.sources import Group
from thermodata.draft.folder.into_tests.log_in_parts import runs_across
from thermodata.draft.folder.into_tests.over_tests import over_tests
from thermodata.draft.words.filenames import Naming, matches, namings, normal
from thermodata.schema.words.numbered import numbered
from thermodata.schema.words.sentences import counted

_NEAR_NS = 15 * 60 * 1_000_000_000
_HOUR_NS = 3_600_000_000_000


def tests_of(groups: Sequence[Group], besides: Iterable[str]) -> list[Group]:
    """The groups with their tests and templates; ids agree between groups wherever the names or the times do. besides:
    other files of the folder, which no template may find."""
    live = [g for g in groups if g.files]
    if not live:
        return list(groups)
    ways = {g.source: _allowed(g) for g in live}
    chosen = agreeing(live, ways)
    made = {g.source: replace(g, tests=grouped(g, chosen[g.source])) for g in live}
    over = {g.source for g in live if any(_is_over(made[g.source], other) for other in made.values())}
    own = [g for g in made.values() if g.source not in over] or list(made.values())
    main = max(own, key=lambda g: (_told(g, own), len(g.tests), _voltage(g), -len(g.source)))
    known = {normal(t): t for g in own for t in g.tests if g is main or _told(g, [main])}
    for g in made.values():
        if g is main:
            continue
        if g in own and _told(g, [main]):
            made[g.source] = replace(g, tests={known.get(normal(t), t): f for t, f in g.tests.items()})
            continue
        made[g.source] = _by_time(g, [main])
    legal = _legal([t for g in made.values() for t in g.tests])
    made = {s: replace(g, tests={legal[t]: f for t, f in g.tests.items()}) for s, g in made.items()}
    ids = list(dict.fromkeys(t for g in made.values() for t in g.tests))
    every = [str(f.path) for g in groups for f in (*g.files, *g.calibrations)]
    every += sorted(set(besides) - set(every))
    return [
        _with_template(made[g.source], chosen[g.source].template, ids, every) if g.source in made else g for g in groups
    ]


def _legal(ids: Iterable[str]) -> dict[str, str]:
    """Ids as a campaign file allows them: no signs of paths and patterns, unique whatever the case."""
    found: dict[str, str] = {}
    taken: set[str] = set()
    for test in ids:
        if test in found:
            continue
        base = re.sub(r"[\x00-\x1f/\\{}*?\[\]]", "_", test).strip()[:110] or "test"
        name = numbered(base, lambda name: name.lower() in taken, "-")
        taken.add(name.lower())
        found[test] = name
    return found


def _allowed(group: Group) -> list[Naming]:
    """The ways to read its names that its clock does not contradict."""
    if sheets := _by_sheet(group):
        return [sheets]
    found = []
    for way in namings([f.path for f in group.files]):
        if way.parts and (not way.joins or one_recording(group, way) is False):
            continue
        if not way.parts and way.joins:
            continue
        found.append(way)
    return found


def _by_sheet(group: Group) -> Naming | None:
    """Of a workbook each sheet is a test, called as the sheet is, and so is each block of a table whose rows name their
    test; of several each names its file."""
    ids = tuple(f.part or "" for f in group.files)
    if not all(ids):
        return None
    files = {str(f.path) for f in group.files}
    return Naming(ids, re.sub(r"([*?[])", r"[\1]", files.pop()) if len(files) == 1 else None, 0.0)


def one_recording(group: Group, way: Naming) -> bool | None:
    """Whether the files that share an id follow each other without a pause; None where no clock tells."""
    verdicts: list[bool] = []
    going_on: list[bool] = []
    for files in grouped(group, way).values():
        if len(files) < 2:
            continue
        if all(f.start_ns is not None for f in files):
            verdicts += _follow(on_one_clock(files))
        elif (goes_on := _counts_on(files)) is not None:
            going_on.append(goes_on)
    if all(going_on):  # else each counts from its own start, and says nothing of the others
        verdicts += going_on
    return all(verdicts) if verdicts else None


def _counts_on(files: Sequence[RawFile]) -> bool | None:
    """Whether the relative times of files go on where the file before ended; None where they have other clocks."""
    if any(f.start_ns is not None or f.recording.start_ns is not None or f.sample.first_ns is None for f in files):
        return None
    found = _follow([(f.sample.first_ns or 0, f.sample.last_ns or 0, f.sample.whole) for f in files])
    return bool(found) and all(found)


def _follow(spans: Sequence[tuple[int, int, bool]]) -> list[bool]:
    """Whether each recording of several follows the one before it without a pause. spans: (first, last time [ns],
    whether that is the end)."""
    spans = sorted(spans)
    verdicts = []
    for (begin, end, whole), (following, _, _) in pairwise(spans):
        pause, length = following - end, max(end - begin, 1)
        if following <= begin or pause < -length // 10:
            verdicts.append(False)  # they ran at once
        elif whole:
            verdicts.append(pause <= max(length // 4, 60_000_000_000))
        elif len(spans) >= 3:
            gaps = [b[0] - a[0] for a, b in pairwise(spans)]
            verdicts.append(max(gaps) <= 1.5 * min(gaps))
    return verdicts


def counted_on(groups: Sequence[Group]) -> list[str]:
    """A note on each source whose tests are in parts, as their relative times alone say."""
    found = {g.source: [(t, f) for t, f in g.tests.items() if len(f) > 1 and _counts_on(f)] for g in groups}
    return [
        f"{source}: {counted(len(of), 'test')} in parts, e.g. {of[0][0]} in {counted(len(of[0][1]), 'file')}: the "
        "times of each go on where those of the one before ended"
        for source, of in found.items()
        if of
    ]


def agreeing(groups: Sequence[Group], ways: Mapping[str, list[Naming]]) -> dict[str, Naming]:
    """A way to read the names of each group, so that most files have their test in another group too."""
    best: tuple[tuple[float, ...], dict[str, Naming]] | None = None
    for lead in groups:
        for way in ways[lead.source]:
            ids = {normal(i) for i in way.ids}
            chosen, agreed, cost = {lead.source: way}, 0, _price(lead, way)
            for other in groups:
                if other is lead:
                    continue
                scored = [
                    ((sum(normal(i) in ids for i in w.ids) / len(w.ids), -_price(other, w)), n)
                    for n, w in enumerate(ways[other.source])
                ]
                (share, price), n = max(scored, key=lambda s: (s[0], -s[1]))
                chosen[other.source] = ways[other.source][n]
                both = {normal(i) for i in ways[other.source][n].ids} & ids
                agreed += len(both)
                cost += -price + (1 - share)
            score = (float(agreed), -cost, float(len(ids)))
            if best is None or score > best[0]:
                best = (score, chosen)
    assert best is not None
    return best[1]


def _price(group: Group, way: Naming) -> float:
    """What it costs to read names so: pieces left out; parts without a clock that shows them to be one recording are
    dear, and cheap with it."""
    if not way.parts:
        return way.cost
    return way.cost - 2.5 if one_recording(group, way) else way.cost + 0.5


def grouped(group: Group, way: Naming) -> dict[str, tuple[RawFile, ...]]:
    found: dict[str, list[RawFile]] = {}
    for test, file in zip(way.ids, group.files, strict=True):
        found.setdefault(test, []).append(file)
    return {t: tuple(f) for t, f in found.items()}


def _told(group: Group, others: Iterable[Group]) -> int:
    """How many of its tests another group has too, by name."""
    ids = {normal(t) for g in others if g is not group for t in g.tests}
    return sum(normal(t) in ids for t in group.tests)


def _is_over(group: Group, other: Group) -> bool:
    """Whether a group of one file, as a log of the hall is, runs over several tests of another one and is called after
    none of them: two such logs that are called alike are no test of their own."""
    return len(group.files) == 1 and not _told(group, [other]) and len(_inside(group, _begins(other))) > 1


def _begins(group: Group) -> dict[str, int]:
    """The first time of each test that has one [ns]."""
    return {t: min(s) for t, f in group.tests.items() if (s := [x.start_ns for x in f if x.start_ns is not None])}


def _inside(group: Group, begins: Mapping[str, int]) -> list[str]:
    """The tests that begin while a file of the group runs. begins: test -> its first time [ns]."""
    spans = [(f.start_ns, max(f.sample.last_ns or 0, f.start_ns)) for f in group.files if f.start_ns is not None]
    return [t for t, begin in begins.items() if any(a - _NEAR_NS <= begin <= b + _NEAR_NS for a, b in spans)]


def _voltage(group: Group) -> int:
    return sum(s.unit in ("V", "um", "µm", "mV") for s, _ in group.signals)


def _by_time(group: Group, others: Sequence[Group]) -> Group:
    """A group whose names agree with no other's: its files belong to the tests that ran at their time."""
    main = others[0]
    begins = _begins(main)
    own = [f for f in group.files if f.start_ns is not None]
    if not begins or len(own) < len(group.files):
        return group
    local = any(f.local for f in (*own, *(x for v in main.tests.values() for x in v)))
    parts: dict[str, tuple[RawFile, ...]] | None = {}
    if len(own) > 1 and len(begins) == len(main.tests) and all(f.sample.whole for f in own):
        ran = {t: (begins[t], max(max(x.sample.last_ns or 0, begins[t]) for x in f)) for t, f in main.tests.items()}
        parts = over_tests(own, ran, local)
        if parts:
            return replace(group, tests=parts, questions=("each file is of the tests that ran during it?",))
        if runs_across(own, ran, local):
            return replace(group, shared=True, tests={}, questions=("one log for many tests, in parts?",))
    for_many = replace(group, shared=True, tests={}, questions=("one log for many tests?",))
    if len(begins) > len(own) and len(_inside(group, begins)) > len(own):
        return for_many
    best: dict[str, RawFile] = {}
    for shift in sorted(range(-13, 15), key=abs):
        if shift and not local:
            continue
        paired: dict[str, RawFile] = {}
        # where summer time began or ended between the tests, the others are an hour further
        for hours in (shift, shift + 1, shift - 1) if shift else (shift,):
            for test, begin in begins.items():
                near = [f for f in own if abs((f.start_ns or 0) - hours * _HOUR_NS - begin) < _NEAR_NS]
                if test not in paired and len(near) == 1 and near[0] not in paired.values():
                    paired[test] = near[0]
        if len(paired) > len(best):
            best = paired
    if parts is None and len(best) < len(begins):  # some begin a whole number of hours from a day's file by chance
        return for_many
    if len(best) * 2 < len(own):
        return group
    joined = {f.path for f in best.values()}
    left = {t: f for t, f in group.tests.items() if not any(x.path in joined for x in f)}
    return replace(
        group, tests={**{t: (f,) for t, f in best.items()}, **left}, questions=("files joined to tests by their times",)
    )


def _with_template(group: Group, template: str | None, ids: Sequence[str], every: Sequence[str]) -> Group:
    """With the template where it finds, for every test of the campaign, exactly this group's files."""
    if group.shared:
        paths = [str(f.path) for f in group.files]
        return replace(group, template=_glob(paths, every))
    many = len(group.tests) > 1 or len(ids) == 1
    if template is not None and any(f.part for f in group.files):
        return replace(group, template=template)
    if (
        template is not None
        and many
        and all(sorted(matches(template, t, every)) == sorted(str(f.path) for f in group.tests.get(t, ())) for t in ids)
    ):
        return replace(group, template=template)
    return replace(group, template=None)


def _glob(paths: Sequence[str], every: Sequence[str]) -> str | None:
    """One glob for these paths and no others; None where there is none."""
    if len(paths) == 1:
        return re.sub(r"([*?[])", r"[\1]", paths[0])
    shortest = min(map(len, paths))
    lead = next((i for i in range(shortest) if len({p[i] for p in paths}) > 1), shortest)
    trail = next((i for i in range(shortest - lead) if len({p[-1 - i] for p in paths}) > 1), 0)
    made = f"{paths[0][:lead]}*{paths[0][len(paths[0]) - trail :]}"
    return made if sorted(matches(made, "", every)) == sorted(paths) else None


def files_of(group: Group, test: str) -> str | list[str]:
    """What `tests[].files` says of a group without a template: one path, or a list."""
    paths = [re.sub(r"([*?[])", r"[\1]", str(f.path)) for f in group.tests[test]]
    return paths[0] if len(paths) == 1 else paths


__all__ = ["agreeing", "counted_on", "files_of", "grouped", "one_recording", "tests_of"]
