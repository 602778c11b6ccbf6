"""What a jump test is judged by, just inside and just outside each limit."""

from __future__ import annotations

from dataclasses import replace
from typing import Any

import numpy as np
import pytest

from thermodata.calibration.jump.checks import EvaluatedJump, rows
from thermodata.calibration.jump.fit import JumpFit
from thermodata.calibration.jump.plateaus import Plateau
from thermodata.calibration.result import Check
from thermodata.schema.files.campaign import JumpCalibration

FIT = JumpFit(
    gain=-50.0,
    offset=0.0,
    uncertainty_pct=1.0,
    noise_um=0.1,
    nonlinearity_pct=0.5,
    drift_um=0.5,
    drift_um_per_s=0.01,
    residual_um=np.zeros(3),
    span_um=100.0,
)


def spec(**more: Any) -> JumpCalibration:
    return JumpCalibration.model_validate(
        {
            "kind": "jump",
            "axis": "Z",
            "source": "daq",
            "file": "j.tdms",
            "signal": "Z",
            "moves": ["100 um", "-100 um"],
            **more,
        }
    )


def plateaus(*dwells: float) -> list[Plateau]:
    return [Plateau(0.0, 0.0, d, 0.0, 0.0, 0.0, 10) for d in dwells]


def judged(
    changed: dict[str, Any] | None = None,
    *,
    moves: tuple[float, ...] = (100.0, -100.0),
    crosstalk: dict[str, float] | None = None,
    dwells: tuple[float, ...] = (10.0,) * 4,
    unit: str = "V",
    **more: Any,
) -> dict[str, Check]:
    fit = replace(FIT, **(changed or {}))
    found = rows(EvaluatedJump(spec(**more), list(moves), fit, crosstalk or {}, plateaus(*dwells), unit))
    return {c["name"]: c for c in found}


def failed(found: dict[str, Check]) -> list[str]:
    assert all(bool(c["advice"]) is not c["passed"] for c in found.values()), "advice where there is something to do"
    return [name for name, c in found.items() if not c["passed"]]


def test_a_sound_jump_test_passes_every_check() -> None:
    assert failed(judged(crosstalk={"x": 1.0}, gain="50 um/V")) == []


@pytest.mark.parametrize(
    ("rule", "changed", "fails"),
    [
        ("uncertainty_pct", {"uncertainty_pct": 5.0}, False),
        ("uncertainty_pct", {"uncertainty_pct": 5.01}, True),
        ("noise_pct_of_move", {"noise_um": 5.0}, False),
        ("noise_pct_of_move", {"noise_um": 5.01}, True),
        ("nonlinearity_pct", {"nonlinearity_pct": 2.0}, False),
        ("nonlinearity_pct", {"nonlinearity_pct": 2.01}, True),
        ("drift_pct", {"drift_um": 5.0}, False),
        ("drift_pct", {"drift_um": 5.01}, True),
        ("drift_pct", {"drift_um": -5.01}, True),
    ],
)
def test_a_limit_of_the_fit(rule: str, changed: dict[str, float], fails: bool) -> None:
    found = judged(changed)
    assert failed(found) == ([rule] if fails else [])
    assert rule in found


def test_noise_counts_against_the_smallest_move() -> None:
    assert failed(judged({"noise_um": 2.51}, moves=(100.0, -50.0))) == ["noise_pct_of_move"]
    assert failed(judged({"noise_um": 2.49}, moves=(100.0, -50.0))) == []


def test_what_cannot_be_told_is_not_judged() -> None:
    assert not {"nonlinearity_pct", "drift_pct", "crosstalk_pct", "answers_most", "data_sheet_gain_pct"} & set(
        judged({"nonlinearity_pct": None, "drift_um": None}, crosstalk={"x": float("nan")})
    )


@pytest.mark.parametrize(
    ("percent", "names"),
    [
        (10.0, []),
        (10.1, ["crosstalk_pct"]),
        (-10.1, ["crosstalk_pct"]),
        (99.9, ["crosstalk_pct"]),
        (100.0, ["crosstalk_pct", "answers_most"]),
    ],
)
def test_another_probe_that_answers(percent: float, names: list[str]) -> None:
    found = judged(crosstalk={"little": 1.0, "x": percent, "no data": float("nan")})
    assert failed(found) == names
    assert found["crosstalk_pct"]["value"] == abs(percent)
    assert all("'x'" in found[name]["advice"] for name in names)


@pytest.mark.parametrize(("gain", "fails"), [(54.99, False), (55.01, True), (-45.01, False), (44.99, True)])
def test_a_data_sheet_may_be_ten_percent_off(gain: float, fails: bool) -> None:
    """Whatever its sign: a data sheet knows nothing of the way the probe looks."""
    assert failed(judged({"gain": gain}, gain="50 um/V")) == (["data_sheet_gain_pct"] if fails else [])


def test_a_data_sheet_in_other_units() -> None:
    assert failed(judged({"gain": 0.05}, gain="0.05 mm/V", unit="mV")) == []
    assert failed(judged({"gain": 50.0}, gain="0.05 mm/V", unit="mV")) == ["data_sheet_gain_pct"]
    assert judged(gain="50 um/K")["data_sheet_gain_pct"]["value"] is None
    assert failed(judged(gain="50 um/K")) == ["data_sheet_gain_pct"]


@pytest.mark.parametrize(("dwell", "fails"), [(4.0, False), (3.99, True), (25.0, False), (25.01, True)])
def test_a_plateau_lasts_two_fifths_to_two_and_a_half_of_a_dwell(dwell: float, fails: bool) -> None:
    """The median of those between the first and the last, which may last as long as they like."""
    assert failed(judged(dwells=(500.0, dwell, dwell, 500.0))) == (["dwell_s"] if fails else [])


def test_without_a_plateau_between_two_moves_the_dwell_is_taken_as_declared() -> None:
    assert failed(judged(dwells=(500.0, 500.0))) == []


@pytest.mark.parametrize(
    ("gain", "noise_um", "unit", "fails"),
    [
        (5001.0, 5.01, "V", True),
        (4999.0, 5.01, "V", False),
        (5001.0, 4.99, "V", False),
        (5001.0, 5.01, "mV", False),  # of a bridge without an amplifier
        (0.19, 0.0004, "Volts", True),
        (0.21, 0.0004, "Volts", False),
        (0.19, 0.0006, "Volts", False),
        (1.0, 0.5, "mm", False),
    ],
)
def test_a_probe_that_no_maker_sells(gain: float, noise_um: float, unit: str, fails: bool) -> None:
    moves = (10_000.0, -10_000.0) if gain > 1 else (100.0, -100.0)
    found = judged({"gain": -gain, "noise_um": noise_um, "span_um": 1e4}, moves=moves, unit=unit)
    assert failed(found) == (["probe_um_per_v"] if fails else [])


def test_moves_in_mm_for_um_are_asked() -> None:
    changed = {"gain": -79997.0, "noise_um": 61.0, "span_um": 50_000.0}
    wrong = judged(changed, moves=(10_000.0, -10_000.0))["probe_um_per_v"]
    assert (wrong["threshold"], wrong["value"]) == (5000.0, 79997.0)
    assert "um rather than mm" in str(wrong["advice"])
    assert "mm rather than um" in str(judged({"gain": 0.08, "noise_um": 6e-5})["probe_um_per_v"]["advice"])
    assert "probe_um_per_v" not in judged(changed, moves=(10_000.0, -10_000.0), gain="80 mm/V")  # a data sheet knows
