"""Names and units of a table's columns, from the rows above its data."""

from __future__ import annotations

import re
from collections.abc import Sequence
from functools import lru_cache
from itertools import pairwise

from thermodata.reader.text.cell import TIME_WORD, Cell, is_number, is_stamp
from thermodata.reader.text.number import clean
from thermodata.schema.unit_scale import scaled_unit
from thermodata.schema.unit_spelling import UNIT_SPELLING

_BASE = (
    r"(?:[kMGmunµμcdh]?(?:m|g|s|A|V|W|K|N|Pa|Hz|J|C|F|bar|l|L|rad|Ohm|ohm|Ω|VA|Wh|mol|lm|lx|T)|min|h|d|rpm|RPM|"
    r"inch|thou|deg|U|rev|mas|arcsec|ppm|RH|dB|psi|inc|imp|1|bit|counts?|digits?)"
)
_UNIT = re.compile(rf"^{_BASE}(?:\s?\^?-?[1-4]|[²³⁻¹]+)?(?:\s?[/*·.]\s?{_BASE}(?:\^?-?[1-4]|[²³⁻¹]+)?){{0,3}}$")
# '°C*10', 'x1000 rpm': a unit and a factor whose sense (of the unit, or of the value) only the lab knows
_TIMES_TEN = re.compile(r"\s*[*·×x]\s*10+$|^[*·×x]\s*10+\s*")
_TRAILING = re.compile(
    r"^(?P<name>.*?)(?P<gap>\s*)"
    r"(?:\[(?P<square>[^\[\]]*)\]|\((?P<round>[^()]*)\)|(?P<fullwidth>（[^（）]*）))$",
    re.DOTALL,
)


@lru_cache(maxsize=4096)
def looks_like_unit(text: str) -> bool:
    """Whether a text reads as a unit: an alias (U/min, Grd C, °C) or SI symbols with / * and powers."""
    unit = scaled_unit(text)[1].strip()
    bare = re.sub(r"\s+", "", unit).strip("[]()")
    if not bare or bare.isdigit():
        return False
    return bare.casefold() in UNIT_SPELLING or _UNIT.match(unit) is not None


@lru_cache(maxsize=4096)
def split_unit(header: str) -> tuple[str, str | None]:
    """(name, unit or None): 'ch3(um)' -> ('ch3', 'um'), 'Temp [degC]' -> ('Temp', 'degC').

    Brackets that hold no unit stay in the name: 'Excitation (Trigger)', 'nckServoData [u1; 1]', 'T[2]'.
    """
    header = header.strip()
    match = _TRAILING.match(header)
    if not match or not match["name"].strip():
        return header, None
    unit = (match["square"] or match["round"] or (match["fullwidth"] or "").strip("（）")).strip()
    if looks_like_unit(unit):
        return match["name"].strip(), unit
    bare = _TIMES_TEN.sub("", unit)
    if bare != unit and looks_like_unit(bare):
        return match["name"].strip(), unit
    # a word of its own in square brackets is a unit that we don't know; an index or an address is none
    if match["square"] and match["gap"] and re.match(r"^[^\W\d][^;,]{0,15}$", unit) and not re.match(r"^u\d", unit):
        return match["name"].strip(), unit
    return header, None


# ---- the rows above the data --------------------------------------------------------------------


def names_and_units(
    rows: Sequence[Sequence[Cell]], width: int, units_row: int | None
) -> tuple[list[str], list[str | None]]:
    """Names and units from the rows before the data; rows that do not span the table are preamble."""
    texts = [[clean(str(c)) if c is not None else "" for c in r] + [""] * (width - len(r)) for r in rows]
    units: list[str | None] = [None] * width
    if units_row is not None and 0 <= units_row < len(texts):
        units = [u.strip("[]() ") or None for u in texts.pop(units_row)]
    spanning = [texts[i] for i in _spanning(texts, width)]
    if units_row is None and len(spanning) >= 2:
        filled = [c for c in spanning[-1] if c]
        if sum(looks_like_unit(c) or c.startswith("[") for c in filled) * 2 > len(filled):
            units = [u.strip("[]() ") or None for u in spanning.pop()]
        elif _units_among(spanning[-2], spanning[-1]):
            units = [u if looks_like_unit(u) else None for u in spanning.pop()]
    names = spanning[-1] if spanning else [""] * width
    at = next((i for i in range(len(texts) - 1, 0, -1) if texts[i] is names), 0)
    if at and any(texts[at - 1]):
        names = _under(texts[at - 1], names)
    found = [split_unit(n)[1] for n in names]
    return names, [u or f for u, f in zip(units, found, strict=True)]


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
        and not _are_units(filled[found[-1]])
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


def lines_between(rows: Sequence[Sequence[Cell]], width: int, skip: int) -> list[str]:
    """A note for lines between the header and the data that are part of neither."""
    spanning = _spanning(rows, width)
    odd = (
        [i + skip + 1 for i in range(spanning[-1] + 1, len(rows)) if any(c not in ("", None) for c in rows[i][:width])]
        if spanning
        else []
    )
    return [f"line {odd[0]} between header and data is not read ({len(odd)} such)"] if odd else []


def are_numbers(cells: Sequence[Cell]) -> bool:
    """Whether a row is one of data: numbers, or all but one and some with decimals, which channels' numbers have not
    (a row whose time was destroyed)."""
    numbers = [str(c) for c in cells if is_number(c)]
    decimals = any(re.search(r"[.,]\d+$", n) and not n.endswith(".0") for n in numbers)
    return len(numbers) == len(cells) or (decimals and len(cells) > 2 and len(numbers) == len(cells) - 1)


def _are_units(cells: Sequence[Cell]) -> bool:
    """Whether most filled cells of a row are units."""
    return sum(looks_like_unit(str(c)) or str(c).startswith("[") for c in cells) * 2 > len(cells)


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


def _under(above: list[str], names: list[str]) -> list[str]:
    """Names below a row of groups, which are written once, over the first of their columns (merged cells): the group
    tells names apart that repeat, and is the name where there is none below it."""
    filled = [n or a for a, n in zip(above, names, strict=True)]
    below = [n for n in names if n]
    if len(set(below)) == len(below):
        return filled
    carried, group = [], ""
    for cell in above:
        group = cell or group
        carried.append(group)
    apart = [f"{g}/{n}" if g and n and g != n else n or a for g, n, a in zip(carried, names, above, strict=True)]
    return apart if sum(map(bool, above)) > 1 and len(set(apart)) >= len(set(filled)) else filled


def numbered_rows(header: Sequence[Cell], heads: Sequence[str], data: Sequence[Sequence[Cell]]) -> bool:
    """Whether rows begin with their number, which the header leaves out (R writes so): it has a cell less than they,
    they count from row to row, and dates stand one column behind the word for them."""
    if len(header) != len(heads) - 1:
        return False
    firsts = [str(r[0]) for r in data]
    counted = all(f.isdecimal() for f in firsts) and all(int(b) - int(a) == 1 for a, b in pairwise(firsts))
    stamped = [bool(data) and all(is_stamp(r[i]) for r in data) for i in range(len(heads))]
    return counted and any(
        TIME_WORD.match(split_unit(heads[i])[0]) is not None and stamped[i + 1] and not stamped[i]
        for i in range(len(heads) - 1)
    )


def unique(names: Sequence[str]) -> list[str]:
    out: list[str] = []
    taken: set[str] = set()
    for i, name in enumerate(names):
        base = name or f"column {i + 1}"
        new, k = base, 2
        while new in taken:
            new, k = f"{base}#{k}", k + 1
        taken.add(new)
        out.append(new)
    return out
