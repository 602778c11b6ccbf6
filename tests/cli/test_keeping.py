"""Keeping a store that others use, too: ids of campaigns, and what another version has left in it."""

from __future__ import annotations

import json
import os
import shutil
import subprocess
import sys
from pathlib import Path

import pytest

from thermodata.schema.answers.diagnosis import Diagnosis
from thermodata.store import Store
from thermodata.store.catalogue.models.findings import keep_answer
from thermodata.store.catalogue.models.looks import count_locked_look

from ..commands import Say
from .conftest import write_campaign


def test_a_colleagues_campaign_of_the_same_id_is_refused_or_replaced_on_demand(
    say: Say, made_campaign: Path, tmp_path: Path
) -> None:
    store = shutil.copytree(made_campaign / "thermodata.store", tmp_path / "own.store")
    theirs = write_campaign(tmp_path / "messung")
    theirs.write_text(theirs.read_text().replace('id: "138"', "id: HMC01"))
    for log in (tmp_path / "messung/raw").iterdir():
        log.write_text(log.read_text() + "21600.0000,1.0,21.0,21.0,21.0,0.0,0.0\n")
    said = say("--store", store, "ingest", theirs)
    assert said.code == 2
    assert said.out == ""
    assert "machine 138" in said.err
    assert "heat1" in said.err
    assert "--replace" in said.err
    assert '"138"' in say("--store", store, "sql", "select distinct machine from machine", "--json").out
    assert say("--store", store, "ingest", theirs, "--replace").code == 0
    assert "HMC01" in say("--store", store, "sql", "select distinct machine from machine", "--json").out


def test_init_says_that_another_campaign_has_the_folders_name(say: Say, campaign: Path, tmp_path: Path) -> None:
    write_campaign(tmp_path / "hall/small")
    (tmp_path / "hall/small/campaign.yaml").unlink()
    said = say("--store", campaign / "thermodata.store", "init", tmp_path / "hall/small")
    assert said.code == 0
    assert "its id is 'hall-small': the store holds another campaign 'small'" in said.err
    assert "\nid: hall-small" in (tmp_path / "hall/small/campaign.yaml").read_text()


def test_a_fit_of_another_version_is_no_defect(say: Say, made_campaign: Path, tmp_path: Path) -> None:
    store = shutil.copytree(made_campaign / "thermodata.store", tmp_path / "own.store")
    with Store(store).write() as con:
        con.execute("update model set result = json_merge_patch(result, '{\"newest_key\": 1}')")
    said = say("--store", store, "history", "baseline")
    assert said.code == 4
    assert "defect" not in said.err
    assert "another version of thermodata wrote it" in said.err
    assert "newest_key" in said.err


def test_a_campaign_of_another_version_is_no_defect(say: Say, made_campaign: Path, tmp_path: Path) -> None:
    store = shutil.copytree(made_campaign / "thermodata.store", tmp_path / "own.store")
    with Store(store).write() as con:
        con.execute("update campaign set spec = json_merge_patch(spec, '{\"newest_key\": 1}')")
    said = say("--store", store, "trace", "small", "heat1")
    assert said.code == 4
    assert "campaign small" in said.err
    assert "newest_key" in said.err


@pytest.mark.parametrize("data", [True, False])
def test_another_answer_of_earlier_rules_is_told(say: Say, made_campaign: Path, tmp_path: Path, data: bool) -> None:
    store = shutil.copytree(made_campaign / "thermodata.store", tmp_path / "own.store")
    first = say("--store", store, "diagnose", "baseline", "--json")
    assert "asked anew" not in first.err
    found = Diagnosis.model_validate({k: v for k, v in json.loads(first.out).items() if k != "stale"})
    claim = found.candidates[0].model_copy(update={"probability": 0.58})
    changed = {"candidates": [claim, *found.candidates[1:]]} | ({"data_version": "other"} if data else {})
    keep_answer(
        Store(store), found.model, "diagnose", "of other rules", found.model_copy(update=changed).model_dump_json()
    )
    again = say("--store", store, "diagnose", "baseline", "--json")
    assert again.out == first.out
    (told,) = [line for line in again.err.splitlines() if "asked anew" in line]
    assert "for the data changed since" in told if data else "for the rules of the diagnosis, the effects or" in told
    assert "missing: " in told
    assert "58 %" in told
    keep_answer(Store(store), found.model, "diagnose", "of other rules", found.model_dump_json())
    assert "asked anew" not in say("--store", store, "diagnose", "baseline", "--json").err, "it said the same"


def test_an_answer_that_another_version_wrote_is_asked_anew(say: Say, made_campaign: Path, tmp_path: Path) -> None:
    store = shutil.copytree(made_campaign / "thermodata.store", tmp_path / "own.store")
    first = say("--store", store, "diagnose", "baseline", "--json")
    with Store(store).write() as con:
        for kind, words in (("diagnosis", '{"oldest": 1}'), ("answer:diagnose", '{"answer": {"oldest": 1}}')):
            con.execute("update finding set payload = json_merge_patch(payload, ?) where kind = ?", [words, kind])
    refused = say("--store", store, "add", "baseline", "1")
    assert refused.code == 2
    assert "thermodata diagnose" in refused.err
    again = say("--store", store, "diagnose", "baseline", "--json")
    assert (again.code, again.out) == (0, first.out)
    assert "from the store" not in again.err


def test_a_campaign_without_a_test_is_traced_by_its_tests(say: Say, campaign: Path) -> None:
    said = say("--store", campaign / "thermodata.store", "trace", "small")
    assert said.code == 2
    assert "'small' is a campaign" in said.err
    assert "heat1, heat2, day1 and day2" in said.err or "heat1, heat2, day1, day2" in said.err
    assert "thermodata trace small heat1" in said.err
    assert "no model 'smal'" in say("--store", campaign / "thermodata.store", "trace", "smal").err


