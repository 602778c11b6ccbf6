"""The short way of an ingest that changes nothing: what was found the last time stands still, so its answer does too.

A note beside the catalogue says from which state of the campaign file, of the source files, of the readers and of the
store the last answer was given. Any difference, and any doubt, and the long way is gone; the note may be deleted at
any time.
"""

from __future__ import annotations

import hashlib
import json
import os
import time
from collections.abc import Mapping
from contextlib import suppress
from dataclasses import dataclass, field
from pathlib import Path
from typing import Any

from thermodata.store.base.files import is_whole, key_of
from thermodata.store.raw.source_file import SourceFile, mark_of, settled

FOLDER = "known"
# a file that was written just before its hash was made may differ and look the same: clocks of disks are coarse
_YOUNG_NS = 2_000_000_000


@dataclass(slots=True)
class Seen:
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
                self.marks[path] = mark_of(os.stat(full))

    @property
    def note(self) -> Path:
        """Where the answer to this campaign file is kept."""
        return self.store / FOLDER / f"{key_of(str(self.campaign))}.json"


def seen(store: Path, campaign: Path, files: Mapping[str, Path], *words: str) -> Seen:
    """words: everything besides the files' content that an answer depends on."""
    return Seen(store, campaign, _digest("\0".join(words)), files)


def noted(here: Seen) -> Mapping[str, Any]:
    """What the last ingest of this campaign file noted; nothing where it can't be told."""
    try:
        digest, _, text = here.note.read_text(encoding="utf-8").partition("\n")
        if digest != _digest(text):  # torn: nothing waits until a note is on the disk
            return {}
        kept: dict[str, Any] = json.loads(text)
    except (OSError, ValueError):
        return {}
    return kept


def known_files(here: Seen, kept: Mapping[str, Any]) -> dict[str, SourceFile]:
    """Source path -> the file with the hash that was noted of it, of those that were left alone since."""
    found = {}
    with suppress(ValueError, TypeError, AttributeError):  # a note of another version
        for path, (was, young, sha256) in kept.get("sources", {}).items():
            mark = here.marks.get(path)
            if mark == tuple(was) and not young:
                found[path] = SourceFile(here.files[path], str(sha256), mark[2], mark)
    return found


def answer(here: Seen, kept: Mapping[str, Any], mark: str) -> dict[str, Any] | None:
    """The summary that was given when all stood as it stands now; None where anything differs, or may differ.

    kept: what was `noted`. mark: of the store's last commit."""
    try:
        if not mark or kept["mark"] != mark or kept["says"] != here.says or len(here.marks) != len(here.files):
            return None
        if kept["catalogue"] != _catalogue(here.store) or kept["sources"].keys() != here.marks.keys():
            return None
        for path, (was, young, sha256) in kept["sources"].items():
            if tuple(was) != here.marks[path]:
                return None
            if young and settled(here.files[path]).sha256 != sha256:
                return None
        if not all(is_whole(os.path.join(here.store, path), size) for path, size in kept["parts"].items()):
            return None
        summary: dict[str, Any] = kept["summary"]
    except (OSError, ValueError, KeyError, TypeError):  # none, or one of another version
        return None
    return summary


def keep(
    here: Seen, mark: str, hashes: Mapping[str, str], parts: Mapping[str, int | None], summary: Mapping[str, Any]
) -> None:
    """Notes an answer, where it is one that the same ingest would give again. hashes: source path -> SHA-256;
    parts: the store's files, and their sizes where these are known."""
    if not mark or hashes.keys() != here.marks.keys() or len(here.marks) != len(here.files):
        return
    sources = {p: [m, max(m[3:]) > here.began_ns - _YOUNG_NS, hashes[p]] for p, m in here.marks.items()}
    with suppress(OSError, TypeError):  # a store that may only be read, or is full
        text = json.dumps(
            {
                "mark": mark,
                "says": here.says,
                "catalogue": _catalogue(here.store),
                "sources": sources,
                "parts": parts,
                "summary": summary,
            }
        )
        here.note.parent.mkdir(exist_ok=True)
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
