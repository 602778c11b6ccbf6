"""[mares2017]: the frame at the stator, and A, B, C at the tool centre point over three tools.

The tool's function e3 is as printed. The printed e1, e2 and gamma1 say nothing of their gains at rest (their sums are
within the rounding of their digits, and are refused); lags of the same size stand in their place, with the k of 1 and
0.4 that the paper gives for its tools.
"""

from __future__ import annotations

from pathlib import Path

import numpy as np
import pytest

from thermodata.effect.lag import lag
from thermodata.modelling.model_file.transfer.as_effect import GivenFunction

from .document import hold_table
from .lab import IDLE_S, STEP_S, Lab, Logged, Once, grid, hall_air, made_once, noisy, value, write_logs

E1 = (-4.0, 35.0)  # um/K, min
E2 = (-2.0, 120.0)
E3 = GivenFunction([-0.4099, 0.1057, 0.2872], [1, -0.2835, -0.7063], 1.0)
E3_AT_REST = (-0.4099 + 0.1057 + 0.2872) / (1 - 0.2835 - 0.7063)  # um/K
HEAT_K_KW, HEAT_MIN = 114.0, 8.0  # of the tool by the cut, at k = 1
K = {"D25": 1.0, "D63": 1.0, "D100": 0.4}

# id: role, tool, spindle's power while it cuts [kW], hours of load, hours in all
CUTS = {
    "cut63": ("calibration", "D63", 0.30, 4.0, 7.0),
    "cut25": ("verification", "D25", 0.006, 4.0, 7.0),
    "cut63b": ("verification", "D63", 0.40, 4.0, 7.0),
    "cut100": ("calibration", "D100", 0.7, 3.0, 6.0),
    "cut100b": ("verification", "D100", 2.5, 3.5, 3.75),  # without cooling down, for lack of time
}
FREE = {"free": (6.0, 12.0), "idle": (0.0, 26.0)}


def _write(folder: Path) -> None:
    for day, test in enumerate([*FREE, *CUTS]):
        _, tool, power, load, hours = CUTS.get(test, ("", "D63", 0.0, *FREE.get(test, (0, 0))))
        t = grid(hours)
        work = (t >= IDLE_S) & (t < IDLE_S + load * 3600)
        # layers of 5 min, then both probes are touched for a minute
        measuring = ~work | ((t - IDLE_S) % 360 >= 300) if power else np.ones(len(t), bool)
        air = hall_air(t, 40 + day, 2.0 if test == "idle" else 0.4)
        spindle = (14.0 if power else 18.0) * lag(work.astype(float), 2400.0, STEP_S) + 0.2 * lag(air, 3600.0, STEP_S)
        cut = power * (work & ~measuring)
        chips = K[tool] * HEAT_K_KW * lag(cut, HEAT_MIN * 60, STEP_S)
        frame = E1[0] * lag(spindle, E1[1] * 60, STEP_S) + E2[0] * lag(air, E2[1] * 60, STEP_S)
        write_logs(
            folder,
            test,
            day,
            {
                "dZ": Logged(noisy(frame + E3.simulate(t, chips), day, 0.3), "um", "daq"),
                "dZ_stator": Logged(noisy(frame, 50 + day, 0.3), "um", "daq"),
                "T_tool": Logged(noisy(22 + chips, 100 + day, 0.1), "degC", "daq"),
                "T_air": Logged(noisy(21 + air, 150 + day, 0.02), "degC", "daq"),
                "T_spindle": Logged(noisy(23 + spindle, 200 + day, 0.03), "degC"),
                "P_spindle": Logged(cut, "kW", decimals=4),
                "measuring": Logged(measuring.astype(float), "1", decimals=0),
            },
        )


CAMPAIGN = """\
schema: thermodata/campaign/1
id: p004
machine: {id: five_axis, description: 5-axis milling centre with a table of 630 mm}
channels:
  dZ: {source: daq, signal: Log/dZ, quantity: displacement, unit: V, axis: Z, at: tcp, calibration: probe_z}
  dZ_stator: {source: daq, signal: Log/dZ_stator, quantity: displacement, unit: V, axis: Z, at: stator,
    calibration: probe_z}
  T_tool: {source: daq, signal: Log/T_tool, quantity: temperature, unit: degC, at: tool}
  T_ambient: {source: daq, signal: Log/T_air, quantity: temperature, unit: degC, at: hall}
  T_spindle: {source: nc, signal: T_spindle, quantity: temperature, unit: degC, at: spindle.bearing}
  P: {source: nc, signal: P_spindle, quantity: power, unit: kW, at: spindle}
  touching: {source: nc, signal: measuring, quantity: state, at: probe}
tests:
"""
for _name in [*FREE, *CUTS]:
    _role, _tool = CUTS[_name][:2] if _name in CUTS else ("calibration", "D63")
    CAMPAIGN += f"  - {{id: {_name}, kind: {'cutting' if _name in CUTS else 'mixed'}, role: {_role}, "
    CAMPAIGN += f'tool: {{id: {_tool}}}, measuring: "touching == 1"}}\n'

