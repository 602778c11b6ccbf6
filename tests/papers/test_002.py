"""[horejs2022]: three spindles in machines of one type: a function of its own for each, against SP1's times a gain.

The functions of SP2 and SP3 are as printed. Those of SP1 and of the hall say nothing of their gains at rest (their sums
are within the rounding of their digits, and are refused): a direct term and one lag stand in their place, of which 1.75
and 1.25 times do as the paper's figures 15 and 16 show.
"""

from __future__ import annotations

from collections.abc import Callable
from functools import cache
from pathlib import Path
from typing import Any

import numpy as np
import pytest

from thermodata.effect.lag import lag
from thermodata.modelling.model_file.transfer.as_effect import GivenFunction
from thermodata.plugin import Float1D

from .document import hold_table
from .lab import STEP_S, Lab, Logged, grid, hall_air, levels, make_lab, noisy, value, write_logs

SP2 = GivenFunction([16.0005, -15.9975], [1, -0.99983], 1.0)
SP3 = GivenFunction([4.30702, -4.28923], [1, -0.9984], 1.0)


def _in_parts(printed: GivenFunction) -> tuple[float, float, float]:
    """direct [um/K], lag [um/K], tau [min] of a0 + a1/q over 1 + b1/q."""
    pole = -printed.den[1]
    direct = -printed.num[1] / pole
    return float(direct), printed.gain_at_rest - float(direct), float(-1 / 60 / np.log(pole))


FUNCTIONS = {"SP1": (4.5, 5.0, 25.0), "SP2": _in_parts(SP2), "SP3": _in_parts(SP3)}
HALL = (-2.6, 180.0)  # um/K, min

# spindle: role, rpm from hour to hour, hours in all, swing of the hall [K]
TESTS: dict[str, tuple[str, str, list[tuple[float, float]], float, float]] = {
    "etve": ("SP1", "calibration", [], 30.0, 2.5),
}
SPECTRA = {
    "SP1": (0.5, [500, 4000, 9000, 10000, 6000, 10000, 10000, 3000, 8000, 10000, 10000, 7000, 9000, 5000]),
    "SP2": (1.0, [9000, 0, 18000, 12000, 18000, 4000, 14000]),
    "SP3": (2.0, [1000, 4000, 2000, 8000, 1000]),
}
for _k, (_spindle, (_every, _speeds)) in enumerate(SPECTRA.items()):
    _steps = [(_every * i, float(rpm)) for i, rpm in enumerate(_speeds)]
    _end = _every * len(_speeds)
    TESTS[f"{_spindle.lower()}_500"] = (_spindle, "verification", [(0, 500.0), (6, 0)], 8.0, 0.5)
    TESTS[f"{_spindle.lower()}_9000"] = (_spindle, "calibration", [(0, 9000.0), (7, 0)], 12.0, 0.5)
    TESTS[f"{_spindle.lower()}_spectrum"] = (
        _spindle,
        "verification",
        [*_steps, (_end, 0)],
        _end + 2.0,
        (0.3, 0.15, 0.8)[_k],
    )


def _bearing(spindle: str, speed: Float1D) -> Float1D:
    """What the bearing would come to at this speed [K]. SP3's motor is hotter the slower it turns, and its bearing with
    it: the paper's figures 3 and 6."""
    if spindle == "SP1":
        return np.asarray(6.3 * (speed / 9000) ** 1.4)
    if spindle == "SP2":
        return np.asarray(3.4 * (speed / 9000) ** 0.7)
    return np.asarray((speed > 0) * (7.5 - 3.5 * speed / 9000))


