"""Rows of several names, each before its value."""

from __future__ import annotations

from pathlib import Path

import pytest
from thermodata_reader_table import Reader

from thermodata.errors import FormatError
from thermodata.plugin import Source


def names_of(path: Path) -> list[str]:
    return [s.name for s in Reader().describe(path, Source()).signals]


@pytest.mark.parametrize("header", [[], ["when;Sensor A;x;Sensor B;y"]])
def test_names_that_change_their_places_from_row_to_row_are_refused(tmp_path: Path, header: list[str]) -> None:
    pairs = [("T_front", 21.5), ("T_rear", 20.5)]
    rows = [
        f"2026-03-12 08:{k:02d}:00;" + ";".join(f"{n};{v}" for n, v in (pairs if k < 20 else pairs[::-1]))
        for k in range(40)
    ]
    path = tmp_path / "pairs.csv"
    path.write_text("\n".join([*header, *rows, ""]))
    if header:  # what nobody calls a name of something may be anything
        assert names_of(path)
        return
    with pytest.raises(FormatError, match="rows of several names, each before its value") as said:
        names_of(path)
    assert "time,channel,value,channel,value" in str(said.value)


@pytest.mark.parametrize("words", [("ON", "OFF"), ("um", "mm"), ("T_front", "T_front"), ("12a", "12b")])
def test_words_before_numbers_that_stay_or_are_states_are_no_names_that_move(
    tmp_path: Path, words: tuple[str, str]
) -> None:
    turned = words[0] == "ON"
    rows = [
        f"2026-03-12 08:{k:02d}:00;{words[turned and k > 20]};21.5;{words[not (turned and k > 20)]};20.5"
        for k in range(40)
    ]
    path = tmp_path / "words.csv"
    path.write_text("\n".join([*rows, ""]))
    assert names_of(path) == ["column 2", "column 3", "column 4", "column 5"]


def pairs(missing: str) -> list[list[str]]:
    """Rows of a time and three names, each before its value; holes: a name and a value, or a value alone."""
    rows = []
    for k in range(60):
        cells = [f"2026-03-12T08:{k:02d}:00Z"]
        for n, name in enumerate(("T_front [degC]", "T_air", "disp_z")):
            hole = k % (7 + n) == 3 and n < 2
            cells += [name if missing == "value" or not hole else "", "" if hole else f"{20 + n + k / 100:.2f}"]
        rows.append(cells)
    return rows


@pytest.mark.parametrize("missing", ["both", "value"])
def test_names_that_stay_before_their_values_are_those_of_the_columns_also_beside_holes(
    tmp_path: Path, missing: str
) -> None:
    path = tmp_path / "pairs.csv"
    path.write_text("\n".join([*(",".join(r) for r in pairs(missing)), ""]))
    recording = Reader().describe(path, Source())
    values = [s for s in recording.signals if s.dtype == "float64"]
    assert [(s.name, s.unit) for s in values] == [("T_front [degC]", "degC"), ("T_air", None), ("disp_z", None)]
    assert any("called by the words before their values" in n for n in recording.notes)


@pytest.mark.parametrize("other", ["header", "number", "once", "no name"])
def test_other_tables_keep_their_names(tmp_path: Path, other: str) -> None:
    rows = pairs("both")
    if other == "header":
        rows = [["time", *(f"c{k}" for k in range(6))], *rows]
    elif other == "number":  # which no word names
        rows = [[*r, str(k)] for k, r in enumerate(rows)]
    elif other == "once":
        rows = [r[:3] for r in rows]
    else:
        rows[3][1], rows[3][2] = "", "20.5"
    path = tmp_path / "pairs.csv"
    path.write_text("\n".join([*(",".join(r) for r in rows), ""]))
    assert not {"T_front [degC]", "T_air"} & set(names_of(path))
