"""In which encoding the texts of a folder are, where that has to be seen in a draft: those of East Asia.

What words told is written as `encoding`, where it can be seen and changed; what somebody wrote before is kept by
`init --force`.
"""

from __future__ import annotations

import codecs
import re
from collections.abc import Iterable
from pathlib import Path

from thermodata.draft.files.declared_before import declared_before
from thermodata.reader.text.file.east_asia import east_asian

_HEAD = 128 * 1024
_PLAIN = "utf-8"
_DECLARED = re.compile(r"""^[^#\n]*\bencoding:\s*["']?([\w.-]+)""", re.MULTILINE)


def letters_of(path: Path, declared: str | None) -> str | None:
    """An encoding of East Asia, or the declared one for a text that is no UTF-8; 'utf-8' for what needs none, None
    for plain ASCII and for what is no text."""
    with path.open("rb") as file:
        head = file.read(_HEAD)
    if b"\0" in head or head.isascii():
        return None
    if _is_utf8(head):
        return _PLAIN
    if declared is not None:
        return declared
    told = east_asian(head)
    return told[0] if told else _PLAIN


def _is_utf8(head: bytes) -> bool:
    """Whether the beginning of a file is; its last character may be cut."""
    try:
        codecs.getincrementaldecoder("utf-8")().decode(head)
    except UnicodeDecodeError:
        return False
    return True


def common(found: Iterable[str | None]) -> str | None:
    """The encoding that a source of these files declares; None where they differ, or need none."""
    named = {name for name in found if name is not None}
    return named.pop() if len(named) == 1 and _PLAIN not in named else None


def encoding_declared_before(path: Path) -> str | None:
    """The one encoding that a campaign file declares."""
    return declared_before(path, _DECLARED, _known)


def _known(encoding: str) -> bool:
    try:
        codecs.lookup(encoding)
    except LookupError:
        return False
    return True
