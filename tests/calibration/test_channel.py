"""Raw readings to canonical values: units, signs, ranges, and what is refused."""

from __future__ import annotations

import numpy as np
import pytest

from thermodata.calibration.channel import calibrate, channel_sign, unit_contradiction
from thermodata.calibration.result import CalibrationResult
from thermodata.errors import CalibrationError
from thermodata.plugin import Scaling
from thermodata.schema.files.campaign import Channel
from thermodata.schema.flag import Flag

JUMP = CalibrationResult(
    "jump_z",
    "jump",
    axis="Z",
    gain=-25.0,
    gain_unit="um/V",
    offset=250.0,
    sign="-",
    detail={"unit_in": "V", "unit_out": "um"},
)


def channel(quantity: str, **more: object) -> Channel:
    return Channel.model_validate({"source": "s", "signal": "x", "quantity": quantity, **more})


def values(raw: object, spec: Channel, unit: str | None = None, *calibrations: CalibrationResult) -> list[float]:
    return calibrate(np.asarray(raw), channel=spec, signal_unit=unit, scaling=None, calibrations=calibrations)[
        0
    ].tolist()


@pytest.mark.parametrize(
    ("quantity", "unit", "raw", "wanted"),
    [
        ("temperature", "Deg C", 20.0, 20.0),
        ("temperature", "Grd C", 20.0, 20.0),
        ("temperature", "K", 293.15, 20.0),
        ("temperature", "°F", 68.0, 20.0),
        ("temperature_difference", "degC", 5.0, 5.0),
        ("temperature_difference", "degF", 9.0, 5.0),
        ("rotational_speed", "1/min", 9000.0, 9000.0),
        ("rotational_speed", "U/min", 9000.0, 9000.0),
        ("rotational_speed", "1/s", 150.0, 9000.0),
        ("feed", "mm/min", 10000.0, 10.0),
        ("displacement", "µm", 3.0, 3.0),
        ("displacement", "mm", 0.003, 3.0),
        ("power", "W", 1500.0, 1.5),
        ("torque", "Nm", 12.0, 12.0),
        ("tilt", "um/m", 4.0, 4.0),
        ("state", None, 1.0, 1.0),
    ],
)
def test_units_come_to_the_canonical_one(quantity: str, unit: str | None, raw: float, wanted: float) -> None:
    assert values([raw], channel(quantity), unit)[0] == pytest.approx(wanted)


def test_a_jump_calibration_gives_micrometres_with_the_convention_of_signs() -> None:
    assert values([10.0, 6.0], channel("displacement", axis="Z"), "V", JUMP) == [0.0, 100.0]
    assert values([10000.0, 6000.0], channel("displacement", axis="Z"), "mV", JUMP) == pytest.approx([0.0, 100.0])
    assert channel_sign(channel("displacement", axis="Z"), [JUMP]) == "+"


def test_scaling_then_calibrations_in_their_order() -> None:
    counts = Scaling("linear", {"gain": 0.001})
    trim = CalibrationResult("trim", "linear", gain=1.0, offset=2.0, detail={"offset_unit": "um"})
    got, _ = calibrate(
        np.array([6000], np.int16),
        channel=channel("displacement"),
        signal_unit="V",
        scaling=counts,
        calibrations=[JUMP, trim],
    )
    assert got.tolist() == pytest.approx([102.0])


def test_volts_never_pass_for_micrometres() -> None:
    with pytest.raises(CalibrationError, match=r"displacement in V without a calibration") as caught:
        values([1.0], channel("displacement"), "V")
    assert "kind: jump" in str(caught.value)


def test_a_jump_test_is_advised_for_what_can_be_displaced_only() -> None:
    with pytest.raises(CalibrationError, match="a load in A without a calibration") as caught:
        values([1.0], channel("load"), "A")
    assert "jump" not in str(caught.value)
    assert "correct the unit or the quantity" in str(caught.value)


def test_a_signal_without_a_unit_is_refused() -> None:
    with pytest.raises(CalibrationError, match="no unit"):
        values([1.0], channel("temperature"))


def test_the_calibration_of_another_axis_or_kind_is_refused() -> None:
    with pytest.raises(CalibrationError, match="moved Z"):
        values([1.0], channel("displacement", axis="X"), "V", JUMP)
    with pytest.raises(CalibrationError, match="takes V"):
        values([1.0], channel("displacement", axis="Z"), "degC", JUMP)


