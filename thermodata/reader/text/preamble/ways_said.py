"""Lines above the data that say which way a probe counts, or by how much it was moved: `# positive dZ = towards the
table`, `Remark: moved by 50 um`. Quoted where a draft asks for it, never taken."""

from __future__ import annotations

import re
from collections.abc import Mapping, Sequence

from thermodata.reader.text.names.header import split_unit

WAY = "way"  # property of a signal: what the head of its file says of its sign, or of a jump
_DIRECTION = re.compile(r"(?<![\w.])[+\-\u2212] ?[XYZ](?![\w])")
_SIGN = re.compile(
    r"(?i)\b(?:sign|positive?r?|negative?r?|vorzeichen|znaménko|signe|segno|gap (?:opens|closes)|towards?|away from|"
    r"(?:reading|value)s? (?:grows?|rises?|increases?|falls?|decreases?)|wächst|steigt)\b"
)
_AXIS = re.compile(r"(?<![^\W_])[XYZ](?![^\W_])")
_MOVED = re.compile(
    r"(?i)\b(?:moved?|shift(?:ed)?|jump\w*|steps?|stepped|sprung\w*|verfahren|versetzt|verschoben|block|shim|endma(?:ß|ss)|"
    r"gauge|posun\w*|skok\w*)\b"
)
_LENGTH = re.compile(r"(?i)\b\d+(?:[.,]\d+)? ?(?:[uµμn]m|mm)\b")
_LONGEST, _MOST = 160, 3


def ways_said(above: Sequence[Sequence[str]], names: Sequence[str]) -> Mapping[str, str]:
    """Name of a column -> the lines that say its sign or a jump of it: those that name it, or its axis, and those that
    name none. above: the cells of the lines above the data; names: of all columns."""
    bare = {name: split_unit(name)[0].strip() for name in names if name}
    found: dict[str, list[str]] = {}
    for cells in above:
        text = " ".join(filter(None, cells))
        own = [n for n, b in bare.items() if len(b) > 1 and re.search(rf"(?<!\w){re.escape(b)}(?!\w)", text)]
        letters = set(_AXIS.findall(text))
        said = _DIRECTION.search(text) or (_SIGN.search(text) and (own or letters))
        if not (said or (_MOVED.search(text) and _LENGTH.search(text))) or 2 * len(own) > len(bare):
            continue  # the row of names, or nothing of it
        own = own or [n for n, b in bare.items() if letters & set(b)]
        for name in own or bare:
            found.setdefault(name, []).append(text[:_LONGEST])
    return {name: "', '".join(lines[:_MOST]) for name, lines in found.items()}
