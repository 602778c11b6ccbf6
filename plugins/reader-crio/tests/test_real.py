"""Files that LabVIEW and a cRIO wrote, against npTDMS and against what stands in them."""

from __future__ import annotations

from pathlib import Path

import numpy as np
import pytest
from thermodata_reader_crio import Reader

from thermodata.calibration.scaling import apply_scaling
from thermodata.plugin import Source
from thermodata.reader import claims
from thermodata.testing.reader import load

DATA = Path(__file__).parents[4] / "shared" / "data"
pytestmark = pytest.mark.skipif(not (DATA / "tdms").is_dir(), reason="the folder of real files is not there")


@pytest.mark.parametrize(("name", "scaled"), [("test_4_DUT_18", 3), ("DAQ-sim", 3), ("example", 0)])
def test_raw_values_and_their_scaling_give_what_nptdms_gives(name: str, scaled: int) -> None:
    from nptdms import TdmsFile

    path = DATA / "tdms" / f"{name}.tdms"
    data = load(Reader(), path, Source())
    compared = 0
    for signal in data.recording.signals:
        group, channel = signal.name.split("/")
        ours = apply_scaling(signal.scaling, data.values[signal.stream, signal.name])
        np.testing.assert_array_equal(ours, TdmsFile.read(str(path))[group][channel][:])
        compared += signal.scaling is not None or "scaled_by_reader" in signal.properties
    assert compared == scaled
    assert data.recording.complete is not False
    assert data.losses == ()


def test_the_heater_test_has_its_time_and_units() -> None:
    data = load(Reader(), DATA / "tdms" / "test_4_DUT_18.tdms", Source())
    (stream,) = data.t_ns
    assert data.t_ns[stream].size == 103_330
    assert set(np.diff(data.t_ns[stream]).tolist()) == {10_000_000}
    assert int(data.t_ns[stream][0]) // 1_000_000 == int(np.datetime64("2020-11-19T13:23:27.643", "ms").astype(int))
    assert [s.unit for s in data.recording.signals] == ["Volts", "Deg C", "Deg C"]
    assert data.recording.signals[0].dtype == "int32"


@pytest.mark.parametrize(
    ("name", "rows", "first"),
    [
        ("short", 10, {"Excitation (Trigger)": 0.914018}),
        ("no_decimal_separator", 4, {"ax": -0.008807, "az": 0.021503}),
        ("long_single_header_multi_ch", 16384, {"F": 0.05253}),
        ("with_comments", 9, {"Temperatura (°C)": 5.479238}),
    ],
)
def test_lvm(name: str, rows: int, first: dict[str, float]) -> None:
    path = DATA / "lvm" / f"{name}.lvm"
    data = load(Reader(), path, Source(timezone="Europe/Ljubljana"))
    assert data.t_ns["data"].size == rows
    assert {k: data.values["data", k][0] for k in first} == first
    assert list(claims(path)) == ["crio"]
    assert data.losses == ()


def test_the_comment_column_is_text() -> None:
    data = load(Reader(), DATA / "lvm" / "with_comments.lvm", Source(timezone="America/Sao_Paulo"))
    assert list(data.values["data", "Comment"]).count("LOST COMMUNICATION") == 3
