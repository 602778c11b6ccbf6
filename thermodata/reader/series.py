"""Rows that are of several series (sensors, hosts) taken apart: each series is a stream, and its signals are called by
it."""

from __future__ import annotations

from collections.abc import Callable, Collection, Iterator, Mapping, Sequence
from dataclasses import dataclass, field, replace

import numpy as np

from thermodata.errors import FormatError
from thermodata.plugin import Array, Block, Int1D, Loss, Signal
from thermodata.reader.interleaved import Parting, series_columns, words_of
from thermodata.reader.unit_words import holds_units
from thermodata.schema.counted import counted
from thermodata.schema.listed import with_dots

SERIES = "series"  # the property of a signal that says which it is of
NEVER = "none"  # declared: rows are of one series
IN_TABLE = "table: {{series: {}}}"
Named = Callable[[str, str], str]


def slash(series: str, name: str) -> str:
    """'bearing' and 'temperature' give 'bearing/temperature'."""
    return f"{series}/{name}"


@dataclass(frozen=True, slots=True)
class Declaration:
    """What a source says of series. columns: that name them; () for rows of one; None where it says nothing. form:
    how it is written, for notes."""

    columns: tuple[str, ...] | None = None
    form: str = IN_TABLE

    @classmethod
    def of(cls, said: object, form: str = IN_TABLE) -> Declaration:
        """As it stands in the source: none, or a list of columns. FormatError for anything else."""
        if said is None or said == NEVER:
            return cls(None if said is None else (), form)
        if isinstance(said, list | tuple) and said and all(isinstance(name, str) for name in said):
            return cls(tuple(said), form)
        raise FormatError(
            "series is neither a list of columns nor none",
            where="the source",
            expected=f"{form.format('[host, sensor]')} or {form.format(NEVER)}",
            got=repr(said),
        )

    def within(self, names: Collection[str], before: str) -> Declaration:
        """What of it holds for one of several tables, whose names begin alike; one that lacks all is of one series."""
        if self.columns is None:
            return self
        here = [name for said in self.columns for name in (said, f"{before}{said}") if name in names]
        return replace(self, columns=tuple(dict.fromkeys(here)))

    def check(self, names: Collection[str]) -> None:
        """FormatError for a column that nothing has. names: of all that is read, behind a topic or sheet."""
        for said in self.columns or ():
            if not any(name == said or name.endswith((f"/{said}", f".{said}")) for name in names):
                raise FormatError(
                    f"nothing is called '{said}', which is declared to name series",
                    where="the source",
                    expected=", ".join(list(names)[:10]),
                    got=self.form.format(f"[{', '.join(self.columns or ())}]"),
                )

    def declined(self) -> str:
        """How it is said that rows are of one series."""
        return f"if they are of one, declare {self.form.format(NEVER)}"

    def parting(self, block: Block, absolute: bool, pieces: Int1D | None) -> Parting:
        """By what is declared, else by what the rows say. FormatError for a column that is not there."""
        if self.columns is None:
            return series_columns(block.t_ns, block.values, absolute=absolute, pieces=pieces)
        self.check(block.values)
        return Parting(self.columns, {})

    def doubts(self, parting: Parting) -> Iterator[str]:
        """A note on each column that may name series."""
        for name, words in parting.doubtful.items():
            shown = ", ".join(words)
            both = [*parting.tags, name]
            yield (
                f"'{name}' ({shown}) may name series whose rows stand below each other; they are read as one stream: "
                f"if each is a series, declare {self.form.format('[' + ', '.join(both) + ']')}, "
                f"else {self.form.format('[' + ', '.join(parting.tags) + ']' if parting.tags else NEVER)}"
            )


@dataclass(frozen=True, slots=True)
class Series:
    """How the rows of one stream are taken apart. tags: the signals whose words name a series, together; held: the
    signals that had a value in each series; streams: of each; named: a signal's name by series and name; units: of the
    series whose one column of numbers has its unit in a column beside it: (that column, the unit)."""

    stream: str
    tags: tuple[str, ...]
    held: Mapping[str, frozenset[str]]
    streams: Mapping[str, str]
    named: Named = slash
    units: Mapping[str, tuple[str, str]] = field(default_factory=dict)

    def note(self) -> str:
        """What was done, for whoever reads the recording's notes."""
        shown = with_dots(self.held, 4)
        told = " and ".join(f"'{tag}'" for tag in self.tags)
        return f"{told} names {len(self.held)} series whose rows stand below each other ({shown}): each is a stream"

    def signals(self, signals: Sequence[Signal]) -> tuple[Signal, ...]:
        """The signals of each series, in place of those of the stream."""
        mine = [s for s in signals if s.stream == self.stream and s.name not in self.tags]
        made = [
            replace(
                s,
                name=self.named(one, s.name),
                stream=self.streams[one],
                unit=s.unit if s.unit or s.dtype == "str" else self.unit(one),
                properties={**s.properties, SERIES: one},
            )
            for one, held in self.held.items()
            for s in mine
            if s.name in held
        ]
        return (*(s for s in signals if s.stream != self.stream), *made)

    def unit(self, series: str) -> str | None:
        """The unit that the rows of a series name for their one number."""
        return self.units[series][1] if series in self.units else None

    def rows(self, block: Block) -> dict[str, Int1D]:
        """Which rows of a block each series has, also those that the first look did not meet ('' names none)."""
        names = np.array(_names(block, self.tags), object)
        return {one: np.flatnonzero(names == one) for one in dict.fromkeys(names.tolist())}


