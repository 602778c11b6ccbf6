"""Files without a header beside one that has it: a logger that begins a new file every hour, and writes names into the
first only."""

from __future__ import annotations

import re
from collections.abc import Sequence
from dataclasses import replace
from pathlib import Path, PurePosixPath

from thermodata.archive.unpacked import unpacked
from thermodata.draft.files.described_file import described_files, sample_of_file
from thermodata.draft.files.file_question import FileQuestion
from thermodata.draft.files.raw_file import RawFile
from thermodata.draft.signals.guess import NUMBERED
from thermodata.errors import ThermodataError
from thermodata.reader.files.rotated import unrotated
from thermodata.reader.finding.registry import reader
from thermodata.reader.text.tables.find_table import open_table
from thermodata.schema.words.sentences import counted

_NUMBER = re.compile(r"[\W_]*\d+\)?")


def with_lent_names(folder: Path, logs: Sequence[RawFile]) -> tuple[RawFile, ...]:
    """The logs; those without names with the names of the files that are called alike but for numbers, where these
    agree on them and have as many columns of the same kinds. It is asked whether that is right."""
    nameless: dict[str, list[RawFile]] = {}
    named: dict[str, list[RawFile]] = {}
    for file in logs:
        (nameless if _is_nameless(file) else named).setdefault(_kind(file.path), []).append(file)
    lent: dict[int, RawFile] = {}
    for kind, files in nameless.items():
        names = _names_of(folder, named.get(kind, ()))
        if names is None:
            continue
        of, words = named[kind][0], list(names)
        bare = f"{counted(len(files), 'file')} without a header, e.g. {files[0].path}"
        asked = FileQuestion(f"names? {bare}: those of {of.path} are taken", {"names": words})
        by_path: dict[str, RawFile] = {}
        for file in files:
            like = by_path.get(file.like or "")
            made = _like(file, like) if like is not None else _described(folder, file, of, asked)
            if made is not None:
                lent[id(file)] = by_path[str(file.path)] = made
    return tuple(lent.get(id(f), f) for f in logs)


def _is_nameless(file: RawFile) -> bool:
    return file.sheet is None and bool(file.signals) and all(NUMBERED.fullmatch(s.name) for s in file.signals)


def _kind(path: PurePosixPath) -> str:
    """Its name without the numbers of parts: 'run', 'run_1' and 'run (2)' have the same, as 'run.log' and the piece of
    it that was put aside as 'run.log.2'."""
    path = unrotated(path)
    bare = _NUMBER.sub("", path.stem)
    return f"{path.parent}/{bare}{path.suffix}".lower()


def _names_of(folder: Path, files: Sequence[RawFile]) -> tuple[str, ...] | None:
    """The names of all columns that the files have, as their headers have them; None where these differ."""
    own = {tuple((s.name, s.dtype) for s in f.signals) for f in files}
    if len(own) != 1:
        return None
    try:
        return open_table(unpacked(folder / files[0].path), files[0].source).layout.names
    except (ThermodataError, OSError):
        return None  # no text, or one that another reader takes apart


def _described(folder: Path, file: RawFile, of: RawFile, asked: FileQuestion) -> RawFile | None:
    """The file by the names of another; None where it is not of that kind."""
    path = folder / file.path
    try:
        made = described_files(reader(of.reader), path, file.path, table=dict(asked.declare))[0]
    except (ThermodataError, OSError):
        return None
    if [(s.name, s.dtype) for s in made.signals] != [(s.name, s.dtype) for s in of.signals]:
        return None
    made = replace(made, asked=(asked, *made.asked))
    return replace(made, sample=sample_of_file(path, made)) if file.sample.rows else made


def _like(file: RawFile, other: RawFile) -> RawFile:
    """A file that was not opened, as the one that it is taken to be like."""
    return replace(file, reader=other.reader, recording=other.recording, asked=other.asked, table=other.table)
