"""What a MAT file holds, whatever its version: numbers, text, cells and structs; bulk is loaded in pieces."""

from __future__ import annotations

from collections.abc import Callable, Mapping
from dataclasses import dataclass, field
from typing import TypeAlias

from thermodata.plugin import Array, Loss

MAX_DEPTH = 24
MAX_NODES = 400_000
MAX_TEXT = 4_000_000  # characters of one array of text


@dataclass(frozen=True, slots=True)
class Numbers:
    """A real matrix of `rows` x `columns`. dtype: numpy's name, "bool" for logical arrays.

    load(fixed, axis, start, stop): elements [start, stop) along `axis` (0: down the column `fixed`, 1: along the row
    `fixed`), shape (stop - start,), in dtype. said: what attributes of it say, by their names.
    """

    rows: int
    columns: int
    dtype: str
    load: Callable[[int, int, int, int], Array]
    said: Mapping[str, str] = field(default_factory=dict)

    @property
    def size(self) -> int:
        """Elements in all."""
        return self.rows * self.columns

    @property
    def is_vector(self) -> bool:
        """Whether it is one row or one column of more than one element."""
        return min(self.rows, self.columns) == 1 and self.size > 1

    def line(self, index: int, axis: int, start: int = 0, stop: int | None = None) -> Array:
        """One column (axis 0) or row (axis 1), or a part of it."""
        length = self.columns if axis else self.rows
        return self.load(index, axis, min(start, length), length if stop is None else min(stop, length))

    def vector(self, start: int = 0, stop: int | None = None) -> Array:
        """Elements of a vector that stands or lies."""
        return self.line(0, 0 if self.columns == 1 else 1, start, stop)


@dataclass(frozen=True, slots=True)
class Text:
    """A char array, one line a row."""

    lines: tuple[str, ...]


def line(letters: str) -> str:
    """A row of a char array as text: NUL, which MATLAB shows as a blank, is one, and none are left behind the text."""
    return letters.replace("\0", " ").rstrip()


@dataclass(frozen=True, slots=True)
class Cells:
    """A cell array, column by column."""

    rows: int
    columns: int
    items: tuple[Node, ...]


@dataclass(frozen=True, slots=True)
class Struct:
    """A 1x1 struct."""

    fields: Mapping[str, Node]


@dataclass(frozen=True, slots=True)
class Structs:
    """A struct array, column by column."""

    items: tuple[Struct, ...]


@dataclass(frozen=True, slots=True)
class Odd:
    """What is no plain data: `kind` is its class (timetable, function_handle, complex double, ...)."""

    kind: str


Node: TypeAlias = Numbers | Text | Cells | Struct | Structs | Odd


@dataclass(frozen=True)
class Tree:
    """The variables of a file, in its order. losses: variables that are damaged, cut off, or no plain data."""

    variables: Mapping[str, Node]
    losses: tuple[Loss, ...] = ()
    complete: bool | None = None
    notes: tuple[str, ...] = field(default=())


def refusal(kind: str) -> str:
    """What an object is, and how to save it so that other programs can read it."""
    save = {
        "timetable": "S = struct('time', seconds(TT.Properties.RowTimes - TT.Properties.RowTimes(1)), 'T1', TT.T1)",
        "timeseries": "S = struct('time', ts.Time, 'T1', ts.Data)",
        "table": "S = table2struct(T, 'ToScalar', true)",
        "datetime": "time = posixtime(t) or cellstr(t)",
        "duration": "time = seconds(t)",
        "string": "names = cellstr(names)",
        "categorical": "state = cellstr(state)",
    }.get(kind, "a struct of plain vectors")
    if kind.startswith(("complex", "sparse")):
        save = "real(x) and imag(x)" if kind.startswith("complex") else "full(x)"
    return f"a {kind} is no plain data: only MATLAB itself can read it. Save it as {save}"
