"""Lines of a dataTaker: a row of one schedule leaves the columns of the others blank, those behind it are not written,
and the schedules follow each other below one header. Each has its own time here, as groups of columns beside each
other do: '"Timestamp","TZ","Z (mV)","A.ALnum","A.ALstate","A.ALtext","bed (degC)"'."""

from __future__ import annotations

import re
from collections.abc import Sequence
from dataclasses import dataclass
from itertools import islice, pairwise

from thermodata.reader.text.cells.lines.delimiter import fields
from thermodata.reader.text.cells.values.quotes import clean

_DELIMITER = ","
_HEAD = ("Timestamp", "TZ")
_PROMPT = re.compile(r"^DT\d+\w*> ?")  # what a terminal shows before the answer to a command
_END = re.compile(r"\w+\.ALtext")  # the last column of a schedule: the text of its alarms
_DATED = re.compile(r"\s*\"?\d{4}[/-]\d\d?[/-]\d\d? \d")
_NO_ZONE = ("n", "")  # what the column of the zone says where the clock has none
_LOOKED_AT = 20  # lines, in which the header stands
_ROWS = 50  # of a schedule, by which its time is known


@dataclass(frozen=True, slots=True)
class Schedules:
    """width: the cells of the header; groups: first and behind the last column of each schedule that was met, with
    those behind it of others that were not; zone: whether the column of the zone says one, and is kept."""

    width: int
    groups: tuple[tuple[int, int], ...]
    zone: bool

    @property
    def times(self) -> list[int]:
        """The columns of the times of the schedules, counted from 1."""
        widths = [1 + b - a for a, b in self.groups]
        return [1 + sum(widths[:k]) + (self.zone and k > 0) for k in range(len(widths))]

    def with_each(self, top: Sequence[str], below: Sequence[str]) -> tuple[str, ...]:
        """The first lines, with rows of those schedules that only have any below them. All as `parted` makes them."""

        def met(line: str) -> set[int]:
            cells = fields(line, _DELIMITER)
            return {t for t in self.times if t <= len(cells) and _DATED.match(cells[t - 1])}

        late = set(self.times).difference(*map(met, top))
        return (*top, *(line for t in sorted(late) for line in islice((b for b in below if t in met(b)), _ROWS)))

    def parted(self, line: str) -> str:
        """A header or a row with a time before each schedule that has values in it; any other line as it is."""
        line = _PROMPT.sub("", line)
        cells = fields(line, _DELIMITER)
        head = _is_head(cells)
        if not head and (not _DATED.match(line) or not len(_HEAD) < len(cells) <= self.width):
            return line
        cells += [""] * (self.width - len(cells))
        filled = [head or any(c.strip() for c in cells[a:b]) for a, b in self.groups]
        made: list[str] = []
        for k, (a, b) in enumerate(self.groups):
            made.append(cells[0] if filled[k] or not any(filled) else "")
            made += [cells[1]] if self.zone and not k else []
            made += cells[a:b]
        return _DELIMITER.join(map(_quoted, made))

    def all_parted(self, data: bytes) -> bytes:
        """The same of whole lines in UTF-8, which keep their number."""
        lines = data.decode("utf-8", "surrogateescape").split("\n")
        return "\n".join(self.parted(line.removesuffix("\r")) for line in lines).encode("utf-8", "surrogateescape")


def schedules_of(lines: Sequence[str]) -> Schedules | None:
    """The schedules of a dataTaker's lines; None of any other text."""
    rows = (fields(_PROMPT.sub("", line), _DELIMITER) for line in lines[:_LOOKED_AT])
    head = next((cells for cells in rows if _is_head(cells)), None)
    dated = [fields(line, _DELIMITER) for line in lines if _DATED.match(line)] if head is not None else []
    if head is None or not dated:
        return None
    names = [clean(c) for c in head]
    ends = [i + 1 for i, name in enumerate(names) if _END.fullmatch(name)]
    edges = sorted({len(_HEAD), *ends, len(names)})
    every = [(a, b) for a, b in pairwise(edges) if any(any(map(clean, cells[a:b])) for cells in dated)]
    # of one that may come later nothing is known: its columns stay beside those before them
    starts = [len(_HEAD), *(a for a, _ in every[1:])]
    groups = tuple(pairwise([*starts, len(names)]))
    return Schedules(len(names), groups, any(clean(c[1]) not in _NO_ZONE for c in dated if len(c) > 1))


def _is_head(cells: Sequence[str]) -> bool:
    return len(cells) > len(_HEAD) and tuple(clean(c) for c in cells[: len(_HEAD)]) == _HEAD


def _quoted(cell: str) -> str:
    return '"' + cell.replace('"', '""') + '"' if _DELIMITER in cell or '"' in cell else cell