@pytest.mark.skipif(os.name != "posix", reason="pipes of POSIX")
@pytest.mark.parametrize("words", [["sql", "from range(300000)", "--csv"], ["--help"]])
def test_a_reader_who_has_read_enough_is_no_failure(tmp_path: Path, words: list[str]) -> None:
    Store(tmp_path / "s", create=True)
    # who writes finds the pipe closed, as behind `| head -1`
    reads, writes = os.pipe()
    os.close(reads)
    command = [sys.executable, "-m", "thermodata", "--store", str(tmp_path / "s"), *words]
    done = subprocess.run(command, stdout=writes, stderr=subprocess.PIPE, text=True, check=False)
    os.close(writes)
    assert (done.returncode, done.stderr) == (0, "")


@pytest.mark.parametrize(
    ("query", "told"),
    [
        ("select id from test", 'test.test is its name; thermodata sql "describe test"'),
        ("select c.id from campaign c", "campaign.campaign is its name"),
        ("select id from temperature", 'thermodata sql "describe temperature" lists its columns'),
    ],
)
def test_an_unknown_column_is_answered_with_where_the_names_stand(
    say: Say, campaign: Path, query: str, told: str
) -> None:
    said = say("--store", campaign / "thermodata.store", "sql", query)
    assert said.code == 2
    assert told in said.err


@pytest.mark.parametrize(
    ("words", "usage", "told", "not_told"),
    [
        (["plugins", "show"], "plugins show [OPTIONS] [NAME]", "equation", "reader-NAME"),
        (["plugins", "new"], "plugins new [OPTIONS] [NAME]", "reader-NAME", "equation"),
        (["model", "export"], "model export [OPTIONS] MODEL", "--to", "export]"),
        (["plugins"], "plugins [OPTIONS] [show|new] [NAME]", "equation", "Structured"),
    ],
)
def test_an_action_has_its_own_help(say: Say, words: list[str], usage: str, told: str, not_told: str) -> None:
    said = say(*words, "--help")
    assert (said.code, said.err) == (0, "")
    assert f"thermodata {usage}" in said.out
    assert told in said.out
    assert not_told not in said.out


def test_an_unknown_model_is_answered_with_those_that_are_there(say: Say, own: Path, tmp_path: Path) -> None:
    said = say("--store", own / "thermodata.store", "history", "nix")
    assert "expected: baseline" in said.err
    assert "thermodata models lists" in said.err
    Store(tmp_path / "s", create=True)
    assert "thermodata fit MODEL.yaml" in say("--store", tmp_path / "s", "history", "nix").err


def test_one_stale_model_is_one(say: Say, own: Path) -> None:
    file = own / "campaign.yaml"
    file.write_text(
        file.read_text().replace(
            "id: heat2, kind: mixed, role: calibration", "id: heat2, kind: mixed, role: verification"
        )
    )
    said = say("--store", own / "thermodata.store", "ingest", file)
    assert "1 fitted model is stale now: fit it again" in said.out


def test_what_is_forgotten_stays_on_the_disk_until_gc_which_says_what_it_leaves(
    say: Say, made_campaign: Path, tmp_path: Path
) -> None:
    store = shutil.copytree(made_campaign / "thermodata.store", tmp_path / "own.store")
    for file in store.rglob("*.parquet"):
        os.utime(file)
    said = say("--store", store, "forget", "small", "day2")
    assert (said.code, "stay on the disk until thermodata gc" in said.err) == (0, True)
    said = say("--store", store, "gc")
    assert said.code == 0
    assert "younger than 1 h and left alone, for an ingest may be writing" in said.err
    said = say("--store", store, "gc", "--grace", "0 s")
    assert "left alone" not in said.err


def test_versions_of_models_are_forgotten_from_the_newest_on_and_their_looks_count_on(
    say: Say, made_campaign: Path, tmp_path: Path
) -> None:
    store = shutil.copytree(made_campaign / "thermodata.store", tmp_path / "own.store")

    def models() -> list[str]:
        return [m["model"] for m in json.loads(say("--store", store, "models", "--json").out)]

    (first,) = models()
    newer = json.loads(say("--store", store, "add", first, "lag:T_nut_Z", "--json").out)["model"]
    count_locked_look(Store(store), newer, [("small", "day2")], "to see")
    newest = json.loads(say("--store", store, "add", newer, "lag:T_hall", "--plain", "--json").out)["model"]
    said = say("--store", store, "forget", "--model", first)
    assert said.code == 2
    assert f"forget these too: {newer}, {newest}" in said.err, "with all that was made from these"
    assert set(models()) == {first, newer, newest}
    assert say("--store", store, "forget", "--model", newest).code == 0
    said = say("--store", store, "forget", "--model", newer)
    assert (said.code, "looks at locked tests that were opened for them stay counted: 1" in said.err) == (0, True)
    assert models() == [first]
    for table in ("fit", "score", "prediction", "finding", "model"):
        assert newer not in say("--store", store, "sql", f"select * from {table}", "--json").out
    assert newer in say("--store", store, "sql", "select * from locked_look", "--json").out


@pytest.mark.parametrize("asked", [(), ("small", "--model", "baseline"), ("--model", "baseline", "--earlier")])
def test_forget_asks_for_a_campaign_or_models(say: Say, made_campaign: Path, asked: tuple[str, ...]) -> None:
    said = say("--store", made_campaign / "thermodata.store", "forget", *asked)
    assert said.code == 2
    assert "a CAMPAIGN, or --model MODEL" in said.err
