"""LVM text files."""

from __future__ import annotations

from pathlib import Path

import numpy as np
import pytest
from thermodata_reader_crio import Reader
from thermodata_reader_crio.lvm import scan

from thermodata.errors import FormatError
from thermodata.plugin import Block
from thermodata.reader.text.rows import odd_rows, typed
from thermodata.schema.flag import Flag
from thermodata.testing.reader import load

from .lvm_files import PRAGUE, START, S, head, packet, read


def test_no_x_column_counts_by_delta_and_takes_local_time(tmp_path: Path) -> None:
    data = read(tmp_path, head("No") + packet(["a", "b"], x="X_Value\ta\tb") + "\t1,5\t-2\n\t1,25\t3\tLOST\n\t1\t4\n")
    np.testing.assert_array_equal(data.t_ns["data"], START + np.array([0, 1, 2]) * S // 2)
    np.testing.assert_array_equal(data.values["data", "a"], [1.5, 1.25, 1.0])
    assert list(data.values["data", "Comment"]) == ["", "LOST", ""]
    assert data.recording.signals[0].unit == "V"


def test_a_comma_in_times_and_points_in_data_of_version_092(tmp_path: Path) -> None:
    text = head("No", decimal="") + packet(["a"], x="X_Value\ta") + "\t0.052530\n\t1.5\n"
    np.testing.assert_array_equal(read(tmp_path, text).values["data", "a"], [0.05253, 1.5])


def test_x_values_in_seconds_since_1904_are_absolute(tmp_path: Path) -> None:
    x = START // S + 2_082_844_800
    text = head("One") + packet(["a"], x="X_Value\ta") + f"{x},0\t1\n{x + 1},0\t2\n"
    np.testing.assert_array_equal(read(tmp_path, text).t_ns["data"], [START, START + S])


@pytest.mark.parametrize(
    ("comment", "flag"),
    [
        ("LOST COMMUNICATION", Flag.NOT_MEASURING),
        ("Sensor timeout", Flag.NOT_MEASURING),
        ("Overload ch 2", Flag.SATURATED),
        ("OK", 0),
        ("no error", 0),
        ("spindle on", 0),
    ],
)
def test_a_comment_that_says_that_nothing_was_measured_flags_its_row(tmp_path: Path, comment: str, flag: int) -> None:
    data = read(tmp_path, head("No") + packet(["a"], x="X_Value\ta") + f"\t1\n\t2\t{comment}\n\t3\n")
    np.testing.assert_array_equal(data.flags["data", "a"], [0, flag, 0])
    assert data.values["data", "Comment"][1] == comment


def test_appended_rows_are_kept_whatever_the_heading_announced(tmp_path: Path) -> None:
    """One heading, then rows of many writes; the channels of a scan start microseconds apart."""
    heading = packet(["a", "b"], x="X_Value\ta\tb").replace(
        "Time\t08:00:00,0\t08:00:00,0", "Time\t08:00:00,000014\t08:00:00,0"
    )
    data = read(tmp_path, head("No") + heading + "\t1\t2\n" * 50)
    assert data.t_ns["data"].size == 50
    assert data.losses == ()


def test_notes_and_special_blocks_are_stepped_over(tmp_path: Path) -> None:
    special = "***Start_Special***\nWaveform\tstuff\n1\t2\t3\n***End_Special***\n"
    text = (
        head("One").replace("***End_of_Header***", special + "***End_of_Header***")
        + "Notes\tX values guaranteed for Dev0 only\n"
        + packet(["a"], x="X_Value\ta")
        + "0,0\t1\n"
        + special
        + "0,5\t2\n1,0\t3\n"
    )
    data = read(tmp_path, text)
    np.testing.assert_array_equal(data.values["data", "a"], [1, 2, 3])
    assert data.losses == ()


def test_spectra_are_not_passed_for_rows_over_time(tmp_path: Path) -> None:
    heading = packet(["a"], x="X_Value\ta").replace("X0\t", "X_Dimension\tFrequency\t\nX0\t")
    with pytest.raises(FormatError, match="without a channel over time"):
        read(tmp_path, head("No") + heading + "\t1\n")


@pytest.mark.parametrize(
    ("end", "encoding"), [("\r\n", "utf-8"), ("\r", "utf-8"), ("\n", "cp1252"), ("\r\n", "utf-16"), ("\n", "utf-8-sig")]
)
def test_line_ends_and_encodings(tmp_path: Path, end: str, encoding: str) -> None:
    heading = packet(["T °C"], x="X_Value\tT °C").replace("Y_Unit_Label\tV", "Y_Unit_Label\tµm")
    text = head("No") + heading + "\t1,5\n\t2,5\tprüfen\n\t3\n"
    path = tmp_path / "x.lvm"
    path.write_bytes(text.replace("\n", end).encode(encoding))
    data = load(Reader(), path, PRAGUE)
    np.testing.assert_array_equal(data.values["data", "T °C"], [1.5, 2.5, 3])
    assert data.recording.signals[0].unit == "µm"
    assert data.values["data", "Comment"][1] == "prüfen"


def test_commas_between_cells(tmp_path: Path) -> None:
    text = (
        (head("One") + packet(["a", "b"], x="X_Value\ta\tb"))
        .replace(",", ".")
        .replace("\t", ",")
        .replace("Separator,Tab", "Separator,Comma")
        .replace("Decimal_Separator,.", "Decimal_Separator,.")
    )
    data = read(tmp_path, text + "0.0,1.5,2\n0.5,2.5,3\n1.0,3.5,4\n")
    np.testing.assert_array_equal(data.values["data", "a"], [1.5, 2.5, 3.5])
    assert data.t_ns["data"][1] - START == S // 2


def test_parts_of_any_size_give_the_same(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    text = head("One", "Yes") + "".join(
        packet(["a", "b"], x="X_Value\ta\tb", start=f"{8 + k:02}:00:00,0") + "0,0\t1\t2\n0,5\t3\t4\tLOST\n1,0\tx\t6\n\n"
        for k in range(4)
    )
    whole = read(tmp_path, text)
    for size in (1, 7, 64, 300):
        monkeypatch.setattr(scan, "PART_BYTES", size)
        small = read(tmp_path, text)
        for key, values in whole.values.items():
            np.testing.assert_array_equal(small.values[key], values)
            np.testing.assert_array_equal(small.t_ns[key[0]], whole.t_ns[key[0]])


def test_the_fast_and_the_slow_parser_agree() -> None:
    rng = np.random.default_rng(3)
    lines = [
        f"{i / 10:.6f}\t{v!r}\t{'' if i % 7 == 0 else f'{w:.3E}'}" + ("\r\n" if i % 2 else "\n")
        for i, (v, w) in enumerate(rng.normal(size=(400, 2)).tolist())
    ]
    grid = typed.Grid("\t", ".", ("float64",) * 3, blank_rows=True)
    data = "".join(lines).encode()
    fast, slow = typed._typed(data, 0, grid), odd_rows.line_by_line(data, 0, grid)
    assert fast is not None
    for c in range(3):
        np.testing.assert_array_equal(fast.columns[c].values, slow.columns[c].values)
    # one odd line in many: all others come as they are
    mixed = typed.parse(b"".join([*map(str.encode, lines[:200]), b"x\ty\n", *map(str.encode, lines[200:])]), 0, grid)
    np.testing.assert_array_equal(mixed.columns[1].values, slow.columns[1].values)
    assert [bad.line for bad in mixed.bad] == [200]


def test_words_for_nothing_and_for_overload_are_flagged_and_no_damage(tmp_path: Path) -> None:
    text = head("No") + packet(["a", "b"], x="X_Value\ta\tb") + "\t1\t2\n\t---\tOVERLOAD\n\t1e999\t6\n"
    data = read(tmp_path, text)
    np.testing.assert_array_equal(data.values["data", "a"], [1, np.nan, np.nan])
    np.testing.assert_array_equal(data.flags["data", "a"], [0, Flag.NOT_MEASURING, Flag.NOT_MEASURING])
    np.testing.assert_array_equal(data.flags["data", "b"], [0, Flag.SATURATED, 0])
    assert [x.reason.split(":")[0] for x in data.losses] == ["1 cell that is no number"]
    assert data.losses[0].where == "x.lvm line 23"


@pytest.mark.parametrize("odd", ["", "\tx"])  # a comment that is no number's neighbour, and a part that is all numbers
def test_a_counted_row_without_values_takes_its_time(tmp_path: Path, odd: str) -> None:
    text = head("No") + packet(["a", "b"], x="X_Value\ta\tb") + f"\t1\t2\n\n\t\t\n\t5\t6{odd}\n"
    data = read(tmp_path, text)
    np.testing.assert_array_equal(data.t_ns["data"] - START, [0, S // 2, S])
    np.testing.assert_array_equal(data.values["data", "b"], [2, np.nan, 6])
    assert data.losses == ()


def test_every_row_carries_its_line(tmp_path: Path) -> None:
    text = head("No") + packet(["a"], x="X_Value\ta") + "\t1\n\txx\n\n\t3\tLOST\n"
    path = tmp_path / "x.lvm"
    path.write_text(text)
    (block,) = (b for b in Reader().blocks(path, PRAGUE) if isinstance(b, Block))
    assert block.at is not None
    assert block.at.tolist() == [21, 24]
    assert Reader().locate(path, PRAGUE, "data", 1) == "line 24"
    assert Reader().locate(path, PRAGUE, "data", 2) == "row 3"
