"""The contracts of plugins: what a reader and an effect are, and what passes between them and the house.

A plugin is a distribution with an entry point in `thermodata.reader` or `thermodata.effect`; see
`thermodata.reader` and `thermodata.effect` for how they are found. No base class, no constructor arguments.
"""

from __future__ import annotations

from collections.abc import Iterator, Mapping
from dataclasses import dataclass, field
from pathlib import Path
from types import MappingProxyType
from typing import Any, Literal, Protocol, TypeAlias, runtime_checkable

import numpy as np
import numpy.typing as npt

Int1D: TypeAlias = npt.NDArray[np.int64]
Float1D: TypeAlias = npt.NDArray[np.float64]
Float2D: TypeAlias = npt.NDArray[np.float64]
Bool1D: TypeAlias = npt.NDArray[np.bool_]
Array: TypeAlias = npt.NDArray[Any]

HEAD_BYTES = 64 * 1024
_NOTHING: Mapping[str, Any] = MappingProxyType({})


# ---- readers -------------------------------------------------------------------------------------


@dataclass(frozen=True, slots=True)
class Head:
    """All that a sniff sees of a file: `start` holds at most its first 64 KiB."""

    name: str
    size_bytes: int
    start: bytes


@dataclass(frozen=True, slots=True)
class Source:
    """What the campaign file declares about a source. Everything has a default: nothing declared.

    timezone: IANA name for local times (None: the file's own zone, else UTC with a note).
    table: the layout keys of `sources.*.table` as plain data (see schema.files.campaign.TableLayout).
    options: any further keys for one reader.
    """

    name: str = ""
    timezone: str | None = None
    encoding: str | None = None
    table: Mapping[str, Any] | None = None
    topics: tuple[str, ...] = ()
    options: Mapping[str, Any] = field(default_factory=lambda: _NOTHING)


@dataclass(frozen=True, slots=True)
class Scaling:
    """A scaling that the file declares: applied when the raw layer becomes the tidy layer, never by a reader.

    kind "linear": properties gain, offset (value = gain * raw + offset).
    kind "ni": the NI_Scale[n]_* properties of the channel as TDMS stores them.
    """

    kind: Literal["linear", "ni"]
    properties: Mapping[str, Any]


@dataclass(frozen=True, slots=True)
class Signal:
    """One column of a stream. dtype is numpy's name ("float64", "int16", "bool") or "str" for text;
    unit is the text as written in the file. held: the log is written on change: a value stands until the next row, and
    no row is no gap."""

    name: str
    stream: str
    unit: str | None = None
    dtype: str = "float64"
    scaling: Scaling | None = None
    properties: Mapping[str, str] = field(default_factory=lambda: _NOTHING)
    held: bool = False


@dataclass(frozen=True, slots=True)
class Recording:
    """What a file holds, read without its bulk. start_ns: UTC of the first sample of an absolute clock; None of a
    relative one, of which no file says when it began. complete: None where the format cannot tell. of_day_ns: of a
    relative clock whose file has times of day without a date, that of its first row: so parts of a recording tell their
    pauses.
    """

    signals: tuple[Signal, ...]
    clock: Literal["absolute", "relative"]
    start_ns: int | None = None
    complete: bool | None = None
    notes: tuple[str, ...] = ()
    of_day_ns: int | None = None

    @property
    def is_undated(self) -> bool:
        """Whether the file does not say when it was recorded: no relative clock began in 1970."""
        return self.clock == "relative" and not self.start_ns


@dataclass(frozen=True, slots=True)
class Block:
    """Consecutive rows of one stream. t_ns: shape (n,), UTC nanoseconds since 1970 (absolute) or since the
    start (relative). values: signal name -> shape (n,), in the file's own dtype. flags: signal -> uint16.
    at: shape (n,), where each row stands in the file, as the reader counts it: the line of a text, counted from 1 (of
    several lines the first), the row of a sheet, the number of a report. None where the reader tells it otherwise."""

    stream: str
    t_ns: Int1D
    values: Mapping[str, Array]
    flags: Mapping[str, Array] | None = None
    at: Int1D | None = None

    def part(self, first: int, last: int) -> Block:
        """Rows [first, last)."""
        cut = slice(first, last)
        return Block(
            self.stream,
            self.t_ns[cut],
            {name: values[cut] for name, values in self.values.items()},
            None if self.flags is None else {name: flags[cut] for name, flags in self.flags.items()},
            None if self.at is None else self.at[cut],
        )


@dataclass(frozen=True, slots=True)
class Loss:
    """A part of the file that could not be read. signal: the only one that it concerns."""

    where: str
    from_ns: int | None = None
    to_ns: int | None = None
    fraction: float | None = None
    reason: str = ""
    signal: str | None = None


