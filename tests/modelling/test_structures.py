"""The model structures of the five source papers (docs/literature.md), each as a model file."""

from __future__ import annotations

from dataclasses import replace
from textwrap import dedent
from typing import Any

import numpy as np
import pytest
import yaml

from thermodata.effect.lag import lag
from thermodata.modelling import fit_model
from thermodata.modelling.predictions.score import scores
from thermodata.modelling.terms.fitted import FittedModel
from thermodata.plugin import Float1D
from thermodata.schema.files.model import Model
from thermodata.view.grid.dataset import ChannelInfo, Dataset, TestData

STEP = 60.0
INFOS = {
    c.name: c
    for c in (
        ChannelInfo("dZ", "displacement", "um", "tcp", "Z"),
        ChannelInfo("dZ_far", "displacement", "um", "table.d3000", "Z"),
        ChannelInfo("dZ_tool", "displacement", "um", "tool.elongation", "Z"),
        ChannelInfo("T_sp", "temperature", "degC", "spindle.bearing"),
        ChannelInfo("T_base", "temperature", "degC", "bed"),
        ChannelInfo("T_motor", "temperature", "degC", "axis.z.motor"),
        ChannelInfo("T_house", "temperature", "degC", "axis.z.bearing"),
        ChannelInfo("T_nut", "temperature", "degC", "axis.z.nut"),
        ChannelInfo("T_table", "temperature", "degC", "table"),
        ChannelInfo("T_tool", "temperature", "degC", "tool"),
        ChannelInfo("T_hall", "temperature", "degC", "hall"),
        ChannelInfo("P", "power", "kW", "spindle"),
        ChannelInfo("speed", "rotational_speed", "rpm", "spindle"),
    )
}


