"""Names by the rows around them: heads of groups, each over the first of its columns, and comments below names."""

from __future__ import annotations

import re
from collections.abc import Sequence

from thermodata.reader.text.cells.cell import is_number, is_stamp
from thermodata.reader.text.names.header import looks_like_unit, split_unit
from thermodata.reader.text.names.time_header import says_time
from thermodata.reader.text.names.units_row import STATISTIC, mostly_units
from thermodata.schema.units.conversion import converts
from thermodata.schema.units.unit import is_unit

# what loggers write before a row that describes the columns
OF_TEXTS = re.compile(
    r"(?i)comments?|kommentar|description|beschreibung|bezeichnung|label|tag( no)?|name|ch|commentaire|libellé|"
    r"désignation|descrizione|commento|descripción|comentario|omschrijving|opmerking|popis|opis|komentarz|komentář|"
    r"コメント|名称|信号名|チャンネル名|注释|备注|信号名称|通道名称|설명|이름"
)

# ... which say more of them than their names do, and name none; a row of comments may hold what the user called them
_OF_DESCRIPTIONS = re.compile(
    r"(?i)(channel |signal )?descriptions?|beschreibung(en)?|descrizion[ei]|descripci(ón|ones)|omschrijving|popis|opis|"
    r"설명"
)


def is_label(cell: str) -> bool:
    """Whether a first cell says what its row holds, as "Comment" and "Tag" do."""
    return cell.endswith(":") or OF_TEXTS.fullmatch(cell.strip(" .")) is not None


def is_of_descriptions(row: Sequence[str]) -> bool:
    """Whether the first cell of a row says that it tells more of each name: "Description", "Popis"."""
    return _OF_DESCRIPTIONS.fullmatch(row[0].strip(" .:")) is not None


def is_sentence(row: Sequence[str]) -> bool:
    """Whether a row says in words, each in a cell where blanks part these, what stands below it: '%% columns:', 'data
    columns :'. They follow each other from the first cell on, behind the mark of a comment, or up to a colon."""
    said = list(row[: max((k + 1 for k, c in enumerate(row) if c), default=0)])
    marked = bool(said) and not any(map(str.isalnum, said[0]))
    return len(said) > 1 and all(said) and len(said) < len(row) and (marked or said[-1].endswith(":"))


def heads_over(above: Sequence[str], names: Sequence[str]) -> list[str]:
    """The head of the group that each name stands in: several heads, each written once over the first of its columns,
    and words, not numbers; a single one is a title of the sheet."""
    heads = [] if is_sentence(above) else [c for c in above if c]
    merged = len(heads) < len(names) and any(n and not a for a, n in zip(above, names, strict=True))
    if len(heads) < 2 or not merged or any(is_number(c) or is_stamp(c) for c in heads) or mostly_units(above):
        return [""] * len(names)
    carried, group = [], ""
    for k, cell in enumerate(above):
        group = "" if k == 0 and is_label(cell) else cell or group
        carried.append(group if names[k] else "")
    return carried


def units_of_heads(above: Sequence[str], names: Sequence[str]) -> list[str | None]:
    """The unit that the head of its group says of each name, but for a time's: 'T_front (DEG F)' over 'Timestamp' and
    'Value'; or the cell above it, in a row that names every column: 'M00: °F' over what the user called it."""
    full = all(above)
    heads = list(above) if full else heads_over(above, names)
    unit_of = _unit_of_column if full else _unit_of_group
    return [None if says_time(n) else unit_of(head) for head, n in zip(heads, names, strict=True)]


def _unit_of_group(head: str) -> str | None:
    return split_unit(head)[1]


def _unit_of_column(head: str) -> str | None:
    """The unit in a cell above a name: one behind a colon, or of temperature or length. Of others the cell may say what
    the channel measures to make that of it ('Ch 3 (V)'), and one letter in round brackets numbers sensors
    ('PT100 (A)')."""
    unit = split_unit(head)[1]
    if unit is None or head.removesuffix(unit).rstrip().endswith(":"):
        return unit
    of_these = is_unit(unit) and any(converts(unit, other) for other in ("degC", "m"))
    return unit if of_these and (len(unit) > 1 or f"({unit})" not in head) else None


def apart_by_comments(names: list[str], below: Sequence[Sequence[str]]) -> list[str]:
    """Names that repeat, each with what a row below the names says of it, where that tells them apart: 'TCP Z/probe 1'
    and 'TCP Z/error'. below: rows that hold no units."""
    again = [k for k, n in enumerate(names) if n and names.count(n) > 1]
    for row in below:
        if again and all(row[k] for k in again) and len({(names[k], row[k]) for k in again}) == len(again):
            return [f"{n}/{row[k]}" if k in again else n for k, n in enumerate(names)]
    return names


def under(above: list[str], names: list[str]) -> list[str]:
    """Names below a row of groups, which are written once, over the first of their columns (merged cells): the group
    tells names apart that repeat, and is the name where there is none below it."""
    if is_sentence(above):
        return names
    filled = [n or a for a, n in zip(above, names, strict=True)]
    below = [n for n in names if n]
    if len(set(below)) == len(below):
        return filled
    carried, group = [], ""
    for k, cell in enumerate(above):
        label = k == 0 and is_label(cell)  # which says what its row holds
        group = "" if label else cell or group
        carried.append(group)
    if all(above):  # each with a unit of its own, which is the column's
        carried = [split_unit(group)[0] for group in carried]
    apart = [f"{g}/{n}" if g and n and g != n else n or a for g, n, a in zip(carried, names, above, strict=True)]
    return apart if sum(map(bool, above)) > 1 and len(set(apart)) >= len(set(filled)) else filled


def with_units_below(above: Sequence[str], names: Sequence[str]) -> list[str]:
    """Names, where a cell of their row is a unit alone in brackets: that belongs to the name above it ('Sonda Z' over
    '[mV]', beside 'column [°C]')."""
    alone = [n[:1] + n[-1:] in ("[]", "()") and looks_like_unit(n[1:-1]) for n in names]
    return [f"{a} {n}" if a and unit else n for a, n, unit in zip(above, names, alone, strict=True)]


def of_channels(rows: Sequence[Sequence[str]], names: list[str]) -> list[str]:
    """Statistics that repeat (MIN, MAX, MIN, MAX), each with its channel, by the lowest row above them that tells them
    apart: 'spindle/MIN'. Other names stay."""
    again = [k for k, n in enumerate(names) if n and names.count(n) > 1]
    if not all(STATISTIC.fullmatch(names[k]) for k in again):
        return names
    for row in reversed(rows):
        # a channel begins over any value, also one whose own name does not repeat; over the time stands what the row,
        # or the sheet, is called
        channel = ""
        said = [c if n and not says_time(n) else "" for c, n in zip(row, names, strict=False)]
        channels = [channel := c or channel for c in said]
        of = {k: f"{channels[k]}/{names[k]}" if channels[k] else "" for k in again}
        if all(of.values()) and len(set(of.values())) == len(again):
            return [of.get(k, n) for k, n in enumerate(names)]
    return names
