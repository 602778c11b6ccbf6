"""Cells that hold their unit beside their number, in one column among others: their values would be words."""

from __future__ import annotations

import re
import subprocess
from pathlib import Path

import pytest
from thermodata_reader_table import Reader

from thermodata.errors import FormatError
from thermodata.plugin import Source
from thermodata.testing.reader import Data, load


def read(tmp_path: Path, row: str, **options: object) -> Data:
    rows = [row.format(m=m) for m in range(30)]
    (tmp_path / "a.csv").write_text("\n".join(["Time,T front,Speed", *rows, ""]), encoding="utf-8")
    return load(Reader(), tmp_path / "a.csv", Source(timezone="UTC", options=options))


@pytest.mark.parametrize(
    ("row", "column"),
    [("2026-03-02 08:{m:02d}:00,21.{m} °C,6000", "T front"), ("2026-03-02 08:{m:02d}:00,21.{m},{m}00 rpm", "Speed")],
)
def test_a_column_of_such_cells_is_told_beside_plain_ones(tmp_path: Path, row: str, column: str) -> None:
    data = read(tmp_path, row)
    assert data.values["table", column].dtype == object
    (told,) = [note for note in data.recording.notes if "hold their unit beside their numbers" in note]
    assert told.startswith(f"column '{column}' is read as words")
    quiet = read(tmp_path, row, text=[column])  # the way out that is named
    assert not any("hold their unit" in note for note in quiet.recording.notes)


@pytest.mark.parametrize("word", ["spindle on", "S1 6000 rpm", "12 pieces left", "10 sec"])
def test_words_are_read(tmp_path: Path, word: str) -> None:
    data = read(tmp_path, "2026-03-02 08:{m:02d}:00,21.{m}," + word)
    assert data.values["table", "Speed"].tolist() == [word] * 30


@pytest.mark.parametrize("words", [["100%", "80%"], ["1F", "0C"], ["12V"], ["10 mm"], ["0T", "1T"], ["8 bar", "G1"]])
def test_a_few_words_in_the_shape_of_units_are_no_values(tmp_path: Path, words: list[str]) -> None:
    rows = [f"2026-03-02 08:{m:02d}:00,21.{m},{words[m % len(words)]}" for m in range(30)]
    (tmp_path / "a.csv").write_text("\n".join(["Time,T front,State", *rows, ""]), encoding="utf-8")
    data = load(Reader(), tmp_path / "a.csv", Source(timezone="UTC"))
    assert data.values["table", "State"].tolist() == [words[m % len(words)] for m in range(30)]
    assert not any("hold their unit" in note for note in data.recording.notes)


def test_a_table_of_such_cells_only_is_refused(tmp_path: Path) -> None:
    with pytest.raises(FormatError, match="cells that hold their units beside their numbers"):
        read(tmp_path, "2026-03-02 08:{m:02d}:00,21.{m} °C,{m}00 rpm")


def test_the_command_that_is_offered_takes_the_units_out(tmp_path: Path) -> None:
    lines = ["Time;T1;RH", *(f"2026-03-01 08:{i:02}:00;{20 + i / 8:.2f} °C;{40 + i} %RH" for i in range(20))]
    (tmp_path / "FILE").write_text("\n".join([*lines, ""]))
    with pytest.raises(FormatError) as refused:
        load(Reader(), tmp_path / "FILE", Source())
    command = re.search(r"sed .* > plain.csv", str(refused.value))
    assert command is not None
    subprocess.run(["bash", "-c", command[0]], cwd=tmp_path, check=True)
    data = load(Reader(), tmp_path / "plain.csv", Source())
    assert data.values["table", "T1"].tolist() == [round(20 + i / 8, 2) for i in range(20)]
    assert data.values["table", "RH"].tolist() == [40 + i for i in range(20)]