def _test(
    name: str,
    role: str,
    k: int,
    *,
    work: bool = True,
    hours: float = 24.0,
    bearing: float = 1.0,
    turning: float = 1.0,
    chips: float = 1.0,
    **conditions: float | str,
) -> TestData:
    rng = np.random.default_rng(k)
    n = int(hours * 60)
    t = np.arange(n) * STEP

    def blocks(length: int, top: float) -> Float1D:
        out = np.repeat(rng.choice([0.0, 0.5, 1.0], n // length + 1), length)[:n] * top * work
        out[:10] = 0.0
        return out

    speed, feed, table, power = blocks(120, 9000), blocks(150, 10), blocks(200, 1), blocks(70, 4)
    sp, nut = 3e-3 * lag(speed, 1200, STEP), 0.8 * lag(feed, 1800, STEP)
    tab, tl = 12 * lag(table, 3600, STEP), 8 * lag(power, 300, STEP)
    hall = 2 * (np.sin(2 * np.pi * (t / 86400 + k / 7)) - np.sin(2 * np.pi * k / 7))
    frame, swarf = -2.5 * lag(hall, 14400, STEP), -3 * lag(power, 2400, STEP) * chips
    heat = bearing * 1.8 * lag(sp, 3600, STEP) - 1.2 * turning * lag(tab, 5400, STEP)
    dz = heat + frame + 1.4 * lag(nut, 4000, STEP) + swarf - 1.7 * lag(tl, 200, STEP)
    values = {
        "dZ": dz,
        "dZ_far": heat * 1.5 + frame,
        "dZ_tool": -1.7 * lag(tl, 200, STEP),
        "T_sp": sp,
        "T_base": 0.2 * hall,
        "T_motor": 1.1 * lag(nut, 600, STEP),
        "T_house": 0.7 * lag(nut, 1500, STEP),
        "T_nut": nut,
        "T_table": tab,
        "T_tool": tl,
        "T_hall": hall,
        "P": power,
        "speed": speed,
    }
    noisy = {
        c: 20 * (INFOS[c].quantity == "temperature")
        + v
        + (c not in ("P", "speed")) * rng.normal(0, 0.2 if c.startswith("d") else 0.02, n)
        for c, v in values.items()
    }
    kind = "etve" if not work else "spectrum"
    return TestData(
        "lab",
        name,
        kind,
        role,
        t,
        noisy,
        {c: np.ones(n, bool) for c in noisy},
        np.ones(n, bool),
        dict(conditions),
        channels=INFOS,
        machine="138",
    )


@pytest.fixture(scope="module")
def lab() -> Dataset:
    tests = (
        _test("etve", "calibration", 0, work=False, spindle="SP1", diameter=0.0, tool_id="D25", hours=26),
        _test("a", "calibration", 1, spindle="SP1", diameter=1500.0, tool_id="D25"),
        _test("b", "calibration", 2, spindle="SP1", diameter=1500.0, tool_id="D25"),
        _test("c", "verification", 3, spindle="SP1", diameter=1500.0, tool_id="D25"),
    )
    return Dataset(STEP, tests, INFOS)


def _variant(base: TestData, k: int, role: str, conditions: dict[str, Any], **physics: float) -> TestData:
    return replace(_test(f"v{k}", role, k, **physics), conditions={**base.conditions, **conditions})


def _fit(lab: Dataset, text: str) -> FittedModel:
    head = {"schema": "thermodata/model/1", "name": "paper", "campaign": "lab", "step": "60 s"}
    return fit_model(Model.model_validate(head | yaml.safe_load(dedent(text))), lab)


def _fits(fitted: FittedModel, data: Dataset) -> dict[str, float]:
    return {f"{s.response}:{s.test}:{s.phase}": float(s.fit or 0.0) for s in scores(fitted, data, "m")}


def test_paper_001_static_baseline_and_separate_functions_for_heating_and_cooling(lab: Dataset) -> None:
    static = _fit(
        lab,
        """
        response: {channel: dZ_far}
        effects: [{effect: static, drivers: {u: "T_sp - T_base"}, fixed: {gain: 1.5}}]""",
    )
    assert static.parameters()["static.gain"].value == 1.5
    assert static.parameters()["static.gain"].unit == "um/K"
    ambient = """
        response: {channel: dZ_far}
        phases: [%s]
        calibrate_on: [a, b]
        effects:
          - {effect: transfer_function, id: heat, drivers: {u: T_sp}, orders: [2, 2]}
          - {effect: lag, id: turning, drivers: {u: T_table}}
          - {effect: transfer_function, id: etve, drivers: {u: T_hall}, method: oe, orders: [4, 4],
             calibrate_on: [etve]}
        """
    timed = replace(
        lab,
        tests=tuple(
            replace(
                t,
                phases={"heating": (0.0, 43200.0), "cooling": (43260.0, 1e6)}
                if t.test != "etve"
                else {"heating": (0.0, 1e6), "cooling": (0.0, 1e6)},
            )
            for t in lab.tests
        ),
    )
    heating, cooling = _fit(timed, ambient % "heating"), _fit(timed, ambient % "cooling")
    assert _fits(heating, timed)["dZ_far:c:heating"] > 90
    assert "dZ_far:c:cooling" not in _fits(heating, timed)
    assert _fits(cooling, timed)["dZ_far:c:cooling"] > 90
    assert _fits(static, timed)["dZ_far:c:heating"] < _fits(heating, timed)["dZ_far:c:heating"]


def test_paper_001_continuous_function_as_printed(lab: Dataset) -> None:
    printed = _fit(
        lab,
        """
        response: {channel: dZ}
        effects:
          - {effect: transfer_function, drivers: {u: T_sp}, fixed: {gain: 1, num0: 0.0162, num1: 10.74, num2: 5.368,
             den0: 0.002098, den1: 2.379, den2: 1.0}}""",
    )
    assert np.ptp(printed.responses[0].predict(lab.tests[1])) > 50


def test_paper_002_one_function_times_a_gain_for_each_spindle(lab: Dataset) -> None:
    other = [
        _variant(lab.tests[1], k, role, {"spindle": "SP2"}, bearing=1.75)
        for k, role in ((11, "calibration"), (12, "verification"))
    ]
    data = replace(lab, tests=(*lab.tests, *other))
    fitted = _fit(
        data,
        """
        response: {channel: dZ_far}
        effects:
          - {effect: transfer_function, id: sp, drivers: {u: T_sp}, orders: [1, 1], gain_by: conditions.spindle,
             shared: [tau]}
          - {effect: ambient_frame, calibrate_on: [etve]}
          - {effect: lag, drivers: {u: T_table}}""",
    )
    found = fitted.parameters()
    assert found["sp.gain[SP2]"].value / found["sp.gain[SP1]"].value == pytest.approx(1.75, rel=0.03)
    assert _fits(fitted, data)["dZ_far:v12:all"] > 95
    own = _fit(
        data,
        """
        response: {channel: dZ_far}
        effects:
          - {effect: transfer_function, id: sp, drivers: {u: T_sp}, orders: [1, 1], gain_by: spindle, shared: [gain]}
          - {effect: ambient_frame, calibrate_on: [etve]}
          - {effect: lag, drivers: {u: T_table}}""",
    )
    assert {"sp.tau[SP1]", "sp.tau[SP2]"} <= set(own.parameters())


def test_paper_003_differences_several_places_and_a_gain_by_diameter(lab: Dataset) -> None:
    wide = [
        _variant(lab.tests[1], k, role, {"diameter": 3000.0}, turning=2.2)
        for k, role in ((21, "calibration"), (22, "verification"))
    ]
    data = replace(lab, tests=(*lab.tests[1:], *wide))
    fitted = _fit(
        data,
        """
        response: [{axis: Z, at: tcp}, {axis: Z, at: table}]
        effects:
          - {effect: lag, id: milling, drivers: {u: "T_sp - T_base"}}
          - {effect: lag, id: turning, drivers: {u: "T_table - T_base"}, gain_by: conditions.diameter}
          - {effect: ambient_frame}
          - {effect: feed_screw, drivers: {temperature: T_nut}}
          - {effect: cutting_power}
          - {effect: tool_elongation}""",
    )
    found = fitted.parameters()
    assert [r.name for r in fitted.responses] == ["dZ", "dZ_far"]
    for place in ("dZ", "dZ_far"):
        g = found[f"{place}/turning.gain[3000]"].value / found[f"{place}/turning.gain[1500]"].value
        assert g == pytest.approx(2.2, rel=0.05), place
        assert _fits(fitted, data)[f"{place}:v22:all"] > 90


def test_paper_004_frame_tool_and_cutting_power(lab: Dataset) -> None:
    heavy = [
        _variant(lab.tests[1], k, role, {"tool_id": "D100"}, chips=0.4)
        for k, role in ((31, "calibration"), (32, "verification"))
    ]
    data = replace(lab, tests=(*lab.tests, *heavy))
    frame = """
          - {effect: spindle_bearing}
          - {effect: lag, id: turning, drivers: {u: T_table}}
          - {effect: feed_screw, drivers: {temperature: T_nut}}
          - {effect: ambient_frame, calibrate_on: [etve]}"""
    a = _fit(data, f"response: {{axis: Z, at: tcp}}\neffects:{frame}")
    b = _fit(
        data,
        f"response: {{axis: Z, at: tcp}}\neffects:{frame}"
        "\n          - {effect: cutting_power, gain_by: conditions.tool_id}",
    )
    c = _fit(
        data,
        f"response: {{axis: Z, at: tcp}}\neffects:{frame}"
        "\n          - {effect: cutting_power, gain_by: conditions.tool_id}\n          "
        "- {effect: tool_elongation}",
    )
    fits = [_fits(m, data)["dZ:v32:all"] for m in (a, b, c)]
    assert fits[0] < fits[1] < fits[2]
    assert fits[2] > 95
    found = c.parameters()
    k = found["cutting_power.gain[D100]"].value / found["cutting_power.gain[D25]"].value
    assert k == pytest.approx(0.4, abs=0.05)
    tool = _fit(data, "response: {channel: dZ_tool}\neffects: [{effect: tool_elongation}]").parameters()
    assert tool["tool_elongation.gain"].value == pytest.approx(-1.7, rel=0.02)


def test_paper_000_three_rival_inputs_of_one_effect(lab: Dataset) -> None:
    clean = replace(
        lab,
        tests=tuple(
            replace(
                t,
                values={
                    **t.values,
                    "dZ": 1.4 * lag(t.values["T_nut"] - 20.0, 4000, STEP)
                    - 2.5 * lag(t.values["T_hall"] - 20, 14400, STEP),
                },
            )
            for t in lab.tests
        ),
    )
    found = {}
    for name in ("T_motor", "T_house", "T_nut"):
        fitted = _fit(
            clean,
            f"""
            response: {{channel: dZ}}
            effects:
              - {{effect: feed_screw, drivers: {{temperature: {name}}}}}
              - {{effect: ambient_frame, calibrate_on: [etve]}}""",
        )
        found[name] = _fits(fitted, clean)["dZ:c:all"]
    assert max(found, key=lambda n: found[n]) == "T_nut"
    assert all(value > 80 for value in found.values())
