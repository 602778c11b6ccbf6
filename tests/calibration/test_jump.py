"""Jump tests: simulated recordings with a known sensitivity, their symmetries, and what must be refused."""

from __future__ import annotations

import re
from collections.abc import Sequence

import numpy as np
import pytest
from hypothesis import HealthCheck, given, settings
from hypothesis import strategies as st

from thermodata.calibration.jump.evaluate import evaluate_jump
from thermodata.calibration.jump.plateaus import find_steps
from thermodata.calibration.result import CalibrationResult
from thermodata.errors import CalibrationError, RailError
from thermodata.plugin import Float1D, Int1D
from thermodata.schema.files.campaign import JumpCalibration
from thermodata.store.catalogue.format.ddl import TABLES

SHORT = settings(max_examples=40, deadline=None, suppress_health_check=[HealthCheck.too_slow])


def recording(
    moves: Sequence[float],
    gain: float = -25.0,
    *,
    dwell: float = 10.0,
    rate: float = 10.0,
    noise_v: float = 0.004,
    drift: float = 0.0,
    lead: float = 20.0,
    tail: float = 15.0,
    ramp: float = 0.6,
    uneven: float = 0.1,
    bend: float = 0.0,
    seed: int = 0,
) -> tuple[Int1D, Float1D]:
    """(t_ns, volts) of a probe with `gain` [um/V] while the axis makes `moves` [um]; drift in um/s."""
    rng = np.random.default_rng(seed)
    dwells = dwell * (1 + uneven * rng.uniform(-1, 1, len(moves) + 1))
    dwells[0], dwells[-1] = lead, tail
    t = np.arange(0, dwells.sum(), 1 / rate)
    x = drift * t
    for move, at in zip(moves, np.cumsum(dwells)[:-1], strict=True):
        x = x + move * np.clip((t - at) / ramp, 0, 1)
    volts = 10 + (x + bend * x**2) / gain + noise_v * rng.standard_normal(len(t))
    return (t * 1e9).astype(np.int64) + 1_700_000_000_000_000_000, volts


def spec(moves: Sequence[float], **more: object) -> JumpCalibration:
    return JumpCalibration.model_validate(
        {
            "kind": "jump",
            "axis": "Z",
            "source": "daq",
            "file": "jump.tdms",
            "signal": "Eddy/Z",
            "moves": [f"{m} um" for m in moves],
            **more,
        }
    )


def jump(
    moves: Sequence[float], data: tuple[Int1D, Float1D], others: dict[str, Float1D] | None = None, **more: object
) -> CalibrationResult:
    return evaluate_jump("jump_z", spec(moves, **more), *data, others or {})


def failed(result: CalibrationResult) -> set[str]:
    return {c["name"] for c in result.checks if not c["passed"]}


@pytest.mark.parametrize(
    "more",
    [
        {},
        {"rate": 500.0},
        {"rate": 1.0, "ramp": 0.1},
        {"drift": 0.03},
        {"drift": -0.05},
        {"noise_v": 0.04},
        {"ramp": 2.5},
        {"lead": 600.0, "tail": 300.0},
        {"lead": 6.0, "tail": 6.0},
        {"uneven": 0.4},
    ],
)
@pytest.mark.parametrize("moves", [[100, -100], [100, 100, -50, -150], [20, -10, 50, -60]])
def test_finds_the_signed_sensitivity(moves: list[float], more: dict) -> None:
    result = jump(moves, recording(moves, **more))
    assert result.gain == pytest.approx(-25.0, rel=0.015)
    assert result.sign == "-"
    assert result.gain_unit == "um/V"
    assert len(result.detail["plateaus"]) == len(moves) + 1


@pytest.mark.parametrize("moves", [[100, -100], [20, -10, 50, -60], [50, 50, 50]])
@pytest.mark.parametrize("dwell", [3.0, 4.0, 30.0, 60.0])
def test_a_wrong_dwell_is_told_and_does_no_harm(moves: list[float], dwell: float) -> None:
    result = jump(moves, recording(moves, dwell=dwell, lead=2 * dwell, tail=2 * dwell), dwell="10 s")
    assert result.gain == pytest.approx(-25.0, rel=0.01)
    assert failed(result) == {"dwell_s"}


