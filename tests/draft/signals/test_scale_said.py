"""A scale that a file states and nobody applies is asked, with the unit that has it."""

from __future__ import annotations

from collections.abc import Callable
from pathlib import Path

import numpy as np
import pyarrow as pa
import pyarrow.parquet as pq
import pytest
import scipy.io
from nptdms import ChannelObject, RootObject, TdmsWriter

from tests.commands import Say
from thermodata.draft.signals.guess import guess_of
from thermodata.draft.signals.told_units.scale_said import with_scale_asked
from thermodata.plugin import Scaling, Signal


@pytest.mark.parametrize(
    ("head", "asked"),
    [
        ("Channel;1;2\nName;T_front;dZ\nUnit;degC;um\nGain;1;0.1\nDate/Time;CH1;CH2", "'Gain = 0.1'"),
        ("Name;T_front;dZ\nUnit;degC;um\nSlope;1;0.1\nDate/Time;CH1;CH2", "'Slope = 0.1'"),
        ("Kanal;CH1;CH2\nName;T_front;dZ\nEinheit;degC;um\nFaktor;1;0,1\nDatum/Zeit;CH1;CH2", "'Faktor = 0,1'"),
        ("# dZ: 1 digit = 0.1 um\nTime;T_front [degC];dZ [um]", "'1 digit = 0.1'"),
        ("Time;T_front [degC];dZ [um]\nScale;1;0.1", "'Scale = 0.1'"),
        ("# displacement counts 0.1 um\nTime;T_front [degC];dZ_um", "'1 count = 0.1'"),
        ("# dZ: 1 digit = 0.1 um\nTime;T_front [degC];dZ_um", "'1 digit = 0.1'"),
        ("# 0.1 um per digit\nTime;T_front [degC];dZ_um", "'1 digit = 0.1'"),
        ("# Inkremente zu 0,1 µm\nTime;T_front [degC];dZ [um]", "'1 Inkrement = 0,1'"),
    ],
)
def test_a_scale_of_the_head_is_asked_of_its_column_alone(tmp_path: Path, say: Say, head: str, asked: str) -> None:
    rows = [f"2026-03-12 08:{k:02d}:00;{20 + k / 7:.2f};{4 + 3 * k}" for k in range(60)]
    (tmp_path / "run1.csv").write_text("\n".join([head, *rows, ""]), encoding="utf-8")
    assert say("init", tmp_path).code in (0, 3)
    lines = (tmp_path / "campaign.yaml").read_text(encoding="utf-8").splitlines()
    told = [line for line in lines if f"the file says {asked}" in line]
    assert len(told) == 1
    assert "quantity: displacement" in told[0]
    assert 'unit: "0.1 um", instead_of: um' in told[0]


@pytest.mark.parametrize("head", ["# ADC 16 bits 10 V range", "# sample counts 200 s", "# counts 300"])
def test_a_head_that_says_no_scale_asks_none(tmp_path: Path, say: Say, head: str) -> None:
    rows = [f"2026-03-12 08:{k:02d}:00;{20 + k / 7:.2f};{4 + 3 * k}" for k in range(60)]
    text = "\n".join([head, "Time;T_front [degC];dZ_um", *rows, ""])
    (tmp_path / "run1.csv").write_text(text, encoding="utf-8")
    assert say("init", tmp_path).code in (0, 3)
    assert "the file says" not in (tmp_path / "campaign.yaml").read_text(encoding="utf-8")


N = 120
COUNTS = np.round(400 * (1 - np.exp(-np.arange(N) / 40))).astype(np.int16)
WARM = 20 + 9 * (1 - np.exp(-np.arange(N) / 60))


def _mat(folder: Path, **beside: object) -> None:
    own = {"time_s": np.arange(N) * 60.0, "T_front": WARM, "dZ": COUNTS, "dZ_unit": "um"}
    scipy.io.savemat(folder / "run1.mat", {k: v for k, v in {**own, **beside}.items() if v is not None})


def _parquet(folder: Path, of_column: dict[str, str], of_file: dict[str, str] | None = None) -> None:
    fields = [("t [s]", pa.float64(), {}), ("T_front", pa.float64(), {}), ("dZ", pa.int16(), of_column)]
    schema = pa.schema([pa.field(n, k, metadata=m or None) for n, k, m in fields], metadata=of_file)
    pq.write_table(pa.table([np.arange(N) * 60.0, WARM, COUNTS], schema=schema), folder / "run1.parquet")


def _tdms(folder: Path, **of_file: object) -> None:
    clock = {"wf_increment": 60.0, "wf_start_offset": 0.0, "wf_samples": N}
    channels = [("T_front", WARM, "degC"), ("dZ", COUNTS, "um")]
    own = [ChannelObject("Log", n, v, {**clock, "unit_string": u}) for n, v, u in channels]
    with TdmsWriter(folder / "run1.tdms") as file:
        file.write_segment([RootObject(of_file), *own])


