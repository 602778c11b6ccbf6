"""Looks at every file of a folder: who reads it, what it holds, and a bounded sample of its values.

A folder may hold 50 GB: heads and headers are read of every file, values of the first blocks only, and of a few files
of each kind once the time for it is used up.
"""

from __future__ import annotations

import re
from collections.abc import Mapping
from dataclasses import dataclass
from pathlib import Path

from thermodata.archive.cut import cut_archives
from thermodata.draft.files.described_file import of_one_sheet
from thermodata.draft.files.raw_file import RawFile
from thermodata.draft.folder.files import files_below, spread
from thermodata.draft.folder.into_sources.lent_names import with_lent_names
from thermodata.draft.folder.into_sources.of_one_time import in_every_file
from thermodata.draft.folder.look import Look, Progress, sampled
from thermodata.draft.folder.put_aside.file_copies import beginnings_in, copies_in, unfinished_in
from thermodata.draft.folder.put_aside.packed_copies import by_archive, packed_copies
from thermodata.draft.folder.put_aside.settings import settings_in
from thermodata.schema.words.sentences import counted


@dataclass(frozen=True, slots=True)
class Scan:
    """logs: files to draft from; ignored: (path, reason) of the others; failed: (path, reader) of those among them that
    a reader claims and could not read; damaged: (path, what) of logs with a defect; others: files that are no logs but
    may be tables of tests."""

    logs: tuple[RawFile, ...]
    ignored: tuple[tuple[str, str], ...] = ()
    damaged: tuple[tuple[str, str], ...] = ()
    others: tuple[str, ...] = ()
    failed: tuple[tuple[str, str], ...] = ()


def scan(folder: Path, progress: Progress | None = None, encoding: str | None = None) -> Scan:
    """All files below the folder; hidden ones, stores and links are left out. progress: (done, of, path); encoding:
    what somebody declared for texts that are no UTF-8."""
    paths = list(files_below(folder))
    tell = progress or (lambda done, of, path: None)
    copies, unfinished = copies_in(folder, paths) | packed_copies(folder, paths), unfinished_in(paths)
    beginnings = beginnings_in(folder, [p for p in paths if p not in copies and p not in unfinished])
    look = Look(folder, encoding, copies, beginnings, unfinished)
    for done, path in enumerate(spread(paths)):
        tell(done, len(paths), str(path))
        look.at(path)
    look.again_as_others()
    logs = look.logs
    for one, whole in in_every_file(look.apart).items():
        logs = {key: made for key, made in logs.items() if str(made.path) != one} | {one: whole}
    logs = _with_single_sheets(folder, logs)
    read = sampled(folder, logs, tell)
    damaged = list(dict.fromkeys((str(f.path), _damage(f)) for f in read if _damage(f)))
    damaged += cut_archives(map(str, paths), lambda path: folder / path).items()
    position = {str(p): i for i, p in enumerate(paths)}
    ignored, failed = (sorted(told, key=lambda item: position[item[0]]) for told in (look.ignored, look.failed))
    ignored = by_archive(folder, ignored, [path for path, _ in failed], [str(f.path) for f in read])
    no_lists = {str(p) for p in (*copies, *unfinished, *beginnings)}  # a log is no list of tests
    return Scan(
        with_lent_names(folder, sorted(read, key=lambda f: position[str(f.path)])),
        (*ignored, *settings_in(folder)),
        tuple(damaged),
        tuple(dict.fromkeys(p for p, _ in ignored if p not in no_lists)),
        tuple(failed),
    )


def _with_single_sheets(folder: Path, logs: Mapping[str, RawFile]) -> dict[str, RawFile]:
    """The logs, those of one sheet as that where the sheets of others of their kind are tests."""
    apart = [f for f in logs.values() if f.sheet]
    found = {}
    for key, file in logs.items():
        made = of_one_sheet(folder / file.path, file, apart) if apart and file.part is None and not file.like else file
        found[key if made is file else f"{key}/{made.part}"] = made
    return found


def _damage(file: RawFile) -> str:
    if file.sample.failed:
        return f"reader '{file.reader}' stopped in it: {file.sample.failed}"
    if file.recording.complete is False:
        wrong = [n for n in file.recording.notes if re.search(r"cut|damag|end|incomplete|lost|truncat|missing|past", n)]
        return wrong[0] if wrong else "it does not end as it should"
    lost = file.sample.losses
    if not lost:
        return ""
    said = "; ".join(file.sample.lost) + ("; ..." if lost > len(file.sample.lost) else "")
    return f"{counted(lost, 'loss')} in what was read of it: {said}"