def _write(folder: Path) -> None:
    for day, (test, (spindle, _, steps, hours, swing)) in enumerate(TESTS.items()):
        t = grid(hours)
        speed = levels(t, steps)
        air = hall_air(t, 30 + day, swing)
        warm = _bearing(spindle, speed)
        bearing = 0.5 * lag(warm, 420.0, STEP_S) + 0.5 * lag(warm, 2400.0, STEP_S) + 0.3 * lag(air, 3600.0, STEP_S)
        printed = {"SP2": SP2, "SP3": SP3}.get(spindle)
        if printed is None:
            direct, gain, tau = FUNCTIONS[spindle]
            heated = direct * bearing + gain * lag(bearing, tau * 60, STEP_S)
        else:
            heated = printed.simulate(t, bearing)
        z = heated + HALL[0] * lag(air, HALL[1] * 60, STEP_S)
        write_logs(
            folder,
            test,
            day,
            {
                "dZ": Logged(noisy(z, day, 0.3), "um", "daq"),
                "T_amb": Logged(noisy(21 + air, 100 + day, 0.02), "degC", "daq"),
                "T_bearing": Logged(noisy(24 + bearing, 150 + day, 0.03), "degC"),
                "nActSpeed": Logged(speed, "rpm", decimals=0),
            },
        )


CAMPAIGN = """\
schema: thermodata/campaign/1
id: p002
machine: {id: gantry, description: 5-axis gantry-type milling centres with a table of 630 mm}
channels:
  dZ: {source: daq, signal: Log/dZ, quantity: displacement, unit: V, axis: Z, at: tcp, calibration: probe_z}
  T_amb: {source: daq, signal: Log/T_amb, quantity: temperature, unit: degC, at: hall}
  T_bearing: {source: nc, signal: T_bearing, quantity: temperature, unit: degC, at: spindle.bearing}
  speed: {source: nc, signal: nActSpeed, quantity: rotational_speed, unit: rpm, at: spindle}
tests:
""" + "".join(
    f"  - {{id: {name}, kind: {'etve' if name == 'etve' else 'spindle'}, role: {role}, "
    f"conditions: {{spindle: {spindle}}}}}\n"
    for name, (spindle, role, *_) in TESTS.items()
)

# eq. 2: a function a spindle and the hall's, the paper's tables 2 and 3 in one file
OWN = """\
response: {axis: Z, at: tcp}
effects:
  - {effect: transfer_function, id: sp, drivers: {u: T_bearing}, orders: [2, 1], gain_by: spindle, shared: none}
  - {effect: transfer_function, id: amb, drivers: {u: T_amb}, orders: [1, 1], calibrate_on: [etve]}
"""
SP1_ALONE = OWN.replace(", gain_by: spindle, shared: none", "") + "calibrate_on: [sp1_9000]\n"
# eq. 6
TIMES_G = """\
response: {axis: Z, at: tcp}
effects:
  - {effect: model, id: sp, name: sp1, parts: [sp], gain: g, gain_by: spindle}
  - {effect: model, id: amb, name: sp1, parts: [amb], gain: 1}
"""


@pytest.fixture(scope="module")
def lab(tmp_path_factory: pytest.TempPathFactory) -> Lab:
    made = make_lab(tmp_path_factory.mktemp("p002"), CAMPAIGN, _write)
    for name, text in (("own", OWN), ("sp1", SP1_ALONE), ("times_g", TIMES_G)):
        made.run("fit", made.model(name, "p002", text))
    return made


@pytest.fixture(scope="module")
def compared(lab: Lab) -> Callable[[str], Any]:
    """The answer of `compare` to a model's name, asked for once."""
    return cache(lambda model: lab.json("compare", model))


def test_each_spindle_has_its_function(compared: Callable[[str], Any]) -> None:
    found = compared("own")
    for spindle, (direct, gain, tau) in FUNCTIONS.items():
        assert value(found, f"sp.direct[{spindle}]") == pytest.approx(direct, rel=0.03), spindle
        rest = value(found, f"sp.gain[{spindle}]") + value(found, f"sp.direct[{spindle}]")
        assert rest == pytest.approx(direct + gain, rel=0.03), spindle
        assert value(found, f"sp.tau[{spindle}]") == pytest.approx(tau, rel=0.1), spindle
    assert value(found, "amb.gain") == pytest.approx(HALL[0], rel=0.03)
    assert value(found, "amb.tau") == pytest.approx(HALL[1], rel=0.1)
    printed = {"sp1_9000": 86, "sp2_9000": 90, "sp3_9000": 94, "etve": 74}
    fits = {s["test"]: s["fit"] for s in found["scores"] if s["phase"] == "all"}
    assert all(fits[test] > fit for test, fit in printed.items()), fits


