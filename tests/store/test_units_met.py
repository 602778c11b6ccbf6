"""Units of rows that the first look at a file did not meet: told once the file is read."""

from __future__ import annotations

from pathlib import Path

import pytest

from thermodata.plugin import Source
from thermodata.reader.finding import registry
from thermodata.reader.finding.preview import preview
from thermodata.store.raw.streams import read_raw


@pytest.mark.parametrize("early", [False, True])
def test_units_that_come_behind_the_first_look_are_converted_and_told_once_they_are_read(
    tmp_path: Path, early: bool
) -> None:
    units = ["mA"] * 60_000 + ["A"] * 3 + ["mA"] * 10_000
    rows = [
        f"2026-03-14 {k // 3600:02d}:{k // 60 % 60:02d}:{k % 60:02d};{u};1.5"
        for k, u in enumerate(["A", *units[1:]] if early else units)
    ]
    path = tmp_path / "a.csv"
    path.write_text("\n".join(["Time;Einheit;Strom", *rows, ""]), encoding="utf-8")
    (tmp_path / "raw").mkdir()
    (raw,) = read_raw(tmp_path, path, path.name, "0" * 64, registry.reader("table"), Source(timezone="UTC"))
    told = [note for note in raw.notes if note.startswith("'Einheit' says the unit of 'Strom' row by row")]
    assert [note.partition(": ")[2] for note in told] == [
        "'mA' is converted to 'A'" if early else "'A' is converted to 'mA'"
    ]
    assert (raw.rows, raw.losses) == (70_003, ())
    assert set(told) <= set(preview(path, source=Source(timezone="UTC"))["notes"])