def _named(values: object, names: object) -> dict[str, object]:
    return {"time_s": np.arange(N) * 60.0, "T_front": None, "dZ": None, "data": values, "names": names}


@pytest.mark.parametrize(
    ("write", "asked"),
    [
        (lambda f: _mat(f, dZ_gain=0.1), "dZ_gain"),
        (lambda f: _mat(f, scale_dZ=0.1, T_front_scale=1.0), "scale_dZ"),
        (lambda f: _mat(f, gain={"T_front": 1.0, "dZ": 0.1}), "gain/dZ"),
        (lambda f: _mat(f, cal={"dZ": {"factor": 0.1, "offset": 0.0}}), "cal/dZ/factor"),
        (lambda f: _mat(f, dZ={"data": COUNTS, "unit": "um", "time": np.arange(N) * 60.0, "gain": 0.1}), "gain"),
        (lambda f: _parquet(f, {"unit": "um", "scale_factor": "0.1"}), "scale_factor"),
        (lambda f: _parquet(f, {}, {"PANDAS_ATTRS": '{"units": {"dZ": "um"}, "scale": {"dZ": 0.1}}'}), "scale/dZ"),
        (lambda f: _tdms(f, dZ_gain=0.1, T_front_gain=1.0), "dZ_gain"),
    ],
)
def test_a_scale_beside_the_data_is_asked_of_the_signal_that_it_is_called_after(
    tmp_path: Path, say: Say, write: Callable[[Path], None], asked: str
) -> None:
    write(tmp_path)
    assert say("init", tmp_path).code in (0, 3)
    lines = (tmp_path / "campaign.yaml").read_text(encoding="utf-8").splitlines()
    (told,) = [line for line in lines if "the file says" in line]
    assert f"'{asked} = 0.1'" in told
    assert "dZ" in told.split(":")[0]
    assert 'unit: "0.1 um", instead_of: um' in told


def test_a_vector_of_gains_is_asked_of_the_columns_of_the_matrix_that_has_as_many(tmp_path: Path, say: Say) -> None:
    names, units = np.array(["T_front", "dZ"], object), np.array(["degC", "um"], object)
    values = np.column_stack([WARM, COUNTS])
    _mat(tmp_path, **_named(values, names), dZ_unit=None, units=units, gain=np.array([1.0, 0.1]))
    assert say("init", tmp_path).code in (0, 3)
    lines = (tmp_path / "campaign.yaml").read_text(encoding="utf-8").splitlines()
    (told,) = [line for line in lines if "the file says" in line]
    assert "'gain = 0.1'" in told
    assert told.strip().startswith("dZ:")


@pytest.mark.parametrize(
    "write",
    [
        lambda f: _mat(f, dZ_gain=1.0, T_front_offset=0.0, sample_gain=3.0, rig="B"),
        lambda f: _parquet(f, {"unit": "um", "scale_factor": "1", "add_offset": "0"}, {"T_rear.gain": "0.1"}),
        lambda f: _tdms(f, dZ_gain=1.0, T_rear_gain=0.1),
    ],
)
def test_a_scale_of_one_or_of_no_signal_of_the_file_is_not_asked(
    tmp_path: Path, say: Say, write: Callable[[Path], None]
) -> None:
    write(tmp_path)
    assert say("init", tmp_path).code in (0, 3)
    assert "the file says" not in (tmp_path / "campaign.yaml").read_text(encoding="utf-8")


def test_a_scale_that_some_files_state_alone_is_asked_with_these(tmp_path: Path, say: Say) -> None:
    for name, gain in {"a": 1.0, "b": 0.1, "c": 1.0}.items():
        _mat(tmp_path, dZ_gain=gain)
        (tmp_path / "run1.mat").rename(tmp_path / f"{name}.mat")
    assert say("init", tmp_path).code in (0, 3)
    lines = (tmp_path / "campaign.yaml").read_text(encoding="utf-8").splitlines()
    (told,) = [line for line in lines if "the file says" in line]
    assert "in b.mat the file says 'dZ_gain = 0.1'" in told


