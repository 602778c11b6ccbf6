"""The blind benchmark: what counts as right, which seeds may be used, what simple methods find, one whole verdict."""

from __future__ import annotations

import json
from pathlib import Path

import numpy as np
import pytest
from scipy.signal import lfilter

from thermodata.cli import main
from thermodata.cli.start.simulating import MACHINES as OFFERED
from thermodata.errors import UsageError
from thermodata.virtual.blind import run as running
from thermodata.virtual.blind.asked import BenchmarkRequest
from thermodata.virtual.blind.goals import overall
from thermodata.virtual.blind.machines import MACHINES
from thermodata.virtual.blind.rivals import RIVALS, STEP_S, Question, _lasso, stepwise_bic
from thermodata.virtual.blind.rules import fingerprint
from thermodata.virtual.blind.seeds import seeds_of
from thermodata.virtual.blind.tally import WITHOUT, rows, wilson
from thermodata.virtual.blind.trial import judge
from thermodata.virtual.blind.wording import goals, text, with_a_cause, without
from thermodata.virtual.lathe.strata import STRATA
from thermodata.virtual.truth.strata import DEVELOPMENT, SEALED

BLANK = {
    "stratum": "strong",
    "seed": 0,
    "hidden": ["nut_z"],
    "base": ["bearing_friction"],
    "by_speed": False,
    "response": "dZ",
    "verdict": "effect",
    "rounds": 1,
    "claims": ["feed_screw:C01_nutZ"],
    "marks": ["exact"],
    "known_again": 0,
    "first": "feed_screw:C01_nutZ",
    "first_mark": "exact",
    "outcome": "right",
    "refinements": [],
    "beside_the_base": 0,
    "stated": [],
    "broken": None,
    "broken_claimed": False,
    "broken_first": False,
    "rmse_um": 5.0,
    "rmse_um_claimed": 1.0,
    "rmse_um_refined": None,
    "rmse_um_named": 1.0,
    "rmse_um_truth": 1.0,
    "share": 1.0,
    "faults": 0,
    "faults_found": 0,
    "artefacts": 0,
    "rivals": dict.fromkeys(RIVALS, True),
    "seconds": 2.0,
}
SILENT = {
    **BLANK,
    "hidden": [],
    "verdict": "unknown",
    "claims": [],
    "marks": [],
    "first_mark": None,
    "outcome": "silent",
    "rivals": {},
    "share": None,
}


def test_seeds_of_one_set_are_never_given_with_the_other() -> None:
    assert seeds_of(None, 3, sealed=False) == range(DEVELOPMENT.start, DEVELOPMENT.start + 3)
    assert seeds_of(None, 3, sealed=True) == range(SEALED.start, SEALED.start + 3)
    for first, sealed in ((SEALED.start, False), (SEALED.start - 1, False), (0, True), (SEALED.start - 1, True)):
        with pytest.raises(UsageError, match="seeds of the"):
            seeds_of(first, 2, sealed)


def test_wilsons_interval_is_the_textbooks() -> None:
    assert wilson(0, 0) is None
    low, high = wilson(27, 42) or (0, 0)
    assert (round(low, 3), round(high, 3)) == (0.492, 0.770)
    assert (wilson(0, 10) or (1, 1))[0] == 0.0
    assert (wilson(10, 10) or (0, 0))[1] == 1.0


def test_the_table_counts_what_could_be_named_apart_from_what_could_not() -> None:
    silent = {**BLANK, "outcome": "abstained", "claims": [], "marks": [], "share": 0.0, "first_mark": "wrong"}
    nothing = {**SILENT, "stratum": "none_thin", "verdict": "none"}
    lie = {**nothing, "outcome": "false claim", "verdict": "effect"}
    blind = {**BLANK, "stratum": "not_logged", "outcome": "false claim", "rivals": {}}
    found = {r["stratum"]: r for r in rows([BLANK, silent, nothing, lie, blind])}
    strong, thin = found["strong"], found["none_thin"]
    assert (strong["named"]["hits"], strong["abstained"], strong["ranked_first"]["hits"]) == (1, 1, 1)
    assert (strong["share"]["mean"], strong["share"]["of"]) == (0.5, 2)
    assert (strong["share_of_claims"]["mean"], strong["share_of_claims"]["of"]) == (1.0, 1)
    assert (thin["false_claims"]["hits"], thin["verdicts"]["none"]["hits"]) == (1, 1)
    assert (found[WITHOUT]["false_claims"]["hits"], found[WITHOUT]["nothing_to_name"]) == (2, 3)
    assert found["not_logged"]["asked"] == 0
    assert with_a_cause([strong])[0]["named right"] == "1/2 (9%-91%)"
    assert without([thin])[0]["none"] == "1/2 (9%-91%)"
    assert with_a_cause([thin]) == []


