"""A log that goes on under a header of its own: the same one is skipped, other names or units end the table."""

from __future__ import annotations

from functools import partial
from pathlib import Path

import pytest
from thermodata_reader_table import Reader

from thermodata.plugin import Source
from thermodata.reader.text.file.lines import chunks
from thermodata.testing.reader import Data, load


def read(tmp_path: Path, head: str, again: str, row: str = "2026-03-02 {h:02d}:{m:02d}:00;2{m}.5;0.{m}") -> Data:
    rows = [[row.format(h=h, m=m) for m in range(10, 40)] for h in (8, 9)]
    (tmp_path / "a.csv").write_text("\n".join([head, *rows[0], again, *rows[1], ""]), encoding="utf-8")
    return load(Reader(), tmp_path / "a.csv", Source(timezone="UTC"))


HEAD = "Zeit;T_vorn;dZ\n"


@pytest.mark.parametrize(
    ("again", "said"),
    [
        (HEAD + ";°C;µm", "'dZ' in µm, in mm before"),
        (HEAD + ";°F;mm", "'T_vorn' in °F, in °C before"),
        (HEAD + ";[°F];[µm]", "'T_vorn' in °F, in °C before, 'dZ' in µm, in mm before"),
        (HEAD + "UTC;°C;V", "'dZ' in V, in mm before"),
        (HEAD + ";;V", "'dZ' in V, in mm before"),
        (HEAD + ";°F", "'T_vorn' in °F, in °C before"),
    ],
)
def test_other_units_under_a_repeated_header_end_the_reading(tmp_path: Path, again: str, said: str) -> None:
    data = read(tmp_path, HEAD + ";°C;mm", again)
    (loss,) = data.losses
    assert data.t_ns["table"].size == 30
    assert loss.where == "a.csv line 34"
    assert loss.reason == f"other units begin here, nothing after it is read: {said}; split the file there"


@pytest.mark.parametrize("again", [HEAD + ";°C;mm", HEAD + ";degC;mm", HEAD.strip()])
def test_the_same_units_are_read_on(tmp_path: Path, again: str) -> None:
    data = read(tmp_path, HEAD + ";°C;mm", again)
    assert data.t_ns["table"].size == 60


@pytest.mark.parametrize(
    ("head", "again"),
    [
        (HEAD + ";°C;µm", ";degC;um"),
        (HEAD + ";°C;µm", HEAD + ";[degC];[μm]"),
        (HEAD + "s;[°C];[µm]", HEAD + "s;°C;µm"),
        (HEAD + ";°C;µm", HEAD + ";Grad C;um;"),
        ("Zeit;T_vorn [°C];dZ [µm]", "Zeit;T_vorn (degC);dZ [um]"),
    ],
)
def test_the_same_units_in_another_spelling_are_the_same_header(tmp_path: Path, head: str, again: str) -> None:
    data = read(tmp_path, head, again)
    assert (data.t_ns["table"].size, data.losses) == (60, ())


@pytest.mark.parametrize(
    ("head", "again", "size"),
    [
        (HEAD + ";°C;µm", ";°C;mm", 60),  # a row of units alone may be one of marks, and is told
        ("Zeit;T_vorn [°C];dZ [µm]", "Zeit;T_vorn [degC];dZ [mm]", 30),
        ("Zeit;T_vorn [°C];dZ [µm]", "Zeit;T_hinten [degC];dZ [um]", 30),
        ("Zeit;T_vorn [°C];dZ [µm]", "Zeit;T_vorn [°F];dZ [um]", 30),
    ],
)
def test_other_units_and_names_are_not_for_a_spelling(tmp_path: Path, head: str, again: str, size: int) -> None:
    data = read(tmp_path, head, again)
    assert (data.t_ns["table"].size, len(data.losses)) == (size, 1)


