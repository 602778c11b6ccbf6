"""Units that files state, that campaign files state, and that differ."""

from __future__ import annotations

from typing import Any

import numpy as np
import pytest

from thermodata.errors import FormatError
from thermodata.schema.units.conversion import linear_conversion

from .conftest import Lab
from .test_times import mat, stamps

TIMES = stamps("2026-03-02 08:00:00", 10, 40)
POWER = {"signal": "P", "quantity": "power", "at": "spindle"}


def csv(unit: str, value: str = "2.5") -> str:
    return f"time;P [{unit}]\n" + "".join(f"{t};{value}\n" for t in TIMES)


def test_a_declared_unit_that_contradicts_the_file_is_refused_until_it_says_so(lab: Lab) -> None:
    lab.write("raw/a.csv", csv("kW"))
    said = lab.ingest({"P1": {**POWER, "unit": "W"}})
    assert said.code == 3
    assert "the file says 'kW', the campaign file says 'W'" in said.out + said.err
    assert np.isnan(lab.values("P1")[1]).all()
    assert lab.ingest({"P1": POWER}).code == 0
    assert lab.values("P1")[1][0] == 2.5
    assert lab.ingest({"P1": {**POWER, "unit": "W", "instead_of": "kW"}}).code == 0
    assert lab.values("P1")[1][0] == 0.0025
    said = lab.ingest({"P1": {**POWER, "unit": "W", "instead_of": "MW"}})
    assert said.code == 3
    assert "not 'MW'" in said.out + said.err


@pytest.mark.parametrize("spelling", ["kW", "KW", "kilowatt"])
def test_the_same_unit_in_other_words_is_no_contradiction(lab: Lab, spelling: str) -> None:
    lab.write("raw/a.csv", csv("kW"))
    assert lab.ingest({"P1": {**POWER, "unit": spelling}}).code == 0
    assert lab.values("P1")[1][0] == 2.5


def two_parts(lab: Lab, units: tuple[str, str], values: tuple[str, str], heads: bool) -> None:
    """Two files of one test, whose power is in units of their own: in the names, or in a row below them."""
    for name, unit, value, hour in zip("ab", units, values, ("08", "09"), strict=True):
        body = "".join(f"{t};{value};20.25\n" for t in TIMES).replace(" 08:", f" {hour}:")
        lab.write(f"raw/{name}.csv", (f"time;P [{unit}];T1 [degC]\n" if heads else f"time;P;T1\n;{unit};degC\n") + body)


@pytest.mark.parametrize("heads", [True, False], ids=["in names", "in a row"])
@pytest.mark.parametrize("written", ["P", "P [kW]"])
def test_parts_of_one_test_in_two_units_are_each_read_in_their_own(lab: Lab, heads: bool, written: str) -> None:
    two_parts(lab, ("kW", "W"), ("2.5", "2600"), heads)
    said = lab.ingest({"P1": {**POWER, "signal": written if heads else "P"}})
    assert said.code == 0, said.out + said.err
    assert "'P1': in kW in raw/a.csv, W in raw/b.csv: each file's own is taken" in said.out + said.err
    np.testing.assert_allclose(lab.values("P1")[1], [2.5] * 40 + [2.6] * 40)
    traced = lab("trace", "odd", "one", "P1", "--at", "3700 s")
    assert "raw/b.csv" in traced.out
    assert ": 2600" in traced.out  # as it stands in its file


def test_temperatures_of_parts_keep_their_zero(lab: Lab) -> None:
    for name, unit, value, hour in (("a", "degC", "20", "08"), ("b", "degF", "86", "09")):
        body = "".join(f"{t};{value}\n" for t in TIMES).replace(" 08:", f" {hour}:")
        lab.write(f"raw/{name}.csv", f"time;T1 [{unit}]\n{body}")
    assert lab.ingest({"T1": {"signal": "T1", "quantity": "temperature"}}).code == 0
    np.testing.assert_allclose(lab.values("T1")[1], [20.0] * 40 + [30.0] * 40)
    assert lab.ingest({"dT": {"signal": "T1", "quantity": "temperature_difference"}}).code == 0
    np.testing.assert_allclose(lab.values("dT")[1], [20.0] * 40 + [86.0 / 1.8] * 40)


