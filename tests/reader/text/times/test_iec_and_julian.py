"""Stamps of IEC 61131-3, Julian days, and dashes that a display shows for a sensor that is not there."""

from __future__ import annotations

from pathlib import Path

import numpy as np
import pytest

from thermodata.draft.make import draft_files
from thermodata.errors import QuestionError
from thermodata.plugin import Source
from thermodata.reader.text.cells.values.number import is_empty
from thermodata.reader.text.clocks.time_questions import size_of_clock
from thermodata.reader.text.tables.find_table import open_table
from thermodata.reader.times.time_units import EPOCHS, to_ns


@pytest.mark.parametrize("prefix", ["DTL#", "DT#", "LDT#", ""])
def test_stamps_of_a_control_are_read(tmp_path: Path, prefix: str) -> None:
    rows = [f"{prefix}2026-03-02-08:00:{k:02d}.500,2{k % 10}.5" for k in range(40)]
    (tmp_path / "t.csv").write_text("\n".join(["Zeit,T_bed [degC]", *rows]))
    table = open_table(tmp_path / "t.csv", Source())
    assert table.layout.names == ("Zeit", "T_bed [degC]")
    assert table.groups[0].absolute


def test_stamps_that_are_not_read_leave_no_word_of_the_programs_inside(tmp_path: Path) -> None:
    rows = [f"Q#2026-03-02-08:00:{k:02d}.500,2{k % 10}.5" for k in range(40)]
    (tmp_path / "t.csv").write_text("\n".join(["Zeit,T_bed [degC]", *rows]))
    draft_files(tmp_path)
    text = (tmp_path / "campaign.yaml").read_text() if (tmp_path / "campaign.yaml").exists() else ""
    assert "broke the rule" not in text


@pytest.mark.parametrize(("unit", "number"), [("mjd", 61101.0), ("jd", 2461101.5)])
def test_julian_days_are_counted_from_their_zero(unit: str, number: float) -> None:
    of = EPOCHS[unit]
    (t_ns,) = to_ns(np.array([number]), of.seconds, of.zero_s)
    assert np.datetime64(int(t_ns), "ns") == np.datetime64("2026-03-02T00:00", "ns")


@pytest.mark.parametrize(
    ("first", "asked", "not_asked"),
    [
        (61101.25, "mjd (modified Julian days: 2026-03-02)", "(Julian"),
        (2461101.75, "jd (Julian", "excel"),
        (46083.25, "excel", "mjd"),
    ],
)
def test_days_are_asked_for_by_their_size(first: float, asked: str, not_asked: str) -> None:
    with pytest.raises(QuestionError) as found:
        size_of_clock("Time", list(first + np.arange(50) / 8640), "here")
    assert asked in found.value.ask
    assert not_asked not in found.value.ask


def test_dashes_around_a_mark_are_no_value() -> None:
    assert all(map(is_empty, ["-.-", "-.--", "--.--", "--,-", "----.-"]))
    assert not any(map(is_empty, ["-.5", "-5.-", ".", "-.", ".-"]))
