"""The blind benchmark: what counts as right, which seeds may be used, what simple methods find, one whole verdict."""

from __future__ import annotations

import json
from pathlib import Path

import numpy as np
import pytest
from scipy.signal import lfilter

from thermodata.cli import main
from thermodata.errors import UsageError
from thermodata.virtual.blind import run as running
from thermodata.virtual.blind.rivals import RIVALS, STEP_S, Question, stepwise_bic
from thermodata.virtual.blind.seeds import seeds_of
from thermodata.virtual.blind.tally import rows, table_rows, wilson
from thermodata.virtual.blind.trial import judge
from thermodata.virtual.lathe.strata import DEVELOPMENT, SEALED

BLANK = {
    "stratum": "strong",
    "hidden": ["nut_z"],
    "verdict": "effect",
    "outcome": "right",
    "first": "exact",
    "known_again": 0,
    "share": 1.0,
    "faults": 0,
    "faults_found": 0,
    "seconds": 2.0,
    "rivals": dict.fromkeys(RIVALS, True),
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
    silent = {**BLANK, "outcome": "abstained", "share": 0.0, "first": "wrong"}
    nothing = {**BLANK, "stratum": "none_thin", "hidden": [], "outcome": "silent", "verdict": "none", "rivals": {}}
    lie = {**nothing, "outcome": "false claim", "verdict": "effect"}
    blind = {**BLANK, "stratum": "not_logged", "outcome": "false claim", "rivals": {}}
    found = {r["stratum"]: r for r in rows([BLANK, silent, nothing, lie, blind])}
    assert (found["strong"]["named"], found["strong"]["abstained"], found["strong"]["ranked_first"]) == (1, 1, 1)
    assert found["strong"]["share_mean"] == 0.5
    assert (found["none_thin"]["false_claims"], found["none_thin"]["said_none"]) == (1, 1)
    assert (found["all without"]["false_claims"], found["all without"]["nothing_to_name"]) == (2, 3)
    assert found["not_logged"]["asked"] == 0
    assert table_rows([found["strong"]])[0]["named right"] == "1/2 (9%-91%)"


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
    with pytest.raises(UsageError, match="one file"):
        running.run(("strong",), range(SEALED.start, SEALED.start + 1), out=out)
    out.write_text("something else\n", encoding="utf-8")
    with pytest.raises(UsageError, match="not a trial"):
        running.run(("strong",), range(2), out=out)


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
    assert answer["summary"][0]["named"] == 2
    assert main([*command, "--first-seed", str(SEALED.start)]) == 2
    assert "sealed" in capsys.readouterr().err
    assert main([*command, "--hide", "coolant"]) == 2
    assert main(["benchmark-diagnosis", "--sealed"]) == 2


def test_a_strong_cause_is_named_from_end_to_end() -> None:
    """Seed 93 is easy: a thin model lacks the hydraulics. Rules that can not name it have lost something."""
    trial = judge("strong", 93)
    assert trial.outcome in ("right", "equivalent"), trial.claims
    assert trial.first in ("exact", "equivalent")
    assert trial.share is not None
    assert trial.share > 0.8
    assert trial.rmse_um_truth is not None
    assert trial.rmse_um is not None
    assert trial.rmse_um_truth < trial.rmse_um
    assert set(trial.rivals) == set(RIVALS)
    json.dumps(trial.to_json())
