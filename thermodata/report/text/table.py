"""Neat text tables: numbers to the right, units in the heading, folded to the screen."""

from __future__ import annotations

import re
import shutil
from collections.abc import Iterable, Mapping, Sequence
from dataclasses import dataclass
from itertools import pairwise
from typing import Any

from thermodata.report.words.numbers import number

Column = tuple[str, str]  # (key of the row, heading)
_WORD = r"[^\s:/]+:(?=[A-Za-z])|[^\s:/]{8,}/(?=[A-Za-z])|\S+"
# within a cell: a number and its unit, and both ends of a range
_TOGETHER = re.compile(r"(?<=\d) (?=(?:%|h|min|s|um)(?:\W|$))|(?<=\S) (?=[…–] )|(?<=[…–]) (?=\S)")
_TIE = "\0"  # a space there, until the lines are made


def cell(value: Any) -> str:
    """One value as a cell: '-' for nothing, lists joined."""
    if isinstance(value, bool):
        return "yes" if value else "no"
    if isinstance(value, float | int) or value is None:
        return number(value)
    if isinstance(value, Mapping):
        return ", ".join(f"{k} {cell(v)}" for k, v in value.items()) or "-"
    if isinstance(value, list | tuple):
        return ", ".join(cell(v) for v in value) or "-"
    text = str(value)
    return " ".join(text.split()) or "-"


def table(
    rows: Sequence[Mapping[str, Any]], columns: Iterable[Column], *, widest: int = 60, width: int | None = None
) -> str:
    """Aligned text; columns of numbers to the right, texts longer than `widest` cut with '…', names in their middle.

    width: of the screen; `screen_width()` where None. Where the columns are wider, what all rows share is said once
    above them, and headings and texts are folded at their spaces, numbers and ranges never; columns that still have no
    room stand in a table below, beside what tells the rows apart again. Where there is no room for that either, each
    run of rows that share the first column has tables of its own, and says once what it shares.
    """
    columns = list(columns)
    lines = [[_TOGETHER.sub(_TIE, _cut(cell(row.get(key)), widest)) for key, _ in columns] for row in rows]
    right = [_numbers(rows, key) for key, _ in columns]
    made = [
        _Column(heading, [line[i] for line in lines], is_number)
        for i, ((_, heading), is_number) in enumerate(zip(columns, right, strict=True))
    ]
    room = screen_width() if width is None else width
    return _one_table(made, room).replace(_TIE, " ")


def _one_table(columns: Sequence[_Column], room: int) -> str:
    said, made = _said_once(columns, room)
    parts = _parts(made, room)
    told_apart = len(parts) == 1 or _tells_apart(made[: _names(made, room)])
    if (told_apart and all(_least(part) <= room for part in parts)) or not (runs := _runs(made[0])):
        return "\n\n".join([*said, *(_drawn(part, room) for part in parts)])
    told = list[str]()
    for a, b in runs:
        shared, run = _said_once([_Column(c.heading, c.cells[a:b], c.right) for c in made[1:]], room)
        told += [prose(", ".join([f"{made[0].heading} {made[0].cells[a]}", *shared]), room), _one_table(run, room)]
    return "\n\n".join([*said, *told])


def _runs(column: _Column) -> list[tuple[int, int]]:
    """From where to where a text stays the same; none where it does not say much of the rows together."""
    edges = [i for i, c in enumerate(column.cells) if i == 0 or c != column.cells[i - 1]]
    if column.right or 2 * len(edges) > len(column.cells):
        return []
    return list(pairwise([*edges, len(column.cells)]))


def _tells_apart(columns: Sequence[_Column]) -> bool:
    return len(set(zip(*(c.cells for c in columns), strict=True))) == len(columns[0].cells)


def _cut(text: str, widest: int) -> str:
    """A name in its middle, for names that are alike differ at their end; a text at its end."""
    if len(text) <= widest:
        return text
    if " " in text:
        return text[: widest - 1] + "…"
    head = (widest - 1) // 2
    return text[:head] + "…" + text[len(text) - (widest - 1 - head) :]


def screen_width() -> int:
    """Columns of the terminal, or COLUMNS; 80 where the answer goes elsewhere."""
    return max(40, shutil.get_terminal_size((80, 24)).columns)


def prose(text: str, width: int | None = None) -> str:
    """Lines of words folded where the screen ends; a line that goes on is put in by two. width: of the screen;
    `screen_width()` where None."""
    room = screen_width() if width is None else width
    told = list[str]()
    for line in text.splitlines():
        first, *rest = _fold(line, room)
        told += [first, *(f"  {x}" for x in _fold(line[len(first) :].lstrip(), room - 2) if rest)]
    return "\n".join(told)


def sentences_folded(text: str, width: int | None = None) -> str:
    """`prose` of the lines that are sentences, put in as they are; rows of tables, whose columns two spaces part, stay
    whole."""
    room = screen_width() if width is None else width
    told = list[str]()
    for line in text.split("\n"):
        body = line.strip()
        put_in = line[: len(line) - len(line.lstrip())]
        told += [line] if "  " in body else [put_in + x for x in prose(body, room - len(put_in)).split("\n")]
    return "\n".join(told)


