"""Headers with another number of cells than their rows: put over their columns where the time tells, else refused."""

from __future__ import annotations

import re
from collections.abc import Sequence

import pytest

from thermodata.errors import FormatError
from thermodata.plugin import Source
from thermodata.reader.text.file.lines import Sample
from thermodata.reader.text.names.time_header import is_time_header
from thermodata.reader.text.tables.find_table import find_table
from thermodata.reader.text.tables.table import Table

DAY = "2026-03-14"


def table(head: str, row: str, **said: object) -> Table:
    rows = [row.format(k=k, n=k + 1, s=60 * k, at=f"08:{k:02d}:00", day=DAY, T=f"{21 + k / 10:.1f}") for k in range(30)]
    lines = (*head.splitlines(), *rows)
    sample = Sample(lines, (), "utf-8", None, True, True)
    source = Source(table={"time": {"unit": "s"}, **said} if "{at}" not in row else said)
    return find_table(lines, sample, source, "a.txt", "table", strict=True)


def columns(found: Table) -> list[tuple[str, str | None]]:
    layout = found.layout
    return [(layout.names[i].split("[")[0].strip(), layout.units[i]) for i in layout.groups[0].columns]


@pytest.mark.parametrize("mark", ["# ", "% ", "; ", "// ", "#\t"])
@pytest.mark.parametrize("above", ["", "# spindle S4000 day 2\n"])
def test_a_mark_of_a_comment_in_front_of_the_names_is_none(mark: str, above: str) -> None:
    between = "\t" if "\t" in mark else " "
    names = between.join(["time[s]", "T_front[degC]", "dZ[um]"])
    found = table(f"{above}{mark}{names}", between.join(["{s}", "{T}", "0.0"]))
    assert [found.layout.names[i] for i in found.layout.time] == ["time[s]"]
    assert columns(found) == [("T_front", "degC"), ("dZ", "um")]


def test_a_row_of_units_behind_a_mark_stands_over_its_columns() -> None:
    found = table("# time T_front dZ\n# s degC um", "{s} {T} 0.0")
    assert columns(found) == [("T_front", "degC"), ("dZ", "um")]


@pytest.mark.parametrize("head", ["#;time;T_front", "# time T_front"])
def test_a_mark_over_a_column_of_its_own_is_its_name(head: str) -> None:
    between = ";" if ";" in head else " "
    found = table(head, between.join(["{n}", "{s}", "{T}"]))
    assert found.layout.names == ("#", "time", "T_front")


@pytest.mark.parametrize(
    ("head", "row"),
    [
        ("Timestamp T_front dZ", "{day} {at} {T} 0.0"),
        ("Date/Time T_front dZ", "{day} {at} {T} 0.0"),
        ("# Timestamp T_front dZ", "{day} {at} {T} 0.0"),
        ("Datum/Zeit;T_front;dZ", "{day};{at};{T};0.0"),
        ("Timestamp T_front dZ\n- - -", "{day} {at} {T} 0.0"),
        ("Timestamp T_front dZ", "{day} {at} +0100 {T} 0.0"),
        ("Datum;Zeit;T_front;dZ", "{day} {at};{T};0.0"),
        ("Date,Time,T_front,dZ", "{day} {at},{T},0.0"),
        ("Date Time T_front dZ", "{day}T{at} {T} 0.0"),
        ("Time T_front dZ", "{at} {T} 0.0"),
        ("time T_front dZ", "{k} {day} {at} {T} 0.0"),
        ("time T_front dZ", "{n} {s} {T} 0.0"),
        ("time\tT_front\tdZ", "{n}\t{s}\t{T}\t0.0"),
        ("Date and Time T_front dZ", "{day}T{at} {T} 0.0"),
        ("Datum und Uhrzeit T_front dZ", "{day} {at} {T} 0.0"),
        ("# Date / Time T_front dZ", "{day}T{at} {T} 0.0"),
        ("Time stamp UTC T_front dZ", "{day}T{at} {T} 0.0"),
        ("Date and Time AM/PM T_front dZ", "{day}T{at} {T} 0.0"),
        ("Time stamp T_front dZ", "{day} {at} AM {T} 0.0"),
    ],
)
def test_names_stand_over_their_columns_where_the_cells_of_the_time_tell(head: str, row: str) -> None:
    found = table(head, row)
    layout = found.layout
    cells = dict(zip(layout.names, row.split(found.delimiter if not found.blanks else None), strict=True))
    assert (cells["T_front"], cells["dZ"]) == ("{T}", "0.0")


@pytest.mark.parametrize(
    ("head", "row"),
    [
        ("time_s T front T rear", "{s} {T} 20.5"),
        ("Time [s] T front [degC] Z [um]", "{s} {T} 0.0"),
        ("time T_front", "{s} {T} 0.0"),
        ("time dZ", "{n} {T} {s}"),  # what rises from 21 is no time behind numbers of rows
        ("time T_front T_hall dZ", "{s} {T} 20.0"),
        ("No;T_front;time;dZ", "{s};{T};20.0"),
        ("No;time;T_front;dZ", "{day} {at};{T};20.0"),
        ("Elapsed time T_front T_rear", "{s} {T} {T}"),  # which of them is the time?
        ("Date and Time T1 T2 T3", "{day}T{at} {T} 20.0"),
        ("T_front;T_hall;T_motor;dZ", "{T};{T};20.0"),
        ("time;T_front;T_hall;dX;dZ", "{s};{T};20.0"),
    ],
)
def test_names_that_nothing_puts_over_columns_are_refused(head: str, row: str) -> None:
    with pytest.raises(FormatError) as refused:
        table(head, row)
    assert "cells than the rows below it" in refused.value.what
    assert refused.value.where.startswith("a.txt line 1, rows from line")
    assert "names: [...]" in str(refused.value.hint)


