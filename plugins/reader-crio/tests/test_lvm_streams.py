"""Which channels of an LVM file are of one stream, and which packets go on in it."""

from __future__ import annotations

from pathlib import Path

import numpy as np
import pytest

from thermodata.schema.flag import Flag

from .lvm_files import START, S, head, packet, read


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


def test_channels_with_fewer_samples_are_streams_of_their_own(tmp_path: Path) -> None:
    heading = packet(["a", "b"], x="X_Value\ta\tb").replace("Samples\t3\t3", "Samples\t3\t2")
    data = read(tmp_path, head("No", "Yes") + heading + "\t1\t5\n\t2\t6\n\t3\t\n")
    np.testing.assert_array_equal(data.values["data", "a"], [1, 2, 3])
    np.testing.assert_array_equal(data.values["data@2", "b"], [5, 6])
