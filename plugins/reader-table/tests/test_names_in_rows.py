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


@pytest.mark.parametrize("words", [("ON", "OFF"), ("T_front", "T_rear")])
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
