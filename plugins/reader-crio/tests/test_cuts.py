"""TDMS files that a power cut, a full disk or a bad copy left behind."""

from __future__ import annotations

from pathlib import Path

import numpy as np
import pytest
from thermodata_reader_crio import Reader

from thermodata.errors import FormatError
from thermodata.plugin import Source
from thermodata.schema.flag import Flag
from thermodata.testing.reader import Data, load

START = np.datetime64("2026-03-01T08:00:00", "ns").astype(np.int64).item()
S = 1_000_000_000
ROWS = 10


def parts(b) -> list[bytes]:  # type: ignore[no-untyped-def]
    """Three segments of 10 rows of two float channels, metadata in each, at 1 Hz."""

    def raw(i: int) -> bytes:
        rows = np.arange(ROWS * i, ROWS * (i + 1), dtype=float)
        return rows.tobytes() + (-rows).tobytes()

    objects = [b.channel("G", name, "float64", ROWS, b.wave(step=1.0)) for name in ("a", "b")]
    return [b.segment(objects, raw(i)) for i in range(3)]


def read(tmp_path: Path, content: bytes) -> Data:
    path = tmp_path / "x.tdms"
    path.write_bytes(content)
    return load(Reader(), path, Source())


@pytest.mark.parametrize(
    ("keep", "reason"),
    [(3, "inside a lead-in"), (27, "inside a lead-in"), (40, "inside metadata"), (100, "inside metadata")],
)
def test_cut_in_lead_in_or_metadata_of_a_later_segment(tmp_path: Path, tdms, keep: int, reason: str) -> None:  # type: ignore[no-untyped-def]
    segments = parts(tdms)
    data = read(tmp_path, segments[0] + segments[1] + segments[2][:keep])
    assert data.t_ns["G"].size == 2 * ROWS
    assert data.recording.complete is False
    (loss,) = data.losses
    assert reason in loss.reason
    assert loss.where == f"x.tdms byte {len(segments[0]) * 2}"
    assert loss.from_ns == START + 19 * S


def test_cut_in_raw_data_keeps_every_value_that_is_there(tmp_path: Path, tdms) -> None:  # type: ignore[no-untyped-def]
    segments = parts(tdms)
    whole = b"".join(segments)
    data = read(tmp_path, whole[: -8 * 6 - 3])  # of the last 10 values of b, 3 and a half are left
    a, b = data.values["G", "G/a"], data.values["G", "G/b"]
    np.testing.assert_array_equal(a, np.arange(30))
    np.testing.assert_array_equal(b[:23], -np.arange(23))
    assert np.isnan(b[23:]).all()
    np.testing.assert_array_equal(data.flags["G", "G/b"][21:25], [0, 0, Flag.NOT_MEASURING, Flag.NOT_MEASURING])
    assert not data.flags["G", "G/a"].any()
    (loss,) = data.losses
    assert loss.fraction == pytest.approx(51 / len(whole))
    assert "raw data" in loss.reason


def test_a_contiguous_file_cut_long_before_its_end_says_until_when_it_would_have_gone(tmp_path: Path, tdms) -> None:  # type: ignore[no-untyped-def]
    objects = [tdms.channel("G", "a", "int16", 1000, tdms.wave(step=1.0))]
    whole = tdms.segment(objects, np.arange(1000, dtype="<i2").tobytes())
    data = read(tmp_path, whole[:-1200])
    np.testing.assert_array_equal(data.values["G", "G/a"], np.arange(400))
    (loss,) = data.losses
    assert (loss.from_ns, loss.to_ns) == (START + 399 * S, START + 999 * S)


def test_a_logger_that_died_leaves_an_unknown_end(tmp_path: Path, tdms) -> None:  # type: ignore[no-untyped-def]
    objects = [tdms.channel("G", name, "float64", 4, tdms.wave(step=1.0)) for name in ("a", "b")]
    rows = np.arange(8.0)
    chunk = rows[:4].tobytes() + (-rows[:4]).tobytes()
    data = read(tmp_path, tdms.segment(objects, chunk + rows[4:].tobytes(), to_next=tdms.UNKNOWN_END))
    np.testing.assert_array_equal(data.values["G", "G/a"], rows)
    assert np.isnan(data.values["G", "G/b"][4:]).all()
    assert data.recording.complete is False
    assert data.losses


def test_interleaved_rows_are_cut_whole(tmp_path: Path, tdms) -> None:  # type: ignore[no-untyped-def]
    objects = [tdms.channel("G", name, "int16", 5, tdms.wave()) for name in ("a", "b")]
    whole = tdms.segment(objects, np.arange(10, dtype="<i2").tobytes(), interleaved=True)
    data = read(tmp_path, whole[:-5])
    np.testing.assert_array_equal(data.values["G", "G/a"], [0, 2, 4])
    np.testing.assert_array_equal(data.values["G", "G/b"], [1, 3, 5])