def test_the_declared_unit_counts_and_a_contradiction_is_told() -> None:
    declared = channel("temperature", unit="degC")
    assert values([20.0], declared, "V") == [20.0]
    assert "instead_of: V" in (unit_contradiction(declared, "V") or "")
    assert "instead_of: K" in (unit_contradiction(declared, "K") or "")
    assert unit_contradiction(channel("temperature", unit="degC", instead_of="K"), "K") is None
    assert unit_contradiction(declared, "°C") is None
    assert unit_contradiction(declared, None) is None


def test_signs_are_unknown_where_nothing_tells_them() -> None:
    unknown = CalibrationResult("s", "scale", axis="Z", gain=250.0, sign="unknown")
    assert channel_sign(channel("displacement", unit="um"), []) == "unknown"
    assert channel_sign(channel("displacement"), [unknown]) == "unknown"
    assert channel_sign(channel("temperature"), []) == "+"
    tilt = Channel(derive="(a - b) / 100 mm", quantity="tilt")
    assert channel_sign(tilt, [], ["+", "+"]) == "+"
    assert channel_sign(tilt, [], ["+", "unknown"]) == "unknown"
    assert channel_sign(tilt, []) == "unknown"


@pytest.mark.parametrize("limits", [["0 V", "20 V"], [0, 20], ["0 mV", "20000 mV"], ["-250 um", "250 um"]])
def test_range_flags(limits: list) -> None:
    spec = channel("displacement", axis="Z", sensor={"range": limits})
    raw = np.array([-0.5, 0.0, 10.0, 19.965, 19.98, 20.0, 20.3, np.nan])  # 19.98: a converter ends so
    _, flags = calibrate(raw, channel=spec, signal_unit="V", scaling=None, calibrations=[JUMP])
    out, edge = Flag.OUT_OF_RANGE, Flag.SATURATED
    assert flags.tolist() == [out, edge, 0, 0, edge, edge, out, out]
    assert flags.dtype == np.uint16


def test_a_range_without_width_is_refused() -> None:
    with pytest.raises(CalibrationError, match="width"):
        values([1.0], channel("temperature", sensor={"range": [5, 5]}), "degC")


def test_infinities_become_missing_and_flagged() -> None:
    got, flags = calibrate(
        np.array([np.inf, -300.0, 20.0]), channel=channel("temperature"), signal_unit="degC", scaling=None
    )
    assert np.isnan(got[0])
    assert flags.tolist() == [Flag.OUT_OF_RANGE, Flag.OUT_OF_RANGE, 0]


def test_text_becomes_numbers_and_labels_stay_text() -> None:
    got, flags = calibrate(
        np.array(["20,5", "UNAVAILABLE", "21.5", ""], dtype=object),
        channel=channel("temperature"),
        signal_unit="degC",
        scaling=None,
    )
    assert got[[0, 2]].tolist() == [20.5, 21.5]
    assert np.isnan(got[[1, 3]]).all()
    assert (flags[[1, 3]] == Flag.OUT_OF_RANGE).all()
    assert values(np.array(["ON", "off", "True"]), channel("state")) == [1.0, 0.0, 1.0]
    label, _ = calibrate(np.array(["G54", "T7"]), channel=channel("label"), signal_unit=None, scaling=None)
    assert label.tolist() == ["G54", "T7"]


def test_empty_input_gives_empty_output() -> None:
    assert values(np.empty(0), channel("temperature"), "degC") == []


@pytest.mark.parametrize(
    ("quantity", "unit", "raw", "wanted"),
    [
        ("temperature", "0.0078125 degC", 2560.0, 20.0),
        ("temperature", "1/128 °C", 2560.0, 20.0),
        ("temperature", "0,05 K", 5863.0, 20.0),
        ("temperature_difference", "0.25 K", 8.0, 2.0),
        ("displacement", "20 nm", 50.0, 1.0),
        ("displacement", "0.02 um", 50.0, 1.0),
        ("power", "0.5 W", 2000.0, 1.0),
    ],
)
def test_a_declared_unit_may_say_how_much_one_count_is(quantity: str, unit: str, raw: float, wanted: float) -> None:
    assert values([raw], channel(quantity, unit=unit)) == pytest.approx([wanted])


def test_a_number_before_the_unit_of_a_file_may_be_its_range() -> None:
    with pytest.raises(CalibrationError, match="20 nm"):
        values([50.0], channel("displacement"), "20 nm")
    with pytest.raises(CalibrationError, match="0 um"):
        values([50.0], channel("displacement", unit="0 um"))


def test_the_kind_that_is_advised_is_one_that_the_quantity_can_have() -> None:
    for quantity, kind in (("temperature", "linear"), ("power", "linear"), ("displacement", "scale")):
        with pytest.raises(CalibrationError) as told:
            values([1.0], channel(quantity, unit="count"))
        assert f"kind: {kind}, gain" in str(told.value.hint)