@dataclass(frozen=True)
class _Column:
    heading: str
    cells: Sequence[str]
    right: bool

    @property
    def widest(self) -> int:
        return max([len(self.heading), *map(len, self.cells)])

    @property
    def least(self) -> int:
        """Below this a word would be broken, or a number."""
        whole = self.cells if self.right else [max(_words(c), key=len) for c in self.cells]
        return max([max(map(len, _words(self.heading))), *map(len, whole)])


def _said_once(columns: Sequence[_Column], room: int) -> tuple[list[str], list[_Column]]:
    """What all rows share stands above them, where the columns have no room beside each other."""
    if sum(c.widest for c in columns) + 2 * (len(columns) - 1) <= room:
        return [], list(columns)
    # of a single row what it stands in, which is a campaign mostly
    several = [c for c in columns if len(c.cells) > 1] or (columns[:1] if len(columns) > 2 else [])
    same = [c for c in several if not c.right and len(set(c.cells)) == 1]
    if not same or len(same) == len(columns):
        return [], list(columns)
    said = ", ".join(f"{c.heading} {c.cells[0]}" for c in same if c.cells[0] != "-")
    return ["\n".join(_fold(said, room))] if said else [], [c for c in columns if c not in same]


def _parts(columns: Sequence[_Column], room: int) -> list[list[_Column]]:
    """The columns in as many tables as have room for them; those that name the rows begin each."""
    names = _names(columns, room)
    if _least(columns) <= room:
        return [list(columns)]
    head, parts = list(columns[:names]), list[list[_Column]]()
    taken = sum(c.least + 2 for c in head)
    left = taken
    now: list[_Column] = []
    for column in columns[names:]:
        if now and left + column.least > room:
            parts.append([*head, *now])
            now, left = [], taken
        now.append(column)
        left += column.least + 2
    return [*parts, [*head, *now]]


def _least(columns: Sequence[_Column]) -> int:
    return sum(c.least for c in columns) + 2 * (len(columns) - 1)


def _names(columns: Sequence[_Column], room: int) -> int:
    """How many of the first columns name a row: those before the first number, and more until no two rows share them,
    where that leaves half of the room to others."""
    texts = next((i for i, c in enumerate(columns) if c.right), 1) or 1
    for n in range(texts, len(columns)):
        if sum(c.least + 2 for c in columns[:n]) > room / 2:
            break
        if _tells_apart(columns[:n]):
            return n
    return texts


def _drawn(columns: Sequence[_Column], room: int) -> str:
    widths = _widths(columns, room - 2 * (len(columns) - 1))
    lines = _folded([c.heading for c in columns], columns, widths)
    lines.append(_line(["─" * w for w in widths], columns, widths))
    for i in range(len(columns[0].cells) if columns else 0):
        lines += _folded([c.cells[i] for c in columns], columns, widths)
    return "\n".join(lines)


def _widths(columns: Sequence[_Column], room: int) -> list[int]:
    """As wide as the longest cell; where there is no room for that, the widest gives first."""
    widths, least = [c.widest for c in columns], [c.least for c in columns]
    while sum(widths) > room:
        can = [i for i, w in enumerate(widths) if w > least[i]]
        if not can:
            break
        widest = max(can, key=lambda i: widths[i])
        widths[widest] -= 1
    return widths


def _folded(texts: Sequence[str], columns: Sequence[_Column], widths: Sequence[int]) -> list[str]:
    parts = [_fold(text, width) for text, width in zip(texts, widths, strict=True)]
    return [
        _line([p[k] if k < len(p) else "" for p in parts], columns, widths)
        for k in range(max((len(p) for p in parts), default=0))
    ]


def _line(parts: Sequence[str], columns: Sequence[_Column], widths: Sequence[int]) -> str:
    placed = zip(parts, widths, columns, strict=True)
    return "  ".join(p.rjust(w) if c.right else p.ljust(w) for p, w, c in placed).rstrip()


def _fold(text: str, width: int) -> list[str]:
    """A text in lines of at most `width`, broken where its words end; a longer word stands out."""
    if len(text) <= width:
        return [text]
    lines, line = list[str](), ""
    for word in re.findall(rf"(?:{_WORD})\s*", text) or [text]:
        joined = line + word
        if line and len(joined.rstrip()) > width:
            lines.append(line.rstrip())
            joined = word
        line = joined
    return [*lines, line.rstrip()]


def _words(text: str) -> list[str]:
    """Where a text may be folded: at spaces, and between an effect and its channels."""
    return re.findall(_WORD, text) or [text]


def _numbers(rows: Sequence[Mapping[str, Any]], key: str) -> bool:
    values = [row.get(key) for row in rows]
    return all(isinstance(v, int | float) or v is None for v in values) and any(
        v is not None and not isinstance(v, bool) for v in values
    )


def fields(pairs: Iterable[tuple[str, Any]]) -> str:
    """Names and values, one a line, values aligned."""
    shown = [(name, cell(value)) for name, value in pairs]
    width = max((len(name) for name, _ in shown), default=0)
    return "\n".join(f"{name.ljust(width)}  {value}" for name, value in shown)
