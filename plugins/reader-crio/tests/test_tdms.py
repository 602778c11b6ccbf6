"""TDMS: layouts, streams, times and scalings, against bytes whose content is known."""

from __future__ import annotations

from pathlib import Path
from typing import Any

import numpy as np
import pytest
from thermodata_reader_crio import Reader

from thermodata.errors import FormatError
from thermodata.plugin import Recording, Source
from thermodata.testing.reader import Data, load

START = np.datetime64("2026-03-01T08:00:00", "ns").astype(np.int64).item()
S = 1_000_000_000


def write(tmp_path: Path, *segments: bytes) -> Path:
    path = tmp_path / "x.tdms"
    path.write_bytes(b"".join(segments))
    return path


def read(path: Path, **options: Any) -> Data:
    return load(Reader(), path, Source(options=options))


def described(path: Path) -> Recording:
    return Reader().describe(path, Source())


@pytest.mark.parametrize("order", ["<", ">"])
@pytest.mark.parametrize("interleaved", [False, True])
def test_both_byte_orders_both_layouts_and_segments_that_only_go_on(
    tmp_path: Path,
    tdms_in,
    order: str,  # type: ignore[no-untyped-def]
    interleaved: bool,
) -> None:
    b = tdms_in(order)
    z, y = (np.arange(9) / 4).astype(order + "f8"), np.arange(9, dtype=order + "i2")

    def raw(i: int) -> bytes:
        part_z, part_y = z[3 * i : 3 * i + 3], y[3 * i : 3 * i + 3]
        if interleaved:
            return b"".join(part_z[k : k + 1].tobytes() + part_y[k : k + 1].tobytes() for k in range(3))
        return part_z.tobytes() + part_y.tobytes()

    objects = [
        b.channel("Eddy", "Z", "float64", 3, b.wave(unit_string="V")),
        b.channel("Eddy", "Y", "int16", 3, b.wave()),
    ]
    path = write(
        tmp_path,
        b.segment(objects, raw(0), interleaved=interleaved),
        b.segment(None, raw(1) + raw(2), interleaved=interleaved),
    )
    data = read(path)
    assert [(s.name, s.stream, s.unit, s.dtype) for s in data.recording.signals] == [
        ("Eddy/Z", "Eddy", "V", "float64"),
        ("Eddy/Y", "Eddy", None, "int16"),
    ]
    np.testing.assert_array_equal(data.values["Eddy", "Eddy/Z"], np.arange(9) / 4)
    np.testing.assert_array_equal(data.values["Eddy", "Eddy/Y"], np.arange(9))
    np.testing.assert_array_equal(data.t_ns["Eddy"], START + np.arange(9) * S // 10)
    assert data.recording.start_ns == START
    assert data.recording.complete is None  # nothing says that a third segment never was


def test_times_do_not_drift_over_a_day(tmp_path: Path, tdms) -> None:  # type: ignore[no-untyped-def]
    n = 864_001
    path = write(tmp_path, tdms.segment([tdms.channel("a", "x", "uint8", n, tdms.wave(step=0.1))], bytes(n)))
    t = read(path).t_ns["a"]
    assert t[-1] - t[0] == 86_400 * S
    assert set(np.diff(t).tolist()) == {S // 10}


def test_a_rate_that_is_no_whole_interval_stays_exact(tmp_path: Path, tdms) -> None:  # type: ignore[no-untyped-def]
    n = 51_200 * 3 + 1
    path = write(tmp_path, tdms.segment([tdms.channel("a", "x", "uint8", n, tdms.wave(step=1 / 51_200))], bytes(n)))
    t = read(path).t_ns["a"]
    assert t[51_200] - t[0] == S
    assert t[-1] - t[0] == 3 * S


def test_other_rates_and_lengths_of_a_group_are_streams_of_their_own(tmp_path: Path, tdms) -> None:  # type: ignore[no-untyped-def]
    names = [
        ("a", 4, 0.1, "2026-03-01T08:00:00"),
        ("b", 4, 0.1, "2026-03-01T08:00:00"),
        ("slow", 4, 1.0, "2026-03-01T08:00:00"),
        ("short", 2, 0.1, "2026-03-01T08:00:00"),
        ("late", 4, 0.1, "2026-03-01T08:00:01"),
    ]
    objects = [tdms.channel("G", name, "float64", n, tdms.wave(start, step)) for name, n, step, start in names]
    path = write(tmp_path, tdms.segment(objects, bytes(8 * sum(n for _, n, _, _ in names))))
    assert {s.name: s.stream for s in described(path).signals} == {
        "G/a": "G",
        "G/b": "G",
        "G/slow": "G@2",
        "G/short": "G@3",
        "G/late": "G@4",
    }
    assert read(path).t_ns["G@4"][0] == START + S


def test_channels_of_one_scan_are_one_stream_with_a_note(tmp_path: Path, tdms) -> None:  # type: ignore[no-untyped-def]
    objects = [
        tdms.channel("G", name, "float64", 2, tdms.wave(f"2026-03-01T08:00:00.0000{us}"))
        for name, us in (("a", "00"), ("b", "14"))
    ]
    path = write(tmp_path, tdms.segment(objects, bytes(32)))
    said = described(path)
    assert {s.stream for s in said.signals} == {"G"}
    assert "one scan" in said.notes[0]


def test_a_start_written_anew_starts_a_new_piece(tmp_path: Path, tdms) -> None:  # type: ignore[no-untyped-def]
    def part(start: str) -> bytes:
        return tdms.segment([tdms.channel("G", "a", "float64", 2, tdms.wave(start, 1.0))], bytes(16))

    path = write(tmp_path, part("2026-03-01T08:00:00"), part("2026-03-01T09:00:00"))
    np.testing.assert_array_equal((read(path).t_ns["G"] - START) // S, [0, 1, 3600, 3601])


def test_time_channels_and_none_at_all(tmp_path: Path, tdms) -> None:  # type: ignore[no-untyped-def]
    t = np.array([100.0, 100.5, 102.0])
    objects = [tdms.channel("G", "Time", "float64", 3, {"unit_string": "s"}), tdms.channel("G", "T", "float64", 3)]
    data = read(write(tmp_path, tdms.segment(objects, t.tobytes() + bytes(24))))
    assert data.recording.clock == "relative"
    assert [s.name for s in data.recording.signals] == ["G/T"]
    np.testing.assert_array_equal(data.t_ns["G"], [100_000_000_000, 100_500_000_000, 102_000_000_000])
    path = write(tmp_path, tdms.segment([tdms.channel("G", "T", "float64", 3)], bytes(24)))
    assert "has no time" in described(path).notes[0]
    np.testing.assert_array_equal(read(path, increment="0.5 s").t_ns["G"], [0, S // 2, S])


LINEAR = {
    "NI_Scaling_Status": "unscaled",
    "NI_Number_Of_Scales": 1,
    "NI_Scale[0]_Scale_Type": "Linear",
    "NI_Scale[0]_Linear_Slope": 0.5,
    "NI_Scale[0]_Linear_Y_Intercept": 1.0,
    "NI_Scale[0]_Linear_Input_Source": 0xFFFFFFFF,
}


def scaled_file(tmp_path: Path, b: Any, **changed: Any) -> Path:
    return write(
        tmp_path,
        b.segment(
            [b.channel("G", "a", "int16", 2, {**b.wave(), **LINEAR, **changed})], np.array([3, -4], "<i2").tobytes()
        ),
    )


def test_raw_numbers_are_kept_and_their_scaling_is_declared(tmp_path: Path, tdms) -> None:  # type: ignore[no-untyped-def]
    data = read(scaled_file(tmp_path, tdms))
    signal = data.recording.signals[0]
    np.testing.assert_array_equal(data.values["G", "G/a"], np.array([3, -4], np.int16))
    assert signal.scaling is not None
    assert signal.scaling.kind == "ni"
    assert dict(signal.scaling.properties) == LINEAR


def test_what_was_written_scaled_is_not_scaled_again(tmp_path: Path, tdms) -> None:  # type: ignore[no-untyped-def]
    assert described(scaled_file(tmp_path, tdms, NI_Scaling_Status="scaled")).signals[0].scaling is None


def test_an_unknown_scale_is_refused_unless_declared_raw(tmp_path: Path, tdms) -> None:  # type: ignore[no-untyped-def]
    path = scaled_file(tmp_path, tdms, **{"NI_Scale[0]_Scale_Type": "Exponential"})
    with pytest.raises(FormatError) as caught:
        described(path)
    assert "unknown type 'Exponential'" in caught.value.what
    assert "x.tdms G/a" in (caught.value.where or "")
    said = Reader().describe(path, Source(options={"unscaled": ["G/a"]}))
    assert said.signals[0].scaling is None


def test_daqmx_buffers_one_raw_number_and_several(tmp_path: Path, tdms) -> None:  # type: ignore[no-untyped-def]
    rows = np.zeros(4, np.dtype([("u", "<i2"), ("cold", "<i4")]))
    rows["u"], rows["cold"] = [1, -2, 3, -4], [10, 20, 30, 40]
    one = {
        "NI_Scaling_Status": "unscaled",
        "NI_Number_Of_Scales": 2,
        "NI_Scale[1]_Scale_Type": "Linear",
        "NI_Scale[1]_Linear_Slope": 0.25,
        "NI_Scale[1]_Linear_Y_Intercept": 0.0,
        "NI_Scale[1]_Linear_Input_Source": 0,
    }
    two = {
        "NI_Scaling_Status": "unscaled",
        "NI_Number_Of_Scales": 3,
        "NI_Scale[2]_Scale_Type": "Add",
        "NI_Scale[2]_Add_Left_Operand_Input_Source": 0,
        "NI_Scale[2]_Add_Right_Operand_Input_Source": 1,
    }
    objects = [
        tdms.channel("G", "U", None, 4, {**tdms.wave(), **one}, tdms.daqmx_index(4, [(3, 0, 0, 0)], [6])),
        tdms.channel("G", "T", None, 4, {**tdms.wave(), **two}, tdms.daqmx_index(4, [(3, 0, 0, 0), (5, 0, 2, 1)], [6])),
    ]
    data = read(write(tmp_path, tdms.segment(objects, rows.tobytes(), daqmx=True)))
    np.testing.assert_array_equal(data.values["G", "G/U"], np.array([1, -2, 3, -4], np.int16))
    np.testing.assert_array_equal(data.values["G", "G/T"], [11.0, 18.0, 33.0, 36.0])
    assert data.recording.signals[0].scaling is not None
    assert data.recording.signals[1].scaling is None
    assert "joins 2 raw numbers" in data.recording.notes[0]


def test_a_stale_index_beside_the_file_is_not_read(tmp_path: Path, tdms) -> None:  # type: ignore[no-untyped-def]
    path = write(tmp_path, tdms.segment([tdms.channel("G", "a", "uint8", 3, tdms.wave())], b"abc"))
    before = read(path)
    (tmp_path / "x.tdms_index").write_bytes(b"TDSh" + bytes(100))
    np.testing.assert_array_equal(read(path).values["G", "G/a"], before.values["G", "G/a"])


def test_group_names_with_quotes_and_letters_of_any_language(tmp_path: Path, tdms) -> None:  # type: ignore[no-untyped-def]
    path = write(tmp_path, tdms.segment([tdms.channel("O''Neil", "ložisko 1", "uint8", 1, tdms.wave())], b"a"))
    assert described(path).signals[0].name == "O'Neil/ložisko 1"


def test_random_files_equal_what_nptdms_reads(tmp_path: Path) -> None:
    from nptdms import ChannelObject, TdmsFile, TdmsWriter

    rng = np.random.default_rng(7)
    for number in range(15):
        path = tmp_path / f"{number}.tdms"
        dtypes = rng.choice(["f8", "f4", "i2", "i4", "u1", "U"], rng.integers(1, 6))
        with TdmsWriter(str(path)) as writer:
            for _ in range(rng.integers(1, 8)):
                n = int(rng.integers(1, 30))
                chosen = [k for k in range(dtypes.size) if rng.random() < 0.8] or [0]
                writer.write_segment(
                    [
                        ChannelObject(
                            f"g{k % 2}",
                            f"c{k}",
                            np.array([f"ř{j}" for j in range(n)])
                            if dtypes[k] == "U"
                            else rng.integers(0, 200, n).astype(dtypes[k]),
                        )
                        for k in chosen
                    ]
                )
        data = read(path, block_rows=int(rng.integers(1, 20)))
        peer = TdmsFile.read(str(path))
        seen = {name: values for (_, name), values in data.values.items()}
        for group in peer.groups():
            for channel in group.channels():
                np.testing.assert_array_equal(seen[f"{group.name}/{channel.name}"], channel[:], err_msg=str(path))
