"""One test as a draft has it: its kind and conditions by its name, its files, a table and a note beside them."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import replace

from thermodata.draft.campaign.parts import DraftTest
from thermodata.draft.courses.kinds import Kind, kind_of
from thermodata.draft.courses.measuring import rule_of
from thermodata.draft.files.raw_file import RawFile
from thermodata.draft.folder.group import files_of
from thermodata.draft.folder.notes import Note
from thermodata.draft.folder.sources import Group
from thermodata.draft.folder.table import TestTable
from thermodata.draft.probes.end_of_range import range_questions
from thermodata.draft.probes.jump_within import window_behind_jumps
from thermodata.draft.times.beside_list import start_listed
from thermodata.draft.times.block_windows import window_question
from thermodata.draft.times.clocks import Named
from thermodata.draft.words.roles import said_by_list


def drafted_test(
    test: str,
    groups: Sequence[Group],
    table: TestTable | None,
    named: Mapping[int, Named],
    warm: str | None,
    version: RawFile | None,
    note: Note | None,
    otherwise: Sequence[str] = (),
) -> DraftTest:
    """otherwise: what its logs say of when it ran that a table does not."""
    files = [f for g in groups for f in g.tests.get(test, ())]
    listed = table.rows.get(test, {}) if table else {}
    kind = kind_of(test, files, listed)
    asked = [f"another version of {version.path}? it has the same minutes"] if version is not None else []
    conditions, doubts = dict(kind.conditions), [*kind.doubts, *([warm] if warm else []), *asked]
    if (role := said_by_list(listed)) is not None:
        kind = replace(kind, role_hint=role[0], role_by=f"the table's '{role[1]}'")
    for key, value in listed.items():
        if key in conditions and conditions[key].split()[0] != value.split()[0]:
            doubts.append(f"{key}: the name says {conditions[key]}, the table {value}")
            continue
        conditions[key] = value
    start, began = start_listed(files, table.times.get(test) if table else None)
    kind = replace(kind, start=start) if start is not None and kind.start is None else kind
    doubts += [*filter(None, [began]), *otherwise]
    if note is not None:
        kind, more = with_note(kind, conditions, note)
        doubts += more
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
    return DraftTest(test, kind, conditions, own, tuple(doubts), rule_of(files, named), window)


def with_note(kind: Kind, conditions: dict[str, str], note: Note) -> tuple[Kind, list[str]]:
    """(the kind with what a note says of its test in its comment, doubts); the conditions get those that they lack."""
    told, doubts = list[str](), list[str]()
    for key, value in note.conditions.items():
        if key not in conditions:
            conditions[key] = value
            told.append(key)
        elif conditions[key].split()[0].casefold() != value.split()[0].casefold():
            doubts.append(f"{key}: {note.file} says {value}, and {conditions[key]} is taken")
    comments = [f"{', '.join(told)} guess: {note.file}" if told else "", note.comment()]
    return replace(kind, comment="; ".join(filter(None, (kind.comment, *comments)))), doubts