def test_units_where_none_stood_end_the_reading_too(tmp_path: Path) -> None:
    data = read(tmp_path, HEAD.strip(), HEAD + ";°F;µm")
    assert data.t_ns["table"].size == 30
    assert "'T_vorn' in °F, in no unit before" in data.losses[0].reason


@pytest.mark.parametrize("again", ["Zeit;T_vorn;T_hinten", "Zeit;dZ;dZ;T_vorn", "Zeit;dZ [µm]", "Zeit;dZ [mm];T_vorn"])
def test_other_names_end_the_reading(tmp_path: Path, again: str) -> None:
    data = read(tmp_path, "Zeit;T_vorn;dZ [µm]" if "[mm]" in again else HEAD.strip(), again)
    assert data.t_ns["table"].size == 30
    assert data.losses[0].reason.startswith("another header begins here")


@pytest.mark.parametrize(("units", "size"), [("- degC um", 30), ("- degC mm", 60)])
def test_headers_that_were_put_over_their_columns_are_compared_so(tmp_path: Path, units: str, size: int) -> None:
    row = "2026-03-02 {h:02d}:{m:02d}:00 2{m}.5 0.{m}"
    head = "Timestamp T_front dZ\n"
    data = read(tmp_path, head + "- degC mm", head + units, row)
    assert data.t_ns["table"].size == size


def test_a_row_of_words_without_a_time_is_lost_alone(tmp_path: Path) -> None:
    data = read(tmp_path, HEAD + ";°C;mm", ";pause;V")
    assert data.t_ns["table"].size == 60
    assert "expected a time" in data.losses[0].reason


@pytest.mark.parametrize("row", [";21.5;0.1", ";;", ";pause;"])
def test_a_row_without_a_time_is_no_header_where_the_time_has_no_name(tmp_path: Path, row: str) -> None:
    data = read(tmp_path, ";T_vorn;dZ", row)
    assert data.t_ns["table"].size == 60
    assert not any("another header" in loss.reason for loss in data.losses)


def test_names_are_compared_where_one_of_two_columns_of_the_time_has_none(tmp_path: Path) -> None:
    row = "2026-03-02;{h:02d}:{m:02d}:00;2{m}.5;0.{m}"
    data = read(tmp_path, "Datum;;T_vorn;dZ", "Datum;;dZ;T_hinten", row)
    assert data.t_ns["table"].size == 30


@pytest.mark.parametrize("row", [";;;A", ";;;%", "-;-;-;-", ";°F;mm;", ";;;S1"])
def test_a_mark_in_the_shape_of_units_is_none_but_below_a_repeated_header(tmp_path: Path, row: str) -> None:
    head = "Zeit;T_vorn;dZ;Marke\n"
    lines = "2026-03-02 {h:02d}:{m:02d}:00;2{m}.5;0.{m};"
    data = read(tmp_path, head + ";°C;mm;", row, lines)
    assert data.t_ns["table"].size == 60
    assert not any("other units" in loss.reason for loss in data.losses)
    assert read(tmp_path, head + ";°C;mm;", head + ";°F;mm;", lines).t_ns["table"].size == 30


def test_a_dash_is_no_unit_below_a_repeated_header(tmp_path: Path) -> None:
    assert read(tmp_path, HEAD + ";°C;mm", HEAD + "-;°C;-").t_ns["table"].size == 60


