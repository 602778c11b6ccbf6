"""A file of a folder as its reader describes it: with what it leaves open, sheet by sheet, and with a sample."""

from __future__ import annotations

import re
from collections.abc import Mapping, Sequence, Set
from dataclasses import replace
from pathlib import Path, PurePosixPath
from typing import Any

from thermodata.archive.members import size_of
from thermodata.archive.unpacked import held
from thermodata.draft.files.file_question import FileQuestion, of_notes, open_order
from thermodata.draft.files.ini_beside import offered_by_ini
from thermodata.draft.files.letters_of_files import letters_of
from thermodata.draft.files.raw_file import RawFile
from thermodata.draft.files.sample import Sample, sample_of
from thermodata.draft.files.sheets import sheet_like, sheets_of
from thermodata.draft.signals.named_by_units import with_names_as_units
from thermodata.errors import QuestionError
from thermodata.plugin import Reader, Recording
from thermodata.reader.contract.guard import described
from thermodata.reader.finding.explain import kind_of, why_no_table
from thermodata.reader.finding.registry import claims, reader

_MOST_QUESTIONS = 4


def sampled_file(folder: Path, path: PurePosixPath) -> RawFile | None:
    """One file of a folder with a sample of its values; None where no reader, or more than one, claims it.

    ThermodataError where it cannot be read at all.
    """
    who, _ = claimant(folder / path)
    if who is None:
        return None
    file = described_files(who, folder / path, path)[0]
    return replace(file, sample=sample_of_file(folder / path, file))


def described_file(
    who: Reader,
    full: Path,
    path: PurePosixPath,
    encoding: str | None,
    table: Mapping[str, Any] | None = None,
) -> RawFile:
    """A file as its reader describes it, with what it leaves open. encoding: what somebody declared for texts that are
    no UTF-8; table: answers to what it leaves open.

    ThermodataError where it cannot be read at all.
    """
    with held(full) as real:
        size, letters = real.stat().st_size, letters_of(real, encoding)
        return _asking(
            who, full, RawFile(path, who.name, Recording((), "relative"), size, table=table, letters=letters)
        )


def described_files(
    who: Reader,
    full: Path,
    path: PurePosixPath,
    table: Mapping[str, Any] | None = None,
) -> list[RawFile]:
    """The same; a workbook whose sheets are alike sheet by sheet."""
    return sheet_by_sheet(who, full, described_file(who, full, path, None, table))


def sheet_by_sheet(who: Reader, full: Path, whole: RawFile) -> list[RawFile]:
    """A workbook whose sheets, or a recording whose groups, are alike, as that many files; any other as it is."""
    names, besides = sheets_of(whole.recording)
    return _by_sheets(who, full, whole, names, besides) if names else [whole]


def of_one_sheet(full: Path, whole: RawFile, others: Sequence[RawFile]) -> RawFile:
    """A recording of one group, or a workbook of one sheet, as that, where it is of the kind of others whose sheets are
    tests; any other as it is."""
    alike = [o for o in others if (o.reader, o.path.suffix.lower()) == (whole.reader, whole.path.suffix.lower())]
    home = sheet_like(whole.recording, [o.recording for o in alike])
    if home is None:
        return whole
    return _by_sheets(reader(whole.reader), full, replace(whole, sample=Sample()), [home], [])[0]


def _by_sheets(who: Reader, full: Path, whole: RawFile, names: Sequence[str], besides: Sequence[str]) -> list[RawFile]:
    found = []
    left = [f"its sheet '{n}' is not like the {len(names)} others: a list of tests, or notes?" for n in besides]
    left += [f"its {note}" for note in whole.recording.notes if re.match(r"sheet '.*' is not read", note)]
    asked = tuple(a for a in whole.asked if a.declare)  # what one sheet leaves open, all are declared by
    for name in names:
        table = {**(whole.table or {}), "sheet": name}
        one = replace(whole, sheet=name, besides=tuple(left), table=table, asked=asked)
        found.append(_asking(who, full, one))
    return found


def _asking(who: Reader, full: Path, file: RawFile) -> RawFile:
    """The file described, each of its questions answered for the time being."""
    asked = list(file.asked)
    table: dict[str, Any] = dict(file.table or {})
    while True:
        try:
            recording = described(who, full, replace(file, table=table or None).source)
            order = next((o for n in recording.notes if (o := open_order(n)) is not None), None)
            # a note may quote a file that says so itself: asked once
            if order is None or any(one.declare == order.declare for one in asked):
                break
            asked.append(order)
            table = merged(table, {"time": dict.fromkeys(order.declare["time"], "dmy")})
        except QuestionError as question:
            if len(asked) == _MOST_QUESTIONS:
                raise
            told = offered_by_ini(full) if question.ask.startswith("period") else ""
            asked.append(
                FileQuestion(question.ask + told, question.declare, question.times, begins_s=question.begins_s)
            )
            table = merged(table, question.meanwhile)
    asked += of_notes(recording.notes, timed=any("time" in a.declare for a in asked))
    left = _without_times(recording, {name for a in asked for name in a.times})
    signals, as_units = with_names_as_units(left.signals)
    if as_units is not None:
        left, asked = replace(left, signals=signals), [*asked, FileQuestion(as_units, {})]
    return replace(file, recording=left, delivered=recording, asked=tuple(asked), table=table or None)


def _without_times(recording: Recording, times: Set[str]) -> Recording:
    """The recording without the columns that are its time once a question is answered: no channels are drafted of
    them."""
    left = tuple(s for s in recording.signals if s.name not in times and s.name.partition("/")[2] not in times)
    return replace(recording, signals=left) if left else recording


def merged(one: Mapping[str, Any], other: Mapping[str, Any]) -> dict[str, Any]:
    """Both declarations; of what is in both, the parts of both."""
    out = dict(one)
    for key, value in other.items():
        out[key] = (
            merged(out[key], value) if isinstance(out.get(key), Mapping) and isinstance(value, Mapping) else value
        )
    return out


def claimant(path: Path) -> tuple[Reader | None, str]:
    """The one reader that claims a file, or None and why there is none."""
    found = claims(path)
    if len(found) == 1:
        return reader(next(iter(found))), ""
    if not size_of(path):
        return None, "an empty file"
    if not found:
        why = why_no_table(path)
        return None, f"no reader claims it ({kind_of(path)}): {why or 'thermodata sniff says why'}"
    said = " and ".join(f"{name} ({why})" for name, why in found.items())
    return (
        None,
        f"two readers claim it: {said}; declare one as the reader of a source, such as reader: {next(iter(found))}",
    )


def sample_of_file(path: Path, file: RawFile) -> Sample:
    """A sample of a file's values, as it was described."""
    return sample_of(path, reader(file.reader), file.source, file.delivered or file.recording, file.size)
