"""Exported programs against the model's free run: within 0.01 um with reals of 32 bits, within 1 nm with 64."""

from __future__ import annotations

import io
import json
import re
import subprocess
import sys
from collections.abc import Mapping
from pathlib import Path

import blark
import numpy as np
import pytest

from thermodata.effect import all_effects
from thermodata.export.control.data import as_data, json_text, write_mat
from thermodata.export.control.program import Limits, Program
from thermodata.export.control.python import python_module
from thermodata.export.control.st import structured_text
from thermodata.modelling.model_file.transfer.as_effect import FreeFunction
from thermodata.plugin import Float1D

from .programs import WIDE, Driven, driven, program, readings
from .run_c import COMPILER, run_c
from .run_st import StError, parse

REAL_UM, LREAL_UM = 0.01, 0.001
LAWFUL = sorted(n for n, e in all_effects().items() if hasattr(e, "law"))
needs_c = pytest.mark.skipif(COMPILER is None, reason="no C compiler (gcc, cc, clang) is installed")


def two_lags() -> list[Driven]:
    """The case of the papers: lags of 20 and 180 min."""
    fast, slow = driven("lag", 12.0, tau=20.0), driven("lag", 25.0, tau=180.0)
    return [fast, slow]


def free_run(terms: list[Driven], cycle_s: float, values: Mapping[str, Float1D]) -> Float1D:
    t = np.arange(len(next(iter(values.values())))) * cycle_s
    return np.asarray(np.sum([one.free_run(t, values) for one in terms], axis=0))


def run_st(made: Program, values: Mapping[str, Float1D], real: str, dialect: str = "st") -> Float1D:
    block = parse(structured_text(made, real, dialect))
    held, out = block.instance(), []
    for k in range(len(next(iter(values.values())))):
        block.call(held, **{i.name: values[i.channel][k] for i in made.inputs})
        out.append(float(held["displacement"]))
    return np.array(out)


def run_python(made: Program, values: Mapping[str, Float1D], folder: Path) -> Float1D:
    """In an interpreter of its own: no site, no packages, not this project."""
    (folder / "model.py").write_text(python_module(made), encoding="utf-8")
    names = [i.name for i in made.inputs]
    rows = io.StringIO()
    rows.write(",".join(names) + "\n")
    for row in zip(*(values[n] for n in names), strict=True):
        rows.write(",".join("" if np.isnan(v) else repr(float(v)) for v in row) + "\n")
    done = subprocess.run(
        [sys.executable, "-I", "-S", str(folder / "model.py")],
        input=rows.getvalue(),
        capture_output=True,
        text=True,
        check=True,
        cwd=folder,
    )
    return np.array([float(line.split(",")[1]) for line in done.stdout.splitlines()[1:]])


@needs_c
@pytest.mark.parametrize("cycle_s", [0.1, 1.0, 10.0, 60.0])
@pytest.mark.parametrize(("real", "most"), [("REAL", REAL_UM), ("LREAL", LREAL_UM)])
def test_a_day_in_c_is_the_free_run(cycle_s: float, real: str, most: float, tmp_path: Path) -> None:
    terms = two_lags()
    values = readings(terms, cycle_s)
    truth = free_run(terms, cycle_s, values)
    made = run_c(program(terms, cycle_s), real, values, tmp_path)
    assert np.ptp(truth) > 100.0
    assert np.abs(made[:, 0] - truth).max() < most


@needs_c
def test_a_reading_that_stands_still_needs_the_second_word(tmp_path: Path) -> None:
    """In one word of 32 bits a state stalls where its change is below the last digit; in two it arrives."""
    from thermodata.export.control import c
    from thermodata.export.control.body import make_body

    terms = two_lags()
    values = {"u_0": np.where(np.arange(864_001) < 36_000, 22.0, 32.0)}
    truth = free_run(terms, 0.1, values)
    made = run_c(program(terms, 0.1), "REAL", values, tmp_path)
    assert np.abs(made[:, 0] - truth).max() < REAL_UM
    (tmp_path / "one").mkdir()
    with pytest.MonkeyPatch.context() as patch:
        patch.setattr(c, "make_body", lambda p, compensated: make_body(p, compensated=False))
        one = run_c(program(terms, 0.1), "REAL", values, tmp_path / "one")
    assert np.abs(one[:, 0] - truth).max() > 10 * REAL_UM


