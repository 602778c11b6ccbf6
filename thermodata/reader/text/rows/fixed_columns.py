"""Columns of a text that stand at the same places in every line, so that a cell that is left blank has its place: by
blanks alone the cells behind it would be those of the columns before."""

from __future__ import annotations

import re
from collections import Counter
from collections.abc import Sequence
from dataclasses import dataclass, replace
from itertools import pairwise

from thermodata.reader.text.cells.lines.delimiter import parted, parted_bytes

_FEWEST, _SHARE = 5, 0.1  # of lines with a cell in each column, of those that hold numbers
_CELL = re.compile(r"\S+")
_NUMBER = re.compile(r"[+-]?(?:\d[\d.,:/T-]*(?:[eE][+-]?\d+)?Z?|[.,]\d+(?:[eE][+-]?\d+)?)")


@dataclass(frozen=True, slots=True)
class FixedColumns:
    """spans: from and to of each column's cells; right: whether they end at one place, or else begin at one; padded:
    whether cells of other lengths do, so that the text is known to be one of widths; heads: whether lines of words are
    cut by the columns too."""

    spans: tuple[tuple[int, int], ...]
    right: tuple[bool, ...]
    padded: bool
    heads: bool = False

    def with_heads(self) -> FixedColumns:
        """The same where names hold blanks, and are known by where they stand."""
        return replace(self, heads=True)

    def parted(self, line: str) -> str:
        """A line with a tab between its cells, one that is blank too; where its cells do not stand in the columns, with
        one between all that blanks part."""
        cells = list(_CELL.finditer(line))
        if "\t" in line or '"' in line or len(cells) == len(self.spans) or not cells:
            return parted(line)
        made = None
        if all(_NUMBER.fullmatch(c[0]) for c in cells):
            made = self._in_place(line, cells) if len(cells) < len(self.spans) else None
        elif self.heads:
            made = self._cut(line)
        return parted(line) if made is None else "\t".join(made)

    def parted_bytes(self, data: bytes) -> bytes:
        """The same of whole lines in UTF-8, which keep their ends and their number."""
        lines = data.split(b"\n")
        if all(len(line.split()) in (0, len(self.spans)) for line in lines):
            return parted_bytes(data)
        return b"\n".join(map(self._line, lines))

    def _line(self, line: bytes) -> bytes:
        bare = line.removesuffix(b"\r")
        text = self.parted(bare.decode("utf-8", "surrogateescape"))
        return text.encode("utf-8", "surrogateescape") + line[len(bare) :]

    def _in_place(self, line: str, cells: Sequence[re.Match[str]]) -> list[str] | None:
        """The cells of all columns, '' for blank ones; None where one stands in no column, or the last ones may have
        been cut off."""
        made = [""] * len(self.spans)
        k = 0
        for cell in cells:
            while k < len(self.spans) and not self._stands(cell, k):
                k += 1
            if k == len(self.spans):
                return None
            made[k] = cell[0]
            k += 1
        whole = made[-1] or self.padded or len(line.rstrip("\r\n")) >= self.spans[-1][1]
        return made if whole else None

    def _stands(self, cell: re.Match[str], column: int) -> bool:
        low, high = self.spans[column]
        before = self.spans[column - 1][1] if column else -1
        if self.right[column]:
            return cell.end() == high and cell.start() > before
        after = self.spans[column + 1][0] if column + 1 < len(self.spans) else cell.end() + 1
        return cell.start() == low and cell.end() < after

    def _cut(self, line: str) -> list[str] | None:
        """The words over each column; None where a word goes over the edge between two."""
        edges = [0]
        for ((_, high), (low, _)), right in zip(pairwise(self.spans), self.right[1:], strict=True):
            edges.append(high if right else low)
        edges.append(max(len(line), self.spans[-1][1]))
        if any(line[e - 1 : e].strip() and line[e : e + 1].strip() for e in edges[1:-1]):
            return None
        made = [line[a:b].strip() for a, b in pairwise(edges)]
        return made if all(made) else None


def fixed_columns(lines: Sequence[str]) -> FixedColumns | None:
    """The columns of a text, as the lines show it that have a cell in each; None where they stand at no fixed places.
    lines: as they stand, of which others than those of numbers tell nothing."""
    rows = [list(_CELL.finditer(line)) for line in lines if line.strip() and "\t" not in line and '"' not in line]
    rows = [cells for cells in rows if len(cells) > 1 and all(_NUMBER.fullmatch(c[0]) for c in cells)]
    many = Counter(map(len, rows))
    wide = max((n for n, count in many.items() if count >= max(_FEWEST, _SHARE * len(rows))), default=0)
    full = [cells for cells in rows if len(cells) == wide]
    if wide < 2 or any(n > wide for n in many):
        return None
    columns = list(zip(*full, strict=True))
    spans = tuple((min(c.start() for c in cells), max(c.end() for c in cells)) for cells in columns)
    if any(low <= high for (_, high), (low, _) in pairwise(spans)):
        return None
    right = tuple(len({c.end() for c in cells}) == 1 for cells in columns)
    left = [len({c.start() for c in cells}) == 1 for cells in columns]
    if not all(r or s for r, s in zip(right, left, strict=True)):
        return None
    padded = any(len({len(c[0]) for c in cells}) > 1 for cells in columns[:-1])
    return FixedColumns(spans, right, padded or (right[-1] and len({len(c[0]) for c in columns[-1]}) > 1))