@pytest.mark.parametrize(("second", "code"), [("temperature_difference", 3), ("temperature", 0)])
def test_two_channels_of_one_signal_of_parts_are_read_alike_or_the_second_is_refused(
    lab: Lab, second: str, code: int
) -> None:
    for name, unit, value, hour in (("a", "degC", "20", "08"), ("b", "degF", "86", "09")):
        body = "".join(f"{t};{value}\n" for t in TIMES).replace(" 08:", f" {hour}:")
        lab.write(f"raw/{name}.csv", f"time;T1 [{unit}]\n{body}")
    said = lab.ingest({"T1": {"signal": "T1", "quantity": "temperature"}, "T2": {"signal": "T1", "quantity": second}})
    assert said.code == code, said.out + said.err
    assert ("'T1' has it otherwise" in said.out + said.err) is (code == 3)
    np.testing.assert_allclose(lab.values("T1")[1], [20.0] * 40 + [30.0] * 40)


@pytest.mark.parametrize("heads", [True, False], ids=["in names", "in a row"])
def test_parts_whose_units_have_nothing_in_common_are_not_joined(lab: Lab, heads: bool) -> None:
    two_parts(lab, ("kW", "bar"), ("2.5", "2.5"), heads)
    said = lab.ingest({"P1": POWER})
    assert said.code == 3
    assert "'kW' in raw/a.csv" in said.out + said.err
    assert "'bar' in raw/b.csv" in said.out + said.err
    assert np.isnan(lab.values("P1")[1]).all()


def test_a_declared_unit_has_to_be_that_of_every_part(lab: Lab) -> None:
    two_parts(lab, ("kW", "W"), ("2.5", "2600"), heads=True)
    said = lab.ingest({"P1": {**POWER, "unit": "kW"}})
    assert said.code == 3
    assert "the file says 'W', the campaign file says 'kW'; try: leave out unit" in said.out + said.err
    two_parts(lab, ("kW", "W"), ("2500", "2600"), heads=True)
    assert lab.ingest({"P1": {**POWER, "unit": "W", "instead_of": "kW"}}).code == 0
    np.testing.assert_allclose(lab.values("P1")[1], [2.5] * 40 + [2.6] * 40)


def test_two_signals_of_one_file_that_differ_in_their_unit_are_two(lab: Lab) -> None:
    lab.write("raw/a.csv", "time;P [kW];P [bar]\n" + "".join(f"{t};2.5;3\n" for t in TIMES))
    said = lab.ingest({"P1": POWER})
    assert said.code == 3
    assert "signal 'P' is ambiguous" in said.out + said.err
    assert lab.ingest({"P1": {**POWER, "signal": "P [kW]"}}).code == 0


@pytest.mark.parametrize(
    ("written", "target", "factor"),
    [
        ("kNm", "N m", 1000.0),
        ("Ncm", "N m", 0.01),
        ("mNm", "N m", 0.001),
        ("m3/h", "l/min", 1000 / 60),
        ("m³/h", "l/min", 1000 / 60),
        ("cm3/min", "l/min", 0.001),
        ("kOhm", "Ohm", 1000.0),
        ("MOhm", "Ohm", 1e6),
        ("mOhm", "Ohm", 1e-3),
        ("kHz", "rpm", 60_000.0),
    ],
)
def test_compound_units_as_labs_write_them(written: str, target: str, factor: float) -> None:
    assert linear_conversion(written, target) == (pytest.approx(factor), 0.0)


