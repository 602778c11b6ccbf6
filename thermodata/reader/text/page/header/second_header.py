"""Where another table begins among the first lines of a file, under a header of more or fewer names, or of the same in
another order: a logger that got a channel more, and went on in its file. Looked at together, the rows of one would be
held against the other's names."""

from __future__ import annotations

from collections.abc import Sequence

from thermodata.reader.text.cells.cell import is_empty, is_number, is_stamp

_FEWEST_ROWS, _ALIKE = 3, 0.9


def second_header(rows: Sequence[Sequence[str]]) -> int | None:
    """The number of the row that names the columns anew; None where none does.
    It repeats most of the names of a header above it, and all rows between have as many cells as that one."""
    heads = [n for n, row in enumerate(rows) if _are_names(row)]
    for k, second in enumerate(heads):
        for first in heads[:k]:
            if _differ(rows[first], rows[second]) and _repeats_names(rows[first], rows[second]):
                between = [r for r in rows[first + 1 : second] if not _blank(r)]
                behind = [r for r in rows[second + 1 :] if not _blank(r)][:_FEWEST_ROWS]
                if _as_wide(between, len(rows[first])) and behind and _as_wide(behind, len(rows[second]), 1):
                    return second
    return None


def _are_names(row: Sequence[str]) -> bool:
    filled = [c for c in row if not is_empty(c)]
    return len(filled) > 1 and not any(is_number(c) or is_stamp(c) for c in filled)


def _differ(first: Sequence[str], second: Sequence[str]) -> bool:
    """Whether two headers are of two tables: by how many names they have, or by their order."""
    return len(first) != len(second) or (list(first) != list(second) and sorted(first) == sorted(second))


def _repeats_names(first: Sequence[str], second: Sequence[str]) -> bool:
    """Whether a row has all names of the shorter one of both but a few, and the same one in front."""
    both, fewest = set(first) & set(second) - {""}, min(len(set(first) - {""}), len(set(second) - {""}))
    return first[0] == second[0] and len(both) > 1 and 2 * len(both) >= fewest


def _as_wide(rows: Sequence[Sequence[str]], width: int, least: int = _FEWEST_ROWS) -> bool:
    """Whether rows are of data, of so many cells but for damaged ones."""
    good = sum(len(r) == width and any(is_number(c) or is_stamp(c) for c in r) for r in rows)
    return good >= max(least, _ALIKE * len(rows))


def _blank(row: Sequence[str]) -> bool:
    return all(map(is_empty, row))
