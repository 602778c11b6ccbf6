"""Words that are a slip of the pen away from a known one: told from names that somebody chose."""

from __future__ import annotations

import re
from collections.abc import Collection

_LONG, _SHORT = 8, 4  # letters: two slips are believed in a long word, none in a short one
_NUMBERED = re.compile(r"[_ -]?\d+$")


def slip_of(word: str, known: Collection[str]) -> str | None:
    """The known word that is meant, or None where it is another name: `lenght` is `length`, `length_2` is not."""
    for choice in known:
        if word != choice and word.casefold() == choice.casefold():
            return choice
        if _NUMBERED.sub("", word) == choice:
            continue
        allowed = 0 if len(choice) < _SHORT else 1 if len(choice) < _LONG else 2
        if 0 < distance(word.casefold(), choice.casefold()) <= allowed:
            return choice
    return None


def distance(a: str, b: str) -> int:
    """Letters that are wrong, missing, too many or changed places with their neighbour (Damerau, restricted)."""
    if abs(len(a) - len(b)) > 2:
        return abs(len(a) - len(b))
    rows = [list(range(len(b) + 1))]
    for i, x in enumerate(a, 1):
        row = [i]
        for j, y in enumerate(b, 1):
            best = min(rows[i - 1][j] + 1, row[j - 1] + 1, rows[i - 1][j - 1] + (x != y))
            if i > 1 and j > 1 and x == b[j - 2] and y == a[i - 2]:
                best = min(best, rows[i - 2][j - 2] + 1)
            row.append(best)
        rows.append(row)
    return rows[-1][-1]
