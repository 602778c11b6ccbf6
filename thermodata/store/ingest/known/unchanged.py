"""The short ways of an ingest: what was found the last time stands still, so its answer does too; where some files
differ, so does the answer of the tests that have none of them.

A note beside the catalogue says from which state of the campaign file, of the source files, of the readers and of the
store the last answer was given; a second one holds a line for each test. Any other difference, and any doubt, and the
long way is gone; the notes may be deleted at any time.
"""

from __future__ import annotations

import hashlib
import json
import os
import time
from collections.abc import Iterable, Mapping, Sequence
from contextlib import suppress
from dataclasses import dataclass, field
from pathlib import Path
from typing import Any

from thermodata.archive.members import size_of, standing
from thermodata.errors import ThermodataError
from thermodata.store.base.files import is_whole, key_of
from thermodata.store.raw.source_file import SourceFile, mark_of, settled

FOLDER = "known"
# a file that was written just before its hash was made may differ and look the same: clocks of disks are coarse
_YOUNG_NS = 2_000_000_000


@dataclass(slots=True)
class FirstGlance:
    """What an ingest finds before it reads anything. says: a digest of the campaign, its files by name, the readers and
    this program; files: source path -> where it is; marks: source path -> by which a change is noticed, of those that
    can be looked at."""

    store: Path
    campaign: Path
    says: str
    files: Mapping[str, Path]
    began_ns: int = field(default_factory=time.time_ns)
    marks: dict[str, tuple[int, ...]] = field(default_factory=dict)

    def __post_init__(self) -> None:
        for path, full in self.files.items():
            with suppress(OSError, ValueError):
                self.marks[path] = mark_of(os.stat(standing(full)))

    @property
    def note(self) -> Path:
        """Where the answer to this campaign file is kept."""
        return self.store / FOLDER / f"{key_of(str(self.campaign))}.json"

    @property
    def test_notes(self) -> Path:
        """Where a line for each test is kept."""
        return self.note.with_suffix(".tests")


def seen(store: Path, campaign: Path, files: Mapping[str, Path], *words: str) -> FirstGlance:
    """words: everything besides the files' content that an answer depends on."""
    return FirstGlance(store, campaign, _digest("\0".join(words)), files)


def noted(here: FirstGlance) -> Mapping[str, Any]:
    """What the last ingest of this campaign file noted; nothing where it can't be told."""
    try:
        digest, _, text = here.note.read_text(encoding="utf-8").partition("\n")
        if digest != _digest(text):  # torn: nothing waits until a note is on the disk
            return {}
        kept: dict[str, Any] = json.loads(text)
    except (OSError, ValueError):
        return {}
    return kept


def known_files(here: FirstGlance, kept: Mapping[str, Any]) -> dict[str, SourceFile]:
    """Source path -> the file with the hash that was noted of it, of those that were left alone since."""
    found = {}
    with suppress(ValueError, TypeError, AttributeError, OSError, ThermodataError):  # a note of another version
        for path, (was, young, sha256) in kept.get("sources", {}).items():
            mark = here.marks.get(path)
            if mark == tuple(was) and not young:
                found[path] = SourceFile(here.files[path], str(sha256), size_of(here.files[path]), mark)
    return found


def differing(here: FirstGlance, kept: Mapping[str, Any], mark: str, known: dict[str, SourceFile]) -> set[str] | None:
    """The source files that are, or may be, other ones than when the last answer was given; None where anything else
    differs, or may differ.

    kept: what was `noted`. mark: of the store's last commit. known: the `known_files`; those that were young when they
    were hashed, and are the same, are added."""
    found = set()
    try:
        if not mark or kept["mark"] != mark or kept["says"] != here.says or len(here.marks) != len(here.files):
            return None
        if kept["catalogue"] != _catalogue(here.store) or kept["sources"].keys() != here.marks.keys():
            return None
        for path, (was, young, sha256) in kept["sources"].items():
            if tuple(was) != here.marks[path]:
                found.add(path)
            elif young:
                file = settled(here.files[path])
                if file.sha256 == sha256:
                    known[path] = file
                else:
                    found.add(path)
        if not all(is_whole(os.path.join(here.store, path), size) for path, size in kept["parts"].items()):
            return None
    except (OSError, ValueError, KeyError, TypeError, ThermodataError):  # none, or one of another version
        return None
    return found


def summary_of(kept: Mapping[str, Any]) -> dict[str, Any]:
    """The answer that was given, of a note from which nothing is `differing`."""
    return dict(kept["summary"])


def of_tests(here: FirstGlance, kept: Mapping[str, Any], tests: Sequence[str]) -> dict[str, str]:
    """Test -> its line of the second note, of a note of which at most source files are `differing`; none where it is
    torn. tests: of the campaign file, in its order."""
    try:
        text = here.test_notes.read_text(encoding="utf-8")
    except (OSError, ValueError):
        return {}
    lines = text.splitlines()
    return (
        dict(zip(tests, lines, strict=True)) if kept.get("tests") == _digest(text) and len(lines) == len(tests) else {}
    )


def keep(
    here: FirstGlance,
    mark: str,
    hashes: Mapping[str, str],
    parts: Mapping[str, int | None],
    summary: Mapping[str, Any],
    tests: Iterable[str],
) -> None:
    """Notes an answer, where it is one that the same ingest would give again. hashes: source path -> SHA-256;
    parts: the store's files, and their sizes where these are known; tests: a line for each."""
    if not mark or hashes.keys() != here.marks.keys() or len(here.marks) != len(here.files):
        return
    sources = {p: [m, max(m[3:]) > here.began_ns - _YOUNG_NS, hashes[p]] for p, m in here.marks.items()}
    with suppress(OSError, TypeError):  # a store that may only be read, or is full
        lines = "".join(f"{line}\n" for line in tests)
        text = json.dumps(
            {
                "mark": mark,
                "says": here.says,
                "catalogue": _catalogue(here.store),
                "sources": sources,
                "parts": parts,
                "summary": summary,
                "tests": _digest(lines),
            }
        )
        here.note.parent.mkdir(exist_ok=True)
        here.test_notes.write_text(lines, encoding="utf-8")
        here.note.write_text(f"{_digest(text)}\n{text}", encoding="utf-8")


def _digest(text: str) -> str:
    return hashlib.sha256(text.encode()).hexdigest()


def _catalogue(store: Path) -> list[list[int] | None]:
    """What changes where anybody writes the catalogue, through this program or not."""
    found: list[list[int] | None] = []
    for name in ("catalog.duckdb", "catalog.duckdb.wal"):
        try:
            status = os.stat(store / name)
        except FileNotFoundError:
            found.append(None)
        else:
            found.append([status.st_size, status.st_mtime_ns, status.st_ctime_ns])
    return found
