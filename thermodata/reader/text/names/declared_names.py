"""The declared names of the columns of a file without a header, or with a mere title above its rows."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from typing import Any

from thermodata.errors import FormatError
from thermodata.reader.text.cells.cell import Cell, is_stamp


def declared_names(names: Sequence[str], width: int, where: str) -> list[str]:
    """What the columns of a file without a header are called."""
    if len(names) != width:
        raise FormatError(
            "a file without a header has other columns than are declared",
            where=where,
            expected=f"{len(names)} columns: {', '.join(names)}",
            got=f"{width} columns",
            hint="a source of its own for it, with table: {names: [...]} that names each of its columns",
        )
    return list(names)


def unused_note(
    heads: Sequence[str], rows: Sequence[Sequence[Cell]], above: int, layout: Mapping[str, Any], where: str
) -> str | None:
    """Why declared names are not used: a column beside the time has one in the file. None where they are: nothing, or a
    title, stands above the rows. heads: names in the file, '' for none; above: lines before the rows; layout: what is
    declared of the table. FormatError where that is the number of rows of the header, too: names alone may be those of
    other files of the source."""
    stamped = {i for r in rows[:1] for i, c in enumerate(r) if is_stamp(c)} or {0}
    named = [h for i, h in enumerate(heads) if h and i not in stamped]
    if not named:
        return None
    if "header_rows" in layout:
        raise FormatError(
            "names are declared, and a header names the columns",
            where=where,
            expected="declared names for columns that the file does not name",
            got=f"'{named[0][:60]}'",
            hint=f"leave out the names; or declare table: {{skip_rows: {above}, header_rows: 0, names: [...]}}, and "
            "the header is none",
        )
    return (
        f"the declared names are not used, for a header names columns: '{named[0][:60]}'; "
        "declare table: {header_rows: 0, skip_rows: ...} where it is none"
    )
