"""Damaged and odd LVM files: what is gone is told, and what contradicts the rows is noted."""

from __future__ import annotations

from pathlib import Path

import numpy as np
import pytest
from thermodata_reader_crio import Reader

from thermodata.errors import FormatError
from thermodata.schema.flag import Flag
from thermodata.testing.reader import load

from .lvm_files import PRAGUE, START, S, head, packet, read


def test_a_cut_last_line_is_a_loss_and_not_a_value(tmp_path: Path) -> None:
    data = read(tmp_path, head("No") + packet(["a"], x="X_Value\ta") + "\t12,53\n\t12,5")
    np.testing.assert_array_equal(data.values["data", "a"], [12.53])
    assert "line 22" in data.losses[0].where


def test_a_line_that_is_no_number_is_reported(tmp_path: Path) -> None:
    data = read(tmp_path, head("No") + packet(["a"], x="X_Value\ta") + "\t1,0\n\txx\n\t3,0\n")
    np.testing.assert_array_equal(data.values["data", "a"], [1.0, 3.0])
    assert data.losses[0].reason.startswith("1 line that is no row")
    assert data.losses[0].where == "x.lvm line 22"


def test_a_cell_that_is_no_number_spoils_itself_only(tmp_path: Path) -> None:
    data = read(tmp_path, head("No") + packet(["a", "b"], x="X_Value\ta\tb") + "\t1,0\t2\n\txx\t3\n\t\t4\n")
    np.testing.assert_array_equal(data.values["data", "a"], [1.0, np.nan, np.nan])
    np.testing.assert_array_equal(data.values["data", "b"], [2, 3, 4])
    np.testing.assert_array_equal(data.flags["data", "a"], [0, Flag.NOT_MEASURING, Flag.NOT_MEASURING])
    assert "1 cell that is no number" in data.losses[0].reason


def test_a_row_with_a_cell_too_few_is_no_row(tmp_path: Path) -> None:
    text = head("No") + packet(["a", "b"], x="X_Value\ta\tb") + "\t1\t2\n\t3\n\t5\t6\n"
    data = read(tmp_path, text)
    np.testing.assert_array_equal(data.values["data", "a"], [1, 5])
    assert "1 line that is no row of 3 numbers" in {x.reason for x in data.losses}


def test_fewer_rows_than_the_heading_announces_are_a_loss(tmp_path: Path) -> None:
    data = read(tmp_path, head("No", "Yes") + packet(["a"], x="X_Value\ta") + "\t1\n\t2\n")
    assert data.losses[0].reason == "2 rows of 3 that the heading announces"
    assert data.losses[0].fraction == pytest.approx(1 / 3)


@pytest.mark.parametrize(
    ("old", "new", "note"),
    [
        ("Delta_X\t", "Delta_Y\t", "no Delta_X"),
        ("X_Columns\tNo", "X_Columns\tMulti", "X column is empty"),
        ("Channels\t1", "Channels\t2", "announces 2 channels"),
        ("Separator\tTab", "Separator\tComma", "names the separator"),
        ("Decimal_Separator\t,", "Decimal_Separator\t.", "decimal mark"),
        ("Date\t2026/03/01", "Date\t1.3.26", "not understood"),
    ],
)
def test_a_header_that_contradicts_the_data_is_noted(tmp_path: Path, old: str, new: str, note: str) -> None:
    text = head("No") + packet(["a"], x="X_Value\ta") + "\t1,5\n\t2,5\n\t3,5\n"
    data = read(tmp_path, text.replace(old, new))
    assert note in " ".join(data.recording.notes)


def test_a_header_without_end_is_refused(tmp_path: Path) -> None:
    with pytest.raises(FormatError, match="ends inside its header"):
        read(tmp_path, "LabVIEW Measurement\t\nWriter_Version\t2\n")


def test_a_row_with_bytes_of_zero_is_lost_and_reported(tmp_path: Path) -> None:
    data = read(tmp_path, head("No") + packet(["a"], x="X_Value\ta") + "\t1,5\n\t2\0\0,5\n\t3,5\n")
    np.testing.assert_array_equal(data.values["data", "a"], [1.5, 3.5])
    np.testing.assert_array_equal(data.t_ns["data"] - START, [0, S])
    assert data.losses[0].where == "x.lvm line 22"


def test_a_line_in_another_encoding_is_read_as_it_looks_and_reported(tmp_path: Path) -> None:
    text = head("No") + packet(["T (°C)", "größe µ"], x="X_Value\tT (°C)\tgröße µ") + "\t1\t2\tprüfen\n\t3\t4\t"
    path = tmp_path / "x.lvm"
    path.write_bytes(text.encode() + "prüfen\n".encode("cp1252") + b"\t5\t6\n")
    data = load(Reader(), path, PRAGUE)
    assert list(data.values["data", "Comment"]) == ["prüfen", "prüfen", ""]
    np.testing.assert_array_equal(data.values["data", "T (°C)"], [1, 3, 5])
    assert [(x.where, x.reason.split(";")[0]) for x in data.losses] == [
        ("x.lvm line 22", "its bytes are not of the file's encoding")
    ]


def test_a_block_of_zeros_over_the_names_and_the_first_rows_is_told(tmp_path: Path) -> None:
    whole = head("No") + packet(["a", "b"], x="X_Value\ta\tb") + "\t1,5\t-2\n\t1,25\t3\n\t1\t4\n"
    at = whole.index("\tComment")
    data = read(tmp_path, whole[:at] + "\0" * (len("\tComment\n\t1,5\t-2")) + "\n" + whole.split("\t1,5\t-2\n")[1])
    assert any("NUL bytes in the line of names" in loss.reason for loss in data.losses)
    np.testing.assert_array_equal(data.values["data", "a"], [1.25, 1.0])


def test_a_heading_that_counts_its_channels_with_nothing_is_noted(tmp_path: Path) -> None:
    text = head("No") + packet(["a", "b"], x="X_Value\ta\tb").replace("Channels\t2", "Channels")
    data = read(tmp_path, text + "\t1,5\t-2\n\t1,25\t3\n\t1\t4\n")
    assert any("announces no number of channels and names 2" in n for n in data.recording.notes)
    np.testing.assert_array_equal(data.values["data", "b"], [-2, 3, 4])


@pytest.mark.parametrize("key", ["Samples", "Date", "Time", "X0", "Delta_X"])
def test_a_heading_that_tells_a_key_of_some_channels_only_is_noted(tmp_path: Path, key: str) -> None:
    """The last one would silently count from another start, or by another step."""
    heading = packet(["a", "b"], x="X_Value\ta\tb")
    (line,) = [t for t in heading.split("\n") if t.startswith(f"{key}\t")]
    fewer = line.rstrip("\t").rpartition("\t")[0] + "\t"
    data = read(tmp_path, head("No") + heading.replace(line, fewer) + "\t1,5\t-2\n\t1,25\t3\n\t1\t4\n")
    assert any(f"{key} stands for 1 of 2 channels" in n for n in data.recording.notes)
    whole = read(tmp_path, head("No") + heading + "\t1,5\t-2\n\t1,25\t3\n\t1\t4\n")
    assert not any("stands for" in n for n in whole.recording.notes)
