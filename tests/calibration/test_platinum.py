"""Platinum thermometers in ohm, against the table of IEC 60751 (Pt100, ohm to two digits)."""

from __future__ import annotations

import numpy as np
import pytest
from pydantic import TypeAdapter

from thermodata.calibration.channel import calibrate
from thermodata.calibration.platinum import degrees, evaluate_platinum
from thermodata.calibration.static import evaluate_linear
from thermodata.errors import CalibrationError
from thermodata.schema.files.campaign import Channel, LinearCalibration, PlatinumCalibration
from thermodata.schema.flag import Flag

TABLE = {-200: 18.52, -100: 60.26, -50: 80.31, -10: 96.09, 0: 100.0, 20: 107.79, 50: 119.40, 100: 138.51, 850: 390.48}
PT = evaluate_platinum("pt", PlatinumCalibration(kind="pt100"))


def channel(**more: object) -> Channel:
    return Channel.model_validate(
        {"source": "s", "signal": "R", "quantity": "temperature", "unit": "ohm", "calibration": "pt", **more}
    )


def read(ohm: list[float], spec: Channel, *calibrations: object) -> tuple[list[float], list[int]]:
    values, flags = calibrate(
        np.array(ohm), channel=spec, signal_unit=None, scaling=None, calibrations=calibrations or (PT,)
    )
    return values.tolist(), flags.tolist()


@pytest.mark.parametrize(("t", "ohm"), TABLE.items())
def test_the_table_of_the_standard(t: float, ohm: float) -> None:
    values, flags = read([ohm], channel())
    assert values == pytest.approx([t], abs=0.02)  # half a digit of the table
    assert flags == [0]


def test_the_curve_is_exact_and_meets_itself_at_zero() -> None:
    t = np.linspace(-199.9, 849.9, 4001)
    ohm = 100 * (1 + 3.9083e-3 * t - 5.775e-7 * t**2 + np.where(t < 0, -4.183e-12 * (t - 100) * t**3, 0))
    np.testing.assert_allclose(degrees(ohm, 100.0), t, atol=1e-8)


def test_what_no_platinum_reads_is_out_of_range() -> None:
    values, flags = read([0.0, 18.4, 390.6, np.inf, np.nan, 107.79], channel())
    assert np.isnan(values[:5]).all()
    assert flags == [int(Flag.OUT_OF_RANGE)] * 5 + [0]


@pytest.mark.parametrize(("kind", "r0"), [("pt200", 200.0), ("pt500", 500.0), ("pt1000", 1000.0)])
def test_others_are_as_much_larger(kind: str, r0: float) -> None:
    spec = TypeAdapter(PlatinumCalibration).validate_python({"kind": kind})
    assert read([r0 * 1.0779], channel(), evaluate_platinum("pt", spec))[0] == pytest.approx([20.0], abs=0.01)
    assert read([r0 * 1.0779e-3], channel(unit="kohm"), evaluate_platinum("pt", spec))[0] == pytest.approx(
        [20.0], abs=0.01
    )


def test_leads_are_taken_away_before_and_an_offset_is_added_behind() -> None:
    leads = evaluate_linear("leads", LinearCalibration(kind="linear", offset="-0.4 ohm"), "ohm")
    own = evaluate_linear("own", LinearCalibration(kind="linear", offset="-0.12 K"))
    assert read([108.19], channel(), leads, PT, own)[0] == pytest.approx([19.88], abs=0.01)


def test_a_temperature_in_ohm_without_it_is_told_of_it() -> None:
    with pytest.raises(CalibrationError, match=r"kind: pt100"):
        calibrate(np.array([107.79]), channel=channel(calibration=None), signal_unit=None, scaling=None)


def test_volts_are_no_resistance() -> None:
    with pytest.raises(CalibrationError, match="takes ohm"):
        read([1.0], channel(unit="V"))
