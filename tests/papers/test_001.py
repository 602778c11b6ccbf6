"""[horejs2010]: the control's linear model against transfer functions, heating and cooling apart, ambient of order 4.

The function of heating in Z and that of the hall are as printed (eq. 2 and 3); those of cooling, and of Y, the paper
leaves out, and they are chosen here with the same structure.
"""

from __future__ import annotations

from pathlib import Path
from typing import Any

import numpy as np
import pytest

from thermodata.effect.lag import lag
from thermodata.modelling.model_file.transfer.as_effect import GivenFunction
from thermodata.plugin import Float1D

from .document import hold_table
from .lab import STEP_S, Lab, Logged, Once, grid, hall_air, levels, made_once, moved_in, noisy, value, write_logs

HEAT = GivenFunction([0.0162, 10.74, 5.368], [0.002098, 2.379, 1.0], None)
HALL = GivenFunction(
    [4.028e-10, 1.491e-7, 0.0002884, 0.0002421, 4.895e-5], [4.02e-10, 1.181e-6, 0.001166, 0.01072, 1.0], None
)
# the printed function of heating is a direct term and one lag: poles at 0.42 s and 1132 s
DIRECT = 10.74 / 2.379  # um/K
AT_REST = 0.0162 / 0.002098  # um/K
TAU_MIN = 2.379 / 0.002098 / 60
COOL = (2.5, 5.0, 40.0)  # direct [um/K], lag [um/K], tau [min]
SHARE_Y = 0.3  # of what happens in Z

TESTS = {
    "sp3200": ("verification", [(0, 3200), (5, 0)], 10.0),
    "sp4800": ("verification", [(0, 4800), (5, 0)], 10.0),
    "sp6400": ("calibration", [(0, 6400), (6, 0)], 13.0),
    "etve": ("calibration", [], 30.0),
    # hour by hour, in the heating phase and while it cools down
    "spectrum": (
        "verification",
        [(0, 6400), (1, 3200), (2, 4800), (3, 1600), (4, 6400), (5, 0), (6.5, 1600), (7.5, 0)],
        11.0,
    ),
}


def _write(folder: Path) -> None:
    for day, (test, (_, steps, hours)) in enumerate(TESTS.items()):
        t = grid(hours)
        speed = levels(t, steps)
        air = hall_air(t, 10 + day, 3.0 if test == "etve" else 0.5)
        own = 0.25 * (speed / 100) ** 0.9
        spindle = 0.6 * lag(own, 500.0, STEP_S) + 0.4 * lag(own, 4000.0, STEP_S) + 0.3 * lag(air, 3600.0, STEP_S)
        base = 0.08 * lag(spindle, 9000.0, STEP_S) + 0.6 * lag(air, 7200.0, STEP_S)
        working, begun = speed > 0, np.cumsum(speed) > 0
        direct, gain, tau = COOL
        cooled: Float1D = direct * spindle + gain * lag(spindle, tau * 60, STEP_S)
        heated = moved_in([(HEAT.simulate(t, spindle), working), (cooled, begun & ~working)])
        z = heated + HALL.simulate(t, air)
        write_one = {
            "dZ": Logged(noisy(z, day, 0.3), "um", "daq"),
            "dY": Logged(noisy(SHARE_Y * z, 50 + day, 0.3), "um", "daq"),
            "T15": Logged(noisy(21 + air, 100 + day, 0.02), "degC", "daq"),
            "T_spindle": Logged(noisy(22 + spindle, 150 + day, 0.03), "degC"),
            "T_base": Logged(noisy(21.5 + base, 200 + day, 0.03), "degC"),
            "nActSpeed": Logged(speed, "rpm", decimals=0),
        }
        write_logs(folder, test, day, write_one)


