"""What stands between the cells of a line, and the cells themselves."""

from __future__ import annotations

import csv
from collections import Counter
from collections.abc import Sequence

DELIMITERS = (";", "\t", ",", "|")
_WORDS = {"tab": "\t", "\\t": "\t", "semicolon": ";", "comma": ","}
_LOOKED_AT = 500


def declared(delimiter: str) -> str:
    """The delimiter that a campaign file names: itself, or one of the words tab, semicolon, comma."""
    return _WORDS.get(delimiter, delimiter)


def fields(line: str, delimiter: str, quoted: bool = True) -> list[str]:
    """The cells of one line; a quote that is never closed is a character like any other."""
    if not quoted or '"' not in line or line.count('"') % 2:
        return line.split(delimiter)
    try:
        return next(csv.reader([line], delimiter=delimiter), [""])
    except csv.Error:  # a cell of more than 128 KiB, a stray carriage return
        return line.split(delimiter)


def find_delimiter(lines: Sequence[str]) -> str | None:
    """The delimiter by which most of the last lines have equally many cells, two or more; None where there is none.

    ';' and tabs stand before ',', which may be a decimal mark; a first line 'sep=;' (Excel's) decides.
    """
    if lines and lines[0].lower().startswith("sep=") and len(lines[0].strip()) == 5:
        return lines[0].strip()[-1]
    body = [line for line in lines if line.strip()]
    body = body[len(body) // 3 :][-_LOOKED_AT:]  # preamble has other lengths
    best: tuple[float, str] | None = None
    for delimiter in DELIMITERS:
        counts = Counter(len(fields(line, delimiter)) for line in body)
        common, many = counts.most_common(1)[0] if counts else (0, 0)
        share = many / len(body) if body else 0.0
        if common >= 2 and share >= 0.5 and (best is None or share > best[0] + 0.2):
            best = (share, delimiter)
    return best[1] if best else None