@pytest.mark.parametrize("name", LAWFUL)
def test_every_effect_with_a_law_runs_as_structured_text(name: str) -> None:
    terms = [driven(name)]
    values = readings(terms, 30.0, hours=8)
    truth = free_run(terms, 30.0, values)
    assert np.abs(truth).max() > 1.0
    assert np.abs(run_st(program(terms, 30.0), values, "REAL") - truth).max() < REAL_UM
    assert np.abs(run_st(program(terms, 30.0), values, "LREAL", "scl") - truth).max() < LREAL_UM


@needs_c
def test_all_effects_in_one_c_program(tmp_path: Path) -> None:
    terms = [driven(name) for name in LAWFUL]
    values = readings(terms, 1.0, hours=3)
    truth = free_run(terms, 1.0, values)
    made = run_c(program(terms, 1.0), "LREAL", values, tmp_path)
    assert np.abs(made[:, 0] - truth).max() < LREAL_UM
    (tmp_path / "real").mkdir()
    made = run_c(program(terms, 1.0), "REAL", values, tmp_path / "real")
    assert np.abs(made[:, 0] - truth).max() < REAL_UM * len(terms)


def test_the_python_runs_alone(tmp_path: Path) -> None:
    terms = [driven("ambient_skin"), driven("spindle_heating_cooling"), driven("screw_growth")]
    values = readings(terms, 10.0, hours=6)
    made = run_python(program(terms, 10.0), values, tmp_path)
    assert np.abs(made - free_run(terms, 10.0, values)).max() < LREAL_UM


@pytest.mark.parametrize("orders", [(1, 2), (2, 2), (3, 2), (2, 1)])
def test_an_identified_function_is_itself_at_the_step_of_its_fit(orders: tuple[int, int], tmp_path: Path) -> None:
    found = driven(FreeFunction("oe", orders), 5.0, tau=40.0, tau_1=15.0, tau_2=120.0)  # type: ignore[arg-type]
    values = readings([found], 60.0, hours=12)
    truth = free_run([found], 60.0, values)
    made = run_python(program([found], 60.0, step_s=60.0), values, tmp_path)
    assert np.abs(made - truth).max() < LREAL_UM
    # and between the samples of the fit: the same answer at the same moments, for inputs that run straight
    fine = {c: np.interp(np.arange((len(v) - 1) * 60 + 1), np.arange(len(v)) * 60, v) for c, v in values.items()}
    made = run_python(program([found], 1.0, step_s=60.0), fine, tmp_path)
    assert np.abs(made[::60] - truth).max() < LREAL_UM


@pytest.mark.parametrize("orders", [(1, 1), (2, 1), (3, 2)])
def test_lags_with_a_direct_term_beside_them_run_at_any_cycle(orders: tuple[int, int], tmp_path: Path) -> None:
    found = driven(FreeFunction("varpro", orders), 5.0, tau=40.0, tau_1=15.0, tau_2=120.0)  # type: ignore[arg-type]
    values = readings([found], 10.0, hours=4)
    made = run_python(program([found], 10.0, step_s=60.0), values, tmp_path)
    assert np.abs(made - free_run([found], 10.0, values)).max() < LREAL_UM


