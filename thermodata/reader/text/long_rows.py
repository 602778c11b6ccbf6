"""Long tables: each row names what it measures, beside its value and often its unit. Read as a wide table, degrees and
micrometres would stand in one channel."""

from __future__ import annotations

import re
from collections.abc import Sequence

from thermodata.errors import FormatError
from thermodata.reader.text.number import clean

NAME_WORDS = (
    *("name", "point", "channel", "sensor", "sensorid", "sensorname", "signal", "variable", "parameter", "measurand"),
    *("messstelle", "messpunkt", "kanal", "groesse", "größe", "kanál", "veličina", "senzor"),
)
VALUE_WORDS = ("value", "wert", "messwert", "reading", "hodnota", "measurement")


def refuse_long(names: Sequence[str], rows: Sequence[Sequence[str]], where: str) -> None:
    """FormatError for a table whose header says that a column names what another one holds the value of, where that
    column has several names."""
    bare = [re.sub(r"[\s_.#()-]", "", name).casefold() for name in names]
    tag = next((i for i, n in enumerate(bare) if n in NAME_WORDS), None)
    value = next((i for i, n in enumerate(bare) if n in VALUE_WORDS), None)
    if tag is None or value is None:
        return
    said = dict.fromkeys(clean(row[tag]) for row in rows if len(row) > tag)
    said.pop("", None)
    if len(said) < 2:
        return
    raise FormatError(
        "a long table: each row names what it measures",
        where=where,
        expected="a column a signal",
        got=f"'{names[tag]}' holds " + ", ".join(list(said)[:4]) + (", ..." if len(said) > 4 else ""),
        hint="with a column of dates and times the reader cnc takes it apart; else pivot it: a column a name",
    )
