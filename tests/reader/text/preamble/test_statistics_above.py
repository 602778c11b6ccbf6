"""A preamble with its start, its end and a block of statistics above the names, as recorders of air write it."""

from __future__ import annotations

import pytest

from thermodata.reader.text.page.layout import find_layout

HEAD = """\
"testo 176 T4";;;
Serien-Nr.:;41234567;;
Startzeit{c};02.03.2026 08:00:00;;
Endzeit{c};02.03.2026 08:59:50;;
Messkanäle{c};2;;
;min;max;Mittelwert
Spindel [°C];20,9;30,7;27,1
Halle [%rF];40,0;41,0;40,5

id;Datum / Zeit;Spindel [°C];Halle [%rF]"""


def _rows(first: int = 1) -> list[str]:
    return [f"{k};02.03.2026 08:00:{k:02d};2{k % 10},0;40,{k % 10}" for k in range(first, 40)]


@pytest.mark.parametrize("colon", [":", ""])
def test_names_stand_below_the_statistics(colon: str) -> None:
    lines = [*HEAD.format(c=colon).split("\n"), *_rows()]
    found = find_layout([line.split(";") for line in lines], None, "here")
    assert found.names == ("id", "Datum / Zeit", "Spindel [°C]", "Halle [%rF]")
    assert found.units[2:] == ("°C", "%rF")
    assert found.first == 10


@pytest.mark.parametrize("torn", ["x1;02.03.2026 08:00:00;20,0;40,0", "#;02.03.2026 08:00:00;20,0;40,0"])
def test_a_first_row_with_a_damaged_number_is_data(torn: str) -> None:
    lines = ["id;Datum / Zeit;Spindel [°C];Halle [%rF]", torn, *_rows()]
    assert find_layout([line.split(";") for line in lines], None, "here").first == 1