@pytest.mark.parametrize("drift", [0.0, 0.05])
def test_moves_that_take_as_long_as_the_plateaus(drift: float) -> None:
    moves = [50, 100, -50, -100]
    data = recording(moves, dwell=5.0, ramp=2.0, rate=100.0, noise_v=0.001, drift=drift, uneven=0.0)
    assert jump(moves, data, dwell="5 s").gain == pytest.approx(-25.0, rel=0.01)


def test_noise_drift_and_uncertainty_are_those_of_the_recording() -> None:
    moves = [100, -100, 100, -100]
    data = recording(moves, drift=0.02, noise_v=0.01, seed=3)
    result = jump(moves, data, move_uncertainty="2 um")
    assert result.noise_um == pytest.approx(0.25, rel=0.15)
    assert result.detail["drift_um_per_h"] == pytest.approx(72.0, rel=0.1)
    assert 2.0 <= result.uncertainty_pct < 2.5  # 2 um of 100 um, and little more
    assert result.passed


def test_a_staircase_takes_its_drift_from_within_the_plateaus() -> None:
    moves = [50.0] * 5
    result = jump(moves, recording(moves, drift=0.1, noise_v=0.002, rate=50.0))
    assert result.gain == pytest.approx(-25.0, rel=0.01)
    assert result.detail["drift_um_per_h"] == pytest.approx(360.0, rel=0.1)


def test_one_move_tells_neither_drift_nor_nonlinearity() -> None:
    result = jump([100], recording([100]))
    assert result.drift_um is None
    assert result.nonlinearity_pct is None
    assert result.gain == pytest.approx(-25.0, rel=0.01)


def test_a_bent_probe_shows_nonlinearity() -> None:
    moves = [100, 100, 100, -300]
    assert jump(moves, recording(moves)).nonlinearity_pct < 0.2
    bent = jump(moves, recording(moves, bend=1e-3))
    assert bent.nonlinearity_pct > 2.0
    assert "nonlinearity_pct" in failed(bent)


def test_spikes_and_missing_values_do_not_matter() -> None:
    t, v = recording([100, -100])
    clean = jump([100, -100], (t, v)).gain
    v = v.copy()
    v[[30, 150, 250, 300]] += [8.0, -9.0, 50.0, -50.0]
    v[100:103] = np.nan
    assert jump([100, -100], (t, v)).gain == pytest.approx(clean, rel=1e-3)


@pytest.mark.parametrize("mark", [1e38, -1e38, 9.9e37, -9999.0, 32767.0])
@pytest.mark.parametrize("many", [1, 40])
def test_marks_of_a_logger_are_no_readings(mark: float, many: int) -> None:
    t, v = recording([100, -100])
    clean = jump([100, -100], (t, v)).gain
    v = v.copy()
    v[-many:] = mark
    v[150] = mark
    found = jump([100, -100], (t, v))
    assert found.gain == pytest.approx(clean, rel=1e-3)
    assert found.detail["steps_found"] == 2


def test_steps_before_and_after_the_moves_are_left_over() -> None:
    t, v = recording([-400, 100, -60, -40, 900])
    result = jump([100, -60, -40], (t, v))
    assert result.gain == pytest.approx(-25.0, rel=0.01)
    assert result.detail["steps_found"] == 5


@SHORT
@given(
    gain=st.sampled_from([-100.0, -25.0, 4.0, 250.0]),
    scale=st.floats(0.1, 10),
    offset=st.floats(-50, 50),
    seed=st.integers(0, 50),
)
def test_gain_follows_scale_and_ignores_offset(gain: float, scale: float, offset: float, seed: int) -> None:
    moves = [100, -40, 80, -140]
    t, v = recording(moves, gain, noise_v=0.1 / abs(gain), seed=seed)
    plain, changed = jump(moves, (t, v)), jump(moves, (t, offset + scale * v))
    assert plain.gain == pytest.approx(gain, rel=0.01)
    assert changed.gain == pytest.approx(plain.gain / scale, rel=1e-6)
    assert changed.uncertainty_pct == pytest.approx(plain.uncertainty_pct, rel=1e-6)


@SHORT
@given(seed=st.integers(0, 50))
def test_the_sign_turns_with_the_probe_and_with_the_moves(seed: int) -> None:
    moves = [100, -40, 80, -140]
    t, v = recording(moves, seed=seed)
    plain = jump(moves, (t, v))
    assert jump(moves, (t, -v)).gain == pytest.approx(-plain.gain, rel=1e-9)
    assert jump([-m for m in moves], (t, v)).gain == pytest.approx(-plain.gain, rel=1e-9)
    assert jump(moves, (t + 10**15, v)).gain == plain.gain