def test_units_below_a_header_at_the_end_of_the_piece_before_are_seen(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    head, row = "Zeit;T_vorn;dZ\n;°C;mm", "2026-03-02 {h:02d}:{m:02d}:00;2{m}.5;0.{m}"
    size = len("\n".join([head, *[row.format(h=8, m=m) for m in range(10, 40)], HEAD]).encode()) + 2
    monkeypatch.setattr("thermodata.reader.text.delimited.chunks", partial(chunks, size=size))
    assert read(tmp_path, head, HEAD + ";°F;µm").t_ns["table"].size == 30


@pytest.mark.parametrize(
    ("head", "again", "first", "then"),
    [
        ("Time,T_front,dZ", "Time,T_front", "21.5,0.1", "21.5"),
        ("Time,T_front,dZ", "Time,T_hall,T_bed,dZ", "21.5,0.1", "20.1,21.5,0.1"),
    ],
)
@pytest.mark.parametrize("rows", [60, 900])
def test_a_header_that_lacks_a_name_ends_the_reading(
    tmp_path: Path, head: str, again: str, first: str, then: str, rows: int
) -> None:
    at = [f"2026-03-02 {8 + k // 60:02d}:{k % 60:02d}:00" for k in range(rows)]
    half = rows // 3
    lines = [head, *(f"{t},{first}" for t in at[:half]), again, *(f"{t},{then}" for t in at[half:]), ""]
    (tmp_path / "a.csv").write_text("\n".join(lines), encoding="utf-8")
    data = load(Reader(), tmp_path / "a.csv", Source(timezone="UTC"))
    assert data.t_ns["table"].size == half
    (loss,) = data.losses
    assert loss.reason == f"another header begins here, nothing after it is read: '{again}'; split the file there"


def test_a_list_of_channels_above_the_table_is_no_table_of_its_own(tmp_path: Path) -> None:
    listed = ["No,Name,Unit", "1,T_front,degC", "2,dZ,um", "3,n,rpm", "4,p,bar", ""]
    rows = [f"2026-03-02 08:{m:02d}:00,2{m}.5,0.{m},4000,6" for m in range(10, 40)]
    (tmp_path / "a.csv").write_text("\n".join([*listed, "Time,T_front,dZ,n,p", *rows, ""]), encoding="utf-8")
    data = load(Reader(), tmp_path / "a.csv", Source(timezone="UTC"))
    assert data.t_ns["table"].size == 30
    assert not data.losses


TOA5 = '"TOA5","VR5","CR1000X"\n"TIMESTAMP","RECORD","Sonda_Z","T"\n"TS","RN","{unit}","{other}"\n"","","Smp","Avg"'
ROW = '"2026-03-02 {h:02d}:{m:02d}:00",{m},0.{m},2{m}.5'


@pytest.mark.parametrize(
    ("unit", "then", "other"),
    [("Volts", "mVolts", "Deg C"), ("mVolts", "Volts", "Deg C"), ("cnts", "mcnts", "foo"), ("mV", "um", "bar_x")],
)
def test_a_logger_whose_program_changes_a_unit_is_read_up_to_there(
    tmp_path: Path, unit: str, then: str, other: str
) -> None:
    """A row with TS and RN is one of units, whatever words stand in it: these are compared as texts."""
    data = read(tmp_path, TOA5.format(unit=unit, other=other), TOA5.format(unit=then, other=other), ROW)
    assert data.t_ns["table"].size == 30
    (loss,) = [loss for loss in data.losses if "other units" in loss.reason]
    assert f"'Sonda_Z' in {then}, in {unit} before" in loss.reason


def test_a_logger_that_writes_its_header_again_is_read_on(tmp_path: Path) -> None:
    head = TOA5.format(unit="cnts", other="foo")
    assert read(tmp_path, head, head, ROW).t_ns["table"].size == 60


def test_units_above_the_names_of_a_loggers_channels_are_theirs(tmp_path: Path) -> None:
    """Fluke DAQ: numbers of channels, units, and the names that somebody gave them."""
    rows = [f"07/07/2026 08:00:{k:02d}.0,+021.{k}E+0,+0.0{k}" for k in range(10, 40)]
    head = ['"Time","0001","0011"', '"","C","mV"', '"Scan","Front brg","Z probe"']
    (tmp_path / "f.csv").write_text("\n".join([*head, *rows, ""]), encoding="utf-8")
    about = Reader().describe(tmp_path / "f.csv", Source(timezone="UTC", table={"time": {"format": "mdy"}}))
    assert {s.name: s.unit for s in about.signals} == {"Front brg": "C", "Z probe": "mV"}