def test_a_gain_carries_the_steady_state_and_not_the_way_there(lab: Lab, compared: Callable[[str], Any]) -> None:
    """Tables 4 and 5: SP1 is the same by definition, the others lose by a gain what they gain by a function."""
    found = compared("times_g")
    g = {spindle: value(found, f"sp.g[{spindle}]") for spindle in FUNCTIONS}
    assert g["SP1"] == pytest.approx(1.0, abs=1e-3)
    # printed 1.75 and 1.25; which they are here follows from SP1's function, of which the digits tell nothing
    assert 1.6 < g["SP2"] < 2.0
    assert 1.1 < g["SP3"] < 1.4
    tests = [f"{spindle.lower()}_spectrum" for spindle in FUNCTIONS]
    words = [word for test in tests for word in ("--test", test)]
    rows = lab.json("compare", "own", "--against", "times_g", *words)
    assert {r["test"] for r in rows} == {*tests, "mean"}
    by_name = {(r["test"], r["name"]): r for r in rows}
    for test in tests[1:]:
        own, gain = by_name[test, "own"], by_name[test, "times_g"]
        assert own["fit"] - gain["fit"] > 10, test
        assert own["residual_peaks"] < 0.5 * gain["residual_peaks"], test
        assert own["against"] > 50, test
    assert by_name[tests[0], "own"]["residual"] == pytest.approx(by_name[tests[0], "times_g"]["residual"], rel=0.02)
    for name in ("own", "times_g"):
        for key in ("fit", "residual_peaks", "low", "high"):
            three = [by_name[test, name][key] for test in tests]
            assert by_name["mean", name][key] == pytest.approx(np.mean(three)), (name, key)
    table = lab.run("compare", "own", "--against", "times_g", *words, "--layout", "markdown").splitlines()
    assert len(table) == 2 + 2 * 4
    assert {line.replace(r"\|", "").count("|") for line in table} == {12}


def test_spindle_1s_function_fails_on_the_others(compared: Callable[[str], Any]) -> None:
    """Figure 15: SP1's own function, with no gain, predicts 50 of SP2's 90 um."""
    alone = {s["test"]: s for s in compared("sp1")["scores"] if s["phase"] == "all"}
    own = {s["test"]: s for s in compared("own")["scores"] if s["phase"] == "all"}
    assert alone["sp1_spectrum"]["fit"] == pytest.approx(own["sp1_spectrum"]["fit"], abs=0.1)
    assert alone["sp2_spectrum"]["fit"] < 60 < 98 < own["sp2_spectrum"]["fit"]
    assert alone["sp3_spectrum"]["fit"] < 85 < 98 < own["sp3_spectrum"]["fit"]


def test_the_document_has_the_tables(lab: Lab, compared: Callable[[str], Any]) -> None:
    rows = lab.json("compare", "own", "--against", "times_g")
    by_name = {(r["test"], r["name"]): r for r in rows}
    g = compared("times_g")
    printed = {"SP1": ("1", 74, 74, 19, 19), "SP2": ("1.75", 85, 60, 16, 34), "SP3": ("1.25", 81, 66, 10, 14)}
    lines = []
    for spindle, (printed_g, *figures) in printed.items():
        own, gain = (by_name[f"{spindle.lower()}_spectrum", name] for name in ("own", "times_g"))
        here = [own["fit"], gain["fit"], own["residual_peaks"], gain["residual_peaks"]]
        pairs = [v for pair in zip(figures, here, strict=True) for v in pair]
        lines.append([spindle, printed_g, value(g, f"sp.g[{spindle}]"), *pairs])
    head = ["spindle", "g printed", "here"]
    for what in ("FIT own [%]", "FIT g [%]", "PTP own [um]", "PTP g [um]"):
        head += [f"{what} printed", "here"]
    hold_table("horejs2022: tables 4 and 5", head, lines)
    scores = {s["test"]: s["fit"] for s in compared("own")["scores"] if s["phase"] == "all"}
    calibration = {"sp1_9000": 86.0, "sp2_9000": 90.0, "sp3_9000": 94.0, "etve": 74.0}
    hold_table(
        "horejs2022: calibration",
        ["test", "FIT printed [%]", "here"],
        [[test, fit, scores[test]] for test, fit in calibration.items()],
    )
