"""Data-sheet scales and linear corrections."""

from __future__ import annotations

import numpy as np
import pytest

from thermodata.calibration.channel import calibrate
from thermodata.calibration.facing import geometric_sign
from thermodata.calibration.static import evaluate_linear, evaluate_scale
from thermodata.errors import CalibrationError, UsageError
from thermodata.schema.files.campaign import Channel, LinearCalibration, ScaleCalibration


def scale(**spec: object) -> ScaleCalibration:
    return ScaleCalibration.model_validate({"kind": "scale", "axis": "X", "gain": "250 um/V", **spec})


@pytest.mark.parametrize(
    ("facing", "increases_with", "sign"),
    [("+X", "gap", 1), ("-X", "gap", -1), ("+X", "approach", -1), ("-X", "approach", 1)],
)
def test_a_probe_that_looks_along_the_axis_sees_the_gap_grow(facing: str, increases_with: str, sign: int) -> None:
    # probe at x = 0 on the table; the target on the tool side stands 1 mm away, where the probe looks
    along = 1 if facing[0] == "+" else -1
    gap_before, gap_after = abs(along * 1.0), abs(along * 1.0 + 0.1)  # the tool centre point moves by +0.1 mm
    reading = (gap_after - gap_before) * (1 if increases_with == "gap" else -1)
    assert np.sign(reading) == sign == geometric_sign(facing, increases_with)
    result = evaluate_scale("s", scale(facing=facing, increases_with=increases_with))
    assert result.gain == sign * 250.0
    assert result.sign == ("+" if sign > 0 else "-")


def test_without_facing_the_sign_is_unknown() -> None:
    result = evaluate_scale("s", scale())
    assert (result.gain, result.sign, result.passed) == (250.0, "unknown", False)


@pytest.mark.parametrize(("gain", "sign"), [("1000 rpm/V", "+"), ("-1000 rpm/V", "-")])
def test_what_is_no_displacement_has_no_side_to_look_from(gain: str, sign: str) -> None:
    result = evaluate_scale("n", scale(axis=None, gain=gain), of_displacement=False)
    assert (result.gain, result.sign, result.passed) == (float(gain.split()[0]), sign, True)


def test_the_axis_comes_from_facing() -> None:
    assert evaluate_scale("s", scale(axis=None, facing="-Y")).axis == "Y"


@pytest.mark.parametrize(
    "spec",
    [
        {"gain": 250},
        {"gain": "250 um"},
        {"gain": "0 um/V"},
        {"gain": "-250 um/V", "facing": "+X"},
        {"facing": "+Y"},
        {"offset": "2 V"},
        {"uncertainty": 2},
    ],
)
def test_what_a_scale_cannot_be(spec: dict) -> None:
    with pytest.raises(CalibrationError):
        evaluate_scale("s", scale(**spec))


def test_offset_and_uncertainty_take_units() -> None:
    result = evaluate_scale("s", scale(gain="0.25 mm/V", offset="50 um", uncertainty="5 um/V"))
    assert result.offset == pytest.approx(0.05)
    assert result.uncertainty_pct == pytest.approx(2.0)
    assert evaluate_scale("s", scale(uncertainty="2 %")).uncertainty_pct == 2.0


def linear(**spec: object) -> LinearCalibration:
    return LinearCalibration.model_validate({"kind": "linear", **spec})


@pytest.mark.parametrize(
    ("spec", "unit", "raw_unit", "raw", "wanted"),
    [
        ({"offset": "-0.12 K"}, "degC", "degC", 20.0, 19.88),
        ({"offset": "-0.12 K"}, None, "degC", 20.0, 19.88),
        ({"offset": "-0.12 K"}, None, "degF", 68.0, 19.88),
        ({"gain": 1.01, "offset": -0.1}, "degC", "degC", 20.0, 20.1),
        ({"gain": "10 degC/V", "offset": "-50 degC"}, None, "V", 7.0, 20.0),
        ({"gain": "10 degC/V", "offset": "-50 K"}, None, "mV", 7000.0, 20.0),
    ],
)
def test_linear(spec: dict, unit: str | None, raw_unit: str, raw: float, wanted: float) -> None:
    result = evaluate_linear("t", linear(**spec), unit)
    channel = Channel(source="s", signal="x", quantity="temperature", unit=raw_unit)
    got, _ = calibrate(np.array([raw]), channel=channel, signal_unit=None, scaling=None, calibrations=[result])
    assert got[0] == pytest.approx(wanted)


def test_what_a_linear_cannot_be() -> None:
    for spec in ({"gain": 0}, {"gain": "2 V"}):
        with pytest.raises(UsageError):
            evaluate_linear("t", linear(**spec), "degC")
    with pytest.raises(ValueError, match="not a value with a unit"):
        linear(gain="x")