def test_json_and_mat_say_the_same(tmp_path: Path) -> None:
    from scipy.io import loadmat

    made = program([*two_lags(), driven("centrifugal_shift")], 1.0)
    data = json.loads(json_text(made))
    assert data == json.loads(json.dumps(as_data(made)))
    values = readings(two_lags(), 1.0, hours=2)
    x, old, out = {}, {}, []
    u0 = values["u_0"][0]
    for value in values["u_0"]:  # run the JSON by the rule that stands in it
        u = value - u0
        for s in data["states"]:
            rate = s["rates"][0]
            x[s["name"]] = (
                x[s["name"]] + rate["forgotten"] * (old[s["name"]] - x[s["name"]]) + rate["new"] * (u - old[s["name"]])
                if old.get(s["name"]) is not None
                else 0.0
            )
            old[s["name"]] = u
        out.append(sum(eval(t["formula"], {"d_speed_0": 0.0, "d_u_0": u, **x}) for t in data["terms"]))
    assert np.abs(np.array(out) - free_run(two_lags(), 1.0, values)).max() < LREAL_UM
    write_mat(made, tmp_path / "model.mat")
    mat = loadmat(tmp_path / "model.mat", simplify_cells=True)["model"]
    assert mat["forgotten"][:, 0].tolist() == [s["rates"][0]["forgotten"] for s in data["states"]]
    assert set(re.findall("`(\\w+)`", mat["rule"])) <= set(mat), "what the rule names is there"
    assert set(re.findall("`(\\w+)`", data["rule"])) <= set(data["states"][0])
    assert list(mat["term_formulas"]) == [t["formula"] for t in data["terms"]]


# ---- readings that are bad, limits, start


def block_of(limits: Limits = WIDE, cycle_s: float = 1.0) -> tuple[object, dict[str, object], Program]:
    made = program([driven("static", 1.0)], cycle_s, limits, low=-40.0)
    block = parse(structured_text(made, "REAL"))
    return block, block.instance(), made


def test_a_bad_reading_is_held_counted_and_bounded() -> None:
    block, held, _ = block_of(Limits(1e6, 1e9, hold_s=5.0))
    step = block.call  # type: ignore[attr-defined]
    step(held, u_0=20.0)
    step(held, u_0=23.0)
    assert held["displacement"] == 3.0
    for k, bad in enumerate((float("nan"), -99.0, 2e5, float("inf"), float("nan")), 1):
        step(held, u_0=bad)
        assert held["displacement"] == 3.0
        assert held["bad_u_0"] == k
        assert not held["fault"]
    step(held, u_0=24.0, valid_u_0=False)
    assert held["fault"]
    assert held["correction"] == -3.0
    assert held["lost_u_0"] == 6
    step(held, u_0=24.0, valid_u_0=True)
    assert not held["fault"]
    assert (held["bad_u_0"], held["lost_u_0"], held["correction"]) == (0, 6, -4.0)


def test_at_a_fault_the_correction_stands_still_though_the_model_goes_on() -> None:
    terms = [driven("lag", 1.0, tau=1.0), driven("static", 1.0)]
    both = Driven(terms[1].effect, {"u": "other"}, {}, {"gain": 1.0})
    made = program([terms[0], both], 1.0, Limits(1e6, 1e9, hold_s=2.0))
    block = parse(structured_text(made, "LREAL"))
    held = block.instance()
    for k in range(12):
        block.call(held, u_0=20.0 if k < 5 else float("nan"), other=20.0 + k)
    assert held["fault"]
    assert held["displacement"] == 11.0
    assert held["correction"] == -6.0  # of the last cycle before the fault


def test_it_waits_for_the_first_good_reading_of_all() -> None:
    block, held, _ = block_of()
    step = block.call  # type: ignore[attr-defined]
    step(held, u_0=float("nan"))
    assert (held["running"], held["correction"]) == (False, 0.0)
    step(held, u_0=30.0)
    assert held["running"]
    assert held["displacement"] == 0.0


def test_size_and_rate_of_the_correction_are_limited() -> None:
    block, held, _ = block_of(Limits(correction=5.0, rate=60.0))
    step = block.call  # type: ignore[attr-defined]
    step(held, u_0=20.0)
    seen = []
    for _ in range(8):
        step(held, u_0=50.0)
        seen.append(float(held["correction"]))  # type: ignore[arg-type]
    assert seen == [-1.0, -2.0, -3.0, -4.0, -5.0, -5.0, -5.0, -5.0]
    assert held["limited"]
    step(held, u_0=10.0)
    assert held["correction"] == -4.0


def test_it_goes_on_from_the_last_state_or_starts_from_balance(tmp_path: Path) -> None:
    terms = two_lags()
    values = readings(terms, 60.0, hours=8)
    scope: dict[str, object] = {"__name__": "model"}
    exec(python_module(program(terms, 60.0)), scope)
    make = scope["Model"]
    whole, first, second = make(), make(), make()  # type: ignore[operator]
    u = values["u_0"].tolist()
    told = [whole.step(v)[0] for v in u]
    for v in u[:200]:
        first.step(v)
    second.restore(json.loads(json.dumps(first.state())))
    assert [second.step(v)[0] for v in u[200:]] == told[200:]
    assert second.step(u[-1], restart=True)[0] == 0.0
    assert second.step(u[-1])[0] == 0.0


