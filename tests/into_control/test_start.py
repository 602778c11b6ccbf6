"""Where temperatures count from in a control: as in a prediction, not from one reading of a coarse sensor."""

from __future__ import annotations

from pathlib import Path

import numpy as np
import pytest

from thermodata.export.control.data import as_data
from thermodata.export.control.program import Program, Start
from thermodata.export.control.python import python_module
from thermodata.export.control.st import structured_text
from thermodata.modelling.inputs.drivers import start_value, still_within
from thermodata.plugin import Float1D

from .programs import Driven, driven, program
from .run_c import COMPILER, run_c
from .run_st import parse

CYCLE_S, STEP_S = 5.0, 60.0
needs_c = pytest.mark.skipif(COMPILER is None, reason="no C compiler (gcc, cc, clang) is installed")


def tenths(rise_k_per_min: float = 0.0, rest_min: float = 15.0) -> Float1D:
    """Two hours of a sensor with 0.1 K and some noise, whose first reading is half a digit off; cycle of 5 s."""
    t = np.arange(0.0, 7200.0, CYCLE_S)
    rise = np.clip((t - rest_min * 60.0) / 3600.0, 0.0, None) * 8.0 + rise_k_per_min * t / 60.0
    read = np.round(20.33 + rise + np.random.default_rng(3).normal(0.0, 0.04, len(t)), 1)
    read[0] = 20.4
    return np.asarray(read, dtype=np.float64)


def bins(read: Float1D) -> Float1D:
    return np.asarray(read.reshape(-1, int(STEP_S / CYCLE_S)).mean(axis=1))


def of(read: Float1D, term: Driven) -> Program:
    return program([term], CYCLE_S, start=Start(int(STEP_S / CYCLE_S), 5), band=still_within(bins(read)))


def displacement(made: Program, read: Float1D) -> Float1D:
    scope: dict[str, object] = {"__name__": "model"}
    exec(python_module(made), scope)
    model = scope["Model"]()  # type: ignore[operator]
    return np.array([model.step(float(v))[0] for v in read])


def test_at_rest_it_counts_from_the_mean_that_a_prediction_counts_from() -> None:
    read, term = tenths(), driven("static", 10.0)
    found = displacement(of(read, term), read)
    wanted = 10.0 * (read - start_value(bins(read), STEP_S))
    assert abs(wanted[0]) > 0.4  # what one reading of 0.1 K would leave through all of the two hours
    assert np.abs(found - wanted)[int(300 / CYCLE_S) :].max() < 1e-9
    assert abs(displacement(program([term], CYCLE_S), read) - wanted)[-1] > 0.4


def test_a_lag_forgets_the_minutes_in_which_the_start_was_sought() -> None:
    read, term = tenths(), driven("lag", 10.0, tau=35.0)
    t = np.arange(len(read)) * CYCLE_S
    moved = read - start_value(bins(read), STEP_S)
    wanted = term.free_run(t, {"u_0": np.concatenate([[0.0], moved[1:]])})
    assert np.abs(displacement(of(read, term), read) - wanted).max() < 0.05


@pytest.mark.parametrize("rate", [0.5, -0.5])
def test_one_that_moves_from_the_first_on_counts_from_where_it_was_then(rate: float) -> None:
    read, term = tenths(rate, rest_min=200.0), driven("static", 10.0)
    found = displacement(of(read, term), read)
    assert found[-1] == pytest.approx(10.0 * (read[-1] - 20.33), abs=0.3)


def test_a_restart_seeks_it_anew() -> None:
    block = parse(structured_text(of(tenths(), driven("static", 1.0)), "LREAL"))
    held = block.instance()
    for v in (20.0, 20.1):
        block.call(held, u_0=v)
    assert held["ref_d_u_0"] == pytest.approx(20.05)
    block.call(held, u_0=31.0, restart=True)
    assert held["ref_d_u_0"] == 31.0
    assert held["displacement"] == 0.0


@needs_c
def test_every_language_starts_alike(tmp_path: Path) -> None:
    read, term = tenths(), driven("lag", 10.0, tau=35.0)
    made = of(read, term)
    wanted = displacement(made, read)
    for real in ("REAL", "LREAL"):
        (tmp_path / real).mkdir()
        assert np.abs(run_c(made, real, {"u_0": read}, tmp_path / real)[:, 0] - wanted).max() < 1e-3
        block = parse(structured_text(made, real))
        held, out = block.instance(), []
        for v in read:
            block.call(held, u_0=v)
            out.append(float(held["displacement"]))
        assert np.abs(np.array(out) - wanted).max() < 1e-3


def test_the_program_says_what_it_counts_from() -> None:
    made = of(tenths(), driven("static", 10.0))
    assert "their mean of the next 5 min" in structured_text(made)
    data = as_data(made)
    assert data["start"]["bin_cycles"] == 12
    assert data["drives"][0]["still_within"] > 0
    assert as_data(program([driven("static", 10.0)], CYCLE_S))["start"] is None
