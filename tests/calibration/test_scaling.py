"""Declared scalings: equal to npTDMS to the last bit, and refused where they aren't known."""

from __future__ import annotations

import warnings
from pathlib import Path

import numpy as np
import pytest

from thermodata.calibration.scaling import NI_SCALE_TYPES, apply_scaling, check_scaling, scaler_ids
from thermodata.errors import CalibrationError
from thermodata.plugin import Scaling

DATA = Path(__file__).resolve().parents[3] / "shared" / "data" / "tdms"
RAW = 0xFFFFFFFF


def ni(*scales: dict, **more: object) -> Scaling:
    properties: dict[str, object] = {"NI_Scaling_Status": "unscaled", "NI_Number_Of_Scales": len(scales), **more}
    for i, scale in enumerate(scales):
        properties |= {f"NI_Scale[{i}]_{k}": v for k, v in scale.items()}
    return Scaling("ni", properties)


def linear(slope: float, intercept: float, source: int = RAW) -> dict:
    return {
        "Scale_Type": "Linear",
        "Linear_Slope": slope,
        "Linear_Y_Intercept": intercept,
        "Linear_Input_Source": source,
    }


RTD = {
    "Scale_Type": "RTD",
    "RTD_Current_Excitation": 1e-3,
    "RTD_R0_Nominal_Resistance": 100.0,
    "RTD_A": 3.9083e-3,
    "RTD_B": -5.775e-7,
    "RTD_C": -4.183e-12,
    "RTD_Lead_Wire_Resistance": 0.0,
    "RTD_Resistance_Configuration": 4,
    "RTD_Input_Source": RAW,
}


def test_no_scaling_gives_the_raw_values_as_float() -> None:
    assert apply_scaling(None, np.array([1, 2], np.int16)).tolist() == [1.0, 2.0]


def test_linear_scaling() -> None:
    assert apply_scaling(Scaling("linear", {"gain": 2.0, "offset": 1.0}), np.array([1, 2])).tolist() == [3.0, 5.0]
    with pytest.raises(CalibrationError, match="gain"):
        check_scaling(Scaling("linear", {"gain": "two"}))


def test_a_chain_of_scales_is_applied_in_order() -> None:
    got = apply_scaling(ni(linear(2.0, 1.0), linear(10.0, 0.0, source=0)), np.array([1.0, 2.0]))
    assert got.tolist() == [30.0, 50.0]


def test_values_that_are_written_scaled_stay_as_they_are() -> None:
    scaled = ni(linear(2.0, 0.0), NI_Scaling_Status="scaled")
    assert apply_scaling(scaled, np.array([3.0])).tolist() == [3.0]


def test_an_unknown_scale_type_is_refused_with_channel_and_type() -> None:
    with pytest.raises(CalibrationError) as caught:
        apply_scaling(ni({"Scale_Type": "Splines"}), np.arange(3), channel="Eddy/Z")
    for word in ("Eddy/Z", "Splines", *NI_SCALE_TYPES):
        assert word in str(caught.value)


@pytest.mark.parametrize(
    "broken",
    [
        ni({"Scale_Type": "Linear", "Linear_Slope": 2.0}),  # no intercept
        ni(linear(1.0, 0.0, source=0)),  # feeds itself
        ni(linear(1.0, 0.0, source=7)),  # reads a scale that is not there
        ni(linear(1.0, 0.0, source=1), linear(1.0, 0.0, source=0)),  # a loop of two
        ni(linear(1.0, 0.0), NI_Number_Of_Scales=10**9),
        ni(linear(1.0, 0.0), NI_Number_Of_Scales="many"),
        Scaling("spline", {}),  # type: ignore[arg-type]
    ],
)
def test_a_broken_scaling_is_refused_without_data(broken: Scaling) -> None:
    with pytest.raises(CalibrationError):
        check_scaling(broken)


def test_a_scaling_that_fails_says_of_which_channel(monkeypatch: pytest.MonkeyPatch) -> None:
    class Broken:
        def scale(self, raw: object) -> None:
            raise KeyError("NI_Scale[0]_Linear_Slope")

    monkeypatch.setattr("thermodata.calibration.scaling._ni", lambda _: Broken())
    known = Scaling("ni", {"NI_Number_Of_Scales": 1, "NI_Scale[0]_Scale_Type": "Linear"})
    with pytest.raises(CalibrationError, match="channel 'Eddy/Z': NI scaling fails") as error:
        apply_scaling(known, np.zeros(3), channel="Eddy/Z")
    assert (error.value.where, error.value.got) == ("Eddy/Z", "KeyError: 'NI_Scale[0]_Linear_Slope'")
    assert "export the channel already scaled" in (error.value.hint or "")


def test_one_reading_that_a_scale_cannot_take_spoils_itself_only() -> None:
    volts = np.array([0.1, 0.09, np.nan, 0.11])
    got = apply_scaling(ni(RTD), volts)
    assert np.isnan(got).tolist() == [False, False, True, False]
    assert got[[0, 1, 3]].tolist() == pytest.approx([0.0, -25.5, 25.7], abs=0.2)


def scale(kind: str, **more: object) -> dict:
    return {"Scale_Type": kind, f"{kind}_Input_Source": RAW, **{f"{kind}_{k}": v for k, v in more.items()}}


def strain(configuration: int) -> dict:
    return scale(
        "Strain",
        Configuration=configuration,
        Poisson_Ratio=0.3,
        Gage_Resistance=350.0,
        Lead_Wire_Resistance=0.5,
        Initial_Bridge_Voltage=1e-5,
        Gage_Factor=2.1,
        Voltage_Excitation=2.5,
        Bridge_Shunt_Calibration_Gain_Adjustment=1.01,
    )


