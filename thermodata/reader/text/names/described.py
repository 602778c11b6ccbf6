"""What a file says of its columns beside their names: a row of comments, or above them a list of its channels with what
the user called them. Their names stay, for old campaign files name them; what is said of them stands beside."""

from __future__ import annotations

import re
from collections.abc import Mapping, Sequence

from thermodata.reader.text.cells.cell import is_number, is_stamp
from thermodata.reader.text.names.group_heads import OF_TEXTS, is_of_descriptions
from thermodata.reader.text.names.header import looks_like_unit, split_unit
from thermodata.reader.text.names.header_rows import OF_UNITS

_OF_NAMES = re.compile(
    r"(?i)((signal|channel|kanal|sensor)[ _-]?)?"
    r"(name|label|comment|description|tag|title|bezeichnung|kommentar|beschreibung|kanalname|název|popis|nom|nombre)|"
    r"信号名称?|通道名称?|名称|名稱|注释|コメント|チャンネル名|名前|신호명|채널명|이름"
)
_SAID_OF_ONE = re.compile(r"[#%'*/ ]*(?P<name>[^:=]{1,60}?)\s*[:=]\s*(?P<said>\S.{0,200}?)\s*")
_FEWEST = 2  # columns that a row of comments, or a list without a header, speaks of: of one, it may be the whole file


def descriptions(rows: Sequence[Sequence[str]], names: Sequence[str]) -> tuple[list[str], list[str | None]]:
    """(what is said of each column, '' where nothing is; its unit, None where none is said). rows: above the data, as
    texts."""
    rows = _name_and_comment_apart(rows, names)
    at = names_at(rows, names)
    below = [row for row in rows[at + 1 :] if row and is_of_descriptions(row)]
    rows = rows[:at]
    key_at, listed = _rows_of_columns(rows, names)
    said, units = _of_list(rows, key_at, listed, names)
    heads = {min(at for at, _ in listed) - 1} if listed else set()
    for at, row in enumerate(rows):
        if at not in heads and not any(said):
            said = _of_row(row, names)
    for row in below:
        said = said if any(said) else _of_row(row, names)
    return said, units


def _name_and_comment_apart(rows: Sequence[Sequence[str]], names: Sequence[str]) -> list[Sequence[str]]:
    """The rows, those of one cell that say a column's name and more (`# Channel 1: front bearing`) as these two."""
    known = {_key(n) for n in names if n}

    def parted(row: Sequence[str]) -> Sequence[str]:
        match = _SAID_OF_ONE.fullmatch(row[0]) if row and not any(row[1:]) else None
        return [match["name"], match["said"]] if match is not None and _key(match["name"]) in known else row

    return [parted(row) for row in rows]


def names_at(rows: Sequence[Sequence[str]], names: Sequence[str]) -> int:
    """The place of the row of names: what stands below it says where values come from, not what they are called."""
    lasts = [n.rsplit("/", 1)[-1] for n in names]
    for at, row in enumerate(rows):
        same = sum(bool(c) and c in (n, last) for c, n, last in zip(row, names, lasts, strict=False))
        if 2 * same >= sum(map(bool, names)):
            return at
    return len(rows)


def _of_row(row: Sequence[str], names: Sequence[str]) -> list[str]:
    """What a row of comments says: "Comment","Bearing front","Bearing rear", one for each column behind the first."""
    cells = [*row[: len(names)], *[""] * (len(names) - len(row))]
    nothing = [""] * len(names)
    if not OF_TEXTS.fullmatch(cells[0].strip(" .:")) or len(row) > len(names):
        return nothing
    said = ["", *(_comment_beyond_name(c, n) for c, n in zip(cells[1:], names[1:], strict=True))]
    return said if sum(map(bool, said)) >= max(_FEWEST, len(names) // 2) else nothing


def _rows_of_columns(rows: Sequence[Sequence[str]], names: Sequence[str]) -> tuple[int, list[tuple[int, str]]]:
    """(which cell of a row names a column, [(place of a row, the column that it lists)]): "CH1","Front","TEMP", or
    behind a number of its own, "1","AI 1","Bearing"; there each is listed once, and is no number itself."""
    known = {_key(n) for n in names if n}
    for k in (0, 1):
        found = [
            (at, key) for at, row in enumerate(rows) if len(row) > k + 1 and row[k] and (key := _key(row[k])) in known
        ]
        if k == 0 and found:
            return 0, found
        counted = all(rows[at][0].strip(" .").isdigit() for at, _ in found)
        if counted and len(found) >= _FEWEST and len({key for _, key in found}) == len(found):
            return k, found
    return 0, []


def _of_list(
    rows: Sequence[Sequence[str]], key_at: int, listed: Sequence[tuple[int, str]], names: Sequence[str]
) -> tuple[list[str], list[str | None]]:
    said: Mapping[str, str] = {}
    units: Mapping[str, str | None] = {}
    if listed:
        first = listed[0][0]
        header = rows[first - 1] if first else ()
        column = next((k for k, c in enumerate(header) if k > key_at and _OF_NAMES.fullmatch(c.strip(" .:"))), None)
        told = column or key_at + 1
        said = {key: rows[at][told] if len(rows[at]) > told else "" for at, key in listed}
        if column is None and (len(said) < _FEWEST or len(set(said.values())) < len(said)):
            said = {}  # what repeats is a kind of input
        of_unit = next((k for k, c in enumerate(header) if k > key_at and OF_UNITS.fullmatch(c.strip(" .:"))), -1)
        units = {key: _unit(rows[at], of_unit) for at, key in listed}
    return (
        [_comment_beyond_name(said.get(_key(n), ""), n) if n else "" for n in names],
        [units.get(_key(n)) if n else None for n in names],
    )


def _unit(row: Sequence[str], column: int) -> str | None:
    cell = row[column].strip("[]() ") if -len(row) <= column < len(row) else ""
    return cell if looks_like_unit(cell) and not cell[0].isdigit() else None


def _comment_beyond_name(cell: str, name: str) -> str:
    """A cell that says more of a column than its name does."""
    bare = cell.strip()
    nothing = is_number(bare) or is_stamp(bare) or looks_like_unit(bare) or not any(c.isalpha() for c in bare)
    return "" if nothing or _key(bare) == _key(name) else bare


def _key(name: str) -> str:
    return re.sub(r"[\s_.-]+", "", split_unit(name)[0]).casefold()
