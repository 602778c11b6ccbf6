"""Rows that are of several series (sensors, hosts) taken apart: each series is a stream, and its signals are called by
it."""

from __future__ import annotations

from collections import Counter
from collections.abc import Callable, Collection, Iterator, Mapping, Sequence
from dataclasses import dataclass, field, replace

import numpy as np

from thermodata.errors import FormatError
from thermodata.plugin import Array, Block, Int1D, Signal
from thermodata.reader.signals.interleaved import Parting, series_columns, words_of
from thermodata.reader.signals.row_units import UNIT_OF, UnitColumn, converts_here, in_unit
from thermodata.reader.signals.unit_words import holds_units
from thermodata.schema.units.unit import normal_unit
from thermodata.schema.words.sentences import counted, with_dots

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
            hint="name the columns whose words tell one sensor from another",
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
                    hint="take a name from the file's header; 'thermodata preview FILE' shows them",
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
    series whose one column of numbers has its unit in a column beside it: what that says."""

    stream: str
    tags: tuple[str, ...]
    held: Mapping[str, frozenset[str]]
    streams: Mapping[str, str]
    named: Named = slash
    units: Mapping[str, UnitColumn] = field(default_factory=dict)

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
                dtype="float64" if self._is_converted(one, s.name) else s.dtype,
                properties={**s.properties, SERIES: one, **self.unit_of(one, s.name)},
            )
            for one, held in self.held.items()
            for s in mine
            if s.name in held
        ]
        return (*(s for s in signals if s.stream != self.stream), *made)

    def unit(self, series: str) -> str | None:
        """The unit that the rows of a series name for their one number."""
        return self.units[series].unit if series in self.units else None

    def _is_converted(self, series: str, name: str) -> bool:
        """Whether rows of a series have the values of a signal in several units."""
        return series in self.units and self.units[series].of == name and bool(self.units[series].others)

    def unit_of(self, series: str, name: str) -> dict[str, str]:
        """Of the column that says the unit of a series, the signal that it is of."""
        said = self.units.get(series)
        return {UNIT_OF: self.named(series, said.of)} if said is not None and said.column == name else {}

    def in_its_unit(self, series: str, block: Block, rows: Int1D) -> tuple[Block, Int1D, dict[str, int]]:
        """(a block with the numbers of a series in its one unit, the rows of it that have them, how many rows are in a
        unit that does not convert). rows: of the series, shape (k,)."""
        said = self.units.get(series)
        if said is None or said.of not in block.values:
            return block, rows, {}
        values = block.values[said.of]
        values = values.astype(np.float64) if said.others else values
        made, lost, foreign = in_unit(words_of(said.column, block.values[said.column][rows]), values[rows], said.unit)
        whole = values.astype(made.dtype)
        whole[rows] = made
        return replace(block, values={**block.values, said.of: whole}), rows[~lost], foreign

    def not_in_its_unit(self, series: str, word: str, count: int) -> str:
        """What is said of rows of a series that are lost for their unit."""
        rows = counted(count, "row")
        return (
            f"{rows} of '{series}' in another unit than '{self.unit(series)}': {word[:20]}, not read; try: give the "
            "values of each unit a name of their own"
        )

    def rows(self, block: Block) -> dict[str, Int1D]:
        """Which rows of a block each series has, also those that the first look did not meet ('' names none)."""
        names = np.array(_names(block, self.tags), object)
        return {one: np.flatnonzero(names == one) for one in dict.fromkeys(names.tolist())}


@dataclass(frozen=True, slots=True)
class Called:
    """How a reader calls a series: stream_of: its stream by its name; named: its signals by its name and theirs; taken:
    streams that others have."""

    stream_of: Callable[[str], str] = str
    named: Named = slash
    taken: Collection[str] = ()


PLAINLY = Called()


@dataclass(frozen=True, slots=True)
class FoundSeries:
    """series: how rows are taken apart, None where all are of one, or it is not plain. notes: what was done or not."""

    series: Series | None = None
    notes: tuple[str, ...] = ()


def find_series(
    block: Block,
    *,
    absolute: bool,
    declared: Declaration,
    pieces: Int1D | None = None,
    called: Called = PLAINLY,
    kept: Collection[str] = (),
) -> FoundSeries:
    """The series in the first rows of a stream. absolute: of its times; pieces: see `series_columns`; kept: signals
    that each series has, though they are not in the block."""
    parting = declared.parting(block, absolute, pieces)
    doubts = tuple(declared.doubts(parting))
    if not parting.tags:
        return FoundSeries(None, doubts)
    tags = parting.tags
    names = np.array(_names(block, tags), object)
    held: dict[str, frozenset[str]] = {}
    streams: dict[str, str] = {}
    for one in dict.fromkeys(names.tolist()):
        rows = np.flatnonzero(names == one)
        some = frozenset(k for k, v in block.values.items() if k not in tags and full(v[rows], block, k, rows).any())
        if not one or not some:
            continue
        stream = called.stream_of(one)
        while stream in called.taken or stream in streams.values():
            stream += "#2"
        held[one], streams[one] = some | frozenset(kept), stream
    if len(held) < (2 if declared.columns is None else 1):
        return FoundSeries(None, doubts)
    named = called.named
    made = Series(block.stream, tags, held, streams, named, _units(block, names, held, tags))
    own = made.note() if declared.columns else f"{made.note()}; {declared.declined()}"
    units = (replace(u, column=named(one, u.column), of=named(one, u.of)).note() for one, u in made.units.items())
    return FoundSeries(made, (own, *filter(None, units), *doubts))


def _units(
    block: Block, names: Array, held: Mapping[str, frozenset[str]], tags: Sequence[str]
) -> dict[str, UnitColumn]:
    """What the rows of each series say of their unit, of those with one column of numbers: the usual one, and others
    that convert to it. What names the series itself is none: machine A is no ampere."""
    texts = [k for k, v in block.values.items() if v.dtype.kind == "O" and k not in tags]
    column = next((k for k in texts if holds_units(k, words_of(k, block.values[k]))), None)
    units: dict[str, UnitColumn] = {}
    if column is None:
        return units
    for one, some in held.items():
        numbers = [k for k in some if k in block.values and block.values[k].dtype.kind in "iuf"]
        found = Counter(word for word in words_of(column, block.values[column][names == one]) if word)
        if len(numbers) != 1 or not found:
            continue
        usual = found.most_common(1)[0][0]
        others = [w for w in found if normal_unit(w) != normal_unit(usual) and converts_here(w, usual)]
        units[one] = UnitColumn(column, numbers[0], usual, tuple(others))
    return units


def _names(block: Block, tags: Sequence[str]) -> list[str]:
    """What each row is called by its tags; '' where one says nothing."""
    rows = zip(*(words_of(tag, block.values[tag]) for tag in tags), strict=True)
    return ["/".join(row) if all(row) else "" for row in rows]


def full(values: Array, block: Block, name: str, rows: Int1D) -> Array:
    """Which of some rows of a signal hold a value."""
    if values.dtype.kind == "f":
        return ~np.isnan(values)
    if values.dtype.kind == "O":
        return np.array([v is not None and v != "" for v in values.tolist()], bool)
    flags = (block.flags or {}).get(name)
    return np.ones(values.size, bool) if flags is None else flags[rows] == 0
