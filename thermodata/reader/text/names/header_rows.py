"""Names and units of a table's columns, from the rows above its data: groups, names, units, and what is neither."""

from __future__ import annotations

import re
from collections.abc import Sequence

from thermodata.reader.text.cells.cell import Cell, is_number, is_stamp
from thermodata.reader.text.cells.values.quotes import clean
from thermodata.reader.text.names.group_heads import (
    apart_by_comments,
    heads_over,
    is_label,
    is_of_descriptions,
    of_channels,
    under,
    units_of_heads,
    with_units_below,
)
from thermodata.reader.text.names.header import looks_like_unit, split_unit
from thermodata.reader.text.names.time_header import says_time
from thermodata.reader.text.names.units_row import (
    STATISTIC,
    are_units,
    as_units,
    known_units,
    mostly_units,
    of_units,
    units_below,
    without_types,
)

# what loggers write before a row of units
OF_UNITS = re.compile(r"(?i)units?|einheit(en)?|jednotk[ay]|unité|unità|unidad|単位|单位")


def names_and_units(
    rows: Sequence[Sequence[Cell]], width: int, units_row: int | None
) -> tuple[list[str], list[str | None], list[str]]:
    """Names, units, and heads of groups over the names, '' where there is none, from the rows before the data; rows
    that do not span the table are preamble."""
    return _read_header(rows, width, units_row)[:3]


def place_of_names(rows: Sequence[Sequence[Cell]], width: int, units_row: int | None) -> int | None:
    """Which of the rows before the data that of the names is; None where none is."""
    return _read_header([r[:width] for r in rows], width, units_row)[3]


def _read_header(
    rows: Sequence[Sequence[Cell]], width: int, units_row: int | None
) -> tuple[list[str], list[str | None], list[str], int | None]:
    """Names, units, heads of groups, and the place of the names."""
    texts = [list(r) for r in without_types([_texts(r, width) for r in rows])]
    units: list[str | None] = [None] * width
    if units_row is None:
        units_row = _labelled_units(texts)
    if units_row is not None and 0 <= units_row < len(texts):
        row = texts.pop(units_row)
        row = ["", *row[1:]] if OF_UNITS.fullmatch(row[0].strip(" :")) else row  # what the row is called is no unit
        units = as_units(_merged(row, texts[units_row - 1], texts[-1]) if 0 < units_row < len(texts) else row)
    at_all = _spanning(texts, width)
    spanning = [texts[i] for i in at_all]
    named = _row_of_names(texts, at_all, width)
    if units_row is None and len(spanning) >= 2:
        times = _times_among(spanning[-1 if named is None else named])
        if named is not None and (below := next((r for r in spanning[named + 1 :] if of_units(r, times)), None)):
            units = units_below(spanning[named], below)
        elif of_units(spanning[-1], _times_among(spanning[-2], again=True)):
            units = as_units(spanning.pop())
        elif _units_among(spanning[-2], spanning[-1]):
            units = known_units(spanning.pop())
    said: Sequence[Sequence[str]] = ()
    if named is not None:
        spanning, said = spanning[: named + 1], texts[at_all[named] + 1 :]
    names = spanning[-1] if spanning else [""] * width
    place = next((i for i in range(len(texts) - 1, -1, -1) if texts[i] is names), None)
    if units_row is None and place and not any(units) and _are_units_above(texts[place - 1], names):
        place = units_row = place - 1
        units = as_units(texts.pop(units_row))
    at = place or 0
    if place is not None and len(texts) < len(rows) and units_row is not None and place >= units_row:
        place += 1
    if at:
        names = with_units_below(texts[at - 1], names)
    over = [""] * width
    names = apart_by_comments(names, [row[:width] for row in said if not of_units(row, ())])
    found = [split_unit(n)[1] for n in names]
    if at and any(texts[at - 1]):
        of_heads = units_of_heads(texts[at - 1], names)
        over, names = heads_over(texts[at - 1], names), under(texts[at - 1], names)
        names = of_channels(texts[: at - 1], names)
        found = [own or split_unit(n)[1] or head for own, n, head in zip(found, names, of_heads, strict=True)]
    return names, [u or f for u, f in zip(units, found, strict=True)], over, place


def texts_of(row: Sequence[Cell]) -> list[str]:
    """The cells of a row as texts."""
    return [clean(str(c)) if c is not None else "" for c in row]


def _texts(row: Sequence[Cell], width: int) -> list[str]:
    return texts_of(row) + [""] * (width - len(row))


def _merged(row: Sequence[str], above: Sequence[str], last: Sequence[str]) -> list[str]:
    """A row of units whose cells stand for those to their right too, where the row above it leaves the same ones out
    and the last one does not (a channel with its minimum and maximum)."""
    out, start = list(row), 0
    for k in range(1, min(len(row), len(above))):
        start = k if above[k] else start
        if start and not row[k] and last[k]:
            out[k] = row[start]
    return out


def _labelled_units(texts: Sequence[Sequence[str]]) -> int | None:
    """The row that is called units by its first cell and holds some; None where there is none."""
    for i, row in enumerate(texts):
        first, *others = [c for c in row if c] or [""]
        if OF_UNITS.fullmatch(first.strip(" :")) and row[0] and any(map(looks_like_unit, others)):
            return i
    return None


