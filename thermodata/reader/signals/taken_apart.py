"""The blocks of a stream taken apart into those of its series, and what of it their first look did not meet."""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import dataclass, field

from thermodata.plugin import Block, Loss
from thermodata.reader.signals.series import Series, full
from thermodata.schema.words.sentences import counted

_THINGS = ("row", "value")


@dataclass(slots=True)
class TakenApart:
    """Takes the blocks of one stream apart; counts what its first look did not meet."""

    series: Series
    where: str
    unmet: dict[str, int] = field(default_factory=dict)
    foreign: dict[tuple[str, str], int] = field(default_factory=dict)

    def split(self, item: Block | Loss) -> Iterator[Block | Loss]:
        """The blocks of each series in a block of the stream; all else as it is."""
        if isinstance(item, Loss) or item.stream != self.series.stream:
            yield item
            return
        for one, rows in self.series.rows(item).items():
            if one not in self.series.held:
                self._count(f"row of '{one}'" if one else "row of no series", rows.size)
                continue
            held = self.series.held[one]
            own, rows, foreign = self.series.in_its_unit(one, item, rows)
            for word, count in foreign.items():
                self.foreign[one, word] = self.foreign.get((one, word), 0) + count
            values = {self.series.named(one, k): v[rows] for k, v in own.values.items() if k in held}
            flags = {self.series.named(one, k): v[rows] for k, v in (item.flags or {}).items() if k in held}
            at = None if item.at is None else item.at[rows]
            yield Block(self.series.streams[one], item.t_ns[rows], values, flags or None, at)
            for k, v in item.values.items():
                if k not in held and k not in self.series.tags and (n := int(full(v[rows], item, k, rows).sum())):
                    self._count(f"value of '{self.series.named(one, k)}'", n)

    def rest(self) -> Iterator[Loss]:
        """What was counted."""
        yield from (Loss(self.where, reason=self.series.not_in_its_unit(*k, n)) for k, n in self.foreign.items())
        for what, count in self.unmet.items():
            things, _, whose = what.partition(" ")
            told = f"{counted(count, things)} {whose}" if things in _THINGS else f"{count} {what}"
            yield Loss(self.where, reason=f"{told}, which the first look at the file did not meet")

    def _count(self, what: str, count: int) -> None:
        what = what if what in self.unmet or len(self.unmet) < 20 else "rows or values of others"
        self.unmet[what] = self.unmet.get(what, 0) + count