CAMPAIGN = """\
schema: thermodata/campaign/1
id: p001
machine: {id: horizontal, description: horizontal milling centre}
channels:
  dZ: {source: daq, signal: Log/dZ, quantity: displacement, unit: V, axis: Z, at: tcp, calibration: probe_z}
  dY: {source: daq, signal: Log/dY, quantity: displacement, unit: V, axis: Y, at: tcp, calibration: probe_y}
  T_hall: {source: daq, signal: Log/T15, quantity: temperature, unit: degC, at: hall}
  T_spindle: {source: nc, signal: T_spindle, quantity: temperature, unit: degC, at: spindle.bearing}
  T_base: {source: nc, signal: T_base, quantity: temperature, unit: degC, at: bed}
  speed: {source: nc, signal: nActSpeed, quantity: rotational_speed, unit: rpm, at: spindle}
tests:
""" + "".join(
    f"  - {{id: {name}, kind: {'etve' if name == 'etve' else 'spindle'}, role: {role}}}\n"
    for name, (role, _, _) in TESTS.items()
)

# one model file: five functions in the paper, three a direction
FUNCTIONS = """\
response: [{axis: Z, at: tcp}, {axis: Y, at: tcp}]
effects:
  - {effect: transfer_function, id: heating, drivers: {u: T_spindle}, orders: [2, 1], phases: [heating]}
  - {effect: transfer_function, id: cooling, drivers: {u: T_spindle}, orders: [2, 1], phases: [cooling]}
  - {effect: transfer_function, id: hall, drivers: {u: T_hall}, calibrate_on: [etve],
     fixed: {num0: 4.028e-10, num1: 1.491e-7, num2: 0.0002884, num3: 0.0002421, num4: 4.895e-5,
             den0: 4.02e-10, den1: 1.181e-6, den2: 0.001166, den3: 0.01072, den4: 1}}
"""
LINEAR = """\
response: [{axis: Z, at: tcp}, {axis: Y, at: tcp}]
effects:
  - {effect: static, drivers: {u: "T_spindle - T_base"}, gain_by: place}
"""


@pytest.fixture(scope="module")
def lab(once: Once, tmp_path_factory: pytest.TempPathFactory) -> Lab:
    return made_once(once, tmp_path_factory.mktemp("lab"), "p001", CAMPAIGN, _write)


@pytest.fixture(scope="module")
def functions(lab: Lab) -> Any:
    """The fit of the paper's functions, which the lab's store holds from then on."""
    return lab.json("fit", lab.model("functions", "p001", FUNCTIONS))


def test_the_functions_of_the_paper_are_found(functions: Any) -> None:
    found = functions
    z, y = "dZ/", "dY/"
    for axis, share in ((z, 1.0), (y, SHARE_Y)):
        for name, direct, rest, tau in (
            ("heating", DIRECT, AT_REST, TAU_MIN),
            ("cooling", COOL[0], COOL[0] + COOL[1], COOL[2]),
        ):
            gain = value(found, f"{axis}{name}.gain")
            assert gain + value(found, f"{axis}{name}.direct") == pytest.approx(share * rest, rel=0.03)
            assert value(found, f"{axis}{name}.direct") == pytest.approx(share * direct, rel=0.03)
            assert value(found, f"{axis}{name}.tau") == pytest.approx(tau, rel=0.1)
        assert value(found, f"{axis}hall.gain") == pytest.approx(share, rel=0.03)
    fits = {s["test"]: s["fit"] for s in found["scores"] if s["response"] == "dZ" and s["phase"] == "all"}
    assert fits["spectrum"] > 95
    assert fits["sp6400"] > 97.17, "the printed FIT of calibration in Z"


def test_one_function_for_heating_and_cooling_does_worse(lab: Lab, functions: Any) -> None:
    one = FUNCTIONS.splitlines()
    one = [line.replace(", phases: [heating]", "") for line in one if "id: cooling" not in line]
    single = lab.json("fit", lab.model("single", "p001", "\n".join(one) + "\n"))

    def left(fit: dict[str, list[dict[str, float | str]]]) -> float:
        return next(
            float(s["ptp_residual_um"])
            for s in fit["scores"]
            if (s["test"], s["response"], s["phase"]) == ("spectrum", "dZ", "all")
        )

    assert left(functions) < 0.5 * left(single)


