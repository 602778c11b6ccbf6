"""The first lines of a text, in which the layout of its table shows."""

from __future__ import annotations

from collections.abc import Sequence

_HEAD_LINES = 500  # in which the layout shows
_HEADER_LINES, _CELL_LINES = 60, 16  # in which cells over several lines are headers, and of how many lines


def records(lines: Sequence[str]) -> list[str]:
    """The lines, those of a header whose cells go over several joined: at the last of them, the others blank, so that
    lines keep their numbers."""
    joined: list[str] = []
    at = 0
    while at < len(lines):
        end = at
        if at < _HEADER_LINES and lines[at].count('"') % 2:
            more = range(at + 1, min(len(lines), at + _CELL_LINES))
            end = next((k for k in more if lines[k].count('"') % 2), at)
        joined += [*[""] * (end - at), " ".join(lines[at : end + 1])]
        at = end + 1
    return joined


def top_of(head: Sequence[str]) -> Sequence[str]:
    """The lines up to the 500th that is not empty."""
    full = [k for k, line in enumerate(head) if line and not line.isspace()][:_HEAD_LINES]
    return head[: full[-1] + 1] if full else head