@runtime_checkable
class Reader(Protocol):
    """Reads one log format. Never scales, flips, resamples or aligns; yields time as recorded.

    A reader may have one method more, which no reader needs: `locate(path, source, stream, row) -> str`. It says
    where in the file a row stands that `blocks` delivered: row counts from 0 over all blocks of that stream. The text
    names what a person can look up there, counted as the program that shows the file counts it: "line 812", "segment 3
    of 86400, byte 123456 (Eddy/Z)", "sheet 'data', row 813". Where that can't be told it says the row only ("row 812").
    It reads the file in bounded memory, and may take as long as reading it. `thermodata trace --verify` shows it.
    A reader without `locate` may have the same method under its first name, `place`.

    Another one is `beginning(path, source) -> Reader | None`: a reader of this file that gives its first rows alone,
    for a preview of a file whose `describe` must read all of it; None where the file is no larger than a look needs.

    It may also have attributes, which none needs:

    - `formats: tuple[str, ...]` names what it reads, for `thermodata plugins show`.
    - `version: str` stands in the raw data's key in place of its distribution's version.
    - `heads: Mapping[str, bytes]`, format -> the first bytes of a small file of it (in capitals: "SHDR"). The
      conformance kit shows them to all other readers, none of which may claim them.
    - `unordered: bool`: the rows of its files need not stand in the order of their times (messages of many writers):
      they are sorted, and a step back is no clock that was set.
    - `gives_way: bool`: the reader is a general one, and claims a file only where no other reader does. Of two that
      claim a file and do not give way none is taken: the source says `reader: NAME`.
    """

    name: str

    def sniff(self, head: Head) -> str | None:
        """The reason for claiming the file, or None."""

    def describe(self, path: Path, source: Source) -> Recording:
        """What the file holds; reads no bulk data. Raises FormatError where it can't be read at all."""

    def blocks(self, path: Path, source: Source) -> Iterator[Block | Loss]:
        """The data, in bounded blocks; a Loss where a part is gone (the good part is still yielded)."""


# ---- effects -------------------------------------------------------------------------------------


@dataclass(frozen=True, slots=True)
class Need:
    """A driver that an effect needs. places: dotted, `{a}` an axis letter, `{s}spindle` any spindle, `*` any one
    part, `spindle.bearing?` the bearing, or the spindle where no bearing has a sensor; () any place."""

    role: str
    quantity: str
    places: tuple[str, ...] = ()
    optional: bool = False


@dataclass(frozen=True, slots=True)
class Param:
    """A nonlinear parameter (time constant, exponent). lower, upper: what a fit may reach. reach: the same, wider, of
    an effect that is added to a model: a diagnosis holds what lies beyond the bounds less likely, and cuts nothing."""

    name: str
    unit: str
    start: float
    lower: float
    upper: float
    meaning: str
    reach: tuple[float, float] | None = None


@dataclass(frozen=True, slots=True)
class Gain:
    """A linear parameter. magnitude: plausible (smallest, largest) absolute value in `unit`."""

    name: str
    unit: str
    magnitude: tuple[float, float]
    sign: Literal["+", "-", "any"]
    meaning: str


@dataclass(frozen=True, slots=True)
class Drivers:
    """What an effect sees of one test, on one grid. t_s: shape (n,), uniform. values: role -> shape (n,), finite (gaps
    are filled), temperatures relative to the start of the test; valid: role -> shape (n,). All of it is read-only."""

    t_s: Float1D
    values: Mapping[str, Float1D]
    valid: Mapping[str, Bool1D]
    conditions: Mapping[str, float | str]


@runtime_checkable
class Effect(Protocol):
    """One physical effect: drivers and nonlinear parameters in, one column a gain out.

    name: an identifier, the one of its entry point. family: effects of one cause share it; `{a}` in it is filled in
    from the places that its drivers sit at. meaning: a sentence. source: where equation and bounds come from.

    It may have six attributes more, which no effect needs (`thermodata.effect.describe` reads them):
    `equation: str`, in plain text with F_tau{u} for a first-order lag; by default the first line of its class's
    docstring that holds " = ". `telltale: str`, how a residual looks where the effect is missing, and what test tells
    it from its like. `refines: tuple[str, ...]`, names of effects that it refines: diagnosis asks for it only where
    the model has one of them. `told_by: str`, a position of its own that tells it from these: where its moves make
    steps diagnosis asks for it without them, too. `closed_by: str`, the feedback of its axis
    (`machine.axes.X.feedback`) behind which it does not reach the tool: where that is declared diagnosis does not ask
    for it. `asked: bool`, False where diagnosis does not ask for it by itself.

    And one method more, `bases(several, points) -> Sequence[Float2D]`, for effects that do many at once at the cost of
    few: of each `Drivers` of several, shape (n, points * gains), what `basis` gives at each point, side by side, to the
    last digit. Without it every basis is asked for by itself.
    """

    name: str
    family: str
    meaning: str
    source: str
    needs: tuple[Need, ...]
    params: tuple[Param, ...]
    gains: tuple[Gain, ...]

    def basis(self, drivers: Drivers, p: Mapping[str, float]) -> Float2D:
        """Shape (n, len(gains)), float64, finite: the contribution of each gain at 1, zero at rest."""
