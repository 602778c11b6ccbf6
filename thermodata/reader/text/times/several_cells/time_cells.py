"""What belongs to a time of day and stands in a cell of its own beside it: AM or PM, and the zone or the offset that
it is in. Such cells are read with the time as one text: '1:00:00 PM', '08:00:00 +02:00'."""

from __future__ import annotations

import re
from collections.abc import Sequence
from dataclasses import replace

from thermodata.errors import FormatError, QuestionError
from thermodata.reader.text.cells.cell import Cell, is_empty, is_number, is_stamp
from thermodata.reader.text.cells.first_rows import FirstRows
from thermodata.reader.text.cells.time_forms.clock_pattern import is_half, needs_half
from thermodata.reader.text.cells.time_forms.time_pattern import TimeFormat
from thermodata.reader.text.cells.time_forms.zone_words import ANY_ZONE, SEVERAL, is_zone, offset_ns
from thermodata.reader.text.names.header import split_unit

_HOUR_NS = 3600 * 1_000_000_000
_NAMELESS = re.compile(r"column \d+|Unnamed: \d+")
_HALF_NAME = re.compile(
    r"(?i)a\.?m\.?\s*[/|_]?\s*p\.?m\.?|am_or_pm|tageszeit|meridi[ae]m|half ?day|上午/下午|午前/午後"
)
_ZONE_NAME = re.compile(
    r"(?i)(?:utc|gmt|tz|time ?zone|zeitzone|(?:utc|gmt|tz|zone|time ?zone)[ _/-]?(?:offset|diff)|"
    r"fuseau(?: horaire)?|fuso(?: orario)?|zona horaria|časové pásmo)(?:\s*[\[(].*[\])])?"
)


def names_part_of_time(header: str) -> bool:
    """Whether a header names AM and PM, or the zone of the time."""
    name = split_unit(header)[0].strip(" .:")
    return _HALF_NAME.fullmatch(name) is not None or _ZONE_NAME.fullmatch(name) is not None


def names_zone(header: str) -> bool:
    return _ZONE_NAME.fullmatch(split_unit(header)[0].strip(" .:")) is not None


def names_half(header: str) -> bool:
    return _HALF_NAME.fullmatch(split_unit(header)[0].strip(" .:")) is not None


def are_halves(cells: Sequence[Cell]) -> bool:
    """Whether all cells that hold anything say which half of the day a time is in."""
    full = [c for c in cells if not is_empty(c)]
    return bool(full) and all(isinstance(c, str) and is_half(c) for c in full)


def are_zones(cells: Sequence[Cell]) -> bool:
    """Whether all cells that hold anything say a zone."""
    full = {str(c).strip() for c in cells if not is_empty(c)}
    return bool(full) and all(map(is_zone, full))


def is_zone_column(cells: Sequence[Cell], header: str) -> bool:
    """Whether zones are those of the time beside them, not an axis 'Z', a tool 'EST' or a direction '+01:30': their
    header names them, or there is none; and they are one, or two an hour apart."""
    if not are_zones(cells):
        return False
    full = {str(c).strip() for c in cells if not is_empty(c)}
    offsets = {offset_ns(c) for c in full}
    if len(offsets) > 2 or max(offsets) - min(offsets) not in (0, _HOUR_NS):
        return False
    name = split_unit(header)[0].strip(" .:").casefold()
    named = names_zone(header) or name == "zone" or (name == "offset" and all(":" in c for c in full))
    return named or (_NAMELESS.fullmatch(header) is not None and "Z" not in full)


def belongs_to_time(cells: Sequence[Cell], header: str | None = None) -> bool:
    """Whether a column beside a time of day is part of it. header: None where it is known to be one of the time."""
    return are_halves(cells) or (are_zones(cells) if header is None else is_zone_column(cells, header))