# ---- what is written


@pytest.mark.parametrize("dialect", ["st", "scl"])
@pytest.mark.parametrize("real", ["REAL", "LREAL"])
def test_the_text_keeps_the_rules_of_the_language(dialect: str, real: str) -> None:
    made = program([driven(name) for name in LAWFUL], 1.0)
    text = structured_text(made, real, dialect)
    assert parse(text).real == real
    assert text.isascii()
    for broken, why in (
        (text.replace("fault := ", "fault = ", 1), "expected :="),
        (text.replace("END_IF;", "END_IF", 1), "expected ;"),
        (text.replace("starting : BOOL", "starting : DINT", 1), "implicit"),
    ):
        with pytest.raises(StError, match=why):
            parse(broken)


def test_an_independent_parser_takes_the_structured_text() -> None:
    """Every effect with 64 bits; the other type is another word in the same places."""
    for names, real in ((LAWFUL, "LREAL"), (LAWFUL[:2], "REAL")):
        text = structured_text(program([driven(name) for name in names], 1.0), real)
        assert blark.parse_source_code(text).exception is None
    assert blark.parse_source_code(text.replace(":=", "=:", 1)).exception is not None


def test_units_version_and_parameters_stand_in_the_comments() -> None:
    made = program([driven("lag", 12.0, tau=20.0)], 0.5)
    for text in (structured_text(made), python_module(made), structured_text(made, dialect="scl")):
        for told in ("test 0123456789ab", "tau = 20 min", "gain = 12 um/u", "every 0.5 s", "[um]", "[degC]"):
            assert told in text, told


# ---- the whole way from a fitted model


def test_another_models_output_runs_in_a_control_and_phases_are_refused(tmp_path: Path) -> None:
    """Model A of [mares2017]: a frame's output times a gain is its own effects, each times that gain."""
    from thermodata.modelling.model_file.nested import ModelOutput
    from thermodata.modelling.seen import laws as room
    from thermodata.modelling.terms.bound import BoundResponse, BoundTerm
    from thermodata.modelling.terms.fitted_response import FittedResponse, FittedTerm, Values
    from thermodata.schema.files.model import EffectSpec
    from thermodata.view.grid.dataset import ChannelInfo

    one = driven("spindle_bearing")
    channels = {"T": ChannelInfo("T", "temperature", "degC", "spindle.bearing")}
    spec = EffectSpec(effect="spindle_bearing")
    bound = BoundTerm("bearing", one.effect, spec, {"c": {"temperature": "T"}}, "spindle")
    inner = FittedTerm(bound, {"": Values({"tau": 20.0}, {"gain": 3.0})})
    frame = FittedResponse(BoundResponse("dY", "um", {"c": "dY"}, (bound,)), (inner,), None, frozenset())
    made = ModelOutput(frame, "frame", "K")
    outer = BoundTerm("frame", made, EffectSpec(effect="model", name="frame"), {"c": {}}, "model")  # type: ignore[arg-type]
    whole = FittedResponse(
        BoundResponse("dZ", "um", {"c": "dZ"}, (outer,)),
        (FittedTerm(outer, {"": Values({}, {"K": 2.0})}),),
        None,
        frozenset(),
    )
    (term,) = room.laws(whole, channels, 60.0)
    assert term.why_not is None
    assert [(g.name, g.value) for g in term.gains] == [("bearing.gain", 6.0)]
    assert [d.text for d in term.drives.values()] == ["T"]
    phased = FittedTerm(
        BoundTerm("b", one.effect, EffectSpec(effect="spindle_bearing", phases=["heating"]), bound.bindings, "spindle"),
        inner.groups,
    )
    (refused,) = room.laws(FittedResponse(whole.bound, (phased,), None, frozenset()), channels, 60.0)
    assert "phases only (heating)" in str(refused.why_not)
