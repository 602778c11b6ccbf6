"""One instrument whose tests stand in two formats: 'day1.csv' and 'day2.xlsx' with the same signals, of which two
readers would make two sources and each channel twice."""

from __future__ import annotations

from collections.abc import Sequence
from pathlib import Path

from thermodata.draft.files.described_file import described_file
from thermodata.draft.files.raw_file import RawFile
from thermodata.draft.folder.into_sources.sources import Group
from thermodata.errors import ThermodataError
from thermodata.reader.finding.registry import reader
from thermodata.reader.text import split_unit
from thermodata.schema.words.sentences import counted

_FEWEST = 2  # signals that are called alike
_ANY = "table"  # reads most tables of the others, where it is declared


def two_formats(group: Group, groups: Sequence[Group], folder: Path) -> str | None:
    """What to ask of a source that has the signals of an earlier one, in other tests and at other times; None of
    another."""
    earlier = groups[: next(i for i, g in enumerate(groups) if g is group)]
    other = next((g for g in earlier if _is_one(group, g)), None)
    if other is None:
        return None
    said = (
        f"is it the instrument of '{other.source}' in another format? It has the same "
        f"{counted(len(_names(group)), 'signal')}, and no test of that"
    )
    both = _reader_of_both(other, group, folder)
    if both is None or other.template is None or group.template is None:
        return f"{said}: then save its files in the format of the others, for one source and each channel once"
    files = f'["{other.template}", "{group.template}"]'
    return f"{said}: then one source for both, {{reader: {both}, files: {files}}}, and each channel once"


def _is_one(group: Group, other: Group) -> bool:
    formats = {(g.reader, f.path.suffix.lower()) for g in (group, other) for f in g.files}
    own, its = _names(group), _names(other)
    alike = len(own) >= _FEWEST and own == its and len(formats) > 1
    return (
        alike
        and not (group.shared or other.shared)
        and group.tests.keys().isdisjoint(other.tests)
        and not (_ran_at_once(group, other))
    )


def _names(group: Group) -> set[str]:
    return {split_unit(s.name)[0].casefold() for s, _ in group.signals}


def _ran_at_once(one: Group, other: Group) -> bool:
    """Whether a file of one was written while one of the other was: two instruments of one make."""
    spans = [_spans(g.files) for g in (one, other)]
    return any(a < end and begin < b for a, b in spans[0] for begin, end in spans[1])


def _spans(files: Sequence[RawFile]) -> list[tuple[int, int]]:
    return [(f.start_ns, max(f.sample.last_ns or 0, f.start_ns)) for f in files if f.start_ns is not None]


def _reader_of_both(one: Group, other: Group, folder: Path) -> str | None:
    """The name of the reader that reads the files of both, with the same signals."""
    if one.reader == other.reader:
        return one.reader
    if _ANY not in (one.reader, other.reader):
        return None
    foreign = next(g for g in (one, other) if g.reader != _ANY)
    try:
        found = described_file(reader(_ANY), folder / foreign.files[0].path, foreign.files[0].path, None)
    except ThermodataError:
        return None
    same = {s.name for s in found.signals} == {s.name for s in foreign.files[0].signals}
    return _ANY if same else None
