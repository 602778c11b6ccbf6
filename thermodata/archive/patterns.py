"""Patterns of file names, and what they find in archives that they lead into."""

from __future__ import annotations

import glob
import os
import re
from pathlib import Path, PurePosixPath

from thermodata.archive.members import is_archive_name, listed
from thermodata.errors import FormatError


def in_archives(root: Path, pattern: str) -> list[str]:
    """The files in archives of a folder under a pattern that names these, as 'raw/*.zip/*.csv' does. An archive
    that can't be read stands for what is in it: whoever reads it is told why."""
    parts = PurePosixPath(pattern).parts
    at = next((k for k, part in enumerate(parts[:-1]) if is_archive_name(part)), None)
    if at is None:
        return []
    outside, inside = "/".join(parts[: at + 1]), re.compile(as_regex("/".join(parts[at + 1 :])))
    archives = glob.glob(outside, root_dir=root, recursive=True)
    found = []
    for archive in (Path(a).as_posix() for a in archives if os.path.isfile(os.path.join(root, a))):
        try:
            held = listed(root / archive)
        except (FormatError, OSError):
            found.append(archive)
            continue
        found += [f"{archive}/{name}" for name in (*held.names, *held.refused) if inside.fullmatch(name)]
    return found


def as_regex(pattern: str) -> str:
    """The same as a regular expression."""
    out, i = "", 0
    while i < len(pattern):
        if pattern.startswith("**/", i):
            out, i = out + "(?:.*/)?", i + 3
        elif pattern[i] == "*":
            out, i = out + "[^/]*", i + 1
        elif pattern[i] == "?":
            out, i = out + "[^/]", i + 1
        elif pattern[i] == "[" and "]" in pattern[i + 1 :]:
            end = pattern.index("]", i + 2) if pattern.find("]", i + 2) > 0 else pattern.index("]", i + 1)
            out, i = out + "[" + pattern[i + 1 : end].replace("!", "^", 1).replace("\\", "\\\\") + "]", end + 1
        else:
            out, i = out + re.escape(pattern[i]), i + 1
    return out