def with_parts(columns: tuple[int, ...], seen: FirstRows) -> tuple[int, ...]:
    """The columns of a time with those beside its time of day that belong to it: a half of the day before or behind,
    and a zone."""
    clock = columns[-1]
    rows = [r for r in seen.rows if is_stamp(r[clock]) and ":" in str(r[clock])]  # a repeated header is none

    def cells(i: int) -> list[Cell]:
        return [r[i] for r in rows]

    out = columns
    before = clock - 1
    if before >= 0 and before not in columns and rows and are_halves(cells(before)):
        out = (*columns[:-1], before, clock)
    behind = clock + 1
    while behind < len(seen.names) and rows and belongs_to_time(cells(behind), seen.names[behind]):
        out = (*out, behind)
        behind += 1
    return out


def zone_notes(columns: Sequence[int], seen: FirstRows) -> list[str]:
    """What is told of the columns of a time that hold its zone."""
    rows = [r for r in seen.rows if any(is_stamp(r[i]) for i in columns)]
    zones = [seen.names[i] for i in columns[1:] if are_zones([r[i] for r in rows])]
    return [f"the zone in '{name}' is used, not the declared one" for name in zones]


def runs(columns: Sequence[Sequence[Cell]]) -> list[list[int]]:
    """Which columns of a time are read together: each alone, but those that belong to a time of day with it."""
    found: list[list[int]] = []
    for k, cells in enumerate(columns):
        leads = bool(found) and found[-1] == [k - 1] and k > 1 and are_halves(columns[k - 1])
        if found and (leads or (k and belongs_to_time(cells) and not _leads(columns, k))):
            found[-1].append(k)
        else:
            found.append([k])
    return found


def _leads(columns: Sequence[Sequence[Cell]], k: int) -> bool:
    """Whether a half of the day stands before its time of day: behind a date, with a time behind it."""
    behind = columns[k + 1] if k + 1 < len(columns) else ()
    dated = not any(":" in str(c) for c in columns[k - 1][:1])
    return are_halves(columns[k]) and dated and any(map(is_stamp, behind[:1]))


def joined_cells(columns: Sequence[Sequence[Cell]]) -> list[str]:
    """One text a row."""
    return [" ".join(str(c).strip() for c in cells if c is not None).strip() for cells in zip(*columns, strict=False)]


def read_together(form: TimeFormat, columns: Sequence[Sequence[Cell]]) -> TimeFormat:
    """The format of texts that are joined from columns: one that lacks its half of the day is no time."""
    pattern = form.pattern
    if pattern is not None and any(map(are_halves, columns)):
        pattern = needs_half(pattern)
    return replace(form, columns=len(columns), pattern=pattern)


def part_question(columns: tuple[int, ...], seen: FirstRows) -> QuestionError | FormatError | None:
    """What to ask, or to refuse, where a column behind the time is called a part of it and its cells are not known."""
    place = columns[-1] + 1
    if place >= len(seen.names) or belongs_to_time(seen.column(columns[-1])):
        return None
    if not any(":" in str(r[columns[-1]]) for r in seen.rows):
        return None
    words = sorted({str(r[place]).strip() for r in seen.rows if not is_empty(r[place])})
    name, own = seen.names[place], [i + 1 for i in columns]
    if not words or not any(any(c.isalpha() for c in w) for w in words):
        return None
    if names_half(name):
        return FormatError(
            "a half of the day in words that are not known",
            where=f"{seen.where} column '{name}'",
            expected="AM and PM",
            got=", ".join(words[:6]),
            hint=f"write AM and PM, or times of 24 hours; where they are, declare table: {{time: {{column: {own}}}}}",
        )
    if not (names_zone(name) or all(w in SEVERAL for w in words)) or any(map(is_number, words)):
        return None
    shown = " or ".join(SEVERAL.get(words[0], (words[0] if "/" in words[0] else ANY_ZONE,)))
    said = {"time": {"column": own}}
    return QuestionError(
        f"times in a zone that is not known by its word: '{words[0]}'",
        where=f"{seen.where} column '{name}'",
        expected="an offset such as +01:00, or a word for one zone",
        got=", ".join(words[:6]),
        hint=f"declare it in the source: timezone: {shown}; and table: {{time: {{column: {own}}}}}",
        times=[seen.names[i] for i in columns],
        ask=f"zone of the times: what is '{words[0]}'? write timezone: {shown} into this source",
        declare=said,
        meanwhile=said,
    )
