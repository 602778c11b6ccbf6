"""LVM text files."""

from __future__ import annotations

from pathlib import Path

import numpy as np
import pytest
from thermodata_reader_crio import Reader
from thermodata_reader_crio.lvm import scan

from thermodata.errors import FormatError
from thermodata.plugin import Block, Source
from thermodata.reader.text.rows import odd_rows, typed
from thermodata.schema.flag import Flag
from thermodata.testing.reader import Data, load

S = 1_000_000_000
START = np.datetime64("2026-03-01T07:00:00", "ns").astype(np.int64).item()  # 08:00 in Prague
PRAGUE = Source(timezone="Europe/Prague")


def head(columns: str, several: str = "No", decimal: str = "Decimal_Separator\t,\n") -> str:
    return (
        f"LabVIEW Measurement\t\nWriter_Version\t2\nSeparator\tTab\n{decimal}Multi_Headings\t{several}\n"
        f"X_Columns\t{columns}\nTime_Pref\tAbsolute\nDate\t2026/03/01\nTime\t08:00:00,0\n"
        "***End_of_Header***\t\n\t\n"
    )


def packet(names: list[str], *, start: str = "08:00:00,0", delta: str = "0,5", x: str = "", gap: str = "\t") -> str:
    n = len(names)

    def row(key: str, value: str) -> str:
        return key + "".join(f"{gap}{value}" if i else f"\t{value}" for i in range(n)) + "\t\n"

    return (
        f"Channels\t{n}\n"
        + row("Samples", "3")
        + row("Date", "2026/03/01")
        + row("Time", start)
        + row("Y_Unit_Label", "V")
        + row("X0", "0,0E+0")
        + row("Delta_X", delta)
        + "***End_of_Header***\t\n"
        + x
        + "\tComment\n"
    )


def read(tmp_path: Path, text: str, source: Source = PRAGUE) -> Data:
    path = tmp_path / "x.lvm"
    path.write_text(text, encoding="utf-8")
    return load(Reader(), path, source)