def test_properties_of_a_signal_that_scale_it_are_asked_unless_its_reader_applies_them() -> None:
    said = {"Factor": "0.1", "Offset": "-5.0", "Polarity": "inverted"}
    signal = Signal("Log/dZ", "log", "um", "float64", properties=said)
    comment = with_scale_asked(guess_of(signal), {"a": signal}).comment()
    assert all(f"'{key} = {value}'" in comment for key, value in said.items())
    applied = Signal("Log/dZ", "log", "um", "float64", Scaling("linear", {"gain": 0.1, "offset": 0.0}), properties=said)
    assert with_scale_asked(guess_of(applied), {"a": applied}) == guess_of(applied)
    plain = Signal("Log/dZ", "log", "um", "float64", properties={"Factor": "1", "Offset": "0", "Polarity": "normal"})
    assert with_scale_asked(guess_of(plain), {"a": plain}) == guess_of(plain)


@pytest.mark.parametrize("head", ["Gain;inf;1;1", "Gain;1e-300;1;1", "Gain;10", "Offset;-5", "Zero;true;true;true"])
def test_what_is_no_scale_of_a_column_is_not_asked_of_one(tmp_path: Path, say: Say, head: str) -> None:
    rows = [f"2026-03-12 08:{k:02d}:00;{20 + k / 7:.2f};{4 + 3 * k};{k}" for k in range(60)]
    names = "Time;T_front [degC];dZ [um];T_rear [degC]"
    (tmp_path / "run1.csv").write_text("\n".join([head, names, *rows, ""]), encoding="utf-8")
    assert say("init", tmp_path).code in (0, 3)
    assert "the file says" not in (tmp_path / "campaign.yaml").read_text(encoding="utf-8")


@pytest.mark.parametrize(
    ("below", "lost"), [(["Scale;0.01;0.1"], False), (["Gain;0.01;0.1", "Offset;-50;0"], False), (["A;0.01;0.1"], True)]
)
def test_a_row_of_scales_below_the_names_is_no_loss(tmp_path: Path, say: Say, below: list[str], lost: bool) -> None:
    rows = [f"2026-03-12 08:{k:02d}:00;{2000 + 14 * k};{4 + 3 * k}" for k in range(60)]
    text = "\n".join(["Time;T_front [degC];dZ [um]", *below, *rows, ""])
    (tmp_path / "run1.csv").write_text(text, encoding="utf-8")
    assert say("init", tmp_path).code in (0, 3)
    assert ("damaged" in (tmp_path / "campaign.yaml").read_text(encoding="utf-8")) is lost


@pytest.mark.parametrize(("head", "told"), [("Gain;10", True), ("Gain;1", False), ("Serial;10", False)])
def test_a_factor_alone_above_several_columns_is_told(tmp_path: Path, say: Say, head: str, told: bool) -> None:
    rows = [f"2026-03-12 08:{k:02d}:00;{20 + k / 7:.2f};{4 + 3 * k};{k}" for k in range(60)]
    names = "Time;T_front [degC];dZ [um];T_rear [degC]"
    path = tmp_path / "run1.csv"
    path.write_text("\n".join([head, names, *rows, ""]), encoding="utf-8")
    said = say("preview", path)
    assert ("'Gain 10', of which column is not told: nothing is scaled" in said.out + said.err) is told


NEEDED = {"unit": '"0.1 um"', "instead_of": "um"}


def _by_hand(folder: Path, channel: str, more: str = "", **answer: str) -> Path:
    """A campaign that somebody wrote, whose channel dZ may say what its scale is."""
    keys = "".join(f", {key}: {value}" for key, value in answer.items())
    path = folder / "campaign.yaml"
    path.write_text(
        "schema: thermodata/campaign/1\nid: rig\nmachine: {id: '1'}\n"
        f"sources:\n  log: {{reader: table, files: '{{test}}.{channel}'}}\n"
        "channels:\n  T_front: {source: log, signal: T_front, quantity: temperature, unit: degC}\n"
        "  dZ: {source: log, signal: dZ, quantity: displacement, axis: Z, at: tcp, relative_to: table"
        f"{keys}}}\n{more}tests:\n  - {{id: run1, kind: other, role: calibration}}\n",
        encoding="utf-8",
    )
    return path


LINEAR = "calibrations:\n  scale_dZ: {kind: linear, gain: 0.1}\n"
SIGN = "calibrations:\n  sign_z: {kind: scale, axis: Z, gain: 1 um/um, facing: -Z, increases_with: gap}\n"
DERIVED = "  dZ_um: {derive: dZ * 0.1, quantity: displacement, axis: Z, at: tcp}\n"


