"""Where each channel's values lie in a TDMS file.

A column is one raw number a sample: a channel, one scaler of a DAQmx channel, or one part of a complex number. Its
values lie in the pieces whose shape holds it. What the columns of one shape share (the pieces, their rows) is kept
once: a day may be 86,400 segments of 40 channels, and a file 100,000 channels.
"""

from __future__ import annotations

from array import array
from dataclasses import dataclass, field

import numpy as np

from thermodata.plugin import Int1D
from thermodata_reader_crio.tdms.raw.places import TEXT, Kind, slots
from thermodata_reader_crio.tdms.segments.index import Index


@dataclass(frozen=True, eq=False)
class Runs:
    """The pieces that hold a set of columns, in the file's order. position, chunks: shape (k,); which: which of the
    columns' places each piece has; pitch: bytes from chunk to chunk of each place."""

    position: Int1D
    chunks: Int1D
    which: Int1D
    piece: Int1D
    pitch: Int1D
    shapes: tuple[int, ...] = ()
    _rows: dict[bytes, Int1D] = field(default_factory=dict)

    def rows(self, n: Int1D) -> Int1D:
        """First row of each piece, and the end: shape (k + 1,), where place i has n[i] values a chunk."""
        key = n.tobytes()
        if key not in self._rows:
            self._rows[key] = np.concatenate(([0], np.cumsum(self.chunks * n[self.which]))).astype(np.int64)
        return self._rows[key]


@dataclass(frozen=True, eq=False, slots=True)
class Column:
    """n, start, stride, kinds: for each place (values a chunk; first byte in it; bytes from value to value, for text
    the bytes of all of them). length: values that are there; planned: those that the file announced, more where it was
    cut."""

    path: str
    part: int | str | None
    runs: Runs
    n: Int1D
    start: Int1D
    stride: Int1D
    kinds: tuple[Kind, ...]
    shapes: tuple[int, ...]
    length: int
    planned: int

    @property
    def row(self) -> Int1D:
        """First row of each piece, and the end: shape (k + 1,)."""
        return self.runs.rows(self.n)

    @property
    def dtype(self) -> str:
        """The type that holds all of its kinds."""
        if len(self.kinds) == 1:
            return self.kinds[0].dtype
        names = {k.dtype for k in self.kinds}
        return names.pop() if len(names) == 1 else np.result_type(*names).str[1:]

    def row_at(self, piece: int) -> int:
        """The first row at or after a piece of the file."""
        return int(self.row[int(np.searchsorted(self.runs.piece, piece, "left"))])


def columns(index: Index) -> tuple[dict[str, list[Column]], list[str]]:
    """Each channel's columns (several for a DAQmx channel with several scalers), in the file's order; and the
    channels that change between numbers and text, of which the first sort is kept, as sentences."""
    # a channel's places in the making, flat: numbers of kind and shape, and start, n, stride and full of each
    places: dict[tuple[str, int | str | None], array[int]] = {}
    kinds: dict[Kind, int] = {}
    wrong: dict[str, str] = {}
    for number, shape in enumerate(index.shapes):
        for path, part, kind, *where in slots(index.layouts[shape.layout], shape):
            of_kind = kinds.setdefault(kind, len(kinds))
            found = places.get((path, part))
            if found is None:
                places[path, part] = array("q", (of_kind, number, *where))
                continue
            if found[0] != of_kind and not _join((first := list(kinds)[found[0]]).dtype, kind.dtype):
                wrong[path] = f"it changes from {_name(first)} to {_name(kind)}; only the first sort is read"
                continue
            found.extend((of_kind, number, *where))
    maker = _Maker(index, tuple(kinds))
    made: dict[str, list[Column]] = {}
    for (path, part), found in places.items():
        made.setdefault(path, []).append(maker.column(path, part, found))
    return made, [f"{path}: {text}" for path, text in wrong.items()]


def _join(a: str, b: str) -> bool:
    """Numbers of different types join; text and timestamps stay among themselves."""
    return a == b or not {a, b} & {TEXT, "V16"}


def _name(kind: Kind) -> str:
    return {TEXT: "text", "V16": "timestamps"}.get(kind.dtype) or np.dtype(kind.dtype).name


class _Maker:
    """Makes columns that share what is equal in them: all but the first byte, in most."""

    def __init__(self, index: Index, kinds: tuple[Kind, ...]) -> None:
        self.index, self.kinds = index, kinds
        self.runs = _RunsOf(index)
        self._numbers: dict[tuple[int, ...], Int1D] = {}
        self._kinds: dict[tuple[int, ...], tuple[Kind, ...]] = {}
        self._lengths: dict[tuple[tuple[int, ...], tuple[int, ...], tuple[int, ...]], tuple[int, int]] = {}

    def column(self, path: str, part: int | str | None, places: array[int]) -> Column:
        """places: of the column, flat."""
        of_kind, shapes, start, n, stride, full = (tuple(places[i::6]) for i in range(6))
        runs = self.runs.of(shapes)
        if of_kind not in self._kinds:
            self._kinds[of_kind] = tuple([self.kinds[i] for i in of_kind])
        length, planned = self._length(runs, shapes, n, full)
        return Column(
            path,
            part,
            runs,
            self._shared_array(n),
            np.array(start, np.int64),
            self._shared_array(stride),
            self._kinds[of_kind],
            runs.shapes,
            length,
            planned,
        )

    def _shared_array(self, numbers: tuple[int, ...]) -> Int1D:
        found = self._numbers.get(numbers)
        if found is None:
            found = self._numbers[numbers] = np.array(numbers, np.int64)
        return found

    def _length(
        self, runs: Runs, shapes: tuple[int, ...], n: tuple[int, ...], full: tuple[int, ...]
    ) -> tuple[int, int]:
        """(values that are there, values that the file announced)."""
        known = self._lengths.get((shapes, n, full))
        if known is None:
            held = int((runs.chunks * self._shared_array(n)[runs.which]).sum())
            cut = any(self.index.shapes[number].cut for number in shapes)
            known = self._lengths[shapes, n, full] = held, held + (sum(full) - sum(n) if cut else 0)
        return known


class _RunsOf:
    """Pieces by the shapes that they have, each combination made once."""

    def __init__(self, index: Index) -> None:
        self.index = index
        self.position = np.frombuffer(index.pieces.position, np.int64) if len(index.pieces) else np.zeros(0, np.int64)
        self.chunks = np.frombuffer(index.pieces.chunks, np.int64) if len(index.pieces) else np.zeros(0, np.int64)
        shape = np.frombuffer(index.pieces.shape, np.int32) if len(index.pieces) else np.zeros(0, np.int32)
        self.order = np.argsort(shape, kind="stable")
        self.bounds = np.searchsorted(shape[self.order], np.arange(len(index.shapes) + 1))
        self.made: dict[tuple[int, ...], Runs] = {}

    def of(self, shapes: tuple[int, ...]) -> Runs:
        if shapes not in self.made:
            parts = [self.order[self.bounds[s] : self.bounds[s + 1]] for s in shapes]
            piece = np.concatenate(parts) if parts else np.zeros(0, np.int64)
            which = np.repeat(np.arange(len(parts)), [p.size for p in parts])
            in_order = np.argsort(piece, kind="stable")
            piece, which = piece[in_order].astype(np.int64), which[in_order].astype(np.int64)
            layouts = [self.index.layouts[self.index.shapes[s].layout] for s in shapes]
            self.made[shapes] = Runs(
                self.position[piece],
                self.chunks[piece],
                which,
                piece,
                np.array([layout.chunk_bytes for layout in layouts], np.int64),
                shapes,
            )
        return self.made[shapes]