@pytest.mark.usefixtures("functions")
def test_the_table_against_the_linear_model_is_the_papers(lab: Lab) -> None:
    linear = LINEAR.replace("gain_by: place", "fixed: {gain: 7.0}").replace(", {axis: Y, at: tcp}]", "]")
    lab.run("fit", lab.model("linear", "p001", linear))
    rows = lab.json("compare", "functions", "--against", "linear")
    spectrum = {r["name"]: r for r in rows if (r["test"], r["response"]) == ("spectrum", "dZ")}
    assert set(spectrum) == {"functions", "linear"}
    assert spectrum["functions"]["against"] > 60
    assert spectrum["linear"]["against"] is None
    for row in spectrum.values():
        assert row["residual"] == pytest.approx(row["high"] - row["low"])
        assert row["residual_peaks"] == pytest.approx(abs(row["high"]) + abs(row["low"]))
        assert row["fold"] == pytest.approx(row["initial"] / row["residual"])
    (mean,) = [r for r in rows if r["test"] == "mean" and r["name"] == "functions" and r["response"] == "dZ"]
    own = [r for r in rows if r["name"] == "functions" and r["response"] == "dZ" and r["test"] != "mean"]
    assert mean["residual"] == pytest.approx(np.mean([r["residual"] for r in own]))
    text = lab.run("compare", "functions", "--against", "linear")
    assert max(map(len, text.partition("\n\n")[0].splitlines())) <= 80, "as wide as a screen"
    markdown = lab.run("compare", "functions", "--against", "linear", "--layout", "markdown")
    assert markdown.startswith("| response |")
    assert "less than the reference [%]" in markdown
    csv = lab.run("compare", "functions", "--against", "linear", "--layout", "csv").splitlines()
    assert csv[0].startswith("response,test,model,FIT [%]")
    latex = lab.run("compare", "functions", "--against", "linear", "--layout", "latex")
    assert latex.count(r"\\") == len(csv)
    assert r"\toprule" in latex


def test_the_document_has_the_table(lab: Lab, functions: Any) -> None:
    """Last: it refits the linear model with the k of the control in both directions."""
    lines: list[list[str | float]] = []
    printed: dict[str, tuple[str, float | str]] = {"dZ": ("7", "97.17"), "dY": ("1.5", "-")}
    fits = {(s["response"], s["test"]): s["fit"] for s in functions["scores"] if s["phase"] == "heating"}
    for response, (k, fit) in printed.items():
        linear = LINEAR.replace("gain_by: place", f"fixed: {{gain: {k}}}")
        axis = response[1]
        linear = linear.replace("[{axis: Z, at: tcp}, {axis: Y, at: tcp}]", f"{{axis: {axis}, at: tcp}}")
        lab.run("fit", lab.model(f"linear_{axis}", "p001", linear))
        rows = lab.json("compare", "functions", "--against", f"linear_{axis}", "--test", "spectrum")
        own, reference = (
            next(r for r in rows if (r["name"], r["response"], r["test"]) == (name, response, "spectrum"))
            for name in ("functions", f"linear_{axis}")
        )
        less = {"dZ": "-", "dY": "more than 85"}[response]
        lines.append(
            [
                axis,
                fit,
                fits[response, "sp6400"],
                own["initial"],
                reference["residual"],
                own["residual"],
                less,
                own["against"],
            ]
        )
    hold_table(
        "horejs2010: functions against the linear model",
        [
            "direction",
            "FIT of calibration printed [%]",
            "here",
            "spectrum at first [um]",
            "left by k (T_spindle - T_base) [um]",
            "by functions [um]",
            "less printed [%]",
            "here",
        ],
        lines,
    )