def _row_of_names(texts: Sequence[Sequence[str]], at: Sequence[int], width: int) -> int | None:
    """Which of the rows that span the table (at: their places) is that of names, where others stand below it that are
    none: it names every column, the time among them, and the rows below it are units and comments on these, repeat
    themselves (a kind of average, a rate) or write no time into the column of the time. None where the last row, but
    for one of units, holds the names."""
    spanning = [texts[k][:width] for k in at]
    for i in range(len(spanning) - 2, -1, -1):
        below = spanning[i + 1 :]
        if _comments_below_units(texts[at[i] - 1][:width] if at[i] else (), spanning[i], below):
            return i
        row = spanning[i]
        times = _times_among(row)
        if times:
            others = [r for r in below if not of_units(r, times)]
            return i if others and all(_names_nothing(r, times) for r in others) else None
    return None


def _are_units_above(row: Sequence[str], names: Sequence[str]) -> bool:
    """Whether a row of units stands above the names that somebody gave to the channels of a logger: one to each."""
    if any(map(looks_like_unit, filter(None, names))) or any(c and not n for c, n in zip(row, names, strict=False)):
        return False
    return 2 * sum(map(bool, row)) > len(names) and of_units(row, _times_among(names))


def _comments_below_units(above: Sequence[str], row: Sequence[str], below: Sequence[Sequence[str]]) -> bool:
    """Whether units stand right below names: further rows, without a word for the time, say where these come from, or
    what the sensors are. above: what is merged with the row below it."""
    merged = [n or a for n, a in zip(row, above, strict=True)] if above else row
    times = _times_among(merged, again=of_units(below[0], ()))
    unnamed = not any(says_time(r[k]) for r in below[1:] for k in times)
    return bool(times) and not mostly_units(row) and of_units(below[0], times) and unnamed


def _times_among(row: Sequence[str], again: bool = False) -> list[int]:
    """Which cells of a row that names every column say time; none of another row. again: its names may repeat."""
    if not all(row) or (len(set(row)) < len(row) and not again) or any(is_number(c) or is_stamp(c) for c in row):
        return []
    return [k for k, c in enumerate(row) if says_time(c)]


def _names_nothing(row: Sequence[str], times: Sequence[int]) -> bool:
    """Whether a row below names holds none: statistics, the same word again and again, descriptions of them, or words
    where the time stands that neither name one nor say that the row is one of labels."""
    filled = [c for c in row if c]
    if all(map(STATISTIC.fullmatch, filled)) or len(set(filled)) == 1:
        return True
    if is_of_descriptions(row):
        return True
    said = [row[k] for k in times if row[k]]
    return bool(said) and not is_label(row[0]) and not any(map(says_time, said))


def _spanning(rows: Sequence[Sequence[Cell]], width: int) -> list[int]:
    """Which rows before the data span the table, and are no preamble; the last may leave out what is merged with
    the row above it. A row of numbers below names is none."""
    filled = [[c for c in r[:width] if c not in ("", None)] for r in rows]
    found = [i for i, cells in enumerate(filled) if len(cells) * 2 > width or len(rows) == 1]
    while len(found) > 1 and are_numbers(filled[found[-1]]):
        found.pop()
    last = len(rows) - 1
    if (
        found
        and found[-1] == last - 1
        and len(filled[last]) > 1
        and not any(is_number(c) or is_stamp(c) for c in filled[last])
        and not are_units(filled[found[-1]])
        and not _ends_early(rows[last], rows[found[-1]], width)
    ):
        found.append(last)
    return found


def _ends_early(row: Sequence[Cell], above: Sequence[Cell], width: int) -> bool:
    """Whether a row of few cells is cut off or foreign, and leaves nothing out that is merged with the row above it:
    that names every column, and the row's cells are its first."""
    named = [c not in ("", None) for c in above[:width]]
    said = [c not in ("", None) for c in row[:width]]
    few = said.index(False) if False in said else len(said)
    return len(named) == width and all(named) and few < width and not any(said[few:])


def rows_between(rows: Sequence[Sequence[Cell]], width: int) -> list[int]:
    """The rows between the names and the data that are part of neither, nor units, nor descriptions; from 0."""
    told = [_texts(r, width)[:width] for r in rows]
    texts = without_types(told)
    called = _labelled_units(texts)
    at = [i for i in range(len(texts)) if i != called]
    spanning = _spanning([texts[i] for i in at], width)
    if not spanning:
        return []
    named = _row_of_names([texts[i] for i in at], spanning, width)
    below = at[spanning[-1 if named is None else named] + 1 :]
    times = [] if named is None else _times_among(texts[at[spanning[named]]])
    apart = [i for i in below if any(told[i]) and not is_of_descriptions(texts[i])]
    return [i for i in apart if named is None or not of_units(texts[i], times)]


def are_numbers(cells: Sequence[Cell]) -> bool:
    """Whether a row is one of data: numbers, or all but one and some with decimals, which channels' numbers have not
    (a row whose time was destroyed)."""
    numbers = [str(c) for c in cells if is_number(c)]
    decimals = any(re.search(r"[.,]\d+$", n) and not n.endswith(".0") for n in numbers)
    return len(numbers) == len(cells) or (decimals and len(cells) > 2 and len(numbers) == len(cells) - 1)


def _units_among(above: Sequence[str], row: Sequence[str]) -> bool:
    """Whether a row below names that are all different repeats itself in units, beside words that are none
    ("NO.", "Time" and the letters of alarms, below "Number" and "Date&Time")."""
    said = [c for c in row if c]
    named = [c for c in above if c]
    units = [c for c in said if looks_like_unit(c)]
    again = len(set(said)) < len(said) or any(a == c for a, c in zip(above, row, strict=True) if looks_like_unit(c))
    return (
        len(set(named)) == len(named) >= len(said)
        and again
        and len(units) * 3 >= len(said)
        and len(units) > sum(map(looks_like_unit, named))
    )