@pytest.mark.parametrize(
    ("facing", "increases_with", "gain"),
    [("+Z", "gap", 25.0), ("-Z", "gap", -25.0), ("+Z", "approach", -25.0), ("-Z", "approach", 25.0)],
)
def test_the_way_the_probe_looks_must_agree(facing: str, increases_with: str, gain: float) -> None:
    declared = {"facing": facing, "increases_with": increases_with}
    assert jump([100, -40], recording([100, -40], gain), **declared).gain == pytest.approx(gain, rel=0.01)
    with pytest.raises(CalibrationError, match="contradicts") as caught:
        jump([100, -40], recording([100, -40], -gain), **declared)
    both = [float(part) for part in re.findall(r"([+-]\d+\.\d+) um/V", str(caught.value))]
    assert both == pytest.approx([gain, -gain], rel=0.01)


def test_facing_along_another_axis_is_refused() -> None:
    with pytest.raises(CalibrationError, match="axis Z"):
        jump([100, -40], recording([100, -40]), facing="+X", increases_with="gap")


def test_the_data_sheet_is_cross_checked() -> None:
    data = recording([100, -40])
    assert "data_sheet_gain_pct" not in failed(jump([100, -40], data, gain="25.5 um/V"))
    assert "data_sheet_gain_pct" not in failed(jump([100, -40], data, gain="0.025 mm/V"))
    assert "data_sheet_gain_pct" in failed(jump([100, -40], data, gain="50 um/V"))
    assert "data_sheet_gain_pct" in failed(jump([100, -40], data, gain="50 mV/um"))


def test_crosstalk_is_a_signed_percentage_of_the_answer() -> None:
    t, v = recording([100, -40, 60])
    result = jump([100, -40, 60], (t, v), {"Eddy/X": 3 + 0.04 * v, "Eddy/Y": 1 - 0.02 * v, "dead": v * np.nan})
    assert result.crosstalk["Eddy/X"] == pytest.approx(4.0, abs=0.01)
    assert result.crosstalk["Eddy/Y"] == pytest.approx(-2.0, abs=0.01)
    assert np.isnan(result.crosstalk["dead"])
    assert result.passed


def test_swapped_cables_show() -> None:
    moves = [100, -40, 60]
    t, v = recording(moves, noise_v=0.001)
    weak = 10 + 0.03 * (v - 10) + 1e-4 * np.random.default_rng(0).standard_normal(len(v))
    result = jump(moves, (t, weak), {"Eddy/X": v})
    assert {"answers_most", "crosstalk_pct"} <= failed(result)
    advice = next(c["advice"] for c in result.checks if c["name"] == "answers_most")
    assert "Eddy/X" in advice
    deaf = np.random.default_rng(0).normal(10, 0.01, len(v))
    with pytest.raises(CalibrationError, match="'Eddy/X' shows these moves"):
        jump(moves, (t, deaf), {"Eddy/X": v})


def test_moves_that_fit_with_either_sign_are_refused() -> None:
    with pytest.raises(CalibrationError, match="either sign") as refused:
        jump([100, -100], recording([100, -100, 100], uneven=0.0))
    # keys of a calibration, each of which makes it one place
    assert "'moves'" in (refused.value.hint or "")
    assert "facing: +Z, increases_with: gap" in (refused.value.hint or "")


@pytest.mark.parametrize(("facing", "gain"), [("+Z", -25.0), ("-Z", 25.0)])
def test_the_way_a_probe_looks_decides_between_two_signs(facing: str, gain: float) -> None:
    turned = {"facing": facing, "increases_with": "approach"}
    t, v = recording([100, -100, 100], gain, uneven=0.0)
    assert evaluate_jump("jump_z", spec([100, -100], **turned), t, v).gain == pytest.approx(gain, rel=0.05)


def test_the_way_a_probe_looks_decides_nothing_where_the_moves_fit_once() -> None:
    t, v = recording([100, -40], -25.0)
    with pytest.raises(CalibrationError, match="contradicts the way the probe looks"):
        evaluate_jump("jump_z", spec([100, -40], facing="+Z", increases_with="gap"), t, v)