@pytest.mark.parametrize(
    ("answer", "more", "lost"),
    [
        ({}, "", True),
        ({"calibration": "sign_z"}, SIGN, True),
        ({"unit": '"0.01 um"', "instead_of": "um"}, "", True),
        (NEEDED, "", False),
        ({"calibration": "scale_dZ"}, LINEAR, False),
        ({"scaled": "true"}, "", False),
        ({}, DERIVED, False),
    ],
)
def test_counts_whose_scale_a_campaign_leaves_open_are_a_loss(
    tmp_path: Path, say: Say, answer: dict[str, str], more: str, lost: bool
) -> None:
    _mat(tmp_path, dZ_gain=0.1)
    said = say("--store", tmp_path / "store", "ingest", _by_hand(tmp_path, "mat", more, **answer))
    assert (said.code, "'dZ_gain = 0.1', which the campaign file leaves open" in said.out + said.err) == (
        3 * lost,
        lost,
    )
    assert ('unit: "0.1 um", instead_of: um' in said.out + said.err) is lost


@pytest.mark.parametrize(
    ("values", "code", "told"),
    [
        (COUNTS, 3, True),
        (COUNTS.astype(float), 3, True),
        (np.round(COUNTS * 0.1, 1), 0, False),  # in steps of the factor
        (COUNTS * 0.0137, 0, True),  # fractions of no step: a filter's
        (np.minimum(COUNTS, 3) * 100.0, 0, True),  # what is set
    ],
)
def test_values_tell_whether_they_are_counts(
    tmp_path: Path, say: Say, values: np.ndarray[tuple[int], np.dtype[np.float64]], code: int, told: bool
) -> None:
    _mat(tmp_path, dZ=values, dZ_gain=0.1)
    said = say("--store", tmp_path / "store", "ingest", _by_hand(tmp_path, "mat"))
    assert (said.code, "which the campaign file leaves open" in said.out + said.err) == (code, told)


def test_a_line_that_applies_a_factor_and_an_offset_gives_the_readings(tmp_path: Path, say: Say) -> None:
    counts = np.round((WARM + 40) * 100).astype(np.int32)
    own = {"unit": "degC", "scale": "0.01", "offset": "-40"}
    schema = pa.schema(
        [pa.field("t [s]", pa.float64()), pa.field("T_front", pa.int32(), metadata=own), pa.field("dZ", pa.float64())]
    )
    pq.write_table(pa.table([np.arange(N) * 60.0, counts, COUNTS + 0.5], schema=schema), tmp_path / "run1.parquet")
    assert say("init", tmp_path).code in (0, 3)
    (line,) = [x for x in (tmp_path / "campaign.yaml").read_text("utf-8").splitlines() if "T_front:" in x]
    assert "'scale = 0.01' and 'offset = -40': are these in the values? then scaled: true" in line
    assert "raw counts" not in line  # the scale answers that
    path = _by_hand(
        tmp_path, "parquet", "calibrations:\n  scale_T_front: {kind: linear, gain: 0.01, offset: -40}\n", unit="um"
    )
    text = path.read_text("utf-8")
    assert say("--store", tmp_path / "store", "ingest", path).code == 3
    path.write_text(text.replace("unit: degC", "unit: degC, calibration: scale_T_front"), "utf-8")
    assert say("--store", tmp_path / "store", "ingest", path).code == 0
    read = say("--store", tmp_path / "store", "sql", "--csv", "select value from sample where channel='T_front'").out
    assert np.allclose([float(x) for x in read.split()[1:]], WARM, atol=0.006)


TURNED = "calibrations:\n  scale_dZ: {kind: linear, gain: -0.1}\n"


@pytest.mark.parametrize(
    ("answer", "more", "lost"),
    [
        ({}, "", True),
        ({"unit": '"0.1 um"', "instead_of": "um"}, "", True),  # which turns no sign
        ({"calibration": "scale_dZ"}, TURNED, False),
        ({"scaled": "true"}, "", False),
    ],
)
def test_a_factor_below_zero_is_proposed_with_its_sign_and_open_until_it_is_applied(
    tmp_path: Path, say: Say, answer: dict[str, str], more: str, lost: bool
) -> None:
    _mat(tmp_path, dZ_gain=-0.1)
    said = say("--store", tmp_path / "store", "ingest", _by_hand(tmp_path, "mat", more, **answer))
    told = said.out + said.err
    assert (said.code, "'dZ_gain = -0.1', which the campaign file leaves open" in told) == (3 * lost, lost)
    assert ("{kind: linear, gain: -0.1}" in told) is lost


def test_the_unit_behind_a_scale_is_named_with_it() -> None:
    said = {"Scale_Gain": "100", "Scale_Offset": "0", "Scale_Unit": "degC"}
    signal = Signal("Pt_rear", "", "V", "float64", None, said)
    (asked,) = [q for q in with_scale_asked(guess_of(signal), {"a.tdms": signal}).questions if "the file says" in q]
    assert "'Scale_Gain = 100'" in asked
    assert "'Scale_Unit = degC'" in asked
    assert "scale_Pt_rear: {kind: linear, gain: 100 degC/V}" in asked
