"""A good reader of a text of lines, and such that lose rows, order or the lack of a value without a word."""

from __future__ import annotations

from collections.abc import Callable, Iterator
from itertools import islice, pairwise
from pathlib import Path

import numpy as np

from thermodata.errors import FormatError
from thermodata.plugin import Block, Head, Loss, Recording, Signal, Source
from thermodata.testing import reader as kit

MAGIC = b"LINES1"
Row = tuple[float, float, float]


class Good:
    """A magic word, then lines of seconds, temperature and speed."""

    name = "lines"

    def sniff(self, head: Head) -> str | None:
        return "starts with LINES1" if head.start.startswith(MAGIC + b"\n") else None

    def describe(self, path: Path, source: Source) -> Recording:
        with path.open("rb") as file:
            if file.readline(100) != MAGIC + b"\n":
                raise FormatError("no log of lines", where=path.name)
        return Recording((Signal("T", "log", "degC"), Signal("n", "log", "rpm")), "relative")

    def blocks(self, path: Path, source: Source) -> Iterator[Block | Loss]:
        self.describe(path, source)
        with path.open("rb") as file:
            lines = islice(enumerate(file, start=1), 1, None)
            while some := list(islice(lines, int(source.options.get("block_rows", 1000)))):
                rows = []
                for number, line in some:
                    row = self.row(line)
                    if row is None:
                        yield Loss(f"line {number}", reason=f"no row: {line[:20]!a}")
                    else:
                        rows.append(row)
                yield self.block(rows)

    def row(self, line: bytes) -> Row | None:
        cells = line.rstrip(b"\r\n").split(b";")
        try:
            seconds, temperature, speed = float(cells[0]), self.number(cells[1]), self.number(cells[2])
        except (IndexError, ValueError):
            return None
        return (seconds, temperature, speed) if line.endswith(b"\n") and abs(seconds) < 9e9 else None

    def number(self, cell: bytes) -> float:
        return float(cell) if cell.strip() else float("nan")

    def block(self, rows: list[Row]) -> Block:
        t_s, temperature, speed = np.array(rows, np.float64).reshape(-1, 3).T
        return Block("log", np.rint(t_s * 1e9).astype(np.int64), {"T": temperature, "n": speed})


class KeepsTheWord(Good):
    """A word makes its whole column one of texts: nothing is lost."""

    def has_one(self, path: Path) -> bool:
        with path.open("rb") as file:
            return any(b"Fault" in line for line in file)

    def describe(self, path: Path, source: Source) -> Recording:
        said = super().describe(path, source)
        kind = "str" if self.has_one(path) else "float64"
        return Recording(tuple(Signal(s.name, s.stream, s.unit, kind) for s in said.signals), "relative")

    def blocks(self, path: Path, source: Source) -> Iterator[Block | Loss]:
        if not self.has_one(path):
            yield from super().blocks(path, source)
            return
        rows = [line.split(b";") for line in path.read_bytes().splitlines()[1:]]
        t_ns = np.array([round(float(row[0]) * 1e9) for row in rows], np.int64)
        yield Block("log", t_ns, {n: np.array([r[i].decode() for r in rows]) for n, i in (("T", 1), ("n", 2))})


class Sorts(Good):
    def block(self, rows: list[Row]) -> Block:
        return super().block(sorted(rows))


class SaysThatItSorts(Sorts):
    """As a good reader may, whose files hold the messages of many writers."""

    unordered = True


class DropsWhatGoesBack(Good):
    def block(self, rows: list[Row]) -> Block:
        return super().block([row for i, row in enumerate(rows) if not i or row >= rows[i - 1]])


class KeepsOneOfEach(Good):
    def block(self, rows: list[Row]) -> Block:
        return super().block(list(dict.fromkeys(rows)))


class ZeroForNothing(Good):
    def number(self, cell: bytes) -> float:
        return float(cell or b"0")


class ZeroForNaN(Good):
    def number(self, cell: bytes) -> float:
        return float(np.nan_to_num(super().number(cell)))


class TheValueBefore(Good):
    def block(self, rows: list[Row]) -> Block:
        filled = [list(row) for row in rows]
        for before, row in pairwise(filled):
            row[1:] = [b if np.isnan(a) else a for a, b in zip(row[1:], before[1:], strict=True)]
        return super().block([(row[0], row[1], row[2]) for row in filled])


class ZeroForAWord(Good):
    def number(self, cell: bytes) -> float:
        try:
            return super().number(cell)
        except ValueError:
            return 0.0


class DropsBadLines(Good):
    def blocks(self, path: Path, source: Source) -> Iterator[Block | Loss]:
        return (item for item in super().blocks(path, source) if isinstance(item, Block))


class DropsTheHalfLine(Good):
    """Tells of a bad line, and not of one without its end."""

    def blocks(self, path: Path, source: Source) -> Iterator[Block | Loss]:
        return (item for item in super().blocks(path, source) if isinstance(item, Block) or "\\n" in item.reason)


class ReadsAllAtOnce(Good):
    def blocks(self, path: Path, source: Source) -> Iterator[Block | Loss]:
        self.describe(path, source)
        rows = [self.row(line) for line in path.read_bytes().splitlines(keepends=True)[1:]]
        yield from (Loss(f"line {i}", reason="no row") for i, row in enumerate(rows, start=2) if row is None)
        good, size = [row for row in rows if row is not None], int(source.options.get("block_rows", 1000))
        yield from (self.block(good[i : i + size]) for i in range(0, len(good), size))


class LooksAtAllAtOnce(Good):
    """Yields small blocks of a file that it held whole before."""

    def describe(self, path: Path, source: Source) -> Recording:
        if b"END OF MEASUREMENT" in path.read_bytes():
            raise FormatError("a log of another version", where=path.name)
        return super().describe(path, source)


BROKEN: dict[type, Callable[..., None]] = {
    Sorts: kit.rows_arrive_in_the_order_of_the_file,
    DropsWhatGoesBack: kit.rows_arrive_in_the_order_of_the_file,
    KeepsOneOfEach: kit.a_row_that_is_written_twice_arrives_twice,
    ZeroForNothing: kit.a_cell_without_a_value_gives_no_number,
    ZeroForNaN: kit.a_cell_without_a_value_gives_no_number,
    TheValueBefore: kit.a_cell_without_a_value_gives_no_number,
    ZeroForAWord: kit.a_word_among_numbers_gives_no_number,
    DropsBadLines: kit.a_line_that_is_no_row_is_told,
    DropsTheHalfLine: kit.a_file_cut_within_a_record_is_told,
    LooksAtAllAtOnce: kit.memory_does_not_grow_with_the_file,
    ReadsAllAtOnce: kit.memory_does_not_grow_with_the_file,
}


def written(path: Path) -> Path:
    path.write_bytes(MAGIC + b"\n" + b"".join(b"%g;%g;%g\n" % (i / 2, 20 + i / 8, 100 + i) for i in range(12)))
    return path
