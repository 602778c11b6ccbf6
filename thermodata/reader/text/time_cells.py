"""What belongs to a time of day and stands in a cell of its own beside it: AM or PM, and the zone or the offset that
it is in. Such cells are read with the time as one text: '1:00:00 PM', '08:00:00 +02:00'."""

from __future__ import annotations

import re
from collections.abc import Sequence

from thermodata.reader.text.cell import Cell, is_empty
from thermodata.reader.text.clock_pattern import is_half
from thermodata.reader.text.header import split_unit
from thermodata.reader.text.zone_words import is_offset, is_zone

_HALF_NAME = re.compile(
    r"(?i)a\.?m\.?\s*[/|_]?\s*p\.?m\.?|am_or_pm|tageszeit|meridi[ae]m|half ?day|上午/下午|午前/午後"
)
_ZONE_NAME = re.compile(
    r"(?i)(?:utc|gmt|tz|zone|time ?zone|zeitzone|z|offset|(?:utc|gmt|tz|zone|time ?zone)[ _/-]?(?:offset|diff)|"
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


def are_zones(cells: Sequence[Cell], header: str = "") -> bool:
    """Whether all cells that hold anything say a zone; '+0100' without a colon is a number too, but for its header, or
    where all of them are one."""
    full = {str(c).strip() for c in cells if not is_empty(c)}
    if not full or not all(map(is_zone, full)):
        return False
    unnamed = re.fullmatch(r"column \d+", header) is not None
    return unnamed or names_zone(header) or not all(map(is_offset, full)) or all(":" in c for c in full)


def belongs_to_time(cells: Sequence[Cell], header: str = "") -> bool:
    """Whether a column beside a time of day is part of it."""
    return are_halves(cells) or are_zones(cells, header)