_THINGS = ("row", "value")


@dataclass(slots=True)
class TakenApart:
    """Takes the blocks of one stream apart; counts what its first look did not meet."""

    series: Series
    where: str
    unmet: dict[str, int] = field(default_factory=dict)

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
            if one in self.series.units:
                column, unit = self.series.units[one]
                same = np.array([word in ("", unit) for word in words_of(column, item.values[column][rows])], bool)
                if not same.all():
                    self._count(f"row of '{one}' in another unit than '{unit}'", int((~same).sum()))
                    rows = rows[same]
            values = {self.series.named(one, k): v[rows] for k, v in item.values.items() if k in held}
            flags = {self.series.named(one, k): v[rows] for k, v in (item.flags or {}).items() if k in held}
            at = None if item.at is None else item.at[rows]
            yield Block(self.series.streams[one], item.t_ns[rows], values, flags or None, at)
            for k, v in item.values.items():
                if k not in held and k not in self.series.tags and (n := int(_full(v[rows], item, k, rows).sum())):
                    self._count(f"value of '{self.series.named(one, k)}'", n)

    def rest(self) -> Iterator[Loss]:
        """What was counted."""
        for what, count in self.unmet.items():
            things, _, whose = what.partition(" ")
            told = f"{counted(count, things)} {whose}" if things in _THINGS else f"{count} {what}"
            yield Loss(self.where, reason=f"{told}, which the first look at the file did not meet")

    def _count(self, what: str, count: int) -> None:
        what = what if what in self.unmet or len(self.unmet) < 20 else "rows or values of others"
        self.unmet[what] = self.unmet.get(what, 0) + count


@dataclass(frozen=True, slots=True)
class Found:
    """series: how rows are taken apart, None where all are of one, or it is not plain. notes: what was done or not."""

    series: Series | None = None
    notes: tuple[str, ...] = ()


def find_series(
    block: Block,
    *,
    absolute: bool,
    declared: Declaration,
    pieces: Int1D | None = None,
    taken: Collection[str] = (),
    stream_of: Callable[[str], str] = str,
    named: Named = slash,
    kept: Collection[str] = (),
) -> Found:
    """The series in the first rows of a stream. absolute: of its times; pieces: see `series_columns`; taken: streams
    that others have; stream_of: a series' stream by its name; kept: signals that each series has, though they are not
    in the block."""
    parting = declared.parting(block, absolute, pieces)
    doubts = tuple(declared.doubts(parting))
    if not parting.tags:
        return Found(None, doubts)
    tags = parting.tags
    names = np.array(_names(block, tags), object)
    held: dict[str, frozenset[str]] = {}
    streams: dict[str, str] = {}
    for one in dict.fromkeys(names.tolist()):
        rows = np.flatnonzero(names == one)
        some = frozenset(k for k, v in block.values.items() if k not in tags and _full(v[rows], block, k, rows).any())
        if not one or not some:
            continue
        stream = stream_of(one)
        while stream in taken or stream in streams.values():
            stream += "#2"
        held[one], streams[one] = some | frozenset(kept), stream
    if len(held) < (2 if declared.columns is None else 1):
        return Found(None, doubts)
    made = Series(block.stream, tags, held, streams, named, _units(block, names, held, tags))
    own = made.note() if declared.columns else f"{made.note()}; {declared.declined()}"
    return Found(made, (own, *doubts))


def _units(
    block: Block, names: Array, held: Mapping[str, frozenset[str]], tags: Sequence[str]
) -> dict[str, tuple[str, str]]:
    """The unit that the rows of each series name, of those with one column of numbers; what names the series itself is
    none: machine A is no ampere. FormatError where one has several."""
    texts = [k for k, v in block.values.items() if v.dtype.kind == "O" and k not in tags]
    column = next((k for k in texts if holds_units(k, words_of(k, block.values[k]))), None)
    units: dict[str, tuple[str, str]] = {}
    if column is None:
        return units
    for one, some in held.items():
        found = sorted(set(words_of(column, block.values[column][names == one])) - {""})
        if sum(block.values[k].dtype.kind in "iuf" for k in some if k in block.values) != 1 or not found:
            continue
        if len(found) > 1:
            raise FormatError(
                f"'{one}' has several units",
                where=f"column '{column}'",
                expected="one",
                got=" and ".join(found[:3]),
                hint="give the values of each unit a name of their own",
            )
        units[one] = column, found[0]
    return units


def _names(block: Block, tags: Sequence[str]) -> list[str]:
    """What each row is called by its tags; '' where one says nothing."""
    rows = zip(*(words_of(tag, block.values[tag]) for tag in tags), strict=True)
    return ["/".join(row) if all(row) else "" for row in rows]


def _full(values: Array, block: Block, name: str, rows: Int1D) -> Array:
    """Which of some rows of a signal hold a value."""
    if values.dtype.kind == "f":
        return ~np.isnan(values)
    if values.dtype.kind == "O":
        return np.array([v is not None and v != "" for v in values.tolist()], bool)
    flags = (block.flags or {}).get(name)
    return np.ones(values.size, bool) if flags is None else flags[rows] == 0
