"""Tests that may be the rest of one before: 'P3_9000_Fortsetzung' or 'P3_9000_2', soon after 'P3_9000' ended."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from pathlib import PurePosixPath

from thermodata.draft.files.raw_file import RawFile
from thermodata.draft.folder.put_aside.file_copies import is_named_after
from thermodata.draft.words.filenames import without_part

_SOON_NS = 2 * 3600 * 1_000_000_000


def rest_of_others(source: str, tests: Mapping[str, Sequence[RawFile]]) -> dict[str, str]:
    """Test -> what to ask of it, where its one file is called after that of another test of the source, or as the
    part of a number of it, and begins within two hours of its end. source: its name."""
    single = [(test, files[0]) for test, files in tests.items() if len(files) == 1 and files[0].part is None]
    found: dict[str, str] = {}
    for test, file in single:
        for other, before in single:
            pause_s = _pause_s(before, file)
            if pause_s is not None and test != other and _is_named_on(file.path, before.path):
                found[test] = (
                    f"does it go on '{other}', which ended {_shown(pause_s)} before? then one test, "
                    f"files: {{{source}: ['{before.path}', '{file.path}']}}"
                )
    return found


def _is_named_on(path: PurePosixPath, before: PurePosixPath) -> bool:
    """Whether a name is another one with more words, or with the number of a part: 'M-123_2' of 'M-123'."""
    part = path.parent == before.parent and path.suffix == before.suffix and without_part(path.stem) == before.stem
    return part or is_named_after(path, before)


def _pause_s(before: RawFile, file: RawFile) -> float | None:
    """From the end of a file to the beginning of another one; None where that is long, or not known."""
    end = before.sample.last_ns if before.sample.whole else None
    if file.start_ns is None or before.start_ns is None or end is None or not 0 <= file.start_ns - end <= _SOON_NS:
        return None
    return (file.start_ns - end) / 1e9


def _shown(seconds: float) -> str:
    return f"{seconds / 60:.0f} min" if seconds >= 90 else f"{seconds:.0f} s"
