"""What `sniff` says of a text agrees with what its readers find in it."""

from __future__ import annotations

from pathlib import Path

import pytest

from thermodata.reader.explain import explain, looks_for


@pytest.mark.parametrize(
    ("row", "between"),
    [
        ("{i};21,{i};22,{i};23,{i};24,{i}", "';' between cells"),
        ("{i},21.{i},22.{i}", "',' between cells"),
        ("{i}\t21,{i}\t22,{i}\t3,0", "tabs between cells"),
    ],
)
def test_what_stands_between_cells_is_what_readers_find(tmp_path: Path, row: str, between: str) -> None:
    path = tmp_path / "log.csv"
    path.write_text("\n".join(row.format(i=i) for i in range(10, 60)))
    assert between in explain(path).kind


def test_a_reader_says_formats_and_not_how_it_works() -> None:
    assert "Sinumerik" in looks_for("cnc")