def test_after_a_destroyed_segment_reading_goes_on_at_the_next_with_times_in_their_place(tmp_path: Path, tdms) -> None:  # type: ignore[no-untyped-def]
    segments = parts(tdms)
    data = read(tmp_path, segments[0] + b"\0" * len(segments[1]) + segments[2])
    np.testing.assert_array_equal(data.values["G", "G/a"], [*range(ROWS), *range(2 * ROWS, 3 * ROWS)])
    np.testing.assert_array_equal((data.t_ns["G"] - START) // S, [*range(ROWS), *range(2 * ROWS, 3 * ROWS)])
    (loss,) = data.losses
    assert "no lead-in" in loss.reason
    assert loss.fraction == pytest.approx(1 / 3)
    assert (loss.from_ns, loss.to_ns) == (START + 9 * S, START + 20 * S)
    assert data.recording.complete is False


def test_times_behind_a_hole_of_unknown_length_are_in_doubt(tmp_path: Path, tdms) -> None:  # type: ignore[no-untyped-def]
    segments = parts(tdms)
    data = read(tmp_path, segments[0] + b"\0" * 77 + segments[2])
    assert data.t_ns["G"].size == 2 * ROWS
    assert (data.flags["G", "G/b"] == [0] * ROWS + [Flag.CLOCK_SUSPECT] * ROWS).all()
    assert "in doubt" in data.losses[0].reason


def test_a_segment_that_reuses_a_lost_list_of_objects_is_not_read(tmp_path: Path, tdms) -> None:  # type: ignore[no-untyped-def]
    first = tdms.segment([tdms.channel("G", "a", "float64", 4, tdms.wave(step=1.0))], bytes(32))
    other = tdms.segment([tdms.channel("G", "b", "float64", 7, tdms.wave(step=1.0))], bytes(56))
    reuse = tdms.segment(None, np.ones(7).tobytes())
    alone = tdms.segment([tdms.channel("G", "a", "float64", 4)], np.full(4, 2.0).tobytes())
    data = read(tmp_path, first + b"XXXX" + other[4:] + reuse + alone)
    np.testing.assert_array_equal(data.values["G", "G/a"], [0] * 4 + [2] * 4)
    assert "G/b" not in {name for _, name in data.values}
    assert "reuse a list of objects that was lost" in data.losses[0].reason


@pytest.mark.parametrize("wrong", [8, 2**63, "unknown"])
def test_a_wrong_length_does_not_pass_the_next_segment_for_data(tmp_path: Path, tdms, wrong: int | str) -> None:  # type: ignore[no-untyped-def]
    segments = parts(tdms)
    length = tdms.UNKNOWN_END if wrong == "unknown" else len(segments[1]) - 28 + int(wrong)
    damaged = bytearray(segments[1])
    damaged[12:20] = tdms.pack("Q", length)
    data = read(tmp_path, segments[0] + bytes(damaged) + segments[2])
    np.testing.assert_array_equal(data.values["G", "G/b"], -np.arange(3 * ROWS))
    assert any("length is wrong" in note for note in data.recording.notes)


@pytest.mark.parametrize("keep", [0, 4, 20, 28, 60])
def test_a_first_segment_that_cannot_be_read_is_refused_with_its_place(tmp_path: Path, tdms, keep: int) -> None:  # type: ignore[no-untyped-def]
    with pytest.raises(FormatError, match="byte 0"):
        read(tmp_path, parts(tdms)[0][:keep])


def test_impossible_sizes_are_damage_and_take_no_memory(tmp_path: Path, tdms) -> None:  # type: ignore[no-untyped-def]
    huge = tdms.channel("G", "a", "float64", 2**60, tdms.wave())
    with pytest.raises(FormatError, match="chunk of"):
        read(tmp_path, tdms.segment([huge], bytes(64)))
    large = tdms.channel("G", "a", "float64", 2**40, tdms.wave())
    assert read(tmp_path, tdms.segment([large], bytes(64), to_next=2**43)).t_ns["G"].size == 8


def test_behind_a_segment_whose_data_no_channel_claims_times_are_in_doubt(tmp_path: Path, tdms) -> None:  # type: ignore[no-untyped-def]
    good = parts(tdms)
    nothing = [tdms.channel("G", name, None, ROWS) for name in ("a", "b")]
    raw = b"\1" * (len(good[0]) - len(tdms.segment(nothing, b"")))
    data = read(tmp_path, good[0] + tdms.segment(nothing, raw) + good[2])  # as long as its neighbours
    np.testing.assert_array_equal(data.values["G", "G/a"], [*range(ROWS), *range(2 * ROWS, 3 * ROWS)])
    np.testing.assert_array_equal(data.flags["G", "G/a"], [0] * ROWS + [Flag.CLOCK_SUSPECT] * ROWS)
    (loss,) = data.losses
    assert "how many values is not known" in loss.reason
    assert loss.to_ns is None