def thermistor(excitation: int, wires: int) -> dict:
    return scale(
        "Thermistor",
        Excitation_Type=excitation,
        Excitation_Value=2.5 if excitation == 10322 else 1e-4,
        Resistance_Configuration=wires,
        R1_Reference_Resistance=5000.0,
        Lead_Wire_Resistance=0.2,
        A=1.295361e-3,
        B=2.343159e-4,
        C=1.018703e-7,
        Temperature_Offset=273.15,
    )


def table(rising: bool) -> dict:
    points = [(0.0, -5.0), (0.5, 2.0), (1.2, 30.0)]
    pairs = points if rising else points[::-1]
    listed = {
        f"{name}[{i}]": pair[k]
        for i, pair in enumerate(pairs)
        for k, name in enumerate(("Pre_Scaled_Values", "Scaled_Values"))
    }
    return scale("Table", Pre_Scaled_Values_Size=3, Scaled_Values_Size=3, **listed)


@pytest.mark.parametrize(
    "chain",
    [
        [scale("Polynomial", Coefficients_Size=3, **{f"Coefficients[{i}]": i + 1.0 for i in range(3)})],
        [table(True)],
        [table(False)],
        [scale("AdvancedAPI")],
        *([strain(c)] for c in (10183, 10184, 10185, 10188, 10189, 10271, 10272)),
        *([thermistor(e, w)] for e in (10322, 10134) for w in (2, 3, 4)),
        *(
            [scale("Thermocouple", Thermocouple_Type=t, Scaling_Direction=d)]
            for t in (10047, 10055, 10072, 10073, 10077, 10082, 10085, 10086)
            for d in (0, 1)
        ),
        [RTD],
        [
            linear(1e3, 0.0),
            scale("Thermocouple", Thermocouple_Type=10073, Scaling_Direction=0) | {"Thermocouple_Input_Source": 0},
        ],
        [
            linear(2.0, 0.0),
            linear(3.0, 1.0),
            {
                "Scale_Type": "Subtract",
                "Subtract_Left_Operand_Input_Source": 0,
                "Subtract_Right_Operand_Input_Source": 1,
            },
        ],
    ],
    ids=lambda c: "+".join(s["Scale_Type"] for s in c),
)
@pytest.mark.parametrize("dtype", ["float64", "float32", "int16"])
def test_every_scale_gives_what_nptdms_gives(chain: list[dict], dtype: str) -> None:
    from types import SimpleNamespace

    from nptdms.scaling import get_scaling

    raw = np.array([1, 2, 0.11, 0.1005, 0.9, 0.4]).astype(dtype)
    raw[raw == 0] = 1
    scaling = ni(*chain)
    # npTDMS cuts the voltages of integer temperatures to whole millivolts, so that it is given them as doubles
    given = raw.astype(np.float64) if dtype == "int16" else raw
    with warnings.catch_warnings():
        warnings.simplefilter("ignore")
        wanted = get_scaling(scaling.properties, {}, {}).scale(SimpleNamespace(data=given, scaler_data={}))
    np.testing.assert_array_equal(apply_scaling(scaling, raw), wanted.astype(np.float64))


def test_raw_integers_do_not_overflow_when_they_are_added() -> None:
    both = Scaling(
        "ni",
        {
            "NI_Number_Of_Scales": 3,
            "NI_Scale[2]_Scale_Type": "Add",
            "NI_Scale[2]_Add_Left_Operand_Input_Source": 0,
            "NI_Scale[2]_Add_Right_Operand_Input_Source": 1,
        },
    )
    assert apply_scaling(both, {0: np.array([200], np.uint8), 1: np.array([100], np.uint8)}).tolist() == [300.0]


def test_several_scalers_need_several_raw_columns() -> None:
    thermocouple = Scaling(
        "ni",
        {
            "NI_Number_Of_Scales": 3,
            "NI_Scale[2]_Scale_Type": "Add",
            "NI_Scale[2]_Add_Left_Operand_Input_Source": 0,
            "NI_Scale[2]_Add_Right_Operand_Input_Source": 1,
        },
    )
    a, b = np.array([1, 2], np.int32), np.array([10, 20], np.int32)
    assert scaler_ids(thermocouple) == (0, 1)
    assert apply_scaling(thermocouple, {0: a, 1: b}).tolist() == [11.0, 22.0]
    assert apply_scaling(thermocouple, np.column_stack([a, b])).tolist() == [11.0, 22.0]
    with pytest.raises(CalibrationError, match="raw scalers"):
        apply_scaling(thermocouple, a)


@pytest.mark.skipif(not DATA.exists(), reason="the folder of real files is missing")
@pytest.mark.parametrize("name", ["test_4_DUT_18.tdms", "DAQ-sim.tdms"])
def test_real_files_scale_as_nptdms_scales_them(name: str) -> None:
    import nptdms

    seen = 0
    with nptdms.TdmsFile.open(DATA / name) as file:
        for channel in (c for group in file.groups() for c in group.channels()):
            scaling = Scaling("ni", {k: v for k, v in channel.properties.items() if k.startswith("NI_")})
            raw = channel.read_data(0, 5000, scaled=False)
            wanted = channel.read_data(0, 5000)
            np.testing.assert_array_equal(apply_scaling(scaling, raw), wanted)
            if len(scaler_ids(scaling)) == 1:
                np.testing.assert_array_equal(apply_scaling(scaling, raw[scaler_ids(scaling)[0]]), wanted)
            seen += 1
    assert seen == 3
