"""LVM files with several headings: what later ones say of order, unit and start."""

from __future__ import annotations

from pathlib import Path

import numpy as np
import pytest

from thermodata.schema.flag import Flag

from .lvm_files import head, packet, read


def reordered(*units: tuple[str, str], names: tuple[str, str] = ("b", "a")) -> str:
    """Three packets of two rows of a and b; the second names them in another order."""
    parts = []
    for k, (said, rows, own) in enumerate(
        zip(
            (("a", "b"), names, ("a", "b")),
            ("\t1\t20\n\t2\t21\n", "\t22\t3\n\t23\t4\n", "\t5\t24\n\t6\t25\n"),
            units,
            strict=True,
        )
    ):
        heading = packet(list(said), start=f"08:00:0{k},0", x="X_Value\t" + "\t".join(said))
        heading = heading.replace("Samples\t3\t3", "Samples\t2\t2")
        parts.append(heading.replace("Y_Unit_Label\tV\tV", "Y_Unit_Label\t" + "\t".join(own)) + rows)
    return head("No", "Yes") + "".join(parts)


def test_channels_in_another_order_are_the_same(tmp_path: Path) -> None:
    data = read(tmp_path, reordered(("mm", "Deg C"), ("Deg C", "mm"), ("mm", "Deg C")))
    assert not data.losses
    assert list(data.t_ns) == ["data"]
    assert data.values["data", "a"].tolist() == [1, 2, 3, 4, 5, 6]
    assert data.values["data", "b"].tolist() == [20, 21, 22, 23, 24, 25]


def test_a_later_unit_is_converted_to_the_first(tmp_path: Path) -> None:
    data = read(tmp_path, reordered(("mm", "Deg C"), ("Deg C", "mm"), ("um", "Deg F")))
    assert not data.losses
    assert [s.unit for s in data.recording.signals[:2]] == ["mm", "Deg C"]
    np.testing.assert_allclose(data.values["data", "a"], [1, 2, 3, 4, 0.005, 0.006])
    np.testing.assert_allclose(data.values["data", "b"], [20, 21, 22, 23, -40 / 9, -35 / 9], atol=1e-9)
    said = [n for n in data.recording.notes if "its unit changes" in n]
    assert len(said) == 2
    assert all(n.endswith(": converted") for n in said)


def test_a_later_unit_of_another_quantity_leaves_the_channel_out_from_there(tmp_path: Path) -> None:
    data = read(tmp_path, reordered(("mm", "V"), ("V", "mm"), ("V", "")))
    (loss,) = data.losses
    assert loss.reason == "a: its unit changes from 'mm' to 'V': left out from there; split the file there"
    np.testing.assert_array_equal(data.values["data", "a"], [1, 2, 3, 4, np.nan, np.nan])
    assert data.values["data", "b"].tolist() == [20, 21, 22, 23, 24, 25], "a heading without a unit means the same"
    assert data.flags["data", "a"].tolist() == [0, 0, 0, 0, Flag.NOT_MEASURING, Flag.NOT_MEASURING]


@pytest.mark.parametrize(
    "starts",
    [
        ("00:30", "01:00", "01:30", "02:00", "02:30", "02:00", "02:30", "03:00"),
        ("01:10", "02:10", "02:10", "03:10", "04:10", "05:10"),
        ("01:50", "02:00", "02:10", "02:20", "02:30", "02:40", "02:50", "02:05", "02:15", "03:00"),  # one is lost
    ],
)
def test_packets_through_the_end_of_summer_time_follow_each_other(tmp_path: Path, starts: tuple[str, ...]) -> None:
    """Each heading tells local time; together they tell the pass of the hour that repeats."""
    packets = [packet(["a"], x="X_Value\ta", start=f"{s}:00,0") + "0,0\t1\n0,5\t2\n1,0\t3\n" for s in starts]
    text = (head("One", "Yes") + "".join(packets)).replace("2026/03/01", "2026/10/25")
    data = read(tmp_path, text)
    assert not data.losses
    local = np.array([np.datetime64(f"2026-10-25T{s}") for s in starts])
    later = 1 + int(np.argmax(np.diff(local.astype(np.int64)) <= 0))
    utc = local - np.where(np.arange(len(starts)) < later, 2, 1) * np.timedelta64(1, "h")
    assert data.t_ns["data"][::3].tolist() == utc.astype("datetime64[ns]").astype(np.int64).tolist()
    assert data.recording.start_ns == data.t_ns["data"][0]
    (said,) = [n for n in data.recording.notes if "the hour that repeats" in n]
    assert "starts in its first pass" in said
    assert "guess" not in said


def dated(file: str, heading: str) -> str:
    text = head("No") + packet(["a", "b"], x="X_Value\ta\tb")
    before, behind = text.split("Channels", 1)
    return (
        f"{before.replace('2026/03/01', file)}Channels{behind.replace('2026/03/01', heading)}"
        "\t1,5\t-2\n\t1,25\t3\n\t1\t4\n"
    )


@pytest.mark.parametrize("zero", ["1904/01/01", "1903/12/31", "1904/01/02"])
def test_a_heading_at_the_zero_of_labview_starts_with_its_file(tmp_path: Path, zero: str) -> None:
    data = read(tmp_path, dated("2026/03/01", zero))
    assert data.recording.start_ns == np.datetime64("2026-03-01T07:00:00", "ns").astype(np.int64)
    assert any("LabVIEW's zero" in note and "the file's is taken" in note for note in data.recording.notes)


def test_a_file_that_nobody_dated_has_no_start(tmp_path: Path) -> None:
    data = read(tmp_path, dated("1904/01/01", "1904/01/01"))
    assert (data.recording.clock, data.recording.start_ns) == ("relative", None)
    assert data.t_ns["data"].tolist() == [0, 500_000_000, 1_000_000_000]
    assert any("times count from the start of the rows" in note for note in data.recording.notes)
