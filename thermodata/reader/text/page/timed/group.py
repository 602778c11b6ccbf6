"""Columns of a table that share one time."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass
from typing import TypeVar

STREAM = "table"
_Cell = TypeVar("_Cell")


@dataclass(frozen=True)
class Group:
    """Columns with one time. stream: its name; time: columns of the time, from 0; seconds: of one unit of a relative
    time, None for dates; epoch: of times counted from a date (clocks.EPOCHS); columns: its signals; counted: no column
    holds the time, `seconds` pass from row to row; others: cells of rows of other kinds, which stand among these and
    take no time."""

    stream: str
    time: tuple[int, ...]
    seconds: float | None
    form: str | None
    epoch: str | None
    columns: tuple[int, ...]
    counted: bool = False
    others: frozenset[int] = frozenset()

    @property
    def dated(self) -> bool:
        """Whether its times are texts, not numbers."""
        return self.seconds is None and self.epoch is None


def heads_of_blocks(groups: Sequence[Group], above: Sequence[Sequence[_Cell]]) -> list[list[Sequence[_Cell]]]:
    """What stands above the columns of each group, and not above those of the next one: a block's own title. above:
    the rows above the data, each as its cells."""
    firsts = [min((*g.time, *g.columns)) for g in groups]
    ends = [min((f for f in firsts if f > first), default=None) for first in firsts]
    return [[row[a:b] for row in above] for a, b in zip(firsts, ends, strict=True)]
