"""The index of a TDMS file: what a walk over its segments found, without the bulk."""

from __future__ import annotations

from array import array
from collections.abc import Mapping
from dataclasses import dataclass, field
from typing import Any, NamedTuple

from thermodata_reader_crio.tdms.segments.chunk_layout import Layout

CLOCK = ("wf_start_time", "wf_start_offset", "wf_increment", "wf_xunit_string", "wf_xname")


class Shape(NamedTuple):
    """How the chunks of a piece lie: full ones (tail None), or a last shorter one of `tail` bytes; cut: that tail is
    what the end of the file left of a full chunk, not a chunk that was written shorter."""

    layout: int
    tail: int | None = None
    cut: bool = False


@dataclass(slots=True)
class Pieces:
    """Chunks of one shape that follow each other, one entry a run of them: flat arrays, for a day may hold 86,400."""

    position: array[int] = field(default_factory=lambda: array("q"))
    chunks: array[int] = field(default_factory=lambda: array("q"))
    shape: array[int] = field(default_factory=lambda: array("i"))

    def add(self, position: int, chunks: int, shape: int) -> None:
        """One run more: its first byte, its chunks, the number of its shape."""
        self.position.append(position)
        self.chunks.append(chunks)
        self.shape.append(shape)

    def drop_from(self, count: int) -> None:
        """Forgets all entries from one on."""
        del self.position[count:], self.chunks[count:], self.shape[count:]

    def copy(self, first: int) -> list[tuple[int, int, int]]:
        """The entries from one on."""
        return list(zip(self.position[first:], self.chunks[first:], self.shape[first:], strict=True))

    def restore(self, first: int, entries: list[tuple[int, int, int]]) -> None:
        """Puts entries back in the place of those from one on."""
        self.drop_from(first)
        for position, chunks, shape in entries:
            self.add(position, chunks, shape)

    def __len__(self) -> int:
        return len(self.position)


@dataclass(frozen=True, slots=True)
class Hole:
    """Bytes [start, end) that no segment could be read from. piece: how many pieces come before it; chunks: how many
    chunks of which layout are gone, where that can be told."""

    start: int
    end: int
    piece: int
    reason: str
    layout: int = -1
    chunks: int | None = None


class ClockChange(NamedTuple):
    """A waveform's properties that changed with a piece."""

    piece: int
    properties: Mapping[str, Any]


@dataclass(slots=True)
class Index:
    """The walk's result. good_end: the first byte that no good segment covers; expected_end: where the file
    should have ended, if the last lead-in says so; starts: the first byte of each good segment."""

    size: int
    properties: dict[str, dict[str, Any]] = field(default_factory=dict)
    layouts: list[Layout] = field(default_factory=list)
    shapes: list[Shape] = field(default_factory=list)
    pieces: Pieces = field(default_factory=Pieces)
    clock_changes: dict[str, list[ClockChange]] = field(default_factory=dict)
    holes: list[Hole] = field(default_factory=list)
    meanings: dict[str, str] = field(default_factory=dict)
    notes: list[str] = field(default_factory=list)
    good_end: int = 0
    expected_end: int | None = None
    damage: str | None = None
    starts: array[int] = field(default_factory=lambda: array("q"))

    @property
    def segments(self) -> int:
        """How many good segments there are."""
        return len(self.starts)

    def note(self, text: str) -> None:
        """Keeps a note; a file that repeats itself 86,400 times says it ten times."""
        if len(self.notes) < 10:
            self.notes.append(text)
