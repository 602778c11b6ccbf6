"""LVM text files."""

from __future__ import annotations

from pathlib import Path

import numpy as np
import pytest
from thermodata_reader_crio import Reader

from thermodata.errors import FormatError
from thermodata.plugin import Source
from thermodata.testing.reader import Data, load

S = 1_000_000_000
START = np.datetime64("2026-03-01T07:00:00", "ns").astype(np.int64).item()   # 08:00 in Prague
PRAGUE = Source(timezone="Europe/Prague")


def head(columns: str, several: str = "No", decimal: str = "Decimal_Separator\t,\n") -> str:
    return (f"LabVIEW Measurement\t\nWriter_Version\t2\nSeparator\tTab\n{decimal}Multi_Headings\t{several}\n"
            f"X_Columns\t{columns}\nTime_Pref\tAbsolute\nDate\t2026/03/01\nTime\t08:00:00,0\n"
            "***End_of_Header***\t\n\t\n")


def packet(names: list[str], *, start: str = "08:00:00,0", delta: str = "0,5", x: str = "", gap: str = "\t") -> str:
    n = len(names)

    def row(key: str, value: str) -> str:
        return key + "".join(f"{gap}{value}" if i else f"\t{value}" for i in range(n)) + "\t\n"

    return (f"Channels\t{n}\n" + row("Samples", "3") + row("Date", "2026/03/01") + row("Time", start)
            + row("Y_Unit_Label", "V") + row("X0", "0,0E+0") + row("Delta_X", delta)
            + "***End_of_Header***\t\n" + x + "\tComment\n")


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
    text = head("One", "Yes") + packet(["a"], x="X_Value\ta") + "0,0\t1\n0,5\t2\n" \
        + packet(["a"], x="X_Value\ta", start="09:00:00,25") + "0,0\t3\n0,5\t4\n"
    data = read(tmp_path, text)
    np.testing.assert_array_equal(data.values["data", "a"], [1, 2, 3, 4])
    np.testing.assert_array_equal(data.t_ns["data"] - START, [0, S // 2, 3600 * S + S // 4, 3600 * S + 3 * S // 4])


def test_channels_with_x_columns_of_their_own(tmp_path: Path) -> None:
    heading = packet(["a", "b"], x="X_Value\ta\tX_Value\tb", gap="\t\t")
    text = head("Multi") + heading + "0,0\t1\t0,0\t5\n0,5\t2\t0,5\t6\n"
    data = read(tmp_path, text)
    np.testing.assert_array_equal(data.values["data", "b"], [5, 6])
    assert {s.unit for s in data.recording.signals if s.dtype == "float64"} == {"V"}
    other = text.replace("0,5\t6", "0,7\t6")
    with pytest.raises(FormatError, match="different X columns"):
        read(tmp_path, other)


def test_x_values_in_seconds_since_1904_are_absolute(tmp_path: Path) -> None:
    x = START // S + 2_082_844_800
    text = head("One") + packet(["a"], x="X_Value\ta") + f"{x},0\t1\n{x + 1},0\t2\n"
    np.testing.assert_array_equal(read(tmp_path, text).t_ns["data"], [START, START + S])


def test_a_cut_last_line_is_a_loss_and_not_a_value(tmp_path: Path) -> None:
    data = read(tmp_path, head("No") + packet(["a"], x="X_Value\ta") + "\t12,53\n\t12,5")
    np.testing.assert_array_equal(data.values["data", "a"], [12.53])
    assert "line 22" in data.losses[0].where


def test_a_line_that_is_no_number_is_reported(tmp_path: Path) -> None:
    data = read(tmp_path, head("No") + packet(["a"], x="X_Value\ta") + "\t1,0\n\txx\n\t3,0\n")
    np.testing.assert_array_equal(data.values["data", "a"], [1.0, 3.0])
    assert data.losses[0].reason == "1 lines that are no numbers"


def test_a_header_without_end_is_refused(tmp_path: Path) -> None:
    with pytest.raises(FormatError, match="ends inside its header"):
        read(tmp_path, "LabVIEW Measurement\t\nWriter_Version\t2\n")
