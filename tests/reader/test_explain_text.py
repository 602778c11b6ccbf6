"""What `sniff` says of a text agrees with what its readers find in it."""

from __future__ import annotations

from pathlib import Path

import pytest

from thermodata.reader.finding.explain import explain, looks_for, why_no_table


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


def test_letters_that_nobody_knows_are_not_shown(tmp_path: Path) -> None:
    path = tmp_path / "memo.txt"
    path.write_bytes("桜吹雪春眠".encode("cp932"))
    assert explain(path).kind == "text, in an encoding that it does not name"


def test_why_a_text_with_cells_is_no_table(tmp_path: Path) -> None:
    path = tmp_path / "grafana.csv"
    rows = [f'"2026-03-02 08:{k:02d}:00","{20 + k / 10} °C","{30 + k / 10} °C"' for k in range(50)]
    path.write_text("\n".join(['"Time","Spindle front","Hall"', *rows]), encoding="utf-8")
    assert (why_no_table(path) or "").startswith("cells that hold their units beside their numbers; export")
    path.write_text("Dear colleague\nthe probe was moved\n")
    assert why_no_table(path) is None


def test_a_reader_says_formats_and_not_how_it_works() -> None:
    assert "Sinumerik" in looks_for("cnc")