@pytest.mark.parametrize(
    ("head", "row"),
    [
        ("time,T_front,T_hall,Comment", "{s},{T},20.0"),
        ("time;T_front;T_hall;Comment", "{day} {at};{T};20.0"),
        ("time\tT_front\tT_hall\tComment", "{s}\t{T}\t20.0"),
        ("Zeit;T_front;T_hall;Comment\ns;°C;°C;", "{s};{T};20.0"),
        ("Date;Time;T_front;T_hall;Comment", "{day};{at};{T};20.0"),
    ],
)
def test_a_last_name_without_a_column_is_told(head: str, row: str) -> None:
    found = table(head, row)
    assert [name for name, _ in columns(found)] == ["T_front", "T_hall"]
    assert any("the last name of the header has no column" in n and "'Comment'" in n for n in found.notes)


def test_the_way_out_of_the_refusal_names_the_columns() -> None:
    names: Sequence[str] = ["time [s]", "T front [degC]", "Z [um]"]
    said = {"skip_rows": 1, "header_rows": 0, "names": names}
    assert columns(table("Time [s] T front [degC] Z [um]", "{s} {T} 0.0", **said)) == [("T front", "degC"), ("Z", "um")]


@pytest.mark.parametrize("head", ["# Elapsed time, T_front, dZ", "#Elapsed time,T_front,dZ", "# time_s, T_front, dZ"])
def test_the_mark_of_a_comment_before_the_word_for_time_is_none_of_it(head: str) -> None:
    assert is_time_header(head.split(",")[0])


@pytest.mark.parametrize("head", ["Elapsed time T_front dZ", "# Elapsed time T_front dZ"])
def test_several_words_of_one_time_stand_over_the_numbers_that_alone_rise(head: str) -> None:
    found = table(head, "{s} 20.5 0.0")
    assert [found.layout.names[i] for i in found.layout.time] == ["Elapsed time"]
    assert [name for name, _ in columns(found)] == ["T_front", "dZ"]


@pytest.mark.parametrize(
    ("head", "row"),
    [
        ("DateTime T1 T2 T3", "{day} {at} {T} 20.0"),
        ("Timestamp;T1;T2;T3", "{day};{at};{T};20.0"),
        ("Time,Remark,T2,T3", "{day},{at},{T},20.0"),
        ("Date Time T1 T2 T3", "{day} {at} AM {T} 20.0"),
        ("No DateTime T1 T2 T3", "{n} {day} {at} {T} 20.0"),
    ],
)
def test_a_name_of_something_else_over_a_part_of_the_time_is_refused(head: str, row: str) -> None:
    with pytest.raises(FormatError) as refused:
        table(head, row)
    assert "the time takes more cells in the rows than names" in refused.value.what
    own = [i + 1 for i, cell in enumerate(re.split("[ ;,]", row)) if cell in ("{day}", "{at}", "AM")]
    assert f"time: {{column: {own}}}" in str(refused.value.hint)
    declared = table(head, row, time={"column": own})
    assert [n for n, _ in columns(declared)][-2:] == ["T2", "T3"]


@pytest.mark.parametrize(
    ("head", "row"),
    [
        ("Datum;Klok;T2;T3", "{day};{at};{T};20.0"),
        ("Timestamp;;T2;T3", "{day};{at};{T};20.0"),
        ("Timestamp;Clock;T2;T3", "{day};{at};{T};20.0"),
        ("DateTime Uhrzeit T2 T3", "{day} {at} {T} 20.0"),
        ("Date;Time;AM/PM;T2;T3", "{day};{at};AM;{T};20.0"),
        ("Date;Time;Tool;T2;T3", "{day};{at};EST;{T};20.0"),
        ("DateTime;T1;T2;T3", "{day}T{at};{T};{T};20.0"),
    ],
)
def test_a_part_of_the_time_under_a_word_for_it_or_none_is_read(head: str, row: str) -> None:
    assert [n for n, _ in columns(table(head, row))][-2:] == ["T2", "T3"]


@pytest.mark.parametrize("head", ["time;T_front;dZ;", "time;T_front;dZ;;"])
def test_empty_names_at_the_end_are_none(head: str) -> None:
    assert table(head, "{s};{T};0.0").layout.names == ("time", "T_front", "dZ")


@pytest.mark.parametrize(
    ("head", "row"),
    [
        ('"time_s" "T_front" "dZ"', '"{n}" {s} {T} 0.0'),  # as R writes it
        ('"time" "T_front" "dZ"', '"{n}" "{day} {at}" {T} 0.0'),
        ("Timestamp T_front dZ", '"{day} {at}" {T} 0.0'),
        ('time_s "T front" dZ', "{s} {T} 0.0"),
    ],
)
def test_quotes_keep_blanks_within_a_cell(head: str, row: str) -> None:
    found = table(head, row)
    assert [name.replace(" ", "_") for name, _ in columns(found) if name != "column 1"] == ["T_front", "dZ"]
    rows = found.grid(".")
    assert (found.blanks, found.quoted, rows.width) == (True, True, len(found.layout.names))


@pytest.mark.parametrize(
    "head", ["spindle S4000 in hall 3", "# spindle run S4000 in hall 3\n# measured by Novak on Monday"]
)
def test_a_sentence_above_rows_without_a_header_names_nothing(head: str) -> None:
    found = table(head, "{s} {T} 0.0", time={"column": 1, "unit": "s"})
    assert found.layout.names == ("column 1", "column 2", "column 3")


def test_a_sentence_above_the_names_names_nothing() -> None:
    assert columns(table("spindle S4000 in hall 3\ntime[s] T_front dZ[um]", "{s} {T} 0.0")) == [
        ("T_front", None),
        ("dZ", "um"),
    ]
