"""Where a row of a text stands: its line, which it carries from the start."""

from __future__ import annotations

from collections.abc import Iterable

from thermodata.plugin import Block, Loss


def row_at(items: Iterable[Block | Loss], stream: str, row: int) -> tuple[int, int | None] | None:
    """(`at` of a row, counted from 0, of a stream; the next larger `at` of the stream, None behind the last). None
    where there is no such row, or its reader does not say."""
    done, here = 0, None
    for item in items:
        if not isinstance(item, Block) or item.stream != stream or not item.t_ns.size:
            continue
        if item.at is None:
            return None
        if here is None and row < done + item.t_ns.size:
            here = int(item.at[row - done])
        if here is not None:  # the rows of a block may have been put in order
            behind = item.at[item.at > here]
            if behind.size:
                return here, int(behind.min())
        done += item.t_ns.size
    return None if here is None else (here, None)


def line_of(items: Iterable[Block | Loss], stream: str, row: int) -> str | None:
    """'line 812' of a row, as an editor counts; None where there is no such row."""
    found = row_at(items, stream, row)
    return None if found is None else f"line {found[0]}"


def lines_of(items: Iterable[Block | Loss], stream: str, row: int) -> str | None:
    """The same of a log in which the lines of one time, one behind another, make a row: 'lines 812 to 815'."""
    found = row_at(items, stream, row)
    if found is None:
        return None
    first, behind = found
    return f"line {first}" if behind is None or behind <= first + 1 else f"lines {first} to {behind - 1}"
