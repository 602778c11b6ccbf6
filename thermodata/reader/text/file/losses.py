"""The losses of a text file: the first ones named with line, expected and got, the rest counted."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass, field

from thermodata.plugin import Int1D, Loss

NAMED = 20


@dataclass(slots=True)
class _Waiting:
    where: str
    reason: str
    size: int
    row: int  # of the part: the row it happened in, or would have been
    column: str | None  # of a cell in a row that is kept


@dataclass(slots=True)
class Losses:
    """Collects the losses of a part of a file; they are dated when the part's times are known. of: a column of
    qualities -> the column that they are of, which a loss there concerns."""

    name: str
    file_size: int
    of: Mapping[str, str] = field(default_factory=dict)
    _waiting: list[_Waiting] = field(default_factory=list)
    _named: int = 0
    _more: int = 0
    _more_bytes: int = 0
    _more_of: set[str | None] = field(default_factory=set)
    _last_ns: int | None = None

    def add(self, line: int, reason: str, size: int, row: int, column: str | None = None) -> None:
        """line: 0-based in the file. size: bytes lost. row: how many rows of the part stand before it."""
        if self._named >= NAMED:
            self._more += 1
            self._more_of.add(self._concerned(column))
            self._more_bytes += size
            return
        self._named += 1
        where = f"{self.name} line {line + 1}" + (f" column '{column}'" if column else "")
        self._waiting.append(_Waiting(where, reason, size, row, column))

    def dated(self, t_ns: Int1D) -> list[Loss]:
        """The losses of the part whose rows have these times: from the row before to the row after."""
        result = []
        for each in self._waiting:
            before = int(t_ns[each.row - 1]) if 0 < each.row <= t_ns.size else self._last_ns
            after = int(t_ns[each.row]) if each.row < t_ns.size else None
            if each.column is not None:
                before = after
            if before is not None and after is not None and after < before:
                after = None  # the clock steps back here
            fraction = min(1.0, each.size / self.file_size)
            result.append(Loss(each.where, before, after, fraction, each.reason, self._concerned(each.column)))
        self._waiting = []
        if t_ns.size:
            self._last_ns = int(t_ns[-1])
        return result

    def rest(self) -> list[Loss]:
        """One loss for all that were only counted."""
        if not self._more:
            return []
        return [
            Loss(
                self.name,
                fraction=min(1.0, self._more_bytes / self.file_size),
                reason=f"{self._more} more cells or rows that do not read",
                signal=self._more_of.copy().pop() if len(self._more_of) == 1 else None,
            )
        ]

    def _concerned(self, column: str | None) -> str | None:
        return None if column is None else self.of.get(column, column)
