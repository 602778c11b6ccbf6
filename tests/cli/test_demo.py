from __future__ import annotations

import json
import re
from pathlib import Path
from typing import Any

import pytest
import yaml

import thermodata.diagnosis.run
import thermodata.virtual
from thermodata.cli.start.demo import prepare, summary_text
from thermodata.errors import UsageError
from thermodata.schema.answers.diagnosis import Diagnosis
from thermodata.virtual import Truth

from ..commands import Say

KEYS = {
    "hidden",
    "found",
    "verdict",
    "claims",
    "refinements",
    "probability",
    "family",
    "equivalents",
    "rmse_um_before",
    "rmse_um_after",
    "locked_rmse_um_before",
    "locked_rmse_um_after",
    "locked_rmse_um_fitted",
    "model",
    "store",
    "report",
    "seconds",
}


@pytest.fixture
def small(monkeypatch: pytest.MonkeyPatch) -> None:
    """A machine with few and short tests, and a model of two effects: the story's mechanics, not its findings."""
    simulate = thermodata.virtual.simulate

    def simulated(folder: Path, *, hide: str, seed: int) -> Truth:
        truth = simulate(folder, hide=hide, seed=seed, tests=4, hours=4.0, rate_hz=0.1)
        model = yaml.safe_load((folder / "model.yaml").read_text())
        assert len(model["effects"]) > 2
        (folder / "model.yaml").write_text(yaml.safe_dump({**model, "effects": model["effects"][:2]}))
        return truth

    monkeypatch.setattr(thermodata.virtual, "simulate", simulated)


@pytest.mark.usefixtures("small")
def test_the_story_runs_and_runs_again_in_its_folder(say: Say, tmp_path: Path) -> None:
    folder = tmp_path / "demo"
    said = say("demo", folder, "--hide", "feed_screw", "--json")
    assert said.code == 0, said.err
    assert said.err == "", "with --json the story is not told"
    result = json.loads(said.out)
    assert set(result) == KEYS
    assert result["hidden"] == "feed_screw"
    assert (result["found"] is None) == (result["rmse_um_after"] is None)
    assert 100_000 < Path(result["report"]).stat().st_size < 1_000_000

    (folder / "mine.txt").write_text("kept")
    own = tmp_path / "own"
    said = say("demo", folder, "--hide", "none", "--store", own)
    assert said.code == 0, said.err
    assert "7/7 report" in said.err
    assert "hidden" in said.out
    assert (folder / "mine.txt").read_text() == "kept", "only what a demo made is cleared"
    assert (own / "catalog.duckdb").exists(), "a store that is named is the one that is used"
    assert not (folder / "thermodata.store").exists(), "what a demo made is cleared"


def answers_with(monkeypatch: pytest.MonkeyPatch, verdict: str, **marks: object) -> list[str]:
    """The diagnosis finds what it finds, and its first two candidates are marked; their ids, once it was asked."""
    real, ids = thermodata.diagnosis.run.diagnose, []

    def marked(*asked: Any) -> Diagnosis:
        found = real(*asked)
        ids.extend(c.id for c in found.candidates[:2])
        plain = {"claimed": False, "refinement": False}
        candidates = [c.model_copy(update=plain | (marks if c.id in ids else {})) for c in found.candidates]
        return found.model_copy(update={"verdict": verdict, "candidates": candidates})

    monkeypatch.setattr(thermodata.diagnosis.run, "diagnose", marked)
    return ids


@pytest.mark.usefixtures("small")
def test_all_claims_of_one_answer_are_added(say: Say, tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    ids = answers_with(monkeypatch, "effect", claimed=True, probability=0.94)
    said = say("demo", tmp_path / "demo", "--hide", "feed_screw")
    assert said.code == 0, said.err
    assert f"add {ids[0]} and {ids[1]}, and compare again" in said.err
    assert re.search(r"(, not told from [^;]*)?, probability 94 %( \(that it is one of these\))?, and ", said.err)
    assert f"{ids[0]} and {ids[1]}" in said.out
    store = tmp_path / "demo" / "thermodata.store"
    rows = json.loads(say("--store", store, "sql", "select count(*) as n from history", "--json").out)
    assert rows[0]["n"] == 2, "the model, and one version with all that is claimed"


@pytest.mark.usefixtures("small")
def test_refinements_are_offered_and_not_added(say: Say, tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    ids = answers_with(monkeypatch, "refine", refinement=True)
    own = tmp_path / "own"
    said = say("--store", own, "demo", tmp_path / "demo", "--hide", "none", "--json")
    assert said.code == 0, said.err
    result = json.loads(said.out)
    assert result["store"] == str(own), "a store that is named is the one that is used"
    assert (own / "catalog.duckdb").exists()
    assert not (tmp_path / "demo" / "thermodata.store").exists()
    assert (result["claims"], result["refinements"], result["found"]) == ([], ids, None)
    assert result["rmse_um_after"] is None
    assert f"refined by           {ids[0]} and {ids[1]}".split() == summary_text(result).split("\n")[3].split()


def test_a_folder_with_other_things_is_refused_untouched(tmp_path: Path) -> None:
    (tmp_path / "campaign.yaml").write_text("measured for months")
    with pytest.raises(UsageError, match="not made by a demo"):
        prepare(tmp_path, None, 1)
    assert (tmp_path / "campaign.yaml").read_text() == "measured for months"


def test_a_link_in_a_demos_folder_is_removed_not_followed(tmp_path: Path) -> None:
    outside = tmp_path / "outside"
    outside.mkdir()
    (outside / "data").write_text("x")
    folder = tmp_path / "demo"
    folder.mkdir()
    (folder / "raw").symlink_to(outside)
    (folder / ".thermodata-demo").touch()
    prepare(folder, "none", 1)
    assert not (folder / "raw").exists()
    assert (outside / "data").read_text() == "x"


def test_the_seed_picks_what_is_hidden(tmp_path: Path) -> None:
    picked = {prepare(tmp_path / str(seed), None, seed) for seed in range(8)}
    assert len(picked) > 2
    assert prepare(tmp_path / "again", None, 3) == prepare(tmp_path / "3", None, 3)


def test_an_unknown_effect_is_named(say: Say, tmp_path: Path) -> None:
    said = say("demo", tmp_path / "d", "--hide", "feed_scrw")
    assert said.code == 2
    assert "feed_screw" in said.err


def test_simulate_refuses_a_folder_with_files(say: Say, tmp_path: Path) -> None:
    (tmp_path / "x").write_text("")
    assert say("simulate", tmp_path).code == 2


@pytest.mark.parametrize(("fitted", "before"), [(None, "5.08"), (6.5, "6.50")])
def test_the_end_of_the_story_tells_locked_tests_from_the_model_as_it_is_fitted(
    fitted: float | None, before: str
) -> None:
    """Null where its refit leaves as much."""
    result = dict.fromkeys(KEYS) | {"claims": ["feed_screw:feed_Z"], "refinements": [], "seconds": 16.0}
    locked = {"locked_rmse_um_before": 5.08, "locked_rmse_um_after": 0.849, "locked_rmse_um_fitted": fitted}
    lines = summary_text({**result, "rmse_um_before": 2.99, "rmse_um_after": 0.6, **locked}).splitlines()
    assert [line.split(maxsplit=2)[2] for line in lines if line.startswith("locked")] == [f"{before} -> 0.849 um"]