def test_no_x_column_counts_by_delta_and_takes_local_time(tmp_path: Path) -> None:
    data = read(tmp_path, head("No") + packet(["a", "b"], x="X_Value\ta\tb") + "\t1,5\t-2\n\t1,25\t3\tLOST\n\t1\t4\n")
    np.testing.assert_array_equal(data.t_ns["data"], START + np.array([0, 1, 2]) * S // 2)
    np.testing.assert_array_equal(data.values["data", "a"], [1.5, 1.25, 1.0])
    assert list(data.values["data", "Comment"]) == ["", "LOST", ""]
    assert data.recording.signals[0].unit == "V"


def test_a_comma_in_times_and_points_in_data_of_version_092(tmp_path: Path) -> None:
    text = head("No", decimal="") + packet(["a"], x="X_Value\ta") + "\t0.052530\n\t1.5\n"
    np.testing.assert_array_equal(read(tmp_path, text).values["data", "a"], [0.05253, 1.5])


def test_several_packets_go_on_in_the_same_stream(tmp_path: Path) -> None:
    text = (
        head("One", "Yes")
        + packet(["a"], x="X_Value\ta")
        + "0,0\t1\n0,5\t2\n"
        + packet(["a"], x="X_Value\ta", start="09:00:00,25")
        + "0,0\t3\n0,5\t4\n"
    )
    data = read(tmp_path, text)
    np.testing.assert_array_equal(data.values["data", "a"], [1, 2, 3, 4])
    np.testing.assert_array_equal(data.t_ns["data"] - START, [0, S // 2, 3600 * S + S // 4, 3600 * S + 3 * S // 4])


def test_channels_with_x_columns_of_their_own(tmp_path: Path) -> None:
    heading = packet(["a", "b"], x="X_Value\ta\tX_Value\tb", gap="\t\t")
    text = head("Multi") + heading + "0,0\t1\t0,0\t5\n0,5\t2\t0,5\t6\n"
    data = read(tmp_path, text)
    np.testing.assert_array_equal(data.values["data", "b"], [5, 6])
    assert {s.unit for s in data.recording.signals if s.dtype == "float64"} == {"V"}
    other = read(tmp_path, text.replace("0,5\t6", "0,7\t6"))
    np.testing.assert_array_equal(other.values["data@2", "b"], [5, 6])
    np.testing.assert_array_equal(other.t_ns["data@2"] - START, [0, 7 * S // 10])
    np.testing.assert_array_equal(other.t_ns["data"] - START, [0, S // 2])


@pytest.mark.parametrize("samples", ["2\t\t4", "4\t\t2"])
def test_a_slower_channel_ends_before_the_others(tmp_path: Path, samples: str) -> None:
    heading = packet(["a", "b"], x="X_Value\ta\tX_Value\tb", gap="\t\t").replace(
        "Samples\t3\t\t3", f"Samples\t{samples}"
    )
    long, short = ("b", "a") if samples.startswith("2") else ("a", "b")
    rows = [("0,0\t1", "0,0\t5"), ("1,0\t2", "0,5\t6"), ("\t", "1,0\t7"), ("\t", "1,5\t8")]
    lines = ["\t".join(r if long == "b" else r[::-1]) for r in rows]
    data = read(tmp_path, head("Multi") + heading + "\n".join(lines) + "\n")
    assert not data.losses
    found = {name: values.tolist() for (_, name), values in data.values.items() if name in ("a", "b")}
    assert found == {long: [5, 6, 7, 8], short: [1, 2]}
    # a value without a time behind its end, and one in the longer channel, are lost all the same
    for k, row in ((2, ("\t9", rows[2][1])), (3, ("\t", "\t8"))):
        lines = ["\t".join(r if long == "b" else r[::-1]) for r in [*rows[:k], row, *rows[k + 1 :]]]
        (loss,) = read(tmp_path, head("Multi") + heading + "\n".join(lines) + "\n").losses
        assert loss.reason == "1 line that is no row of 4 numbers"


@pytest.mark.parametrize("first", [True, False])
def test_rows_that_one_of_two_groups_lacks_in_its_middle_are_a_loss(tmp_path: Path, first: bool) -> None:
    heading = packet(["a", "b"], x="X_Value\ta\tX_Value\tb", gap="\t\t").replace("Samples\t3\t\t3", "Samples\t5\t\t5")
    whole, torn = [f"{k},0\t{k}" for k in range(5)], ["0,0\t5", "\t", "\t", "3,0\t8", "4,0\t9"]
    rows = zip(torn, whole, strict=True) if first else zip(whole, torn, strict=True)
    (loss,) = read(tmp_path, head("Multi") + heading + "\n".join(map("\t".join, rows)) + "\n").losses
    assert loss.reason == "2 lines that are no rows of 4 numbers"


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


def test_packets_with_other_channels_are_streams_of_their_own(tmp_path: Path) -> None:
    text = (
        head("No", "Yes")
        + packet(["a"], x="X_Value\ta")
        + "\t1\n\t2\n\t3\n\n"
        + packet(["c", "b"], x="X_Value\tc\tb", start="09:00:00,0")
        + "\t4\t5\n\t6\t7\n\t8\t9\n"
    )
    data = read(tmp_path, text)
    np.testing.assert_array_equal(data.values["data@2", "b"], [5, 7, 9])
    assert data.t_ns["data@2"][0] - START == 3600 * S


@pytest.mark.parametrize("swapped", [False, True])
def test_a_packet_with_a_channel_more_or_less_goes_on_in_the_same_stream(tmp_path: Path, swapped: bool) -> None:
    def part(names: list[str], start: str, rows: str) -> str:
        return packet(names, x="X_Value\t" + "\t".join(names), start=start) + rows

    few = "\t1\n\t2\n\t3\n\n", "\t4\t5\n\t6\t7\n\t8\t9\n"
    if swapped:
        text = part(["a", "b"], "08:00:00,0", few[1]) + part(["a"], "09:00:00,0", few[0])
    else:
        text = part(["a"], "08:00:00,0", few[0]) + part(["b", "a"], "09:00:00,0", few[1])
    data = read(tmp_path, head("No", "Yes") + text)
    assert list(data.t_ns) == ["data"]
    assert not data.losses
    a, b = data.values["data", "a"], data.values["data", "b"]
    np.testing.assert_array_equal(a, [4, 6, 8, 1, 2, 3] if swapped else [1, 2, 3, 5, 7, 9])
    np.testing.assert_array_equal(b, [5, 7, 9, *[np.nan] * 3] if swapped else [*[np.nan] * 3, 4, 6, 8])
    flags = [0, 0, 0, *[Flag.NOT_MEASURING] * 3]
    assert data.flags["data", "b"].tolist() == (flags if swapped else flags[::-1])
    assert any("'b' of data is not measured where one lacks it" in n for n in data.recording.notes)


def test_channels_that_were_of_two_streams_go_on_in_none_of_them(tmp_path: Path) -> None:
    """a and b had other numbers of samples, and are counted together in the next packet."""
    heading = packet(["a", "b"], x="X_Value\ta\tb").replace("Samples\t3\t3", "Samples\t3\t2")
    behind = packet(["a", "b"], x="X_Value\ta\tb", start="09:00:00,0")
    data = read(tmp_path, head("No", "Yes") + heading + "\t1\t5\n\t2\t6\n\t3\t\n" + behind + "\t1\t2\n\t3\t4\n\t5\t6\n")
    np.testing.assert_array_equal(data.values["data@3", "b"], [2, 4, 6])


def test_appended_rows_are_kept_whatever_the_heading_announced(tmp_path: Path) -> None:
    """One heading, then rows of many writes; the channels of a scan start microseconds apart."""
    heading = packet(["a", "b"], x="X_Value\ta\tb").replace(
        "Time\t08:00:00,0\t08:00:00,0", "Time\t08:00:00,000014\t08:00:00,0"
    )
    data = read(tmp_path, head("No") + heading + "\t1\t2\n" * 50)
    assert data.t_ns["data"].size == 50
    assert data.losses == ()


def test_channels_with_fewer_samples_are_streams_of_their_own(tmp_path: Path) -> None:
    heading = packet(["a", "b"], x="X_Value\ta\tb").replace("Samples\t3\t3", "Samples\t3\t2")
    data = read(tmp_path, head("No", "Yes") + heading + "\t1\t5\n\t2\t6\n\t3\t\n")
    np.testing.assert_array_equal(data.values["data", "a"], [1, 2, 3])
    np.testing.assert_array_equal(data.values["data@2", "b"], [5, 6])


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
