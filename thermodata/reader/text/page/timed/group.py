"""Columns of a table that share one time."""

from __future__ import annotations

from dataclasses import dataclass

STREAM = "table"


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