@pytest.mark.parametrize("broken", ["flat", "noise", "short", "nan", "ramp", "other moves"])
def test_a_recording_without_the_moves_is_refused(broken: str) -> None:
    t, v = recording([100, -40])
    rng = np.random.default_rng(0)
    v = {
        "flat": np.full(len(v), 10.0),
        "noise": rng.normal(10, 1, len(v)),
        "short": v,
        "nan": v * np.nan,
        "ramp": np.linspace(0, 10, len(v)),
        "other moves": recording([100, 90])[1],
    }[broken]
    n = 10 if broken == "short" else min(len(t), len(v))
    with pytest.raises(CalibrationError):
        jump([100, -40], (t[:n], v[:n]))


@pytest.mark.parametrize("moves", [[], [0.0], [100, 0]])
def test_moves_of_zero_are_no_jump_test(moves: list[float]) -> None:
    with pytest.raises(CalibrationError, match="not a jump test"):
        jump(moves, recording([100, -40]))


def test_backward_and_repeated_times_are_left_out() -> None:
    t, v = recording([100, -40])
    t = t.copy()
    t[50], t[60] = t[40], t[59]
    assert jump([100, -40], (t, v)).gain == pytest.approx(-25.0, rel=0.01)


def test_a_result_is_a_row_of_the_catalogue_and_back() -> None:
    result = jump([100, -40, 60], recording([100, -40, 60]))
    row = result.row("c")
    table = TABLES.split("create table calibration (")[1].split(");")[0]
    columns = [part.split()[0] for part in table.replace("\n", " ").split(",")]
    assert sorted(row) == sorted(columns)
    assert CalibrationResult.from_row(row) == result


@pytest.mark.parametrize("n", [2, 3, 4])
def test_a_recording_of_a_few_samples_is_refused_not_a_defect(n: int) -> None:
    t_ns, volts = recording([100.0, -100.0])
    with pytest.raises(CalibrationError):
        evaluate_jump("jump_z", spec([100.0, -100.0]), t_ns[:n], volts[:n], {})
    assert find_steps(t_ns[:n] / 1e9, volts[:n], 10.0) == ([], 0.0)
    assert find_steps(t_ns[:n] / 1e9 * 1e-6, volts[:n], 10.0) == ([], 0.0)


def test_a_probe_that_stands_on_its_rail_is_said_to_stand_there() -> None:
    """Moves that aren't found because the voltage ends at 0 V, at 10 V, or nowhere."""
    moves = [100.0, 50.0, -200.0, -50.0, 100.0]
    t_ns, volts = recording(moves, noise_v=0.02)
    for clipped, said in (
        (np.maximum(volts - 6, 0.0), "got: 0 V in"),
        (np.minimum(volts - 2, 10.0), "got: 10 V in"),
    ):
        with pytest.raises(RailError, match="stands at its end of range") as caught:
            jump(moves, (t_ns, clipped))
        assert said in str(caught.value)
        assert "% of the record" in str(caught.value)
        assert "try: set the probe nearer to the middle of its range" in str(caught.value)
    with pytest.raises(CalibrationError, match="are not found") as other:
        jump([100.0, -37.0, 81.0, -19.0], (t_ns, volts))
    assert not isinstance(other.value, RailError)


def test_coarse_volts_without_noise_are_no_rail() -> None:
    t_ns, volts = recording([100.0, 50.0, -200.0, -50.0, 100.0], noise_v=0.0)
    with pytest.raises(CalibrationError, match="are not found"):  # each plateau is one voltage: its last is no rail
        jump([100.0, -37.0, 81.0, -19.0], (t_ns, np.round(volts, 2)))


@pytest.mark.parametrize("rate", [0.2, 10.0])
def test_noise_is_told_of_few_samples_a_plateau(rate: float) -> None:
    moves = [100.0, -100.0, -100.0, 100.0]
    every = {"dwell": 30.0, "lead": 30.0, "tail": 60.0, "uneven": 0.0}
    data = [recording(moves, rate=rate, noise_v=0.004, seed=k, **every) for k in range(6)]
    noise_um = [jump(moves, one, dwell="30 s").noise_um for one in data]
    assert np.mean(noise_um) == pytest.approx(0.1, rel=0.4)