def test_what_is_said_of_nothing_is_counted_verdict_by_verdict() -> None:
    said = ("none", "refine", "refine", "unknown", "not_testable")
    refined = {"refinements": ["lag:n_S"], "rmse_um_refined": 4.0}
    trials = [{**SILENT, "stratum": "none_full", "verdict": v, **(refined if v == "refine" else {})} for v in said]
    found = rows(trials)[0]
    assert {v: r["hits"] for v, r in found["verdicts"].items()} == {
        "effect": 0,
        "refine": 2,
        "none": 1,
        "unknown": 1,
        "not_testable": 1,
    }
    assert found["verdicts"]["refine"]["interval"] == wilson(2, 5)
    assert found["false_claims"]["hits"] == 0
    assert (found["refined"], found["refined_drop"]["median"]) == (2, pytest.approx(0.2))


def test_thin_models_that_know_the_speed_alone_have_a_row_of_their_own() -> None:
    heat = {**SILENT, "stratum": "none_thin"}
    speed = {**heat, "by_speed": True, "outcome": "false claim", "verdict": "effect"}
    found = {r["stratum"]: r for r in rows([heat, heat, speed])}
    assert (found["none_thin"]["machines"], found["none_thin"]["by_speed"]) == (3, 1)
    assert (found["none_thin, by speed"]["machines"], found["none_thin, by speed"]["false_claims"]["hits"]) == (1, 1)
    assert (found["none_thin, by heat"]["machines"], found["none_thin, by heat"]["false_claims"]["hits"]) == (2, 0)
    assert found[WITHOUT]["machines"] == 3


def test_the_few_figures_that_a_rule_is_judged_by() -> None:
    trials = [
        BLANK,
        {**BLANK, "outcome": "wrong", "first_mark": "wrong"},
        {**BLANK, "stratum": "two", "hidden": ["nut_z", "nut_x"], "outcome": "some", "share": 0.5},
        {**SILENT, "stratum": "none_full", "verdict": "refine"},
        {**BLANK, "stratum": "sensor_fault", "broken": "C13", "broken_claimed": True},
    ]
    found = {r["question"]: r["value"] for r in overall(trials)}
    first = "one strong, logged: ranked first"
    assert (found["one strong, logged: named right"]["hits"], found["one strong, logged: named right"]["of"]) == (1, 2)
    assert found["one strong, logged: named wrong"]["hits"] == 1
    assert (found[first]["hits"], found[f"{first} by LASSO-CV"]["hits"]) == (1, 2)
    assert (found["two hidden: all found"]["hits"], found["two hidden: all found"]["of"]) == (0, 1)
    assert found["nothing hidden: none or refine"]["hits"] == 1
    assert found["a broken channel is claimed"]["hits"] == 1
    assert found["share of the drop, all machines"]["mean"] == pytest.approx(0.875)
    assert "three hidden: all found" not in found
    assert goals(overall(trials))[0]["measured"] == "1/2 (9%-91%)"


def question(noise: float) -> Question:
    """The second of four channels acts through a lag of 90 min."""
    rng = np.random.default_rng(3)
    n, tests = 150, 4
    raw = np.cumsum(rng.standard_normal((n * tests, 4)), axis=0)
    test = np.repeat(np.arange(tests), n)
    a = np.exp(-STEP_S / 5400)
    y = np.concatenate([lfilter([1 - a], [1, -a], raw[test == k, 1] - raw[test == k, 1][0]) for k in range(tests)])
    for k in range(tests):
        raw[test == k] -= raw[test == k][0]
    blank = Question(("a", "b", "c", "d"), y + noise * rng.standard_normal(len(y)), raw, test)
    return Question(blank.names, blank.centred(blank.residual[:, None])[:, 0], raw, test)


@pytest.mark.parametrize("name", RIVALS)
def test_each_simple_method_finds_the_channel_of_an_easy_question(name: str) -> None:
    assert RIVALS[name](question(0.01)) == "b"


def test_the_path_of_lasso_meets_its_conditions() -> None:
    """Pull on each column: the penalty where it has a weight, at most the penalty where it has none."""
    q = question(0.3)
    X, _ = q.lagged()
    top = float(np.max(np.abs(X.T @ q.residual)))
    path = top * np.array([1.01, 0.5, 0.1])
    betas = _lasso(X, q.residual, path)
    assert not betas[0].any()
    for beta, penalty in zip(betas[1:], path[1:], strict=True):
        pull = X.T @ (q.residual - X @ beta)
        held = beta != 0
        assert 0 < held.sum() < len(beta)
        assert np.allclose(pull[held], penalty * np.sign(beta[held]), atol=0.01 * top)
        assert np.all(np.abs(pull[~held]) <= penalty + 0.01 * top)


