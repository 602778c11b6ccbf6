"""The tests as a draft has them: kind and conditions of each by its name, its files, a table and a note beside them."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import dataclass, replace
from itertools import pairwise
from math import isclose
from pathlib import Path

from thermodata.draft.campaign.parts import DraftTest
from thermodata.draft.courses.kinds import Kind, kind_of
from thermodata.draft.courses.measuring import Measuring, rule_of
from thermodata.draft.courses.same_rule import same_rules
from thermodata.draft.courses.warm import warm_starts
from thermodata.draft.files.raw_file import RawFile
from thermodata.draft.folder.beside.listed_times import ListedTime
from thermodata.draft.folder.beside.notes import Note, notes_of
from thermodata.draft.folder.beside.table import TestTable
from thermodata.draft.folder.into_sources.sources import Group
from thermodata.draft.folder.into_tests.goes_on import rest_of_others
from thermodata.draft.folder.into_tests.group import files_of
from thermodata.draft.folder.put_aside.file_copies import other_versions
from thermodata.draft.probes.end_of_range import range_questions
from thermodata.draft.probes.jump_within import window_behind_jumps
from thermodata.draft.times.beside_list import not_as_listed, start_listed
from thermodata.draft.times.block_windows import window_question
from thermodata.draft.times.clocks import Alignment, Named
from thermodata.draft.times.one_clock import on_one_clock
from thermodata.draft.words.numbered import without_number
from thermodata.draft.words.roles import said_by_list
from thermodata.reader.times.open_questions import UNKNOWN
from thermodata.store.catalogue.conditions import plain_unit, plain_value

_DAY_NS = 86_400 * 10**9


@dataclass(frozen=True, slots=True)
class _BesideTest:
    """What is known of a test beside its files. listed: its row of the table of tests; began: when it began by that;
    warm: the doubt that it began at rest; version: a log that this one may be another version of; goes_on: the question
    whether it is the rest of another one; otherwise: what its logs say of when it ran that the table does not."""

    listed: Mapping[str, str]
    began: ListedTime | None
    note: Note | None
    warm: str | None
    version: RawFile | None
    goes_on: str | None
    otherwise: Sequence[str]


def drafted_tests(
    folder: Path,
    groups: Sequence[Group],
    table: TestTable | None,
    keyed: Mapping[str, Named],
    texts: Sequence[str],
    aligned: Mapping[str, Alignment],
) -> tuple[DraftTest, ...]:
    """All tests of a folder. keyed: source -> its channels, by (stream, signal) of the files; texts: files that may
    say what tests are; aligned: source -> what is guessed of its clock."""
    ids = list(dict.fromkeys(t for g in groups for t in g.tests))
    recordings = {t: [f for g in groups for f in g.tests.get(t, ())] for t in ids}
    sources = {id(f): g.source for g in groups for f in (*g.files, *(x for own in g.tests.values() for x in own))}
    named = {file: keyed[source] for file, source in sources.items()}
    of_sources = on_one_clock(keyed, aligned)
    clocks = {file: of_sources[source] for file, source in sources.items()}
    rows, times = (table.rows, table.times) if table else ({}, {})
    notes = notes_of(folder, [p for p in texts if table is None or p != table.file], recordings)
    warm = warm_starts(recordings, named)
    versions = {t: v for g in groups for t, v in other_versions(g.tests).items()}
    rest = {t: asked for g in groups for t, asked in rest_of_others(g.source, g.tests).items()}
    otherwise = not_as_listed(recordings, times)
    more = {t: (rest.get(t), otherwise.get(t, ())) for t in ids}
    beside = {
        t: _BesideTest(rows.get(t, {}), times.get(t), notes.get(t), warm.get(t), versions.get(t), *more[t]) for t in ids
    }
    called = without_number(ids)
    rules, differ = same_rules({t: rule_of(recordings[t], named, clocks) for t in ids}, recordings, named, clocks)
    drafted = (_drafted(t, recordings[t], groups, rules[t], beside[t], called[t]) for t in ids)
    return tuple(replace(d, doubts=(*d.doubts, differ[d.id])) if d.id in differ else d for d in drafted)


def _drafted(
    test: str,
    files: Sequence[RawFile],
    groups: Sequence[Group],
    measuring: Measuring | None,
    beside: _BesideTest,
    called: str,
) -> DraftTest:
    """called: what its name says, without its number."""
    listed, version = beside.listed, beside.version
    kind = kind_of(called, files, listed)
    asked = [f"another version of {version.path}? it has the same minutes"] if version is not None else []
    asked += [beside.goes_on] if beside.goes_on else []
    conditions, doubts = dict(kind.conditions), [*kind.doubts, *([beside.warm] if beside.warm else []), *asked]
    if (role := said_by_list(listed)) is not None:
        kind = replace(kind, role_hint=role[0], role_by=f"the table's '{role[1]}'")
    for key, value in listed.items():
        if key in conditions and not _agree(conditions[key], value):
            doubts.append(f"{key}: the name says {conditions[key]}, the table {value}")
            continue
        conditions[key] = value
    start, began = start_listed(files, beside.began)
    kind = replace(kind, start=start) if start is not None and kind.start is None else kind
    doubts += [*filter(None, [began]), *beside.otherwise]
    if beside.note is not None:
        kind, conditions, more = _with_note(kind, conditions, beside.note)
        doubts += more
    logs = [found for g in groups if (found := g.tests.get(test))]
    own = {g.source: files_of(g, test) for g in groups if g.template is None and test in g.tests}
    block = next((f.block for f in files if f.block is not None), None)
    window = None if block is None else block.window
    if block is not None and block.said is not None:
        doubts.append(f"window: {block.said}; history: recording where it does not begin at rest")
    if window is not None and len(files) > 1:
        doubts.append(window_question(files))
    if window is None and (jumps := window_behind_jumps(files)) is not None:
        doubts.append(jumps)
    doubts += range_questions(files)
    return DraftTest(test, kind, conditions, own, tuple(doubts), measuring, window, _length_s(logs, window))


def _length_s(logs: Sequence[Sequence[RawFile]], window: tuple[float, float] | None) -> float | None:
    """Of the longest of a test's logs, whose clocks may differ; None where a file was not read to its end, or nobody
    knows its days. logs: the files of each source, which are parts of one."""
    if window is not None:
        return window[1] - window[0]
    dated = [files for files in logs if not _may_be_of_other_days(files)]
    if logs and not dated:
        return None
    spans = [_span_s(files) for files in dated]
    known = [s for s in spans if s is not None]
    return max(known) if known and len(known) == len(spans) else None


def _may_be_of_other_days(files: Sequence[RawFile]) -> bool:
    """Whether a log goes from one day into another while it is asked which of its numbers are days and which months."""
    open_order = any(a.declare.get("time", {}).get("format") == UNKNOWN and not a.told for f in files for a in f.asked)
    times = [t for f in files for t in (f.sample.first_ns, f.sample.last_ns) if t is not None]
    return open_order and bool(times) and min(times) // _DAY_NS != max(times) // _DAY_NS


def _span_s(files: Sequence[RawFile]) -> float | None:
    """From the first row of a log to its last, with the pauses between its parts where clocks tell these."""
    ends = [(f.sample.first_ns, f.sample.last_ns) for f in files if f.sample.whole]
    told = sorted((first, last) for first, last in ends if first is not None and last is not None)
    if not told or len(told) < len(files):
        return None
    if any(then < last for (_, last), (then, _) in pairwise(told)):  # each counts from its own start
        return sum(last - first for first, last in told) / 1e9
    return (told[-1][1] - told[0][0]) / 1e9


def _agree(one: str, other: str) -> bool:
    """Whether two texts say the same condition: '8 krpm' and '8000 rpm'. Of a number without a unit the number does."""
    units = plain_unit(one), plain_unit(other)
    if None in units:
        return one.split()[0].casefold() == other.split()[0].casefold()
    a, b = plain_value(one), plain_value(other)
    return units[0] == units[1] and isinstance(a, float) and isinstance(b, float) and isclose(a, b, rel_tol=1e-9)


def _with_note(kind: Kind, conditions: Mapping[str, str], note: Note) -> tuple[Kind, dict[str, str], list[str]]:
    """(the kind with what a note says of its test in its comment, the conditions with those that it adds, doubts)."""
    told = {key: value for key, value in note.conditions.items() if key not in conditions}
    doubts = list[str]()
    for key, value in note.conditions.items():
        if key not in told and not _agree(conditions[key], value):
            doubts.append(f"{key}: {note.file} says {value}, and {conditions[key]} is taken")
    comments = [f"{', '.join(told)} guess: {note.file}" if told else "", note.comment()]
    kind = replace(kind, comment="; ".join(filter(None, (kind.comment, *comments))))
    return kind, {**conditions, **told}, doubts