FRAME = """\
response: {axis: Z, at: stator}
calibrate_on: [free, idle]
effects:
  - {effect: spindle_bearing, id: e1}
  - {effect: ambient_frame, id: e2}
"""
HEAD = "response: {axis: Z, at: tcp}\ncalibrate_on: [cut63, cut100]\neffects:\n"
A = HEAD + "  - {effect: model, name: frame, gain: K}\n"
B = HEAD + (
    "  - {effect: model, name: frame, gain: 1}\n"
    "  - {effect: transfer_function, id: gamma1, drivers: {u: P}, orders: [2, 2], gain_by: tool,\n"
    "     groups: {[D25, D63]: k1, D100: k2}, one_gain: true}\n"
)
C = HEAD + (
    "  - {effect: model, name: frame, gain: 1}\n"
    "  - {effect: transfer_function, id: e3, drivers: {u: T_tool}, orders: [2, 1]}\n"
)


@pytest.fixture(scope="module")
def lab(once: Once, tmp_path_factory: pytest.TempPathFactory) -> Lab:
    made = made_once(once, tmp_path_factory.mktemp("lab"), "p004", CAMPAIGN, _write)
    for name, text in (("frame", FRAME), ("A", A), ("B", B), ("C", C)):
        made.run("fit", made.model(name, "p004", text))
    return made


def test_the_load_free_model_is_found_at_the_stator(lab: Lab) -> None:
    found = lab.json("compare", "frame")
    for name, (gain, tau) in (("e1", E1), ("e2", E2)):
        assert value(found, f"{name}.gain") == pytest.approx(gain, rel=0.03)
        assert value(found, f"{name}.tau") == pytest.approx(tau, rel=0.1)
    fits = {s["test"]: s["fit"] for s in found["scores"] if s["phase"] == "all"}
    assert fits["cut63b"] > 76, "printed for the calibration test"


def test_models_b_and_c_are_found(lab: Lab) -> None:
    b, c = lab.json("compare", "B"), lab.json("compare", "C")
    assert value(b, "gamma1.gain_1") + value(b, "gamma1.gain_2") == pytest.approx(E3_AT_REST * HEAT_K_KW, rel=0.03)
    assert value(b, "gamma1.g[k1]") == 1.0
    assert value(b, "gamma1.g[k2]") == pytest.approx(0.4, rel=0.03)
    assert max(value(b, f"gamma1.tau_{k}") for k in (1, 2)) == pytest.approx(HEAT_MIN, rel=0.1)
    assert value(c, "e3.gain") + value(c, "e3.direct") == pytest.approx(E3_AT_REST, rel=0.03)
    assert value(c, "e3.tau") == pytest.approx(0.0464 * 60, rel=0.1)


def test_the_table_of_the_paper_over_three_tools(lab: Lab) -> None:
    rows = lab.json("compare", "A", "B", "C", "--against", "A")
    mean = {r["name"]: r for r in rows if r["test"] == "mean"}
    for name in ("B", "C"):
        assert mean[name]["initial"] == pytest.approx(mean["A"]["initial"])
        assert mean[name]["residual"] < 0.5 * mean["A"]["residual"] < 0.5 * mean["A"]["initial"]
    assert mean["C"]["fit"] > 86, "printed"
    assert {r["test"] for r in rows if r["name"] == "B" and r["n"]} == {*CUTS, "mean"}
    rough = {r["name"]: r for r in rows if r["test"] == "cut100b"}
    for name in ("B", "C"):
        share = 1 - rough[name]["residual"] / rough["A"]["residual"]
        assert rough[name]["against"] == pytest.approx(100 * share)
        assert rough[name]["fold"] > 5


def test_the_cutting_of_finishing_leaves_the_tool_cold(lab: Lab) -> None:
    """The paper: B covers the stator part only, for the power is a weak signal."""
    rows = lab.json("compare", "B", "C", "--against", "A")
    finishing = {r["name"]: r["residual"] for r in rows if r["test"] == "cut25"}
    assert finishing["B"] == pytest.approx(finishing["C"], rel=0.2)


def test_the_document_has_the_table(lab: Lab) -> None:
    rows = {(r["test"], r["name"]): r for r in lab.json("compare", "A", "B", "C", "--against", "A")}
    printed = {
        "cut25": ("D25, 6 W here", (65, 49, 86)),
        "cut63": ("D63, calibration", (67, 90, 92)),
        "cut63b": ("D63", (76, 87, 86)),
        "cut100": ("D100, 0.7 kW", (48, 84, 85)),
        "cut100b": ("D100, 2.5 kW", (54, 72, 81)),
        "mean": ("mean", (62, 76, 86)),
    }
    lines: list[list[str | float | None]] = []
    for test, (words, fits) in printed.items():
        line: list[str | float | None] = [words]
        for name, fit in zip("ABC", fits, strict=True):
            line += [fit, rows[test, name]["fit"]]
        lines.append(line)
    head = ["test", "FIT A printed [%]", "here", "FIT B printed [%]", "here", "FIT C printed [%]", "here"]
    hold_table("mares2017: FIT", head, lines)
    peaks = [["at first", 118, rows["mean", "A"]["initial"]]]
    peaks += [[name, um, rows["mean", name]["residual"]] for name, um in zip("ABC", (51, 36, 20), strict=True)]
    hold_table("mares2017: peak to valley", ["model", "mean printed [um]", "here"], peaks)


def test_models_of_an_older_state_of_the_data_are_refused(lab: Lab, tmp_path: Path) -> None:
    """Last: it changes the data."""
    path = lab.folder / "campaign.yaml"
    path.write_text(path.read_text().replace("gain: 40.0 um/V, facing: -Z", "gain: 41.0 um/V, facing: -Z"))
    lab.run("ingest", path)
    lab.run("fit", lab.folder / "C.yaml")
    from thermodata.cli import main

    store = str(lab.folder / "thermodata.store")
    assert main(["--store", store, "compare", "C", "--against", "A"]) == 2