def test_stepwise_bic_names_nothing_where_nothing_moves() -> None:
    q = question(0.0)
    still = Question(q.names, np.random.default_rng(0).standard_normal(len(q.residual)), 0.0 * q.raw, q.test)
    assert stepwise_bic(still) is None


def test_a_run_goes_on_where_its_file_ends(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    asked: list[tuple[str, int]] = []

    def one(stratum: str, seed: int, rivals: bool) -> dict[str, object]:
        asked.append((stratum, seed))
        return {**BLANK, "stratum": stratum, "seed": seed}

    monkeypatch.setattr(running, "one", one)
    out = tmp_path / "trials.jsonl"
    running.run(("strong",), range(2), out=out)
    found = running.run(("strong", "two"), range(2), out=out)
    assert asked == [("strong", 0), ("strong", 1), ("two", 0), ("two", 1)]
    assert [(t["stratum"], t["seed"]) for t in found] == [("strong", 0), ("strong", 1), ("two", 0), ("two", 1)]
    assert len(out.read_text(encoding="utf-8").splitlines()) == 4
    with pytest.raises(UsageError, match="sealed seeds would stand in one file"):
        running.run(("strong",), range(SEALED.start, SEALED.start + 1), out=out)
    monkeypatch.setattr(running, "fingerprint", lambda: "other")
    with pytest.raises(UsageError, match="two rules would stand in one file"):
        running.run(("strong",), range(2), out=out)
    monkeypatch.undo()
    old = {k: v for k, v in json.loads(out.read_text(encoding="utf-8").splitlines()[0]).items() if k != "stated"}
    out.write_text(json.dumps(old) + "\n", encoding="utf-8")
    with pytest.raises(UsageError, match="another version") as refused:
        running.run(("strong",), range(2), out=out)
    assert "no stated" in str(refused.value)
    out.write_text("something else\n", encoding="utf-8")
    with pytest.raises(UsageError, match="not a trial"):
        running.run(("strong",), range(2), out=out)


def test_a_trial_that_fails_ends_the_run_and_says_where(monkeypatch: pytest.MonkeyPatch) -> None:
    def judge(stratum: str, seed: int, *, rivals: bool) -> object:
        raise ValueError("no such thing")

    monkeypatch.setattr(running, "judge", judge)
    with pytest.raises(RuntimeError, match="stratum two, seed 71 failed: no such thing"):
        running.run(("two",), [71])


def test_the_command_says_which_seeds_it_used_and_refuses_to_mix(
    monkeypatch: pytest.MonkeyPatch, capsys: pytest.CaptureFixture[str]
) -> None:
    monkeypatch.setattr(running, "one", lambda stratum, seed, rivals: {**BLANK, "stratum": stratum, "seed": seed})
    command = ["benchmark-diagnosis", "--json", "--machine", "lathe", "--stratum", "strong", "--seeds", "2"]
    assert main(command) == 0
    said = capsys.readouterr()
    answer = json.loads(said.out)
    assert answer["seeds"] == "development seeds 0 to 1"
    assert "development seeds" in said.err
    assert answer["summary"][0]["named"]["hits"] == 2
    assert answer["overall"][0]["value"]["of"] == 2
    assert answer["rules"] == fingerprint()
    assert main([*command, "--first-seed", str(SEALED.start)]) == 2
    assert "sealed" in capsys.readouterr().err
    assert main([*command, "--hide", "coolant"]) == 2


def test_the_gantry_hides_effects_and_is_counted_by_how_many_are_missing(
    monkeypatch: pytest.MonkeyPatch, capsys: pytest.CaptureFixture[str]
) -> None:
    def one(stratum: str, seed: int, rivals: bool) -> dict[str, object]:
        more = {"hidden": ["coolant", "hydraulics"], "outcome": "some"} if seed else {"hidden": ["coolant"]}
        return {**BLANK, "stratum": stratum, "seed": seed, **more}

    monkeypatch.setattr(running, "one", one)
    command = ["benchmark-diagnosis", "--json", "--hide", "coolant", "--seeds", "3"]
    assert main(command) == 0
    answer = json.loads(capsys.readouterr().out)
    counted = {r["stratum"]: r["machines"] for r in answer["summary"]}
    assert counted == {"coolant": 3, "1 missing": 1, "2 missing": 2, "all with a cause": 3}
    several = "several hidden: some found, nothing wrong"
    assert next(r["value"]["hits"] for r in answer["overall"] if r["question"] == several) == 2
    assert main([*command, "--not-logged"]) == 0
    assert {t["stratum"] for t in json.loads(capsys.readouterr().out)["trials"]} == {"coolant, not logged"}
    assert main([*command, "--stratum", "strong"]) == 2
    assert main(["benchmark-diagnosis", "--hide", "none", "--not-logged"]) == 2, "none has no sensors"
    assert main(["benchmark-diagnosis", "--hide", "coolnat"]) == 2
    assert "coolant" in capsys.readouterr().err


@pytest.mark.parametrize(
    ("machine", "stratum", "of_another"), [("lathe", "strong", "coolant"), ("gantry", "coolant", "strong")]
)
def test_a_run_is_asked_for_and_told_without_a_command(
    monkeypatch: pytest.MonkeyPatch, machine: str, stratum: str, of_another: str
) -> None:
    monkeypatch.setattr(running, "one", lambda stratum, seed, rivals: {**BLANK, "stratum": stratum, "seed": seed})
    used = range(SEALED.start, SEALED.start + 2)
    asked = BenchmarkRequest(machine, used, (stratum,))
    found = asked.answered()
    assert found.seeds == asked.which == f"sealed seeds {SEALED.start} to {SEALED.start + 1}"
    assert found.to_json()["machine"] == machine
    assert "probabilities  none stated" in text(found)
    for wrong in (stratum[:-1], of_another):
        with pytest.raises(UsageError, match=f"no stratum '{wrong}'"):
            BenchmarkRequest(machine, used, (wrong,))


def test_every_stratum_of_a_machine_is_asked_where_none_is_named(monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr(running, "one", lambda stratum, seed, rivals: {**BLANK, "stratum": stratum, "seed": seed})
    for machine, strata in MACHINES.items():
        assert [t["stratum"] for t in BenchmarkRequest(machine, range(1)).answered().trials] == list(strata)
    assert set(OFFERED) == set(MACHINES), "what the command offers is what can be judged"


def test_machines_that_share_their_heat_go_to_one_process() -> None:
    pairs = [(stratum, seed) for seed in (70, 71) for stratum in STRATA]
    groups = list(running.sharing_heat(pairs))
    assert sorted(p for g in groups for p in g) == sorted(pairs)
    assert all(len(g) <= running.TOGETHER for g in groups)
    for group in groups:
        assert len({(seed, STRATA[s].tests, STRATA[s].idle) for s, seed in group}) == 1
    assert len(groups) == 2 * (2 + 4)


def test_the_diagram_is_drawn_where_probabilities_are_stated(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch, capsys: pytest.CaptureFixture[str]
) -> None:
    said = [{"of": "first", "id": "feed_screw:C01_nutZ", "probability": 0.9, "right": True}]
    monkeypatch.setattr(
        running, "one", lambda stratum, seed, rivals: {**BLANK, "stratum": stratum, "seed": seed, "stated": said}
    )
    picture = tmp_path / "reliability.svg"
    command = ["benchmark-diagnosis", "--machine", "lathe", "--stratum", "strong", "--reliability"]
    assert main([*command, str(picture)]) == 0
    assert "Brier 0.010" in capsys.readouterr().out
    assert "ranked first: 1, Brier 0.010" in picture.read_text(encoding="utf-8")
    assert main([*command, str(tmp_path / "reliability.png")]) == 2
    assert "reliability.svg" in capsys.readouterr().err
    monkeypatch.setattr(running, "one", lambda stratum, seed, rivals: {**BLANK, "stratum": stratum, "seed": seed})
    assert main([*command, str(tmp_path / "no.svg")]) == 0
    assert "no answer states a probability" in capsys.readouterr().err
    assert not (tmp_path / "no.svg").exists()


def test_a_strong_cause_is_named_from_end_to_end() -> None:
    """Seed 93 is easy: a thin model lacks the hydraulics. Rules that can not name it have lost something."""
    trial = judge("strong", 93)
    assert trial.outcome in ("right", "equivalent"), trial.claims
    assert trial.first_mark in ("exact", "equivalent")
    assert trial.share is not None
    assert trial.share > 0.8
    assert trial.rmse_um_truth is not None
    assert trial.rmse_um is not None
    assert trial.rmse_um_truth < trial.rmse_um
    assert set(trial.rivals) == set(RIVALS)
    assert json.loads(json.dumps(trial.to_json())).keys() == BLANK.keys()