LONG = "".join(f"{t};{p};{v};{u}\n" for t in TIMES for p, v, u in (("T1", "20.5", "degC"), ("dX", "3.1", "um")))
SORTED = "".join(f"{t};{p};{v};{u}\n" for p, v, u in (("T1", "20.5", "degC"), ("dX", "3.1", "um")) for t in TIMES)


@pytest.mark.parametrize("body", [LONG, SORTED], ids=["by time", "by name"])
@pytest.mark.parametrize("head", ["time;point;value;unit\n", "Zeit;Messstelle;Wert;Einheit\n"])
def test_a_long_table_is_taken_apart_with_its_units(lab: Lab, head: str, body: str) -> None:
    lab.write("raw/a.csv", head + body)
    said = lab.ingest(
        {
            "T1": {"signal": "T1", "quantity": "temperature"},
            "pos": {"signal": "dX", "quantity": "position"},
        },
        {"reader": "cnc"},
    )
    assert said.code == 0, said.out + said.err
    assert set(lab.values("T1")[1]) == {20.5}
    np.testing.assert_allclose(lab.values("pos")[1], 0.0031)
    assert "OPC UA: a long table" in lab("sniff", lab.folder / "raw/a.csv").out


def test_a_name_with_two_units_is_refused(read: Any) -> None:
    with pytest.raises(FormatError, match="'T1' has several units"):
        read("time;point;value;unit\n" + LONG.replace("dX", "T1"))


@pytest.mark.parametrize("by", ["table", "cnc"])
def test_a_long_table_without_dates_is_refused(read: Any, by: str) -> None:
    body = "".join(f"{i};{p};{v}\n" for i in range(40) for p, v in (("T1", "20.5"), ("dX", "3.1")))
    with pytest.raises(FormatError, match="long table"):
        read("time [s];sensor_id;value\n" + body, by=by)
    one = "".join(f"{i};T1;20.5\n" for i in range(40))
    assert read("time [s];sensor_id;value\n" + one, by=by).t_ns


@pytest.mark.parametrize("by", ["table", "cnc", None])
def test_a_small_file_with_a_tail_of_zeros_is_read_to_its_end(read: Any, by: str | None) -> None:
    data = read(csv("kW").encode() + b"\0" * 300, by=by)
    assert next(iter(data.t_ns.values())).size == 40
    torn = read(csv("kW")[:-3].encode() + b"\0" * 300, by=by)  # 2.5 may be 2.53
    assert next(iter(torn.t_ns.values())).size == 39
    assert "without a line end" in torn.losses[0].reason


@pytest.mark.parametrize("by", ["table", "cnc"])
@pytest.mark.parametrize(
    ("head", "units"),
    [
        ('time;"T front\n[degC]";"dX\n[um]"\n', ["degC", "um"]),
        ('time;"T front\nbearing";"dX"\n;degC;um\n', ["degC", "um"]),
        ('"time\nlocal";"T\nfront\nbearing";dX [um]\n', [None, "um"]),
    ],
)
def test_a_line_feed_in_a_quoted_header_shifts_nothing(read: Any, by: str, head: str, units: list[str | None]) -> None:
    data = read(head + "".join(f"{t};20.5;{i}.25\n" for i, t in enumerate(TIMES)), by=by)
    assert [s.unit for s in data.recording.signals] == units
    assert "dX" in data.recording.signals[1].name
    assert data.recording.signals[0].name.startswith("T ")
    np.testing.assert_array_equal(list(data.values.values())[1], np.arange(40) + 0.25)
    assert data.losses == ()


def test_the_unit_of_a_mat_variable_may_stand_beside_it(read: Any) -> None:
    n = np.arange(50)
    data = read(mat(time=n * 1.0, T1=n / 8, T1_unit="degC", dX=n / 4, unit_dX="um", T2=n / 2, T2Unit="K"), "a.mat")
    assert {s.name: s.unit for s in data.recording.signals} == {"T1": "degC", "dX": "um", "T2": "K"}
